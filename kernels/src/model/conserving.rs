//! Energy conservation: models whose shading points return no more light than arrives.

use crate::model::lobe::{LobeMask, PerLobe};
use crate::model::{Eval, Hit, LobeEval, Model, SampleLanes};
use crate::simd::{Broadcast, LaneStruct, Lanes, Scalar, Vec3x};

/// Model that scales each channel of every shading point so that its albedo is at most 1. The scaling is part of `prepare`; calls on
/// hits, eight lanes and samplers are those of the inner model.
///
/// The factor depends on `wo` alone, `min(1, 1 / albedo(wo))`. The model is not reciprocal where the factor is below 1:
/// `S(wo, wi) / S(wi, wo)` is the ratio of two factors. Light hair keeps its brightness, while
/// [`Material::conserving_scale`](crate::Material::conserving_scale), one factor from the worst direction, darkens the hair but keeps
/// the model reciprocal. Models that [conserve energy](Model::CONSERVES) by their parameters stay as they are.
///
/// - Accuracy: the albedo is at most 1.001.
/// - Cost: a material stores a fit of its albedo, which takes as long to make as some hundred hits, and which each hit reads. A
///   material whose fit is not accurate enough [`integrates`](crate::Material::integrates) its lobes at every hit instead.
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
    pub(crate) inner: I,
    pub(crate) fit: F,
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
    fn restrict<C: Lanes + Broadcast<C>>(
        prepared: &M::Prepared<C>,
        lobes: LobeMask,
    ) -> M::Prepared<C> {
        M::restrict(prepared, lobes)
    }

    #[inline(always)]
    fn draw<L: Lanes, C: Broadcast<L>>(prepared: &M::Prepared<C>, xi: [L; 3]) -> (Vec3x<L>, L) {
        M::draw(prepared, xi)
    }

    #[inline(always)]
    fn energy<L: Lanes, C: Broadcast<L>>(prepared: &M::Prepared<C>) -> L {
        M::energy(prepared)
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
