//! A direction from three uniform numbers.

use super::{MatchedBell, MatchedGather};
use crate::hair::{Place, Turn, turned};
use crate::lanes::lanes3;
use crate::{Broadcast, Lanes, Vec3x};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// A quarter of the step between uniform numbers of 24 bits: the share of an angle that is left out at its ends, so that
/// rounding takes no sample past them, and none to a pole or to where a Gaussian has no density left.
const LEAST_SHARE: f32 = f32::EPSILON / 8.0;

/// A direction for `xi = [lobe, theta, phi]`, the lobe it came from, and its place.
#[inline(always)]
pub(super) fn draw<B: MatchedBell, L: Lanes, C: Broadcast<L>, const N: usize>(
    gather: &MatchedGather<C, N>,
    xi: [L; 3],
) -> (Vec3x<L>, L::Choice, Place<L>) {
    let c = L::splat;
    let (zero, one) = (c(0.0), c(1.0));
    let (point, hair) = (&gather.point, &gather.point.lobes);
    let choice = L::choose(xi[0], lanes3(&gather.bounds));

    // Longitude: the number's share of the integral of M W, from the pole of its side, and the band it falls in.
    let [below, above] = &gather.sides;
    let total = C::pick_three(&gather.area, choice);
    let area = zero.max(xi[1].min(one)) * total;
    let lower = area.lt(C::pick_three(&below.area, choice));
    let area = L::select(lower, area, total - area);
    let [first, last] = [C::pick_three(&below.integral[0], choice), C::pick_three(&above.integral[0], choice)];
    // The band's end towards the pole, W in it, and what lies beyond it.
    let w = L::select(lower, below.height[0].lanes(), above.height[0].lanes());
    let (mut from, mut height, mut beyond) = (L::select(lower, first, last), w, zero);
    let (mut end, mut w, mut sum) = (from, height, zero);
    let mut j = 1;
    while j < N {
        let [low, high] = [C::pick_three(&below.integral[j], choice), C::pick_three(&above.integral[j], choice)];
        let next = L::select(lower, low, high);
        sum = (next - end).abs().mul_add(w, sum);
        (end, w) = (next, L::select(lower, below.height[j].lanes(), above.height[j].lanes()));
        let past = sum.lt(area);
        from = L::select(past, end, from);
        height = L::select(past, w, height);
        beyond = L::select(past, sum, beyond);
        j += 1;
    }
    let integral = from + L::negate(lower, beyond - area) / height;
    let least = (last - first) * c(LEAST_SHARE);
    let integral = (first + least).max(integral.min(last - least));
    let x = B::invert(C::pick_three(&gather.origin, choice), integral);
    let half_theta_i = x.mul_sub(C::pick_three(&hair.beta, choice), C::pick_three(&point.shift, choice));
    let half_theta_i = c(-FRAC_PI_4).max(half_theta_i.min(c(FRAC_PI_4)));

    // Azimuth: TT's runs from its centre outwards, that of a glint from phi = 0.
    let turn = Turn::of(xi[2]);
    let is_glint = L::is_slot(choice, 3);
    let share = L::select(is_glint, one - turn.across, turn.across);
    let share = c(LEAST_SHARE).max(share.min(c(1.0 - f32::EPSILON / 2.0)));
    let (mass, from) = (C::pick_pair(&gather.azimuth_mass, choice), C::pick_pair(&gather.azimuth_from, choice));
    let y = B::invert(C::pick_pair(&gather.azimuth_origin, choice), share.mul_add(mass, from));
    let center = L::keep(is_glint, hair.half_phi_g.lanes());
    let psi = y.mul_add(C::pick_pair(&hair.half_gamma, choice), center);
    let psi = zero.max(psi.min(c(FRAC_PI_2)));
    let (wi, place) = turned(point, choice, half_theta_i, turn, psi);
    (wi, choice, place)
}
