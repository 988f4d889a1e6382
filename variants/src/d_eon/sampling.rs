//! Sampling of a direction of one lobe by three uniform numbers.

use super::lobes::LEAST_SQUEEZE;
use super::prepare::DEonPrepared;
use crate::{cone, cylinder};
use core::f32::consts::{FRAC_PI_2, LN_2};
use hairis::model::Direction;
use hairis::model::math::{
    gaussian_and_complement, log2_one_plus, normal_tail_inverse, sin_cos_half_turn,
};
use hairis::simd::{Broadcast, Choice, Lanes};

/// Least divisor of a number that is stretched to the whole interval.
const LEAST_SHARE: f32 = 1e-12;

/// Draws a direction of a lobe: the azimuth by the second number, and the inclination by the others.
#[inline(always)]
pub(super) fn sample<L: Lanes, C: Broadcast<L>>(
    prepared: &DEonPrepared<C>,
    lobe: L::Index,
    xi: [L; 3],
) -> Direction<L> {
    let c = L::splat;
    let (zero, one, two, half) = (c(0.0), c(1.0), c(2.0), c(0.5));
    let (is_r, is_trt, is_diffuse) = (lobe.equals(0), lobe.equals(2), lobe.equals(3));

    L::stage("offset of R and of TT");
    let uniform = prepared.uniform.lanes();
    let by_power = uniform.lt(xi[1]);
    let above = L::quotient(xi[1] - uniform, (one - uniform).max(c(LEAST_SHARE)));
    let below = L::quotient(xi[1], uniform.max(c(LEAST_SHARE)));
    let signed = L::select(by_power, above, below).min(one).mul_sub(two, one);
    let root = signed.abs().sqrt().sqrt().sqrt().times_sign(signed);
    let offset_r = L::select(by_power, root, signed);
    let h = L::select(is_r, offset_r, xi[1].mul_sub(two, one));
    let cos_gamma = zero.max((one - h) * (one + h)).sqrt();

    L::stage("half the azimuth of R, and of TT: a right angle less gamma_i and plus gamma_t");
    let inside = prepared.q.lanes() * h;
    let cos_inside = ((one - inside) * (one + inside)).sqrt();
    let sin_tt = cos_gamma.mul_add(cos_inside, h * inside);
    let cos_tt = L::difference_of_products(h, cos_inside, cos_gamma, inside);

    L::stage(
        "half the azimuth of TRT: its side, one of three Gaussians, and the Gaussian by inversion",
    );
    let g = &prepared.gaussians;
    let is_left = xi[1].lt(half);
    let side = L::select(is_left, xi[1] + xi[1], (xi[1] + xi[1]) - 1.0);
    let share = g.share.lanes();
    let is_outer = side.lt(share);
    let into = L::select(is_outer, side, side - share);
    let of = L::select(is_outer, share, one - share).max(c(LEAST_SHARE));
    let part = L::quotient(into, of).min(one);
    let centre_tail = g.tail[2].lanes();
    let low = L::select(is_outer, g.tail[0].lanes(), centre_tail);
    let high = L::select(is_outer, g.tail[1].lanes(), centre_tail);
    let kept = one - low - high;
    let from_low = part.mul_add(kept, low);
    let from_high = (one - part).mul_add(kept, high);
    let is_low = from_low.lt(from_high);
    let tail = from_low.min(from_high).min(half).max(c(f32::MIN_POSITIVE));
    let deviates = normal_tail_inverse(tail);
    let deviation = L::select(is_outer, g.deviation[0].lanes(), g.deviation[1].lanes());
    let place = L::keep(is_outer, g.place.lanes());
    let phi = L::negate(is_low, deviates).mul_add(deviation, place);
    let half_phi = (phi * half).min(c(FRAC_PI_2)).max(c(-FRAC_PI_2));
    let (sin_trt, cos_trt) = sin_cos_half_turn(L::negate(is_left, half_phi));

    let sin_half = L::select(is_r, h, L::select(is_trt, sin_trt, sin_tt));
    let cos_half = L::select(is_r, cos_gamma, L::select(is_trt, cos_trt, cos_tt));
    let sin_phi = (sin_half + sin_half) * cos_half;
    let cos_phi = (cos_half - sin_half) * (cos_half + sin_half);

    L::stage("inclination: a point about the lobe's cone");
    let squeeze = L::select(is_r, cos_gamma.max(c(LEAST_SQUEEZE)), one);
    let squeeze_sq = squeeze * squeeze;
    let minus_v_ln_2 = C::look_up_three(&prepared.minus_v_ln_2, lobe) * squeeze_sq;
    let inv_v = L::quotient(c(-LN_2), minus_v_ln_2);
    let (_, cut) = gaussian_and_complement(inv_v * 4.0);
    let drop = zero.max((log2_one_plus(-(xi[0] * cut)) * minus_v_ln_2).min(two));
    let around = cone::about(drop, xi[2]);
    let [sin_i, cos_i] = cone::inclination(
        drop,
        around,
        [
            C::look_up_three(&prepared.sin_cone, lobe),
            C::look_up_three(&prepared.cos_cone, lobe),
        ],
    );

    let ([sin_d, cos_d], [sin_phi_d, cos_phi_d]) = cylinder::draw(xi);
    let theta = [
        L::select(is_diffuse, sin_d, sin_i),
        L::select(is_diffuse, cos_d, cos_i),
    ];
    let azimuth = [
        L::select(is_diffuse, sin_phi_d, sin_phi),
        L::select(is_diffuse, cos_phi_d, cos_phi),
    ];
    let plane_o = [prepared.plane_o[0].lanes(), prepared.plane_o[1].lanes()];
    cylinder::direction(plane_o, prepared.inv_plane_o.lanes(), theta, azimuth)
}
