//! Kernels that draw a BSDF's candidates, and that weigh candidates.

use super::weighing::{Weighed8, Weighing};
use crate::frame::Vec3x8;
use crate::handle::kernels::{AtBsdf, ValuePdf};
use crate::model::{Model, SampleLanes};
use crate::simd::{Broadcast, Kernel, Lanes, Row, Vec3x, fresh_lanes3, store3};
use wide::f32x8;

/// Columns of the BSDF's candidates: the directions of samples, 0 where a sample was discarded.
pub(crate) struct Proposed;
impl<M: Model> Row<3, 3> for AtBsdf<'_, M, Proposed> {
    #[inline(always)]
    fn row<L: Lanes>(self, xi: [L; 3]) -> [L; 3] {
        proposed(M::sample::<L, f32>(self.prepared, xi))
    }
}

/// Returns the direction of a sample, or 0 if the sample was discarded.
#[inline(always)]
fn proposed<L: Lanes>(sample: SampleLanes<L>) -> [L; 3] {
    let kept = L::splat(0.0).lt(sample.pdf);
    [
        L::keep(kept, sample.wi.x),
        L::keep(kept, sample.wi.y),
        L::keep(kept, sample.wi.z),
    ]
}

/// Columns of the contributions and weights of candidates.
#[derive(Clone, Copy)]
pub(crate) struct Weighs<'a, M: Model> {
    at: AtBsdf<'a, M, ValuePdf>,
    weighing: Weighing,
}

impl<'a, M: Model> Weighs<'a, M> {
    #[inline(always)]
    pub(crate) fn new(prepared: &'a M::Prepared<f32>, weighing: Weighing) -> Self {
        Self {
            at: AtBsdf::new(prepared),
            weighing,
        }
    }
}

impl<M: Model> Row<7, 4> for Weighs<'_, M> {
    #[inline(always)]
    fn row<L: Lanes>(self, [x, y, z, r, g, b, pdf_light]: [L; 7]) -> [L; 4] {
        weighed::<M, L, f32>(
            self.at.prepared,
            self.weighing,
            Vec3x::new(x, y, z),
            [r, g, b],
            pdf_light,
        )
    }
}

#[inline(always)]
fn weighed<M: Model, L: Lanes, C: Broadcast<L>>(
    prepared: &M::Prepared<C>,
    weighing: Weighing,
    wi: Vec3x<L>,
    radiance: [L; 3],
    pdf_light: L,
) -> [L; 4] {
    let cos_theta_i = wi.cos_theta();
    let eval = M::eval::<L, C>(prepared, wi);
    weighing.weigh(eval.value, eval.pdf, cos_theta_i, radiance, pdf_light)
}

/// Kernel that draws a candidate of the BSDF for each of eight hits.
pub(crate) struct ProposalsOf<'a, M: Model> {
    pub(crate) prepared: &'a M::Prepared<f32x8>,
    pub(crate) xi: &'a [f32x8; 3],
}

impl<M: Model> Kernel for ProposalsOf<'_, M> {
    type Output = Vec3x8;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> Vec3x8 {
        let [x, y, z] = store3(proposed(M::sample::<L, f32x8>(
            self.prepared,
            fresh_lanes3(self.xi),
        )));
        Vec3x::new(x, y, z)
    }
}

/// Kernel of the contribution and the weight of a candidate for each of eight hits.
pub(crate) struct WeighOf<'a, M: Model> {
    pub(crate) prepared: &'a M::Prepared<f32x8>,
    pub(crate) wi: &'a Vec3x8,
    pub(crate) radiance: &'a [f32x8; 3],
    pub(crate) pdf_light: &'a f32x8,
    pub(crate) weighing: Weighing,
}

impl<M: Model> Kernel for WeighOf<'_, M> {
    type Output = Weighed8;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> Weighed8 {
        let (wi, light) = (Vec3x::load_fresh(self.wi), self.pdf_light.fresh_lanes());
        let [r, g, b, weight] = weighed::<M, L, f32x8>(
            self.prepared,
            self.weighing,
            wi,
            fresh_lanes3(self.radiance),
            light,
        );
        Weighed8 {
            contribution: store3([r, g, b]),
            weight: weight.store(),
        }
    }
}
