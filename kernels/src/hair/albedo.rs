//! Directional albedo of the published model, by quadrature away from the centres of the bells.

use super::HairView;
use crate::lanes3;
use crate::math::{FRAC_PI_2_LOW, half_atan2, sin_cos_half_turn};
use crate::quadrature::GRADED;
use crate::{Bell, Broadcast, Lanes, PerLobe};
use core::f32::consts::FRAC_PI_2;

/// An interval is cut at so many widths from the centre of its bell. What is left further out changes on scales from there
/// to the end of the interval.
const CUT: f32 = 8.0;

/// Integral of a bell of width `width` over `[lo, hi]`, about its centre at 0.
#[inline]
pub(super) fn bell_area<B: Bell>(lo: f32, hi: f32, width: f32) -> f32 {
    let side = |end: f32| {
        let cut = (CUT * width).min(end);
        let mut sum = 0.0;
        for [node, _, weight] in GRADED {
            for (from, len) in [(0.0, cut), (cut, end - cut)] {
                let x = (from + node * len) / width;
                sum += weight * len * B::one(x * x, 1.0 / (1.0 + x * x));
            }
        }
        sum
    };
    side(-lo) + side(hi)
}

/// Directional albedo of each lobe, linear RGB; 0 where `wo` is no direction.
#[inline(always)]
pub(crate) fn albedo<B: Bell, L: Lanes, C: Broadcast<L>>(view: &HairView<C>) -> PerLobe<[L; 3]> {
    let hair = &view.lobes;
    let (r, tt, trt) = (lanes3(&hair.color_r), lanes3(&hair.color_tt), lanes3(&hair.color_trt));
    // The azimuthal term of R and TRT-g, cos(phi / 2), has an area of 4.
    let four = L::splat(4.0);
    let area = [longitudinal::<B, L, C>(view, 0), longitudinal::<B, L, C>(view, 1), longitudinal::<B, L, C>(view, 2)];
    PerLobe([
        lobe(view, 0, area[0] * four, r),
        lobe(view, 1, area[1] * hair.azimuth_area[0].lanes(), tt),
        lobe(view, 2, area[2] * four, trt),
        lobe(view, 3, area[2] * hair.azimuth_area[1].lanes(), trt),
    ])
}

#[inline(always)]
fn lobe<L: Lanes, C: Broadcast<L>>(view: &HairView<C>, l: usize, area: L, color: [L; 3]) -> [L; 3] {
    let hair = &view.lobes;
    let (zero, most) = (L::splat(0.0), L::splat(f32::MAX));
    // The second operand wins over NaN.
    let albedo = (area * hair.strength[l].lanes()).max(zero);
    [(albedo * color[0]).min(most), (albedo * color[1]).min(most), (albedo * color[2]).min(most)]
}

/// Integral of `M cos^2 theta_i / cos^2 theta_d` over `theta_i`.
///
/// From the centre of the bell towards either pole, told by distances in `theta_h` from it and from both poles: no digit of a
/// small one is lost.
#[inline(always)]
fn longitudinal<B: Bell, L: Lanes, C: Broadcast<L>>(view: &HairView<C>, l: usize) -> L {
    let c = L::splat;
    let (sin, cos) = (view.half_sin_theta_o.lanes(), view.half_cos_theta_o.lanes());
    // Mirrored, so that wo is above the normal plane, and the tilt with it. From the lower pole to the centre, and from the
    // upper one.
    let tilt = view.lobes.alpha[l].lanes().times_sign(sin);
    let to_pole = half_atan2(cos, sin.abs(), c(0.5));
    let lower = tilt + to_pole;
    let upper = ((c(FRAC_PI_2) - tilt) + c(FRAC_PI_2_LOW)) - to_pole;
    let beta = [view.lobes.beta[l].lanes(), view.lobes.inv_beta[l].lanes()];
    let down = towards::<B, L>(beta, lower, upper, [-sin.abs(), cos]);
    let up = towards::<B, L>(beta, upper, lower, [sin.abs(), cos]);
    // dtheta_i = 2 dtheta_h.
    c(2.0) * (down + up)
}

/// The part towards a pole, of which the centre of the bell is `pole` away, and `other` from the other pole: below 0 if it
/// lies beyond. The sine of `theta_o`, halved as its cosine is, is above 0 if the pole is the one next to `wo`.
#[inline(always)]
fn towards<B: Bell, L: Lanes>([beta, inv_beta]: [L; 2], pole: L, other: L, [half_sin, half_cos]: [L; 2]) -> L {
    let c = L::splat;
    let (zero, one, half) = (c(0.0), c(1.0), c(0.5));
    // From the centre, or from where the sphere begins.
    let from = zero.max(-other);
    let other = zero.max(other);
    let cut = from.max(pole.min(beta * c(CUT)));
    let (within, beyond) = (cut - from, (pole - cut).max(zero));
    let (starts, lens) = ([from, cut], [within, beyond]);
    let (behind, ahead) = ([other, other + within], [beyond, zero]);
    let (above, below) = (half_sin + half, half_sin - half);
    let mut sum = zero;
    let mut panel = 0;
    while panel < 2 {
        let len = lens[panel];
        let mut part = zero;
        let mut k = 0;
        while k < GRADED.len() {
            let [node, rest, weight] = GRADED[k];
            let x = c(node).mul_add(len, starts[panel]) * inv_beta;
            // Half of the angle to this pole and to the other, which add up to pi / 2.
            let (to_pole, to_other) = (c(rest).mul_add(len, ahead[panel]), c(node).mul_add(len, behind[panel]));
            let (sin, cos) = sin_cos_half_turn(to_pole.min(to_other));
            // Halves of cos theta_i, and of the sums of both sines and both cosines: no digit is lost next to opposite poles.
            let cos_theta_i = sin * cos;
            let mean_u = L::select(to_pole.lt(to_other), above - sin * sin, below + sin * sin);
            let mean_c = cos_theta_i + half_cos;
            let cos_sq_theta_d = mean_u.mul_add(mean_u, mean_c * mean_c).max(c(f32::MIN_POSITIVE));
            let w = c(4.0) * (cos_theta_i * cos_theta_i) / cos_sq_theta_d;
            let d = x.mul_add(x, one);
            part = (B::one(x * x, one / d) * w).mul_add(c(weight), part);
            k += 1;
        }
        sum = part.mul_add(len, sum);
        panel += 1;
    }
    sum
}
