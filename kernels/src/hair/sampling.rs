//! The published sampler: chooses a lobe by its energy, then inclination and azimuth by inversion (section 3.2 of the paper).

use super::{Angles, HairView, PublishedPrepared};
use crate::hair::truncated::TruncatedCauchy;
use crate::model::math::{half_angle, sin_cos_absolute, sin_cos_twice};
use crate::simd::pair::Pair;
use crate::simd::{Broadcast, Choice, Lanes, Vec3x, lanes3};
use core::f32::consts::FRAC_PI_4;

/// Draws a direction for `xi = [lobe, theta, phi]`. Returns the direction, its lobe, and its angles.
#[inline(always)]
pub(super) fn draw<L: Lanes, C: Broadcast<L>>(
    prepared: &PublishedPrepared<C>,
    xi: [L; 3],
) -> (Vec3x<L>, L::Index, Angles<L>) {
    let c = L::splat;
    let (zero, one, half) = (c(0.0), c(1.0), c(0.5));
    let (view, hair, sampler) = (&prepared.view, &prepared.view.lobes, &prepared.sampler);
    L::stage("lobe that xi.x selects");
    let choice = L::Index::search(xi[0], lanes3(&sampler.bounds), 3);
    // `min` and `max` return their second operand for NaN, so that the NaN of either number stays and the sample has no
    // inclination.
    let along = zero.max(one.min(xi[1].min(xi[0] + xi[1])));

    L::stage("inclination by xi.y and azimuth by xi.z, by inversion of the Cauchy distributions");
    // x = theta_h - alpha, and theta_i = 2 (x + alpha) - theta_o. Interleaved with the azimuth.
    let folded = FoldedXi::of(xi[2]);
    let both = TruncatedCauchy {
        tan_mid: Pair(
            C::look_up_three(&prepared.inclination_middle, choice),
            C::look_up_half(&sampler.azimuth_middle, choice),
        ),
        span: Pair(
            C::look_up_three(&prepared.inclination_span, choice),
            C::look_up_half(&sampler.azimuth_span, choice),
        ),
    };
    let Pair(x, y) = both.invert(Pair(along - 0.5, half - folded.across));
    let from_quarter = x.mul_sub(
        C::look_up_three(&hair.beta, choice),
        C::look_up_three(&view.shift, choice),
    );
    let center = L::keep(choice.equals(3), hair.half_phi_g.lanes());
    let psi = y.mul_add(C::look_up_half(&hair.half_gamma, choice), center);
    let (wi, angles) = direction_from_angles(view, choice, from_quarter, folded, psi);
    (wi, choice, angles)
}

/// Uniform number for the azimuth, folded about its middle.
#[derive(Clone, Copy)]
pub(crate) struct FoldedXi<L> {
    /// Number whose sign is the side.
    side: L,
    /// Share of one side, measured from the middle of `xi_phi`.
    pub(crate) across: L,
}

impl<L: Lanes> FoldedXi<L> {
    /// Splits a number in `[0, 1]`, or NaN.
    #[inline(always)]
    pub(crate) fn of(xi: L) -> Self {
        let side = xi + xi - 1.0;
        Self {
            side,
            across: L::splat(1.0).min(side.abs()),
        }
    }
}

/// Least cosine of an inclination, far below that of any kept sample. Its reciprocal is finite, and so are products with it.
const LEAST_COSINE: f32 = 1e-20;

/// Computes the direction at an inclination and an azimuth, and its angles. Angles that keep their digits in the direction are
/// reused, not recomputed from it.
///
/// `from_quarter` is half of `theta_i` plus `quarter_o`. The azimuth is on the side of `folded`. `psi` is half of `|phi|` for the
/// glints and half of `pi - |phi|` for TT; R and TRT-g compute it from `folded` alone. For narrow bells rounding may move `psi` a
/// little out of `[0, pi/2]`: the cosine is cut at one end, and `rotation` turns the angle back at the other.
#[inline(always)]
pub(crate) fn direction_from_angles<L: Lanes, C: Broadcast<L>>(
    view: &HairView<C>,
    choice: L::Index,
    from_quarter: L,
    FoldedXi { side, across }: FoldedXi<L>,
    psi: L,
) -> (Vec3x<L>, Angles<L>) {
    L::stage("sines and cosines of the inclination and of half the azimuth");
    let c = L::splat;
    let (zero, one) = (c(0.0), c(1.0));
    let is_tt = choice.equals(1);
    let is_glint = choice.equals(3);
    let is_bell = L::or(is_tt, is_glint);
    let (from_quarter, psi) = L::interleave(from_quarter, psi);
    let quarter_o = view.quarter_o.lanes();
    let half_theta_i = from_quarter - quarter_o;
    let (sin_theta_i, cos_theta_i) = sin_cos_twice(half_theta_i);
    // Rounding may take the last of a tail past the pole: no direction, and no density.
    let cos_theta_i = zero.max(cos_theta_i);

    // R and TRT-g need no arcsine: sin(phi/2) = 2 xi - 1.
    let (sin_bell, cos_bell) = sin_cos_absolute(psi);
    let sin_psi = L::select(is_bell, sin_bell, across);
    let cos_psi = L::select(is_bell, zero.max(cos_bell), (one - across * across).sqrt());
    let (cos_half_phi, sin_half_phi) = L::swap(is_tt, sin_psi, cos_psi);
    // Half of |phi| or of pi - |phi|, whichever is smaller: psi itself, or from the sine and cosine that the direction is made of.
    // Next to pi R and TRT-g vanish, and TT takes all of the digits there; so it does for a glint, whose psi is next to pi/2.
    let as_drawn = L::and(is_bell, psi.lt(c(FRAC_PI_4)));
    let (small, large) = (sin_psi.min(cos_psi), sin_psi.max(cos_psi));
    let half = L::select(as_drawn, psi, half_angle(small + small, large));
    let of_phi = sin_half_phi.lt(cos_half_phi);

    L::stage("direction");
    // From the double angle; phi_i = phi_o - phi. The sides of R and TRT-g are the other way round.
    let sin_psi_sq = sin_psi * sin_psi;
    let sin_twice = (sin_psi + sin_psi) * cos_psi;
    let cos_phi = L::negate(is_tt, cos_psi.mul_sub(cos_psi, sin_psi_sq));
    let sin_phi = sin_twice.times_sign(L::negate(is_bell, side));
    // The length absorbs the distance of sine and cosine from the unit circle.
    let off_unit = cos_psi.mul_add(cos_psi, sin_psi_sq) - 1.0;
    let [v_o, w_o, _] = lanes3(&view.plane_o);
    let inv_plane_o = view.inv_plane_o.lanes();
    let by = (inv_plane_o - inv_plane_o * off_unit) * cos_theta_i;
    let v = v_o.mul_add(cos_phi, w_o * sin_phi) * by;
    let w = w_o.mul_sub(cos_phi, v_o * sin_phi) * by;

    L::stage("angles of that direction: half the azimuth, turned by the rounding of the direction");
    // A division of its own: nothing before it waits for it.
    let inv_cos_theta_i = L::quotient(one, c(LEAST_COSINE).max(cos_theta_i));
    let dot = v.mul_add(v_o, w * w_o);
    let cross = L::difference_of_products(w, v_o, v, w_o).abs();
    let rotation =
        cross.mul_sub(cos_phi, dot * sin_twice) * (inv_cos_theta_i * (inv_plane_o * 0.5));
    let angles = Angles {
        // Not `from_quarter`: the direction is that of the rounded half.
        half_theta_i_plus_quarter: half_theta_i + quarter_o,
        sin_theta_i,
        cos_theta_i,
        inv_cos_theta_i,
        half: half - L::negate(of_phi, rotation),
        of_phi,
        // On the seam the two may cancel to below 0.
        cos_half_phi: zero.max(rotation.mul_add(-sin_half_phi, cos_half_phi)),
        front: zero.lt(dot),
    };
    (Vec3x::new(sin_theta_i, v, w), angles)
}
