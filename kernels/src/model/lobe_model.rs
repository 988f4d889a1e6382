//! Models that are defined by their lobes alone, and the code that these models share.

mod mixture;

use mixture::Mixture;

use crate::model::lobe::{PerLobe, times};
use crate::model::{Direction, Eval, Hit, LobeEval, LobeMask, Model, SampleLanes};
use crate::simd::{Broadcast, Choice, LaneStruct, Lanes, Scalar, Vec3x, lanes3};
use wide::f32x8;

/// Scattering model defined by its lobes: the trait to implement for a new model.
///
/// Every `LobeModel` is a [`Model`]. The library provides guards, the handling of non-finite inputs, the choice of a lobe, the
/// density of the mixture, discarded samples, weights, masks, packing and a quadrature of the albedo. Scalar calls, eight lanes,
/// dispatch and columns follow.
///
/// # What an implementation promises
///
/// - `lobes`, `weights` and `sample_lobe` return no NaN for the directions and numbers they receive. Both directions are unit
///   vectors further than [`GRAZING`](crate::model::GRAZING) from the axis (except `wo`, which may lie on the axis). `h` is in
///   `[-1, 1]`, and `xi` in `[0, 1)`.
/// - `sample_lobe` draws from the density that `lobes` reports, which is above 0 wherever the lobe scatters.
/// - Every function over lanes, and every function it calls, is `#[inline(always)]`. Array `map` and closures over lanes count as
///   calls.
///
/// # Examples
///
/// The example below is a complete model of one lobe. A model of two lobes, with a sampler of its own, is `examples/lambert_fiber`
/// of the package `hairis-variants`.
///
/// ```
/// use core::f32::consts::FRAC_1_PI;
/// use glam::Vec3;
/// use hairis::model::{Direction, LobeEval, LobeModel};
/// use hairis::simd::{Broadcast, Lanes, Scalar, lane_struct, lanes3};
/// use hairis::{Hit, Material, PerLobe};
///
/// /// A fibre that scatters evenly: `S cos theta_i = albedo / (4 pi)`, whatever the direction.
/// #[derive(Clone, Copy)]
/// struct Even;
///
/// lane_struct! {
///     /// Material and shading point alike: the albedo, linear RGB.
///     pub struct Albedo {
///         /// Red, green and blue.
///         pub rgb: [C; 3],
///     }
/// }
///
/// impl LobeModel for Even {
///     type Params = [f32; 3];
///     type Material<C: Scalar> = Albedo<C>;
///     type Prepared<C: Scalar> = Albedo<C>;
///
///     const LOBES: &'static [&'static str] = &["even"];
///
///     fn material(&self, albedo: &[f32; 3]) -> Albedo<f32> {
///         Albedo { rgb: *albedo }
///     }
///
///     #[inline(always)]
///     fn prepare<L: Lanes, C: Broadcast<L>>(material: &Albedo<C>, _hit: Hit<L>) -> Albedo<L::Stored> {
///         material.spread::<L>()
///     }
///
///     #[inline(always)]
///     fn weights<L: Lanes, C: Broadcast<L>>(_prepared: &Albedo<C>) -> PerLobe<L> {
///         PerLobe::padded([L::splat(1.0)], L::splat(0.0))
///     }
///
///     #[inline(always)]
///     fn lobes<L: Lanes, C: Broadcast<L>>(prepared: &Albedo<C>, wi: &Direction<L>) -> PerLobe<LobeEval<L>> {
///         let pdf = L::splat(0.25 * FRAC_1_PI);
///         let lobe = LobeEval { value: L::quotient(pdf, wi.cos_theta), color: lanes3(&prepared.rgb), pdf };
///         PerLobe::padded([lobe], LobeEval::none())
///     }
///
///     #[inline(always)]
///     fn sample_lobe<L: Lanes, C: Broadcast<L>>(_: &Albedo<C>, _: L::Index, xi: [L; 3]) -> Direction<L> {
///         let (one, sin) = (L::splat(1.0), xi[1] + xi[1] - 1.0);
///         Direction::with_uniform_azimuth([sin, ((one - sin) * (one + sin)).sqrt()], xi[2])
///     }
/// }
///
/// let prepared = Material::new(&Even, &[0.9, 0.5, 0.1]).prepare(Vec3::Y);
/// let sample = prepared.sample([0.2, 0.6, 0.3]).expect("not along the fibre");
/// assert!((sample.weight[0] - 0.9).abs() < 1e-6 && (prepared.albedo().0[0][2] - 0.1).abs() < 1e-6);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scattering model",
    note = "a bell is part of one: `Published(Gaussian)`, `Matched::new(Gaussian)`"
)]
pub trait LobeModel: Copy {
    /// Checked parameters of a material.
    type Params;
    /// Constants of a material, declared with [`lane_struct!`](crate::simd::lane_struct).
    type Material<C: Scalar>: LaneStruct<Number = C, One = Self::Material<f32>, Eight = Self::Material<f32x8>>;
    /// Constants of a shading point.
    type Prepared<C: Scalar>: LaneStruct<Number = C, One = Self::Prepared<f32>, Eight = Self::Prepared<f32x8>>;

    /// Names of the lobes in slot order, 1 to 4 of them.
    const LOBES: &'static [&'static str];
    /// True if the parameters alone limit how much light returns: see [`Model::CONSERVES`]. For a `LobeModel` where this is false,
    /// [`Conserving`](crate::Conserving) fails to compile when it makes a material.
    const CONSERVES: bool = false;

    /// Computes the constants of a material from its parameters.
    fn material(&self, params: &Self::Params) -> Self::Material<f32>;

    /// Computes everything that depends on the material and the hit alone. `wo` may have any length: see [`Direction::normalized`].
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Self::Material<C>,
        hit: Hit<L>,
    ) -> Self::Prepared<L::Stored>;

    /// Returns the sampling weight of each lobe, to any common scale, and 0 for slots without a lobe.
    fn weights<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> PerLobe<L>;

    /// Estimates the albedo of each lobe, as the mean over the channels: see [`Model::energy`].
    ///
    /// Provided: the [`weights`](Self::weights), for models whose weights are such estimates.
    #[inline(always)]
    fn energies<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> PerLobe<L> {
        Self::weights(prepared)
    }

    /// Evaluates each lobe's value, colour and own density at a direction.
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        wi: &Direction<L>,
    ) -> PerLobe<LobeEval<L>>;

    /// Evaluates the lobes of [`lobes`](Self::lobes) without the slots that a `LobeModel` leaves empty.
    ///
    /// Provided: those of `lobes`. Models with four lobes may construct the array here, which spares compilers the empty slot.
    #[doc(hidden)]
    #[inline(always)]
    fn first_four<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        wi: &Direction<L>,
    ) -> [LobeEval<L>; 4] {
        four(Self::lobes(prepared, wi))
    }

    /// Draws a direction from the lobe of each lane. All three numbers are uniform in `[0, 1)`: the first has chosen the lobe, and
    /// is stretched to the whole interval again.
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        lobe: L::Index,
        xi: [L; 3],
    ) -> Direction<L>;

    /// Returns the directional albedo of each lobe, linear RGB.
    ///
    /// - Accuracy: the provided quadrature draws 1024 lattice points per lobe by `sample_lobe`. Its error is 1e-6 if the weights
    ///   depend on the second number alone and smoothly, up to square roots at its ends. Override it if there is a closed form.
    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> PerLobe<[L; 3]> {
        sampled_albedo::<Self, L, C>(prepared)
    }
}

/// Constants of a shading point of a [`LobeModel`], and the mixture of its lobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixed<P, C> {
    prepared: P,
    mixture: Mixture<C>,
}

impl<P, C> Mixed<P, C> {
    /// Returns the constants that the model itself computed.
    #[inline(always)]
    #[must_use]
    pub const fn prepared(&self) -> &P {
        &self.prepared
    }
}

crate::simd::lane_struct! {
    @impl {P: LaneStruct<Number = C>, C: Scalar} C, Mixed {P, C} {P::One, f32} {P::Eight, f32x8}
    prepared: P, mixture: Mixture<C>
}

/// Largest number of lobes.
const MOST: usize = 4;
/// Density below which a sample is discarded, because close to denormals its weight would have no digits.
const LEAST_DENSITY: f32 = 1e-30;
/// Largest uniform number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// Sums value and density over the lobes; the sums are 0 where `wi` is not a valid direction, and the density is at least `least`.
#[inline(always)]
fn total<M: LobeModel, L: Lanes, C: Broadcast<L>>(
    prepared: &Mixed<M::Prepared<C>, C>,
    wi: &Direction<L>,
    least: L,
) -> Eval<L> {
    let mixture = &prepared.mixture;
    let lobes = M::first_four(&prepared.prepared, wi);
    L::stage("value and density: sums over the lobes, 0 where wi is no direction");
    let value = lobes[0].value * mixture.kept[0].lanes();
    let [r, g, b] = lobes[0].color;
    let mut sum = [
        value * r,
        value * g,
        value * b,
        lobes[0].pdf * mixture.selection[0].lanes(),
    ];
    // Written out: slots without a lobe cost nothing.
    macro_rules! add {
        ($($i:literal)*) => { $(
            if $i < M::LOBES.len() {
                let value = lobes[$i].value * mixture.kept[$i].lanes();
                let [r, g, b] = lobes[$i].color;
                sum = [
                    value.mul_add(r, sum[0]),
                    value.mul_add(g, sum[1]),
                    value.mul_add(b, sum[2]),
                    lobes[$i].pdf.mul_add(mixture.selection[$i].lanes(), sum[3]),
                ];
            }
        )* };
    }
    add!(1 2 3);
    let limit = limit::<L>(wi.is_sound());
    let [r, g, b, pdf] = sum;
    Eval {
        value: [within(r, limit), within(g, limit), within(b, limit)],
        pdf: least.max(pdf.min(limit)),
    }
}

/// Draws the direction of a sample and its lobe, and returns whether the numbers are numbers.
#[inline(always)]
fn drawn<M: LobeModel, L: Lanes, C: Broadcast<L>>(
    prepared: &Mixed<M::Prepared<C>, C>,
    xi: [L; 3],
) -> (Direction<L>, L::Index, L::Mask) {
    let c = L::splat;
    let (zero, most) = (c(0.0), c(BELOW_ONE));
    L::stage("lobe that xi.x selects, and xi.x stretched to [0, 1) again");
    let m = &prepared.mixture;
    let lobe = L::Index::search(xi[0], lanes3(&m.bounds), M::LOBES.len() - 1);
    // From the nearer end, where differences are exact: a rare lobe keeps the low bits.
    let (start, start_less_one) = (
        C::look_up(&m.start, lobe),
        C::look_up(&m.start_less_one, lobe),
    );
    let into = L::select(
        xi[0].lt(c(0.5)),
        xi[0] - start,
        (xi[0] - 1.0) - start_less_one,
    );
    // A lobe without energy has no share.
    let share = C::look_up(&m.selection, lobe).max(c(f32::MIN_POSITIVE));
    let again = L::quotient(into, share);
    // False for NaN.
    let numbers = (xi[0] + xi[1] + xi[2]).lt(c(f32::INFINITY));
    let xi = [
        zero.max(again.min(most)),
        zero.max(xi[1].min(most)),
        zero.max(xi[2].min(most)),
    ];
    let wi = M::sample_lobe(&prepared.prepared, lobe, xi);
    (wi, lobe, numbers)
}

/// Returns the numbers of the slots that a `LobeModel` may have.
#[inline(always)]
fn four<L>(PerLobe([a, b, c, d, _]): PerLobe<L>) -> [L; MOST] {
    [a, b, c, d]
}

/// Returns the largest result where a lane is sound, and 0 where it is not.
#[inline(always)]
fn limit<L: Lanes>(sound: L::Mask) -> L {
    L::keep(sound, L::splat(f32::MAX))
}

/// Clamps `x` between 0 and `limit`; NaN becomes the limit.
#[inline(always)]
fn within<L: Lanes>(x: L, limit: L) -> L {
    L::splat(0.0).max(x.min(limit))
}

/// Clamps each number to at most `limit`.
#[inline(always)]
fn min3<L: Lanes>([x, y, z]: [L; 3], limit: L) -> [L; 3] {
    [x.min(limit), y.min(limit), z.min(limit)]
}

impl<M: LobeModel> Model for M {
    type Params = M::Params;
    type Material<C: Scalar> = M::Material<C>;
    type Prepared<C: Scalar> = Mixed<M::Prepared<C>, C>;
    type Fit<C: Scalar> = [C; 0];
    type Inner = Self;

    const CONSERVES: bool = M::CONSERVES;
    const LOBES: &'static [&'static str] = {
        assert!(
            !M::LOBES.is_empty() && M::LOBES.len() <= MOST,
            "a `LobeModel` has 1 to 4 lobes"
        );
        M::LOBES
    };

    #[inline]
    fn material(&self, params: &M::Params) -> M::Material<f32> {
        LobeModel::material(self, params)
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &M::Material<C>,
        hit: Hit<L>,
    ) -> Mixed<M::Prepared<L::Stored>, L::Stored> {
        let (Hit { wo, h }, finite) = hit.finite();
        let prepared = <M as LobeModel>::prepare(material, Hit::new(wo, h));
        L::stage("probability of each lobe");
        let kept = L::keep(finite, L::splat(1.0));
        let mixture = Mixture::new(four(M::weights::<L, L::Stored>(&prepared)), [kept; 4]).store();
        Mixed { prepared, mixture }
    }

    #[inline(always)]
    fn restrict<C: Lanes>(
        prepared: &Mixed<M::Prepared<C>, C>,
        lobes: LobeMask,
    ) -> Mixed<M::Prepared<C>, C> {
        let Mixture {
            selection, kept, ..
        } = prepared.mixture;
        Mixed {
            mixture: Mixture::new(selection, times(kept, lobes.factors())),
            ..*prepared
        }
    }

    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L>>(
        prepared: &Mixed<M::Prepared<C>, C>,
        wi: Vec3x<L>,
    ) -> Eval<L> {
        total::<M, L, C>(prepared, &Direction::new(wi), L::splat(0.0))
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Mixed<M::Prepared<C>, C>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>> {
        let wi = Direction::new(wi);
        let limit = limit::<L>(wi.is_sound());
        let mut lobes = <M as LobeModel>::lobes(&prepared.prepared, &wi);
        L::stage("value and density of each lobe, 0 where wi is no direction");
        let mut l = 0;
        while l < M::LOBES.len() {
            let kept: L = prepared.mixture.kept[l].lanes();
            lobes.0[l].value = within(lobes.0[l].value * kept, limit);
            lobes.0[l].pdf = within(lobes.0[l].pdf * kept, limit);
            l += 1;
        }
        // A constant, so that it costs nothing.
        lobes.0[MOST] = LobeEval::none();
        lobes
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &Mixed<M::Prepared<C>, C>,
        xi: [L; 3],
    ) -> SampleLanes<L> {
        let c = L::splat;
        let (wi, lobe, numbers) = drawn::<M, L, C>(prepared, xi);
        // A divisor, and so above 0.
        let least = c(LEAST_DENSITY);
        let Eval { value, pdf } = total::<M, L, C>(prepared, &wi, least);
        L::stage("density and weight of the sample, 0 where it is discarded");
        let sound = L::and(L::and(wi.is_sound(), least.lt(pdf)), numbers);
        let limit = limit::<L>(sound);
        let by = L::quotient(wi.cos_theta, pdf);
        let Vec3x { x, y, z } = wi.vector;
        SampleLanes {
            wi: Vec3x::new(L::keep(sound, x), L::keep(sound, y), L::keep(sound, z)),
            value: min3(value, limit),
            pdf: pdf.min(limit),
            weight: min3([value[0] * by, value[1] * by, value[2] * by], limit),
            slot: L::select_predictable(sound, lobe.to_number(), c(-1.0)),
        }
    }

    #[inline(always)]
    fn draw<L: Lanes, C: Broadcast<L>>(
        prepared: &Mixed<M::Prepared<C>, C>,
        xi: [L; 3],
    ) -> (Vec3x<L>, L) {
        let (wi, lobe, _) = drawn::<M, L, C>(prepared, xi);
        (wi.vector, lobe.to_number())
    }

    #[inline(always)]
    fn energy<L: Lanes, C: Broadcast<L>>(prepared: &Mixed<M::Prepared<C>, C>) -> L {
        let energies = four(M::energies::<L, C>(&prepared.prepared));
        let most = L::splat(f32::MAX / 8.0);
        let (mut sum, mut l) = (L::splat(0.0), 0);
        while l < M::LOBES.len() {
            let kept: L = prepared.mixture.kept[l].lanes();
            sum = sum + energies[l].min(most) * kept;
            l += 1;
        }
        sum
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &Mixed<M::Prepared<C>, C>) -> PerLobe<[L; 3]> {
        let mut albedo = four(<M as LobeModel>::albedo::<L, C>(&prepared.prepared));
        let most = L::splat(f32::MAX);
        let mut l = 0;
        while l < MOST {
            let kept: L = prepared.mixture.kept[l].lanes();
            // Finite first: 0 times an infinity is NaN.
            let [r, g, b] = min3(albedo[l], most);
            albedo[l] = [r * kept, g * kept, b * kept];
            l += 1;
        }
        PerLobe::padded(albedo, [L::splat(0.0); 3])
    }
}

/// Computes each lobe's albedo as the mean weight of its samples at the points of a lattice.
#[inline(always)]
fn sampled_albedo<M: LobeModel, L: Lanes, C: Broadcast<L>>(
    prepared: &M::Prepared<C>,
) -> PerLobe<[L; 3]> {
    const STEPS: u16 = 1024;
    let c = L::splat;
    let mut albedo = [[c(0.0); 3]; MOST];
    let mut l = 0;
    while l < M::LOBES.len() {
        let lobe = L::Index::search(c([0.0, 1.0, 2.0, 3.0][l]), [c(1.0), c(2.0), c(3.0)], 3);
        let (mut sum, mut color) = (c(0.0), [c(0.0); 3]);
        let mut step = 0;
        while step < STEPS {
            // The lattice of the plastic number. Along the second number it is a rule of midpoints, which loses digits to
            // square roots at the ends: `3 u^2 - 2 u^3`, of slope 0 there, has none. The slopes sum to 1 + 1 / (2 STEPS^2).
            let u = (f32::from(step) + 0.5) / f32::from(STEPS);
            let slope = 6.0 * u * (1.0 - u);
            let xi = [
                c(lattice(step, 0x91e1_0da5)),
                c(u * u * (3.0 - 2.0 * u)),
                c(lattice(step, 0xc13f_a9a9)),
            ];
            let wi = M::sample_lobe(prepared, lobe, xi);
            let at = M::lobes(prepared, &wi).0[l];
            let sound = L::and(wi.is_sound(), c(LEAST_DENSITY).lt(at.pdf));
            sum = sum
                + L::select(
                    sound,
                    L::quotient(at.value * wi.cos_theta, at.pdf.max(c(LEAST_DENSITY))) * slope,
                    c(0.0),
                );
            color = at.color;
            step += 1;
        }
        let mean = sum * c(1.0 / (f32::from(STEPS) + 0.5 / f32::from(STEPS)));
        albedo[l] = [color[0] * mean, color[1] * mean, color[2] * mean];
        l += 1;
    }
    PerLobe::padded(albedo, [c(0.0); 3])
}

/// Returns the fractional part of `(step + 1/2) ratio / 2^32`, in integers, because `floor` would be a call in every step.
#[inline(always)]
#[expect(clippy::cast_precision_loss, reason = "24 bits fit a float exactly")]
fn lattice(step: u16, ratio: u32) -> f32 {
    let fraction = u32::from(step).wrapping_mul(ratio).wrapping_add(ratio / 2);
    (fraction >> 8) as f32 * (1.0 / 16_777_216.0)
}
