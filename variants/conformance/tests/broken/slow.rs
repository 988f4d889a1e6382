//! Sound fibre with one function that is not inlined; its results are the same.

use super::{Broken, Fiber, Params, SOUND};
use hairis::model::{LobeEval, Model, SampleLanes};
use hairis::simd::{Broadcast, Lanes, Scalar, Vec3x};
use hairis::{Eval, Hit, LobeMask, PerLobe};
use hairis_conformance::{Materials, Subject};

/// Fibre with a function that is not inlined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slow;

impl Model for Slow {
    type Params = Params;
    type Material<C: Scalar> = <Fiber as Model>::Material<C>;
    type Prepared<C: Scalar> = <Fiber as Model>::Prepared<C>;
    type Fit<C: Scalar> = [C; 0];
    type Inner = Self;

    const LOBES: &'static [&'static str] = Fiber::LOBES;
    const CONSERVES: bool = true;

    fn material(&self, params: &Params) -> Self::Material<f32> {
        Fiber.material(params)
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Self::Material<C>,
        hit: Hit<L>,
    ) -> Self::Prepared<L::Stored> {
        Fiber::prepare(material, hit)
    }

    #[inline(always)]
    fn restrict<C: Lanes + Broadcast<C>>(
        prepared: &Self::Prepared<C>,
        lobes: LobeMask,
    ) -> Self::Prepared<C> {
        Fiber::restrict(prepared, lobes)
    }

    #[inline(never)]
    fn eval<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>, wi: Vec3x<L>) -> Eval<L> {
        Fiber::eval(prepared, wi)
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>> {
        Fiber::lobes(prepared, wi)
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        xi: [L; 3],
    ) -> SampleLanes<L> {
        Fiber::sample(prepared, xi)
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> PerLobe<[L; 3]> {
        Fiber::albedo(prepared)
    }
}

impl Subject for Slow {
    type Model = Self;

    fn model(&self) -> Self {
        Self
    }

    fn materials(&self) -> Materials<Self> {
        Broken(SOUND).materials()
    }
}
