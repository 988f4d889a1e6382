//! Elementary functions on the ranges that the models use, one source for every backend.
//!
//! The general functions of `wide` branch on their data and cost two to four times as much. Each function here states
//! its range, and the error measured on it by the tests (rows of `tests/tolerance.rs`). None branches.

use crate::Lanes;
use core::f32::consts::{FRAC_PI_2, PI};

/// `pi/2 - FRAC_PI_2`, what the rounding of the constant leaves out.
const FRAC_PI_2_LOW: f32 = -4.371_139e-8;

/// A polynomial, its even and odd halves apart: half the dependency chain of Horner's rule.
#[inline(always)]
fn polynomial<L: Lanes, const N: usize>(x: L, coefficients: [f32; N]) -> L {
    let square = x * x;
    let mut halves = [L::splat(coefficients[(N - 1) & !1]), L::splat(coefficients[(N - 2) | 1])];
    let mut i = N - 2;
    while i > 0 {
        i -= 1;
        halves[i & 1] = halves[i & 1].mul_add(square, L::splat(coefficients[i]));
    }
    halves[1].mul_add(x, halves[0])
}

/// `2^-x` for `x >= 0`; exactly 0 from about `2^-115` down.
///
/// That is far below any other term of a sum, and so far above the denormals that the products made of it seldom are
/// one: denormals cost as much as the rest of the model. NaN gives NaN.
#[inline(always)]
pub fn exp2_neg<L: Lanes>(x: L) -> L {
    // Adding 2^23 rounds to an integer and leaves it in the low bits, biased as an exponent is. The bias is 12 short,
    // so that the exponent reaches 0, and with it the power, at -115 already; the polynomial makes up for it.
    let magic = L::splat(8_388_608.0 + 115.0);
    // The second operand of `max` wins over NaN.
    let t = L::splat(-115.0).max(-x);
    let n = t + magic;
    let f = t - (n - magic);
    const SCALE: f32 = 4096.0;
    let p = polynomial(
        f,
        [
            SCALE * 0.693_147_182_464_599_6,
            SCALE * 0.240_226_477_384_567_26,
            SCALE * 0.055_503_323_674_201_965,
            SCALE * 0.009_618_436_917_662_62,
            SCALE * 0.001_339_887_385_256_588_5,
            SCALE * 0.000_153_533_619_595_691_56,
        ],
    );
    p.mul_add(f, L::splat(SCALE)) * n.bits_shl_23()
}

/// `atan t` for `|t| <= 1`.
#[inline(always)]
pub fn atan_unit<L: Lanes>(t: L) -> L {
    let z = t * t;
    let p = polynomial(
        z,
        [
            -0.333_331_525_325_775_15,
            0.199_937_671_422_958_37,
            -0.142_110_009_922_256_47,
            0.106_657_691_299_915_31,
            -0.075_516_752_898_693_08,
            0.043_205_402_791_500_09,
            -0.016_364_114_359_021_187,
            0.002_919_823_629_781_604,
        ],
    );
    p.mul_add(z * t, t)
}

/// `atan2(y, x)` for `y >= 0`: an angle in `[0, pi]`. Both zero give 0.
#[inline(always)]
pub fn atan2_upper<L: Lanes>(y: L, x: L) -> L {
    let c = L::splat;
    let across = x.abs();
    let steep = across.lt(y);
    let (small, large) = (L::select(steep, across, y), L::select(steep, y, across));
    let a = atan_unit(small / large.max(c(f32::MIN_POSITIVE)));
    let a = L::select(steep, (c(FRAC_PI_2) - a) + c(FRAC_PI_2_LOW), a);
    L::select(x.lt(c(0.0)), (c(PI) - a) + c(2.0 * FRAC_PI_2_LOW), a)
}

/// `(sin x, cos x)` for `|x| <= pi/2`.
#[inline(always)]
pub fn sin_cos_half_turn<L: Lanes>(x: L) -> (L, L) {
    // cos x = sin(pi/2 - |x|), with pi/2 in two parts: the cosine keeps its digits where it vanishes.
    let y = (L::splat(FRAC_PI_2) - x.abs()) + L::splat(FRAC_PI_2_LOW);
    (sin_half_turn(x), sin_half_turn(y))
}

/// `sin x` for `|x| <= pi/2`.
#[inline(always)]
fn sin_half_turn<L: Lanes>(x: L) -> L {
    let z = x * x;
    let p = polynomial(
        z,
        [-0.166_666_612_029_075_62, 0.008_333_072_066_307_068, -0.000_198_096_604_435_704_65, 2.606_138_195_915_264e-6],
    );
    p.mul_add(z * x, x)
}
