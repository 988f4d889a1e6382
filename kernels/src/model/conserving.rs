//! Energy conservation: models whose shading points return no more light than arrives.

use crate::model::{Eval, Hit, LobeEval, Model, SampleLanes};
use crate::simd::{Broadcast, Kernel, LaneStruct, Lanes, Path, Scalar, Vec3x};
use crate::{Bsdf, Bsdf8, LobeMask, Material, Material8, PerLobe};
use wide::f32x8;

impl<M: Model> Bsdf<M> {
    /// Returns the BSDF with each channel divided by its albedo where the albedo is above 1: see [`Conserving`].
    ///
    /// Call this for parameters that vary per hit, because it integrates the lobes where [`Conserving`] reads a fit of the material.
    /// To conserve energy for some lobes alone, call `with_lobes` first: `with_lobes` of a BSDF that conserves energy keeps the
    /// factors of all lobes.
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        Self {
            prepared: M::conserving::<f32>(&self.prepared, true),
            level: self.level,
        }
    }
}

impl<M: Model> Bsdf8<M> {
    /// Returns the BSDFs with each channel divided by its albedo where the albedo is above 1: see [`Bsdf::conserving`].
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        self.conserving_where(f32x8::ONE)
    }

    /// Conserves energy in the lanes whose number is above 0.
    #[cold]
    #[inline(never)]
    pub(crate) fn conserving_where(&self, lanes: f32x8) -> Self {
        let level = self.level;
        let kernel = Integrate::<M::Inner> {
            prepared: &self.prepared,
            lanes,
        };
        level.run_into(kernel, |prepared| Self { prepared, level })
    }
}

/// Kernel of [`Model::conserving`] for eight shading points.
struct Integrate<'a, M: Model> {
    prepared: &'a M::Prepared<f32x8>,
    lanes: f32x8,
}

impl<M: Model> Kernel for Integrate<'_, M> {
    type Output = M::Prepared<f32x8>;
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> M::Prepared<f32x8> {
        M::conserving::<L>(self.prepared, L::splat(0.0).lt(self.lanes.lanes()))
    }
}

impl<M: Model> Material<Conserving<M>> {
    /// Returns true if every hit integrates the lobes, because the fit of this material is not accurate enough. Calls then take many
    /// times as long, with results as good.
    ///
    /// Lobes narrower than a degree, or intensities far above 1, may need the integrals; everyday hair does not.
    #[inline]
    #[must_use]
    pub fn integrates(&self) -> bool {
        M::unfit::<f32, f32>(&self.constants.fit) > 0.0
    }

    /// Returns the material with energy conservation, whether it conserves energy already or is [`raw`](Self::raw). The fit is made
    /// anew.
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        let inner = self.constants.inner;
        let fit = M::fit(&inner);
        Self {
            constants: ConservingMaterial { inner, fit },
            level: self.level,
        }
    }

    /// Returns the material without energy conservation, like [`from`](Self::from) of a [`Material<M>`].
    #[inline]
    #[must_use]
    pub fn raw(&self) -> Self {
        self.inner().into()
    }

    /// Returns the material of the model that conserves no energy, with the bits of [`raw`](Self::raw) and hits in less time.
    #[inline]
    #[must_use]
    pub fn inner(&self) -> Material<M> {
        Material {
            constants: self.constants.inner,
            level: self.level,
        }
    }
}

/// Conversions of a raw material to the type of one that conserves energy, with the same bits: for hosts that choose at run time,
/// because a second type would double their code. Constants that change nothing are read all the same, which
/// [`inner`](Material::inner) avoids.
macro_rules! from_raw_material {
    ($($Handle:ident)*) => { $(
        impl<M: Model> From<$Handle<M>> for $Handle<Conserving<M>> {
            #[inline]
            fn from(raw: $Handle<M>) -> Self {
                let constants = ConservingMaterial {
                    inner: raw.constants,
                    // An albedo of 0 everywhere.
                    fit: LaneStruct::make(&Path::Root, &mut |_| 0.0.into()),
                };
                Self {
                    constants,
                    level: raw.level,
                }
            }
        }
    )* };
}
from_raw_material! { Material Material8 }

/// Conversions of a raw BSDF to the type of one whose material conserves energy: both have the same constants.
macro_rules! from_raw_bsdf {
    ($($Handle:ident)*) => { $(
        impl<M: Model> From<$Handle<M>> for $Handle<Conserving<M>> {
            #[inline]
            fn from(raw: $Handle<M>) -> Self {
                Self {
                    prepared: raw.prepared,
                    level: raw.level,
                }
            }
        }
    )* };
}
from_raw_bsdf! { Bsdf Bsdf8 }

/// Model that scales each channel of every shading point so that its albedo is at most 1. The scaling is part of `prepare`; calls on
/// hits, eight lanes and samplers are those of the inner model.
///
/// The factor depends on `wo` alone, `min(1, 1 / albedo(wo))`. The model is not reciprocal where the factor is below 1:
/// `S(wo, wi) / S(wi, wo)` is the ratio of two factors. Light hair keeps its brightness, while [`Material::conserving_scale`], one
/// factor from the worst direction, darkens the hair but keeps the model reciprocal. Models that [conserve energy](Model::CONSERVES)
/// by their parameters stay as they are.
///
/// - Accuracy: the albedo is at most 1.001.
/// - Cost: a material stores a fit of its albedo, which takes as long to make as some hundred hits, and which each hit reads. A
///   material whose fit is not accurate enough [`integrates`](Material::integrates) its lobes at every hit instead.
///
/// ```
/// use glam::Vec3;
/// use hairis::{Conserving, Gaussian, HairParams, Material, PerLobe, Published};
/// let grazing = Vec3::new(0.99, 0.14, 0.0).normalize();
/// let red = |PerLobe(lobes): PerLobe<[f32; 3]>| lobes.iter().map(|lobe| lobe[0]).sum::<f32>();
/// let params = HairParams::bright();
/// assert!(red(Material::new(&Published(Gaussian), &params).prepare(grazing).albedo()) > 1.5);
/// let hair = Material::new(&Conserving(Published(Gaussian)), &params);
/// assert!((red(hair.prepare(grazing).albedo()) - 1.0).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Conserving<M>(pub M);

/// Constants of a material, and the constants of its energy conservation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConservingMaterial<I, F> {
    inner: I,
    fit: F,
}

crate::simd::lane_struct! {
    @impl {I: LaneStruct, F: LaneStruct<Number = I::Number>} I::Number, ConservingMaterial
    {I, F} {I::One, F::One} {I::Eight, F::Eight}
    inner: I, fit: F
}

impl<M: Model> Model for Conserving<M> {
    type Params = M::Params;
    type Material<C: Scalar> = ConservingMaterial<M::Material<C>, M::Fit<C>>;
    type Prepared<C: Scalar> = M::Prepared<C>;
    type Fit<C: Scalar> = [C; 0];
    type Inner = M::Inner;

    const LOBES: &'static [&'static str] = M::LOBES;
    const CONSERVES: bool = true;
    const INTEGRATES: bool = !M::CONSERVES;

    #[inline]
    fn material(&self, params: &M::Params) -> Self::Material<f32> {
        const {
            assert!(
                M::CONSERVES || size_of::<M::Fit<f32>>() > 0,
                "the model has no `conserving`: give it one, or say that it conserves energy by its parameters, `CONSERVES`"
            );
        }
        let inner = self.0.material(params);
        let fit = M::fit(&inner);
        ConservingMaterial { inner, fit }
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Self::Material<C>,
        hit: Hit<L>,
    ) -> M::Prepared<L::Stored> {
        M::fitted::<L, C>(&material.fit, &M::prepare::<L, C>(&material.inner, hit))
    }

    #[inline(always)]
    fn prepare_one(material: &Self::Material<f32>, hit: Hit<f32>) -> M::Prepared<f32> {
        M::fitted::<f32, f32>(&material.fit, &M::prepare_one(&material.inner, hit))
    }

    #[inline(always)]
    fn integrates<L: Lanes, C: Broadcast<L>>(material: &Self::Material<C>) -> L {
        M::unfit::<L, C>(&material.fit)
    }

    // For shading points of materials without a fit; a material with a fit conserves energy in `prepare`.
    #[inline(always)]
    fn conserving<L: Lanes>(
        prepared: &M::Prepared<L::Stored>,
        lanes: L::Mask,
    ) -> M::Prepared<L::Stored> {
        M::conserving::<L>(prepared, lanes)
    }

    #[inline(always)]
    fn restrict<C: Lanes>(prepared: &M::Prepared<C>, lobes: LobeMask) -> M::Prepared<C> {
        M::restrict(prepared, lobes)
    }

    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L>>(prepared: &M::Prepared<C>, wi: Vec3x<L>) -> Eval<L> {
        M::eval(prepared, wi)
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &M::Prepared<C>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>> {
        M::lobes(prepared, wi)
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L>>(prepared: &M::Prepared<C>, xi: [L; 3]) -> SampleLanes<L> {
        M::sample(prepared, xi)
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &M::Prepared<C>) -> PerLobe<[L; 3]> {
        M::albedo(prepared)
    }
}
