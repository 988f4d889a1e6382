//! Results for a direction and for a sample, computed from the lobe terms and the density.

use super::{Angles, GRAZING, HairView, LobeTerms};
use crate::model::{Eval, LobeEval, PerLobe, SampleLanes};
use crate::simd::{Broadcast, Choice, Lanes, Vec3x, lanes3};

/// Density below which a sample is discarded, because close to denormals its weight would have no digits.
const LEAST_DENSITY: f32 = 1e-30;

/// Returns the largest result where a lane is sound, and 0 where it is not. On an unsound lane `x.min(limit)` is then 0 whatever `x`
/// is, NaN included, and on every other lane it is finite.
#[inline(always)]
fn limit<L: Lanes>(sound: L::Mask) -> L {
    L::keep(sound, L::splat(f32::MAX))
}

/// Multiplies `x` by `by`, and clamps the result to at most `limit`.
#[inline(always)]
fn scale3<L: Lanes>(x: [L; 3], by: L, limit: L) -> [L; 3] {
    [
        (x[0] * by).min(limit),
        (x[1] * by).min(limit),
        (x[2] * by).min(limit),
    ]
}

/// Computes the density of a mixture of lobes, from the shape of each lobe's density and its weight.
#[inline(always)]
pub(crate) fn mix_densities<L: Lanes, C: Broadcast<L>>(lobes: [L; 4], weight: &[C; 4]) -> L {
    L::stage("density of the mixture of lobes");
    let back = lobes[1].mul_add(weight[1].lanes(), lobes[3] * weight[3].lanes());
    let d = lobes[2].mul_add(weight[2].lanes(), back);
    lobes[0].mul_add(weight[0].lanes(), d)
}

/// Computes value and density at these angles; `density` is that of the mixture times `cos theta_i`.
#[inline(always)]
pub(crate) fn finish_eval<L: Lanes, C: Broadcast<L>>(
    view: &HairView<C>,
    angles: &Angles<L>,
    sound: L::Mask,
    terms: &LobeTerms<L>,
    density: L,
) -> Eval<L> {
    L::stage("value and density, 0 where wi is no direction");
    let limit = limit::<L>(sound);
    let value = scale3(terms.sum_lobes(view), terms.inv_cos_sq_theta_d, limit);
    Eval {
        value,
        pdf: (density * angles.inv_cos_theta_i).min(limit),
    }
}

/// Computes each lobe at these angles; `density` is that of each lobe times `cos theta_i`.
#[inline(always)]
pub(crate) fn finish_lobes<L: Lanes, C: Broadcast<L>>(
    view: &HairView<C>,
    angles: &Angles<L>,
    sound: L::Mask,
    terms: &LobeTerms<L>,
    density: [L; 4],
) -> PerLobe<LobeEval<L>> {
    L::stage("value and density of each lobe, 0 where wi is no direction");
    let limit = limit::<L>(sound);
    let hair = &view.lobes;
    let colors = [
        lanes3(&hair.color_r),
        lanes3(&hair.color_tt),
        lanes3(&hair.color_trt),
        lanes3(&hair.color_trt),
    ];
    let mut lobes = [LobeEval::none(); 4];
    let mut l = 0;
    while l < 4 {
        let strength = hair.strength[l].lanes() * terms.inv_cos_sq_theta_d;
        let pdf = (density[l] * angles.inv_cos_theta_i).min(limit);
        lobes[l] = LobeEval::new((terms.value[l] * strength).min(limit), colors[l], pdf);
        l += 1;
    }
    PerLobe::padded(lobes, LobeEval::none())
}

/// Computes the sample `wi` of the lobe `choice`; `density` is that of the mixture times `cos theta_i`.
#[inline(always)]
pub(crate) fn finish_sample<L: Lanes, C: Broadcast<L>>(
    view: &HairView<C>,
    wi: Vec3x<L>,
    choice: L::Index,
    angles: &Angles<L>,
    terms: &LobeTerms<L>,
    density: L,
) -> SampleLanes<L> {
    L::stage("value, density and weight of the sample, 0 where it is discarded");
    let cos = angles.cos_theta_i;
    let sound = L::and(
        L::splat(GRAZING).lt(cos),
        L::splat(LEAST_DENSITY).lt(density),
    );
    let limit = limit::<L>(sound);
    let (sum, inv_cos_sq_theta_d) = (terms.sum_lobes(view), terms.inv_cos_sq_theta_d);
    // weight = S cos theta_i / pdf, and pdf = density / cos theta_i. The product before the division is at most 4. Where results
    // are rounded down, a density of 0 may be -0, and a quotient by it -infinity.
    let by = L::quotient(
        cos * cos * inv_cos_sq_theta_d,
        density.max(L::splat(LEAST_DENSITY)),
    );
    SampleLanes {
        wi,
        value: scale3(sum, inv_cos_sq_theta_d, limit),
        pdf: (density * angles.inv_cos_theta_i).min(limit),
        weight: scale3(sum, by, limit),
        slot: L::select_predictable(sound, choice.to_number(), L::splat(-1.0)),
    }
}
