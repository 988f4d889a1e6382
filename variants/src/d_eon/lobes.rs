//! Value, colour and density of the four lobes at a direction.

use super::prepare::DEonPrepared;
use crate::chiang::{Four, apart, four, same};
use crate::cone::{SEAM, bessel};
use crate::cylinder::{self, Azimuth};
use hairis::model::math::{gaussian, gaussian_and_complement, horner};
use hairis::model::{Direction, LobeEval};
use hairis::simd::{Broadcast, Lanes, Pair, Schedule, lanes3};

/// Least `cos(phi/2)` in the width of R.
pub(super) const LEAST_SQUEEZE: f32 = 0.1;
/// Least density of R and TT, which end at an azimuth. Levels round differently, and without a least density a lobe might be 0 on one and
/// not on another.
const LEAST: f32 = 1e-30;
/// Least cosine in the attenuation of TT, for the same reason.
const LEAST_PASSED: f32 = 1e-6;

/// Returns the light that passes the surface twice at a ray whose `gamma_i` has this cosine: `(1 - F)^2` times the share of the lobe.
///
/// `1 - (1 - x)^5` is `x` times a sum of powers of `1 - x`, which loses no digits where `x` is small.
#[inline(always)]
pub(super) fn clear_passage<L: Lanes, C: Broadcast<L>>(
    prepared: &DEonPrepared<C>,
    cos_gamma_i: L,
) -> L {
    let x = prepared.cos_theta_o.lanes() * cos_gamma_i;
    let rest = L::splat(1.0) - x;
    let passed = prepared.normal[1].lanes() * (x * horner(rest, [1.0; 5]));
    prepared.kept.lanes() * (passed * passed)
}

/// Evaluates the lobes at a direction.
#[inline(always)]
pub(super) fn lobes<L: Lanes, C: Broadcast<L>>(
    prepared: &DEonPrepared<C>,
    wi: &Direction<L>,
) -> [LobeEval<L>; 4] {
    let c = L::splat;
    let (zero, one, least) = (c(0.0), c(1.0), c(LEAST));
    let cos_i = wi.cos_theta;
    let inv_root_i = L::quotient(one, cos_i.sqrt());
    let inv_cos = inv_root_i * inv_root_i;

    let azimuth = Azimuth::between(lanes3(&prepared.plane_o), wi);
    let ([cos, sin], phi) = (azimuth.half, azimuth.phi);
    let (cos_sq, sin_sq) = (cos * cos, sin * sin);

    L::stage("azimuthal density and attenuation of R");
    let squeeze = cos.max(c(LEAST_SQUEEZE));
    let inv_squeeze = L::quotient(one, squeeze);
    let inv_squeeze_sq = inv_squeeze * inv_squeeze;
    let [normal, complement] = [prepared.normal[0].lanes(), prepared.normal[1].lanes()];
    let grazing = one - prepared.cos_theta_o.lanes() * cos;
    let grazing_sq = grazing * grazing;
    let reflected = (complement * (grazing_sq * grazing_sq)).mul_add(grazing, normal);
    let n_r = cos * 0.25;
    let uniform = prepared.uniform.lanes();
    let seventh = (sin_sq * sin_sq) * (sin_sq * sin);
    let drawn_r = ((one - uniform) * 8.0).mul_add(seventh, uniform);

    L::stage("azimuthal density and attenuation of TT");
    let (q, less) = (prepared.q.lanes(), prepared.less.lanes());
    let short = L::quotient(cos_sq, one + sin);
    let (outer, inner) = (zero.max(sin - q), q.mul_add(short, less));
    let inv_chord = L::quotient(one, (less * less + (q + q) * short).sqrt());
    let (cos_gamma_i, cos_gamma_t) = ((outer * inv_chord).min(one), (inner * inv_chord).min(one));
    let n_tt = cos_gamma_i * cos_gamma_t * (inv_chord * 0.25);
    let clear = clear_passage(prepared, cos_gamma_i.max(c(LEAST_PASSED)));
    let depth = lanes3(&prepared.twice_depth);

    L::stage("azimuthal density of TRT: three Gaussians");
    let g = &prepared.gaussians;
    let [inv_outer, inv_centre] = [g.inv_deviation[0].lanes(), g.inv_deviation[1].lanes()];
    let place = g.place.lanes();
    let (near, far) = ((phi - place) * inv_outer, (phi + place) * inv_outer);
    let middle = phi * inv_centre;
    let n_trt = (gaussian(near * near) + gaussian(far * far)).mul_add(
        g.peak[0].lanes(),
        gaussian(middle * middle) * g.peak[1].lanes(),
    );

    L::stage("longitudinal density of R, TT and TRT");
    let (across, along) = (
        same(cos_i) - four(&prepared.cos_cone),
        same(wi.sin_theta) + four(&prepared.sin_cone),
    );
    let chord_sq = across.mul_add(across, along * along);
    // The width of R follows the azimuth.
    let narrower = Pair(Pair(inv_squeeze_sq, one), Pair(one, one));
    let wider = Pair(Pair(squeeze, one), Pair(one, one));
    let inv_variance = four(&prepared.inv_variance) * narrower;
    let x = same(cos_i) * four(&prepared.concentration) * narrower;
    let small = x.lt(Four::splat(SEAM));
    let root = same(inv_root_i) * four(&prepared.spread) * wider;
    let bessel = bessel(small, x, root);
    let exponent = chord_sq.mul_add(inv_variance, Four::keep(small, x + x));
    let Pair(Pair(inv_v, _), _) = inv_variance;
    let (_, cut) = gaussian_and_complement(inv_v * 4.0);
    let [_, norm_tt, norm_trt] = lanes3(&[prepared.norm[0], prepared.norm[1], prepared.norm[2]]);
    let norm_r = L::quotient(inv_v, cut);
    let norm = Pair(Pair(norm_r, norm_tt), Pair(norm_trt, norm_trt));
    let [m_r, m_tt, m_trt, _] = apart(gaussian(exponent).alone() * bessel * norm);

    L::stage("value and density of the diffuse lobe");
    let cylinder = cylinder::value(azimuth.lacking);

    let by_lobe = [
        (m_r * n_r).max(least),
        (m_tt * n_tt).max(least),
        m_trt * n_trt,
    ];
    let r = prepared.kept.lanes() * reflected;
    let tt = [
        clear * gaussian(depth[0] * cos_gamma_t),
        clear * gaussian(depth[1] * cos_gamma_t),
        clear * gaussian(depth[2] * cos_gamma_t),
    ];
    [
        LobeEval::new(by_lobe[0] * inv_cos, [r; 3], by_lobe[0] * drawn_r),
        LobeEval::new(by_lobe[1] * inv_cos, tt, by_lobe[1]),
        LobeEval::new(
            by_lobe[2] * inv_cos,
            lanes3(&prepared.attenuation_trt),
            by_lobe[2],
        ),
        LobeEval::new(cylinder, lanes3(&prepared.diffuse), cylinder * cos_i),
    ]
}
