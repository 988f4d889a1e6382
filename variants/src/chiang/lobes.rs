//! Densities of the four lobes at a direction, per steradian.

use super::ChiangPrepared;
use super::gather::{Four, apart, four, quotient, same};
use crate::cone::{SEAM, bessel};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};
use hairis::model::Direction;
use hairis::model::math::{atan_eighth_turn, gaussian};
use hairis::simd::{Broadcast, Lanes, Pair, Schedule};

/// Returns the density `M N` of each lobe, per steradian, and `1 / cos theta_i`.
///
/// `M = exp(-2 sin^2((theta_i + theta') / 2) / v) I0e(x) / (v (1 - exp(-2 / v)))`, with `x = cos theta_i cos theta' / v` and
/// `I0e(x) = exp(-x) I0(x)`, is d'Eon's term without its overflow. `N = e / (s (1 + e)^2 K)`, with `e = exp(-|delta| / s)`.
/// One exponential serves `M`, the series of the Bessel function and `N` together, so that no product of two tails is denormal.
#[inline(always)]
pub(super) fn densities<L: Lanes, C: Broadcast<L>>(
    prepared: &ChiangPrepared<C>,
    wi: &Direction<L>,
) -> ([L; 4], L) {
    let c = L::splat;
    let (zero, one) = (c(0.0), c(1.0));
    let (m, cos_i) = (&prepared.widths, wi.cos_theta);

    // 1 / sqrt(cos theta_i), which the tails of the Bessel functions share.
    let inv_root_i = L::quotient(one, cos_i.sqrt());

    L::stage("azimuth: distance from that of R, TT and TRT");
    // |delta| / 2 of R, TT and TRT, from its tangent or from the tangent of what it lacks of an eighth turn. The rest has no
    // azimuth; the azimuth of TRT takes its place, at no cost.
    let [v, w] = [&prepared.azimuth_v, &prepared.azimuth_w];
    let (v, w) = (
        four(&[v[0], v[1], v[2], v[2]]),
        four(&[w[0], w[1], w[2], w[2]]),
    );
    let (wi_v, wi_w) = (same(wi.vector.y), same(wi.vector.z));
    let (cross, dot) = (v.mul_sub(wi_w, w * wi_v).abs(), v.mul_add(wi_v, w * wi_w));
    let angle = atan_eighth_turn(quotient(
        cross.min(dot.abs()),
        same(cos_i) + cross.max(dot.abs()),
    ));
    let half = Four::select(dot.abs().lt(cross), Four::splat(FRAC_PI_4) - angle, angle);
    let half = Four::select(
        dot.lt(Four::splat(0.0)),
        Four::splat(FRAC_PI_2) - half,
        half,
    );
    let exponent = half * four(&m.four_inv_scale);

    L::stage("azimuth: logistic of each distance");
    // (1 + e)^-2, by one division.
    let tail = Four::splat(1.0) + gaussian(exponent);
    let [a, b, d, _] = apart(tail * tail);
    let (inverse, ab) = (L::quotient(one, a * b * d), a * b);
    let (inv_ab, inv_d) = (inverse * d, inverse * ab);
    let logistic = Pair(Pair(inv_ab * b, inv_ab * a), Pair(inv_d, one));
    let Pair(first, Pair(trt, _)) = exponent;
    let exponent = Pair(first, Pair(trt, zero));

    L::stage("inclination: distance from each lobe's cone, and the Bessel function");
    // Squared chord between theta_i and -theta' on the unit circle: 4 sin^2 of half their angle. Half angles are avoided because their
    // rounding would count twice, whereas the rounding of the cosines vanishes with them at the poles.
    let (across, along) = (
        same(cos_i) - four(&prepared.cos_cone),
        same(wi.sin_theta) + four(&prepared.sin_cone),
    );
    let chord_sq = across.mul_add(across, along * along);
    let x = same(cos_i) * four(&prepared.concentration);
    let small = x.lt(Four::splat(SEAM));
    // 1 / sqrt(x).
    let root = same(inv_root_i) * four(&prepared.spread);
    let bessel = bessel(small, x, root);
    let sum = chord_sq.mul_add(four(&m.inv_variance), exponent) + Four::keep(small, x + x);
    L::stage("density of each lobe: M N");
    // Kept apart, because in vectors of three lobes the unused number would overflow.
    let densities = gaussian(sum).alone() * bessel * (logistic * four(&m.norm));
    (apart(densities), inv_root_i * inv_root_i)
}
