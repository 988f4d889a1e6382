//! Contributions and weights of candidates.

use crate::model::Eval8;
use crate::simd::Lanes;
use wide::f32x8;

/// Largest contribution and weight; larger ones are clamped.
const MOST: f32 = 1e30;

/// Numbers of candidates that each technique proposes for one hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Directions drawn from the BSDF.
    pub bsdf: u32,
    /// Directions drawn from the light.
    pub light: u32,
}

/// Share of the direct light that resampling estimates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Partition {
    /// All of the light.
    #[default]
    All,
    /// Balance heuristic: `w_l = p_l / (p_l + p_b)`. The path's next direction estimates the rest.
    Balance,
    /// Power heuristic: `w_l = p_l^2 / (p_l^2 + p_b^2)`. The path's next direction estimates the rest.
    Power,
}

impl Partition {
    /// Returns the share of the light technique, `w_l`, for the densities of the light and of the BSDF at a direction. An emitter
    /// that a path meets by its BSDF sample counts with `1 - w_l`; if resampling estimates [`All`](Self::All), the emitter does not
    /// count.
    ///
    /// - Range: `[0, 1]`. Without a density of the light the share is 0, except for `All`.
    #[inline]
    #[must_use]
    pub fn light_share(self, pdf_light: f32, pdf_bsdf: f32) -> f32 {
        share(self, pdf_light, pdf_bsdf)
    }
}

#[inline(always)]
fn share<L: Lanes>(partition: Partition, pdf_light: L, pdf_bsdf: L) -> L {
    let one = L::splat(1.0);
    // As large as squares allow.
    let ratio =
        L::quotient(pdf_bsdf, L::splat(f32::MIN_POSITIVE).max(pdf_light)).min(L::splat(1e18));
    match partition {
        Partition::All => one,
        Partition::Balance => L::quotient(one, one + ratio),
        Partition::Power => L::quotient(one, ratio.mul_add(ratio, one)),
    }
}

/// Constants by which candidates are weighed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weighing {
    counts: [f32; 2],
    partition: Partition,
}

impl Weighing {
    #[expect(
        clippy::cast_precision_loss,
        reason = "numbers of candidates are far below 2^24"
    )]
    pub(super) const fn new(counts: Counts, partition: Partition) -> Self {
        Self {
            counts: [counts.bsdf as f32, counts.light as f32],
            partition,
        }
    }

    /// Computes contribution and weight of a direction whose S is `value`.
    #[inline(always)]
    pub(crate) fn weigh<L: Lanes>(
        self,
        value: [L; 3],
        pdf_bsdf: L,
        cos_theta_i: L,
        radiance: [L; 3],
        pdf_light: L,
    ) -> [L; 4] {
        let c = L::splat;
        let (zero, most) = (c(0.0), c(MOST));
        let pdf_light = positive(pdf_light);
        let scale = cos_theta_i * share(self.partition, pdf_light, pdf_bsdf);
        let [r, g, b] = radiance;
        let f = [
            (value[0] * scale * positive(r)).min(most),
            (value[1] * scale * positive(g)).min(most),
            (value[2] * scale * positive(b)).min(most),
        ];
        let [bsdf, light] = self.counts;
        let density = pdf_bsdf.min(most).mul_add(c(bsdf), pdf_light * light);
        let mean = (f[0] + f[1] + f[2]) * (1.0 / 3.0);
        let weight = L::keep(
            zero.lt(density),
            L::quotient(mean, c(f32::MIN_POSITIVE).max(density)),
        )
        .min(most);
        let [r, g, b] = f;
        [r, g, b, weight]
    }
}

/// Returns `x` where it is above 0, clamped to the largest number that counts, and 0 elsewhere.
#[inline(always)]
fn positive<L: Lanes>(x: L) -> L {
    L::keep(L::splat(0.0).lt(x), x).min(L::splat(MOST))
}

/// Contributions and weights of eight candidates, one per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighed8 {
    /// Light that the direction would contribute, `L S cos theta_i`, linear RGB, without visibility.
    pub contribution: [f32x8; 3],
    /// Weight of the candidate; 0 if it contributes nothing.
    pub weight: f32x8,
}

impl Weighed8 {
    /// Weighs candidates whose values and densities the host has already, for densities other than the model's own, such as those of
    /// a mixture with another technique. Otherwise [`Bsdf8::weigh8`](crate::Bsdf8::weigh8) and [`Bsdf::weigh_columns`](crate::Bsdf::weigh_columns) evaluate and weigh in one pass.
    #[inline]
    #[must_use]
    pub fn new(
        eval: &Eval8,
        cos_theta_i: &f32x8,
        radiance: &[f32x8; 3],
        pdf_light: &f32x8,
        counts: Counts,
        partition: Partition,
    ) -> Self {
        let weighing = Weighing::new(counts, partition);
        let [r, g, b, weight] =
            weighing.weigh(eval.value, eval.pdf, *cos_theta_i, *radiance, *pdf_light);
        Self {
            contribution: [r, g, b],
            weight,
        }
    }
}
