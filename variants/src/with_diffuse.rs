//! Diffuse part for any model: a Lambertian cylinder beside its lobes.

mod entry;
mod params;
mod part;

pub use params::{DiffusePresets, WithDiffuseDesc, WithDiffuseParams};
pub(crate) use params::{OWN as DIFFUSE_FIELDS, check_diffuse};
use part::{DiffuseChoice, DiffuseMaterial, DiffusePrepared, mean};

use crate::cylinder;
use hairis::model::{Direction, LobeEval, LobeMask, Model, SampleLanes};
use hairis::simd::{Broadcast, LaneStruct, Lanes, Scalar, Vec3x, f32x8, lane_struct, lanes3};
use hairis::{Eval, Hit, Lobe, PerLobe};

/// Model `M` with a diffuse part: a Lambertian cylinder as its last lobe, for dust, grease, cloth and fur that no lobe of `M` describes.
///
/// `S = (1 - diffuse) S_M + diffuse diffuse_color (sin |phi| + (pi - |phi|) cos phi) / (4 pi)`, with `phi = phi_i - phi_o` in `[-pi, pi]`.
/// Without a diffuse part, `diffuse = 0`, value and density are those of `M` to the bit.
///
/// - Lobes: those of `M`, at most four, and "diffuse" in the slot after them.
/// - Far field: the cylinder does not read [`Hit::h`], whether or not `M` does. A near-field model has the mean of the cylinder over the
///   width at every offset.
/// - Energy: the albedo of the cylinder is `diffuse diffuse_color`, and that of `M` is scaled by `1 - diffuse`, so that the whole conserves
///   energy where `M` does. [`Conserving`](hairis::Conserving) limits the part of `M` alone.
/// - Sampling: exact. The first number chooses between `M` and the cylinder by the energies of both at the hit ([`Model::energy`]), and is
///   stretched to the whole interval again. The cylinder draws a normal from the width that is seen, and a direction about it by its cosine.
/// - Weights: at most the largest weight of `M` times `1 - diffuse` over the probability of `M`, plus `diffuse diffuse_color` over that of
///   the cylinder.
/// - Source: Lambert's law integrated over the width of a cylinder, as d'Eon et al. 2011 and Kajiya & Kay 1989 use it; the names are those
///   of Arnold's `standard_hair`.
/// - Accuracy: that of `M`, and 1e-5 for the cylinder.
///
/// ```
/// use glam::Vec3;
/// use hairis::{Gaussian, HairParams, Material, Published};
/// use hairis_variants::{WithDiffuse, WithDiffuseDesc, WithDiffuseParams};
/// let desc = WithDiffuseDesc { fiber: HairParams::brown(), diffuse: 0.2, diffuse_color: [0.6, 0.4, 0.3] };
/// let hair = Material::new(&WithDiffuse(Published(Gaussian)), &WithDiffuseParams::new(&desc)?);
/// let bsdf = hair.prepare(Vec3::new(0.6, 0.8, 0.0));
/// assert!((bsdf.albedo().0[4][0] - 0.12).abs() < 1e-6);
/// assert!(bsdf.sample([0.99, 0.25, 0.75]).is_some());
/// # Ok::<(), hairis::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithDiffuse<M>(pub M);

/// Constants of a material: those of the model, and those of the diffuse part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithDiffuseMaterial<I, C> {
    fiber: I,
    diffuse: DiffuseMaterial<C>,
}

lane_struct! {
    @impl {I: LaneStruct<Number = C>, C: Scalar} C, WithDiffuseMaterial {I, C} {I::One, f32} {I::Eight, f32x8}
    fiber: I, diffuse: DiffuseMaterial<C>
}

/// Constants of a shading point: those of the model, and those of the diffuse part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithDiffusePrepared<P, C> {
    fiber: P,
    diffuse: DiffusePrepared<C>,
}

lane_struct! {
    @impl {P: LaneStruct<Number = C>, C: Scalar} C, WithDiffusePrepared {P, C} {P::One, f32} {P::Eight, f32x8}
    fiber: P, diffuse: DiffusePrepared<C>
}

impl<P, C> WithDiffusePrepared<P, C> {
    /// Returns the constants of the model without its diffuse part.
    #[inline(always)]
    #[must_use]
    pub const fn fiber(&self) -> &P {
        &self.fiber
    }
}

/// Density below which a sample is discarded, because close to denormals its weight would have no digits.
const LEAST_DENSITY: f32 = 1e-30;
/// Largest uniform number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
/// Returns a shading point of the model with the diffuse part, which is chosen anew by their energies.
#[inline(always)]
fn with_choice<M: Model, L: Lanes>(
    fiber: M::Prepared<L::Stored>,
    diffuse: DiffusePrepared<L::Stored>,
) -> WithDiffusePrepared<M::Prepared<L::Stored>, L::Stored> {
    let model = diffuse.share.lanes() * M::energy::<L, L::Stored>(&fiber);
    let cylinder = diffuse.kept.lanes() * mean::<L>(lanes3(&diffuse.color));
    let choice = DiffuseChoice::new(model, cylinder).store();
    let diffuse = DiffusePrepared { choice, ..diffuse };
    WithDiffusePrepared { fiber, diffuse }
}

/// Clamps `x` between 0 and `limit`; NaN becomes the limit.
#[inline(always)]
fn within<L: Lanes>(x: L, limit: L) -> L {
    L::splat(0.0).max(x.min(limit))
}

/// Returns the largest result where a lane is sound, and 0 where it is not.
#[inline(always)]
fn limit<L: Lanes>(sound: L::Mask) -> L {
    L::keep(sound, L::splat(f32::MAX))
}

/// Sums value and density of the model and of the cylinder.
#[inline(always)]
fn total<M: Model, L: Lanes, C: Broadcast<L>>(
    prepared: &WithDiffusePrepared<M::Prepared<C>, C>,
    wi: &Direction<L>,
) -> Eval<L> {
    let own = &prepared.diffuse;
    let fiber = M::eval::<L, C>(&prepared.fiber, wi.vector);
    let [value, pdf] = own.at(wi);
    L::stage("value and density: sums over the model and the diffuse lobe");
    let (share, color, limit) = (
        own.share.lanes(),
        lanes3(&own.color),
        limit::<L>(wi.is_sound()),
    );
    let [q, p] = [
        own.choice.selection[0].lanes(),
        own.choice.selection[1].lanes(),
    ];
    let channel = |c: usize| within(value.mul_add(color[c], fiber.value[c] * share), limit);
    Eval {
        value: [channel(0), channel(1), channel(2)],
        pdf: within(pdf.mul_add(p, fiber.pdf * q), limit),
    }
}

impl<M: Model> WithDiffuse<M> {
    /// Slot of the diffuse lobe, after those of the model.
    const SLOT: usize = {
        assert!(
            M::LOBES.len() < Lobe::COUNT,
            "a model with a diffuse part has at most 4 lobes"
        );
        M::LOBES.len()
    };
    const NAMES: [&'static str; Lobe::COUNT] = {
        let mut names = ["diffuse"; Lobe::COUNT];
        let mut slot = 0;
        while slot < Self::SLOT {
            names[slot] = M::LOBES[slot];
            slot += 1;
        }
        names
    };
}

impl<M: Model> Model for WithDiffuse<M> {
    type Params = WithDiffuseParams<M::Params>;
    type Material<C: Scalar> = WithDiffuseMaterial<M::Material<C>, C>;
    type Prepared<C: Scalar> = WithDiffusePrepared<M::Prepared<C>, C>;
    type Fit<C: Scalar> = M::Fit<C>;
    type Inner = WithDiffuse<M::Inner>;

    const LOBES: &'static [&'static str] = Self::NAMES.split_at(Self::SLOT + 1).0;
    const CONSERVES: bool = M::CONSERVES;
    const INTEGRATES: bool = M::INTEGRATES;

    #[inline]
    fn material(&self, params: &Self::Params) -> Self::Material<f32> {
        let desc = params.desc();
        WithDiffuseMaterial {
            fiber: self.0.material(&desc.fiber),
            diffuse: DiffuseMaterial::new(desc.diffuse, desc.diffuse_color),
        }
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Self::Material<C>,
        hit: Hit<L>,
    ) -> Self::Prepared<L::Stored> {
        let fiber = M::prepare::<L, C>(&material.fiber, hit);
        with_choice::<M, L>(fiber, material.diffuse.prepare(hit))
    }

    #[inline(always)]
    fn prepare_one(material: &Self::Material<f32>, hit: Hit<f32>) -> Self::Prepared<f32> {
        let fiber = M::prepare_one(&material.fiber, hit);
        with_choice::<M, f32>(fiber, material.diffuse.prepare(hit))
    }

    #[inline(always)]
    fn restrict<C: Lanes + Broadcast<C>>(
        prepared: &Self::Prepared<C>,
        lobes: LobeMask,
    ) -> Self::Prepared<C> {
        let fiber = M::restrict::<C>(&prepared.fiber, lobes);
        let own = &prepared.diffuse;
        let kept = own.kept * lobes.factor(Lobe::ALL[Self::SLOT]);
        let model = own.share * M::energy::<C, C>(&fiber);
        let choice = DiffuseChoice::new(model, kept * mean(own.color));
        WithDiffusePrepared {
            fiber,
            diffuse: DiffusePrepared {
                kept,
                choice,
                ..*own
            },
        }
    }

    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>, wi: Vec3x<L>) -> Eval<L> {
        total::<M, L, C>(prepared, &Direction::new(wi))
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>> {
        let own = &prepared.diffuse;
        let mut lobes = M::lobes::<L, C>(&prepared.fiber, wi);
        let (share, mut slot) = (own.share.lanes(), 0);
        while slot < Self::SLOT {
            lobes.0[slot].value = lobes.0[slot].value * share;
            slot += 1;
        }
        let wi = Direction::new(wi);
        let ([value, pdf], limit) = (own.at(&wi), limit::<L>(wi.is_sound()));
        lobes.0[Self::SLOT] =
            LobeEval::new(within(value, limit), lanes3(&own.color), within(pdf, limit));
        lobes
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        xi: [L; 3],
    ) -> SampleLanes<L> {
        let (wi, slot) = Self::draw::<L, C>(prepared, xi);
        let wi = Direction::new(wi);
        let Eval { value, pdf } = total::<M, L, C>(prepared, &wi);
        L::stage("density and weight of the sample, 0 where it is discarded");
        let least = L::splat(LEAST_DENSITY);
        // False for NaN.
        let numbers = (xi[0] + xi[1] + xi[2]).lt(L::splat(f32::INFINITY));
        let drawn = L::and(numbers, L::splat(-0.5).lt(slot));
        let sound = L::and(L::and(wi.is_sound(), least.lt(pdf)), drawn);
        let limit = limit::<L>(sound);
        let by = L::quotient(wi.cos_theta, pdf.max(least));
        let [r, g, b] = value;
        let Vec3x { x, y, z } = wi.vector;
        SampleLanes {
            wi: Vec3x::new(L::keep(sound, x), L::keep(sound, y), L::keep(sound, z)),
            value: [r.min(limit), g.min(limit), b.min(limit)],
            pdf: pdf.min(limit),
            weight: [
                (r * by).min(limit),
                (g * by).min(limit),
                (b * by).min(limit),
            ],
            slot: L::select_predictable(sound, slot, L::splat(-1.0)),
        }
    }

    #[inline(always)]
    fn draw<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>, xi: [L; 3]) -> (Vec3x<L>, L) {
        let own = &prepared.diffuse;
        let c = L::splat;
        L::stage(
            "choice by xi.x between the model and the diffuse lobe, and xi.x stretched to [0, 1) again",
        );
        let [q, p] = [
            own.choice.selection[0].lanes(),
            own.choice.selection[1].lanes(),
        ];
        let is_model = xi[0].lt(own.choice.bound.lanes());
        // From the nearer end, where differences are exact: a rare lobe keeps the low bits.
        let above = L::select(xi[0].lt(c(0.5)), xi[0] - q, (xi[0] - 1.0) + p);
        let again = L::quotient(
            L::select(is_model, xi[0], above),
            L::select(is_model, q, p).max(c(f32::MIN_POSITIVE)),
        );
        let (zero, most) = (c(0.0), c(BELOW_ONE));
        let xi = [
            zero.max(again.min(most)),
            zero.max(xi[1].min(most)),
            zero.max(xi[2].min(most)),
        ];
        let (model, slot) = M::draw::<L, C>(&prepared.fiber, xi);
        let (theta, phi) = cylinder::draw(xi);
        let plane_o = [own.plane_o[0].lanes(), own.plane_o[1].lanes()];
        let Vec3x { x, y, z } =
            cylinder::direction(plane_o, own.inv_plane_o.lanes(), theta, phi).vector;
        let wi = Vec3x::new(
            L::select(is_model, model.x, x),
            L::select(is_model, model.y, y),
            L::select(is_model, model.z, z),
        );
        #[expect(clippy::cast_precision_loss, reason = "at most 4")]
        let own_slot = c(Self::SLOT as f32);
        (wi, L::select(is_model, slot, own_slot))
    }

    #[inline(always)]
    fn energy<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> L {
        let own = &prepared.diffuse;
        let model = own.share.lanes() * M::energy::<L, C>(&prepared.fiber);
        model + own.kept.lanes() * mean(lanes3(&own.color))
    }

    #[inline(always)]
    fn conserving<L: Lanes>(
        prepared: &Self::Prepared<L::Stored>,
        lanes: L::Mask,
    ) -> Self::Prepared<L::Stored> {
        let fiber = M::conserving::<L>(&prepared.fiber, lanes);
        with_choice::<M, L>(fiber, prepared.diffuse)
    }

    #[inline]
    fn fit(material: &Self::Material<f32>) -> M::Fit<f32> {
        M::fit(&material.fiber)
    }

    #[inline]
    fn raw_fit<C: Scalar + From<f32>>() -> M::Fit<C> {
        M::raw_fit()
    }

    #[inline(always)]
    fn fitted<L: Lanes, C: Broadcast<L>>(
        fit: &M::Fit<C>,
        prepared: &Self::Prepared<L::Stored>,
    ) -> Self::Prepared<L::Stored> {
        let fiber = M::fitted::<L, C>(fit, &prepared.fiber);
        with_choice::<M, L>(fiber, prepared.diffuse)
    }

    #[inline(always)]
    fn unfit<L: Lanes, C: Broadcast<L>>(fit: &M::Fit<C>) -> L {
        M::unfit::<L, C>(fit)
    }

    #[inline(always)]
    fn integrates<L: Lanes, C: Broadcast<L>>(material: &Self::Material<C>) -> L {
        M::integrates::<L, C>(&material.fiber)
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> PerLobe<[L; 3]> {
        let own = &prepared.diffuse;
        let mut albedo = M::albedo::<L, C>(&prepared.fiber);
        let (share, mut slot) = (own.share.lanes(), 0);
        while slot < Self::SLOT {
            let [r, g, b] = albedo.0[slot];
            albedo.0[slot] = [r * share, g * share, b * share];
            slot += 1;
        }
        let ([r, g, b], kept) = (lanes3(&own.color), own.kept.lanes());
        albedo.0[Self::SLOT] = [r * kept, g * kept, b * kept];
        albedo
    }
}
