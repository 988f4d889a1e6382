//! Azimuth of TRT: three Gaussians by the inclination, each cut to one turn.

use core::f32::consts::{LN_2, PI};
use hairis::model::math::{gaussian, log2, normal_tail, sin_cos_half_turn, sin_half_turn};
use hairis::simd::{Lanes, lane_struct};

lane_struct! {
    /// Gaussians of TRT. Arrays of two hold the outer ones and the one at the centre.
    pub struct DEonGaussians {
        /// Azimuth of the outer Gaussians, rad.
        pub(super) place: C,
        /// Share of both outer Gaussians.
        pub(super) share: C,
        /// Standard deviation of each, rad.
        pub(super) deviation: [C; 2],
        /// Its inverse.
        pub(super) inv_deviation: [C; 2],
        /// Peak of each, times its share.
        pub(super) peak: [C; 2],
        /// Mass of the uncut Gaussians beyond half a turn: of an outer one on the far side and on its own, and of the centre.
        pub(super) tail: [C; 3],
    }
}

/// Ends of the pieces of the fit, rad.
const ENDS: [f32; 2] = [0.525, 1.1];
/// Least weight of the Gaussian at the centre.
const LEAST_CENTRE: f32 = 5e-5;
/// `1 / sqrt(2 pi)`.
const PEAK: f32 = 0.398_942_28;

/// Computes `base^exponent` of a base in `[0, 1]`, for an exponent above 2.
#[inline(always)]
fn power<L: Lanes>(base: L, exponent: f32) -> L {
    gaussian(log2(base.max(L::splat(1e-30))) * (-2.0 * LN_2 * exponent))
}

/// Computes `a + b t + d t^2`.
#[inline(always)]
fn quadratic<L: Lanes>(t: L, a: f32, b: f32, d: f32) -> L {
    L::splat(d).mul_add(t, L::splat(b)).mul_add(t, L::splat(a))
}

/// Evaluates the published fit at an inclination in `[0, pi/2]` with this sine and cosine: place of the outer Gaussians, weight of each,
/// weight of the centre, and both variances at a roughness of .06.
///
/// The second piece begins with a negative weight of the centre, in place of which there is a least one. Next to 0 it would have no digits.
#[inline(always)]
fn fit<L: Lanes>(theta: L, [sin, cos]: [L; 2]) -> [L; 5] {
    let (c, zero, one) = (L::splat, L::splat(0.0), L::splat(1.0));
    let [first, second] = ENDS.map(L::splat);

    L::stage("fit of TRT below 30 degrees");
    let t = theta.min(first);
    let tan = L::quotient(sin.min(c(0.6)), cos.max(c(0.8)));
    let half = sin_half_turn(t * (0.5 * 5.41149));
    let inner = sin_half_turn(t * (0.5 * 2.121));
    let (sin_inner, cos_inner) = sin_cos_half_turn(one - (inner + inner) * inner);
    let low = [
        cos - 0.733,
        power(t, 15.7265) + ((c(0.103_125) - t) * t).mul_add(c(0.000_111_282), c(0.000_239_39)),
        (t - power(t * 1.80972, 16.7669)).mul_add(tan, c(0.991_977)) * 0.000_322_755,
        (one - (half + half) * half).mul_add(c(0.000_428_897), c(0.005_975_78)),
        L::quotient(sin_inner, cos_inner) * 0.0181,
    ];

    L::stage("fit of TRT below 63 degrees, and beyond");
    let t = first.max(theta.min(second));
    let middle = [
        zero.max(quadratic(t, 0.00493, 0.579, -0.775)),
        quadratic(t, 0.00108, -0.0014, 0.000_393_7),
        t.mul_add(c(0.00219), c(-0.00119)).max(c(LEAST_CENTRE)),
        quadratic(t, 0.0391, -0.0888, 0.0581),
        quadratic(t, 0.384, -1.14, 0.942),
    ];
    let t = second.max(theta);
    let square = t * t;
    let high = [
        zero,
        zero,
        (square * -0.000_531_24 + 0.00139).mul_add(square * t, c(0.000_239)),
        one,
        c(-0.7437).mul_add(t, c(2.73)).mul_add(t, c(-1.86)),
    ];
    let (is_low, is_middle) = (theta.lt(first), theta.lt(second));
    let mut fitted = low;
    let mut i = 0;
    while i < 5 {
        fitted[i] = L::select(is_low, low[i], L::select(is_middle, middle[i], high[i]));
        i += 1;
    }
    fitted
}

/// Computes the Gaussians at an inclination in `[0, pi/2]` with this sine and cosine; `width` is the roughness over .06.
#[inline(always)]
pub(super) fn gaussians<L: Lanes>(
    theta: L,
    theta_parts: [L; 2],
    width: L,
) -> DEonGaussians<L::Stored> {
    let (c, one) = (L::splat, L::splat(1.0));
    let [place, outer, centre, outer_variance, centre_variance] = fit(theta, theta_parts);
    L::stage("Gaussians of TRT: shares, widths, and masses beyond half a turn");
    let pair = outer + outer;
    let share = L::quotient(pair, pair + centre);
    let [s, z] = [
        outer_variance.sqrt() * width,
        centre_variance.sqrt() * width,
    ];
    let [inv_s, inv_z] = [L::quotient(one, s), L::quotient(one, z)];
    let far = normal_tail((c(PI) + place) * inv_s);
    let near = normal_tail((c(PI) - place) * inv_s);
    let beyond = normal_tail(inv_z * PI);
    let [kept_s, kept_z] = [one - far - near, one - beyond - beyond];
    DEonGaussians {
        place: place.store(),
        share: share.store(),
        deviation: [s.store(), z.store()],
        inv_deviation: [inv_s.store(), inv_z.store()],
        peak: [
            L::quotient(share * inv_s * (0.5 * PEAK), kept_s).store(),
            L::quotient((one - share) * inv_z * PEAK, kept_z).store(),
        ],
        tail: [far.store(), near.store(), beyond.store()],
    }
}
