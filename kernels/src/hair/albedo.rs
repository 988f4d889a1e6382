//! Directional albedo of the published model, by quadrature over each bell.

use super::HairView;
use super::bell::Nodes;
use crate::hair::quadrature::{COARSE, GRADED};
use crate::model::math::{FRAC_PI_2_LOW, half_atan2, sin_cos_half_turn};
use crate::model::{Bell, PerLobe};
use crate::simd::{Broadcast, Lanes, lanes3};
use core::f32::consts::FRAC_PI_2;

/// Computes the directional albedo of each lobe, linear RGB; 0 if `wo` is not finite.
#[inline(always)]
pub(crate) fn albedo<B: Bell, L: Lanes, C: Broadcast<L>>(view: &HairView<C>) -> PerLobe<[L; 3]> {
    let hair = &view.lobes;
    let (r, tt, trt) = (
        lanes3(&hair.color_r),
        lanes3(&hair.color_tt),
        lanes3(&hair.color_trt),
    );
    // The azimuthal term of R and TRT-g, cos(phi / 2), has an area of 4.
    let area = inclinations::<B, L, C, _>(view, &GRADED);
    let lobes = [
        lobe(view, 0, area[0] * 4.0, r),
        lobe(view, 1, area[1] * hair.azimuth_area[0].lanes(), tt),
        lobe(view, 2, area[2] * 4.0, trt),
        lobe(view, 3, area[2] * hair.azimuth_area[1].lanes(), trt),
    ];
    PerLobe::padded(lobes, [L::splat(0.0); 3])
}

#[inline(always)]
fn lobe<L: Lanes, C: Broadcast<L>>(view: &HairView<C>, l: usize, area: L, color: [L; 3]) -> [L; 3] {
    let hair = &view.lobes;
    let (zero, most) = (L::splat(0.0), L::splat(f32::MAX));
    // `max` returns its second operand for NaN.
    let albedo = (area * hair.strength[l].lanes()).max(zero);
    [
        (albedo * color[0]).min(most),
        (albedo * color[1]).min(most),
        (albedo * color[2]).min(most),
    ]
}

/// Computes the directional albedo of each channel, to within 2e-4.
#[inline(always)]
pub(super) fn channels<B: Bell, L: Lanes>(view: &HairView<L::Stored>) -> [L; 3] {
    let hair = &view.lobes;
    let four = L::splat(4.0);
    let [r, tt, trt] = inclinations::<B, L, L::Stored, _>(view, &COARSE);
    let glints = hair.azimuth_area[1].lanes() * hair.strength[3].lanes();
    let r = r * 4.0 * hair.strength[0].lanes();
    let tt = tt * hair.azimuth_area[0].lanes() * hair.strength[1].lanes();
    let trt = trt * four.mul_add(hair.strength[2].lanes(), glints);
    let colors = [
        lanes3(&hair.color_r),
        lanes3(&hair.color_tt),
        lanes3(&hair.color_trt),
    ];
    let mut albedo = [L::splat(0.0); 3];
    let mut c = 0;
    while c < 3 {
        albedo[c] = r.mul_add(colors[0][c], tt.mul_add(colors[1][c], trt * colors[2][c]));
        c += 1;
    }
    albedo
}

/// Computes the [`longitudinal`] integrals of R, TT and TRT.
#[inline(always)]
fn inclinations<B: Bell, L: Lanes, C: Broadcast<L>, const N: usize>(
    view: &HairView<C>,
    rule: &[[f32; 3]; N],
) -> [L; 3] {
    [
        longitudinal::<B, L, C, N>(view, 0, rule),
        longitudinal::<B, L, C, N>(view, 1, rule),
        longitudinal::<B, L, C, N>(view, 2, rule),
    ]
}

/// Integrates `M cos^2 theta_i / cos^2 theta_d` over `theta_i`.
///
/// Angles are distances in `theta_h` from the nearer pole, and cosines are products of factors that do not cancel, so that no digit
/// of a small cosine is lost.
#[inline(always)]
fn longitudinal<B: Bell, L: Lanes, C: Broadcast<L>, const N: usize>(
    view: &HairView<C>,
    l: usize,
    rule: &[[f32; 3]; N],
) -> L {
    let c = L::splat;
    let (zero, one, two) = (c(0.0), c(1.0), c(2.0));
    let (beta, inv_beta) = (view.lobes.beta[l].lanes(), view.lobes.inv_beta[l].lanes());
    // Mirrored, so that wo is above the normal plane, and the tilt with it. From the lower pole to the centre, and from the
    // upper one.
    let (sin, cos) = (view.half_sin_theta_o.lanes(), view.half_cos_theta_o.lanes());
    let tilt = view.lobes.alpha[l].lanes().times_sign(sin);
    let to_pole = half_atan2(cos, sin.abs(), c(0.5));
    let lower = tilt + to_pole;
    let upper = ((c(FRAC_PI_2) - tilt) + FRAC_PI_2_LOW) - to_pole;
    let (from, to) = (-lower * inv_beta, upper * inv_beta);
    let nodes = Nodes::between(from, to);
    let (sin_pole, cos_pole) = sin_cos_half_turn(to_pole);
    let mut sum = zero;
    let mut k = 0;
    while k < N {
        let (x, dx) = nodes.at(rule[k]);
        let (above, below) = ((x - from) * beta, (to - x) * beta);
        let (near, far) = sin_cos_half_turn(zero.max(above.min(below)));
        let is_low = above.lt(below);
        let (sin, cos) = (L::select(is_low, near, far), L::select(is_low, far, near));
        // Cos theta_i is that of twice the distance, and cos theta_d the sine of the distance and half of wo's.
        let cos_theta_d = sin.mul_add(cos_pole, cos * sin_pole);
        let s = x * x;
        let d = s + 1.0;
        let reciprocal = L::quotient(one, d * cos_theta_d.max(c(f32::MIN_POSITIVE)));
        let ratio = two * sin * cos * (reciprocal * d);
        sum = (B::one(s, reciprocal * cos_theta_d) * (ratio * ratio)).mul_add(dx, sum);
        k += 1;
    }
    // dtheta_i = 2 dtheta_h.
    two * beta * sum
}
