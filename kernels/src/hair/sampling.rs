//! The published sampler: a lobe by its energy, then longitude and azimuth by inversion (section 3.2 of the paper).

use super::{HairGather, Place};
use crate::math::{atan_unit, sin_cos_half_turn};
use crate::truncated::TruncatedCauchy;
use crate::{Broadcast, Lanes, Vec3x};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// A direction for `xi = [lobe, theta, phi]`, the lobe it came from, and its place: of the angles it was made of, those
/// that keep their digits in the direction are kept, not taken back from it.
#[inline(always)]
pub(super) fn draw<L: Lanes, C: Broadcast<L>>(gather: &HairGather<C>, xi: [L; 3]) -> (Vec3x<L>, L::Choice, Place<L>) {
    let c = L::splat;
    let (zero, one, two) = (c(0.0), c(1.0), c(2.0));
    let choice = L::choose(xi[0], crate::lanes::lanes3(&gather.bounds));
    let is_tt = L::is_slot(choice, 1);
    let is_cosine = L::or(L::is_slot(choice, 0), L::is_slot(choice, 2));

    // Longitude: x = theta_h - alpha, and theta_i = 2 (x + alpha) - theta_o.
    let longitude = TruncatedCauchy::pick(&gather.longitude_sin, &gather.longitude_cos, &gather.longitude_span, choice);
    let x = longitude.invert(xi[1]) * C::pick(&gather.beta, choice);
    let half_theta_i = c(-FRAC_PI_4).max(c(FRAC_PI_4).min(x - C::pick(&gather.shift, choice)));
    let (sin_theta_i, cos_theta_i) = sin_cos_half_turn(half_theta_i + half_theta_i);
    // At the poles the cosine is the rounding of pi/2, of either sign: below 0 the density would be too.
    let cos_theta_i = zero.max(cos_theta_i);

    // Azimuth of TT and the glints: psi is half of phi - pi or of phi. The second half of xi mirrors the first.
    let g = xi[2] + xi[2];
    let mirrored = one.lt(g);
    let folded = L::select(mirrored, two - g, g);
    let azimuth = TruncatedCauchy::pick(&gather.azimuth_sin, &gather.azimuth_cos, &gather.azimuth_span, choice);
    let y = azimuth.invert(L::select(is_tt, xi[2], folded));
    let psi = y.mul_add(C::pick(&gather.azimuth_scale, choice), C::pick(&gather.azimuth_offset, choice));
    let psi = c(-FRAC_PI_2).max(c(FRAC_PI_2).min(psi));
    let psi = L::select(is_tt, psi, L::select(mirrored, -psi, psi));
    let (sin_psi, cos_psi) = sin_cos_half_turn(psi);
    // R and TRT-g need no arcsine: sin(phi/2) = 2 xi - 1.
    let sin_psi = L::select(is_cosine, g - one, sin_psi);
    let cos_psi = L::select(is_cosine, (g * (two - g)).sqrt(), cos_psi);

    // The direction, from the double angle; phi_i = phi_o - phi.
    let sign = L::select(is_tt, c(-1.0), one);
    let sin_phi = (sin_psi + sin_psi) * cos_psi * sign;
    let cos_phi = (sin_psi * sin_psi).mul_add(c(-2.0), one) * sign;
    let (cos_phi_o, sin_phi_o) = (gather.phi_o[0].lanes(), gather.phi_o[1].lanes());
    let v = cos_phi_o.mul_add(cos_phi, sin_phi_o * sin_phi) * cos_theta_i;
    let w = sin_phi_o.mul_add(cos_phi, -(cos_phi_o * sin_phi)) * cos_theta_i;

    // |phi| as the rounded direction has it: next to pi, where R and TRT-g vanish, the angle it was made of is another.
    let [v_o, w_o, cos_o] = crate::lanes::lanes3(&gather.plane_o);
    let dot = v.mul_add(v_o, w * w_o);
    let cross = L::difference_of_products(w, v_o, v, w_o).abs();
    let tau = cross / cos_theta_i.mul_add(cos_o, dot.abs());
    let front = zero.lt(dot);
    let angle = atan_unit(tau);
    let angle = angle + angle;
    let rest = c(PI) - angle;
    let (sin_psi, cos_psi) = (sin_psi.abs(), zero.max(cos_psi));
    let sin_half_phi = L::select(is_tt, cos_psi, sin_psi);
    let cos_half_phi = L::select(is_tt, sin_psi, cos_psi);
    let place = Place {
        half_theta_i,
        sin_theta_i,
        cos_theta_i,
        phi: L::select(front, angle, rest),
        back: L::select(front, rest, angle),
        cos_half_phi: L::select(front, cos_half_phi, tau * sin_half_phi),
        front,
    };
    (Vec3x::new(sin_theta_i, v, w), choice, place)
}
