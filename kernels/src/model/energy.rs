//! Energy per direction: a model that returns no more light than arrives.

use crate::model::{Eval, Hit, LobeEval, Model, SampleLanes};
use crate::simd::{Broadcast, Kernel, Lanes, Scalar, Vec3x};
use crate::{Bsdf, Bsdf8, LobeMask, PerLobe};
use wide::f32x8;

impl<M: Model> Bsdf<M> {
    /// The BSDF with each channel divided by its albedo where that is above 1: see [`Conserving`].
    ///
    /// With some lobes alone, give the lobes first: `with_lobes` of a BSDF that conserves keeps its factors.
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        Self {
            prepared: M::conserve::<f32>(&self.prepared),
            level: self.level,
        }
    }
}

impl<M: Model> Bsdf8<M> {
    /// The BSDFs with each channel divided by its albedo where that is above 1: see [`Conserving`].
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        let level = self.level;
        let kernel = Conserve::<M>(&self.prepared);
        level.run_into(kernel, |prepared| Self { prepared, level })
    }
}

struct Conserve<'a, M: Model>(&'a M::Prepared<f32x8>);

impl<M: Model> Kernel for Conserve<'_, M> {
    type Output = M::Prepared<f32x8>;
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> M::Prepared<f32x8> {
        M::conserve::<L>(self.0)
    }
}

/// A model with each channel of every shading point scaled so that its albedo is at most 1: [`Model::conserve`] as part of
/// `prepare`, and nothing later. Slices of hits, eight lanes and samplers are those of the model.
///
/// The factor depends on `wo` alone, `min(1, 1 / albedo(wo))`. The model is not reciprocal where it is below 1:
/// `S(wo, wi) / S(wi, wo)` is the ratio of two factors. Light hair keeps its brightness, while
/// [`Material::conserving_scale`](crate::Material::conserving_scale), one factor from the worst direction, darkens it but keeps the
/// model reciprocal.
///
/// - Accuracy: the albedo is at most 1.001.
/// - Cost: two thirds of the time of [`Bsdf::albedo`](crate::Bsdf::albedo) for every shading point; packets of eight take a
///   tenth per hit.
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

impl<M: Model> Model for Conserving<M> {
    type Params = M::Params;
    type Material<C: Scalar> = M::Material<C>;
    type Prepared<C: Scalar> = M::Prepared<C>;

    const LOBES: &'static [&'static str] = M::LOBES;

    #[inline]
    fn material(&self, params: &M::Params) -> M::Material<f32> {
        self.0.material(params)
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &M::Material<C>,
        hit: Hit<L>,
    ) -> M::Prepared<L::Stored> {
        M::conserve::<L>(&M::prepare::<L, C>(material, hit))
    }

    #[inline(always)]
    fn prepare_one(material: &M::Material<f32>, hit: Hit<f32>) -> M::Prepared<f32> {
        M::conserve::<f32>(&M::prepare_one(material, hit))
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
