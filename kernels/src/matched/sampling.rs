//! A direction from three uniform numbers.

use super::warp::Side;
use super::{MatchedBell, MatchedGather, Truncated};
use crate::hair::{Place, Turn, turned};
use crate::lanes::lanes3;
use crate::{Broadcast, Lanes, Vec3x};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

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

    // Longitude: the number's share of the area below the warp, from the end of its side.
    let (total, below) = (C::pick_three(&gather.area, choice), C::pick_three(&gather.area_lower, choice));
    let area = zero.max(xi[1].min(one)) * total;
    let lower = area.lt(below);
    let area = L::select(lower, area, (total - area).min(total - below));
    let mut side = Side { outer: [zero; N], middle: C::pick_three(&gather.middle, choice) };
    let mut j = 0;
    while j < N {
        let [at_lower, at_upper] = [&gather.outer[0][j], &gather.outer[1][j]];
        side.outer[j] = L::select(lower, C::pick_three(at_lower, choice), C::pick_three(at_upper, choice));
        j += 1;
    }
    let v = side.invert(area);
    let rest = one - v;
    let cut = Truncated {
        mass: C::pick_three(&gather.mass, choice),
        inv_mass: C::pick_three(&gather.inv_mass, choice),
        ends: [C::pick_three(&gather.ends[0], choice), C::pick_three(&gather.ends[1], choice)],
    };
    let x = B::invert(&cut, L::select(lower, v, rest), L::select(lower, rest, v));
    let half_theta_i = x.mul_add(C::pick_three(&hair.beta, choice), -C::pick_three(&point.shift, choice));
    let half_theta_i = c(-FRAC_PI_4).max(half_theta_i.min(c(FRAC_PI_4)));

    // Azimuth: TT's cdf runs from its centre outwards, that of a glint from phi = 0.
    let turn = Turn::of(xi[2]);
    let is_glint = L::is_slot(choice, 3);
    let mass = C::pick_pair(&gather.azimuth_mass, choice);
    let cut = Truncated {
        mass,
        inv_mass: one / mass,
        ends: [C::pick_pair(&gather.azimuth_ends[0], choice), C::pick_pair(&gather.azimuth_ends[1], choice)],
    };
    let rest = one - turn.across;
    let y = B::invert(&cut, L::select(is_glint, rest, turn.across), L::select(is_glint, turn.across, rest));
    let center = L::keep(is_glint, hair.half_phi_g.lanes());
    let psi = y.mul_add(C::pick_pair(&hair.half_gamma, choice), center);
    let psi = zero.max(psi.min(c(FRAC_PI_2)));
    let (wi, place) = turned(point, choice, half_theta_i, turn, psi);
    (wi, choice, place)
}
