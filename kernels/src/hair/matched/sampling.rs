//! Draws a direction from three uniform numbers.

use super::{MatchedBell, MatchedPrepared};
use crate::hair::{Angles, FoldedXi, direction_from_angles};
use crate::simd::pair::Pair;
use crate::simd::{Broadcast, Choice, Lanes, Vec3x, lanes3};

/// Share of an integral that is left out at its ends: a quarter of the step between uniform numbers of 24 bits. On narrow bells and
/// in far tails, where the ends have digits for it, rounding then moves no sample past them, to a pole or to a place where a
/// Gaussian has no density left. A wide bell may reach the pole, where it has no sample. The azimuth leaves out two steps below 1 at its
/// far end: the integral falls to 0 there, and one step is lost where results are rounded up.
const LEAST_SHARE: f32 = f32::EPSILON / 8.0;

/// Draws a direction for `xi = [lobe, theta, phi]`. Returns the direction, its lobe, and its angles.
#[inline(always)]
pub(super) fn draw<B: MatchedBell, L: Lanes, C: Broadcast<L>, const N: usize>(
    prepared: &MatchedPrepared<C, N>,
    xi: [L; 3],
) -> (Vec3x<L>, L::Index, Angles<L>) {
    let c = L::splat;
    let one = c(1.0);
    let (view, hair) = (&prepared.view, &prepared.view.lobes);
    L::stage("lobe that xi.x selects");
    let choice = L::Index::search(xi[0], lanes3(&prepared.bounds), 3);

    L::stage("integral of the lobe's inclination at xi.y");
    // The number's share of the integral of M W, from the nearer pole. As a function of it the integral of M is the
    // least of the bands' lines: outwards they are steeper. Above the middle it is the negative integral.
    let total = C::look_up_three(&prepared.area, choice);
    let area = xi[1] * total;
    let lower = area.lt(C::look_up_three(&prepared.below, choice));
    let area = L::select(lower, area, total - area);
    let mut integral = line::<L, C, N>(prepared, choice, lower, area, 0);
    let mut j = 1;
    while j <= N / 2 {
        integral = integral.min(line::<L, C, N>(prepared, choice, lower, area, j));
        j += 1;
    }
    let [first, minus_last] = [
        C::look_up_three(&prepared.offset[0], choice),
        C::look_up_three(&prepared.offset[N - 1], choice),
    ];
    let whole = first + minus_last;
    let (least, most) = (
        whole.mul_add(c(-LEAST_SHARE), first),
        whole.mul_sub(c(LEAST_SHARE), minus_last),
    );
    // `max` and `min` return their second operand for NaN.
    let integral = L::select(lower, integral, -integral).max(least).min(most);

    L::stage("integral of the lobe's azimuth at xi.z");
    // TT's runs from its centre outwards, that of a glint from phi = 0.
    let folded = FoldedXi::of(xi[2]);
    let is_glint = choice.equals(3);
    let share = L::select(is_glint, one - folded.across, folded.across);
    let share = c(LEAST_SHARE).max(share.min(c(1.0 - f32::EPSILON)));
    let (mass, from) = (
        C::look_up_half(&prepared.azimuth_mass, choice),
        C::look_up_half(&prepared.azimuth_from, choice),
    );

    L::stage("inclination and azimuth at these integrals");
    let origin = Pair(
        C::look_up_three(&prepared.origin, choice),
        C::look_up_half(&prepared.azimuth_origin, choice),
    );
    let Pair(x, y) = B::invert(origin, Pair(integral, share.mul_add(mass, from)));
    let from_quarter = x.mul_sub(
        C::look_up_three(&hair.beta, choice),
        C::look_up_three(&view.shift, choice),
    );
    // Far below 8. NaN if any number is, because `min` returns its second operand for NaN: the sample then has no inclination and
    // no density. Rounding may take another sample past the pole, where it has no density either.
    let from_quarter = from_quarter.min(xi[0] + 8.0 + xi[1] + xi[2]);
    let center = L::keep(is_glint, hair.half_phi_g.lanes());
    let psi = y.mul_add(C::look_up_half(&hair.half_gamma, choice), center);
    let (wi, angles) = direction_from_angles(view, choice, from_quarter, folded, psi);
    (wi, choice, angles)
}

/// Evaluates the line of band `j` of a side at an area from its pole.
#[inline(always)]
fn line<L: Lanes, C: Broadcast<L>, const N: usize>(
    prepared: &MatchedPrepared<C, N>,
    choice: L::Index,
    lower: L::Mask,
    area: L,
    j: usize,
) -> L {
    let middle = j == N / 2;
    let above = if middle {
        &prepared.offset_above
    } else {
        &prepared.offset[N - 1 - j]
    };
    let offset = L::select(
        lower,
        C::look_up_three(&prepared.offset[j], choice),
        C::look_up_three(above, choice),
    );
    let slope = prepared.slope[j].lanes();
    let slope = if middle {
        slope
    } else {
        L::select(lower, slope, prepared.slope[N - 1 - j].lanes())
    };
    slope.mul_add(area, offset)
}
