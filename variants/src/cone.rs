//! Longitudinal lobe of d'Eon et al. 2011, which two models have: its Bessel function, and directions about its cone.

use core::f32::consts::PI;
use hairis::model::math::{polynomial, sin_cos_half_turn};
use hairis::simd::Lanes;

/// Argument below which the scaled Bessel function is a series in `x^2`, and above which it is a series in `1 / x`.
pub(crate) const SEAM: f32 = 5.5;
/// Coefficients of `I0(x)` in powers of `x^2`, for `x` below the seam.
const SERIES: [f32; 8] = [
    0.999_999_964_93,
    0.250_000_247_14,
    0.015_624_746_521,
    4.341_184_831_1e-4,
    6.766_766_700_5e-6,
    6.908_044_545e-8,
    4.144_287_593_5e-10,
    3.643_167_776e-12,
];
/// Coefficients of `exp(-x) I0(x) sqrt(x)` in powers of `1 / x`, for `x` above the seam.
const TAIL: [f32; 6] = [
    0.398_942_300_81,
    0.049_868_737_73,
    0.027_805_208_42,
    0.037_460_558_19,
    -0.055_432_330_86,
    0.535_620_729_8,
];

/// Computes `I0(x)` where `x` is `small`, below [`SEAM`], and `exp(-x) I0(x)` elsewhere; `root` is `1 / sqrt(x)`.
#[inline(always)]
pub(crate) fn bessel<L: Lanes>(small: L::Mask, x: L, root: L) -> L {
    // Each is clamped to bounds that it keeps where it is selected; elsewhere its powers would overflow.
    let (below, above) = (x.min(L::splat(8.0)), root.min(L::splat(1.0)));
    L::select(
        small,
        polynomial(below * below, SERIES),
        polynomial(above * above, TAIL) * root,
    )
}

/// Returns the components towards the cone's pole and across of a point on the unit sphere, at `1 - drop` along the cone and at half a turn
/// times `xi` about it.
#[inline(always)]
pub(crate) fn about<L: Lanes>(drop: L, xi: L) -> [L; 2] {
    let radius = (drop * (L::splat(2.0) - drop)).sqrt();
    let (minus_cos, sin) = sin_cos_half_turn((xi - 0.5) * PI);
    [-(radius * minus_cos), radius * sin]
}

/// Returns sine and cosine of the inclination of that point, for the cone about `-theta'` with this sine and cosine of `theta'`.
#[inline(always)]
pub(crate) fn inclination<L: Lanes>(
    drop: L,
    [towards, across]: [L; 2],
    [sin_cone, cos_cone]: [L; 2],
) -> [L; 2] {
    let along = L::splat(1.0) - drop;
    let sin_i = towards.mul_sub(cos_cone, along * sin_cone);
    let plane = along.mul_add(cos_cone, towards * sin_cone);
    [sin_i, plane.mul_add(plane, across * across).sqrt()]
}
