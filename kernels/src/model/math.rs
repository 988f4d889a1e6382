//! Elementary functions on the ranges that the models use, from one source for every backend.
//!
//! The general functions of `wide` branch on their data and cost two to four times as much. Each function here states its range, on
//! which the tests measure its error (rows of `tests/tolerance.rs`), and none branches. The largest errors over all floats of the range,
//! and over sets of pairs for functions of two numbers, are in a [table](crate::guide::platforms).

pub use crate::hair::quadrature::GAUSS_LEGENDRE_32;

use crate::simd::Lanes;
use crate::simd::pair::Pair;
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, LOG2_E, PI};

/// Rounding error of the constant `FRAC_PI_2`: `pi/2 - FRAC_PI_2`.
pub const FRAC_PI_2_LOW: f32 = -4.371_139e-8;

/// Evaluates a polynomial of up to ten coefficients, the constant first. Its even and odd halves are summed apart, which halves the
/// dependency chain of Horner's rule.
#[inline(always)]
pub fn polynomial<L: Lanes, const N: usize>(x: L, coefficients: [f32; N]) -> L {
    halves::<L, N, 0>(x, coefficients)
}

/// Evaluates [`polynomial`] from the coefficient `FIRST` on, which is 0 or 2.
///
/// The steps are written out because compilers that optimise for size would keep a loop, over coefficients in memory.
#[inline(always)]
fn halves<L: Lanes, const N: usize, const FIRST: usize>(x: L, coefficients: [f32; N]) -> L {
    let square = x * x;
    let mut even = L::splat(coefficients[(N - 1) & !1]);
    let mut odd = L::splat(coefficients[(N - 2) | 1]);
    macro_rules! steps {
        ($($half:ident $i:literal)*) => { $(
            if $i + 2 < N && $i >= FIRST {
                $half = $half.mul_add(square, L::splat(coefficients[$i]));
            }
        )* };
    }
    const { assert!(N <= 10, "every coefficient has a step") };
    steps!(odd 7 even 6 odd 5 even 4 odd 3 even 2 odd 1 even 0);
    odd.mul_add(x, even)
}

/// Evaluates a polynomial of up to ten coefficients, the constant first, by Horner's rule. It takes the fewest instructions and
/// registers and has the smallest error, but pays off only where other work fills its waits.
///
/// Without fused products a step is two instructions that wait for each other, so that other work cannot fill a long chain. Long
/// polynomials then have their even and odd halves apart, except for the two lowest coefficients, for the sake of the error.
#[inline(always)]
pub fn horner<L: Lanes, const N: usize>(x: L, coefficients: [f32; N]) -> L {
    let apart = !L::fuses() && N > 7;
    let mut sum = if apart {
        halves::<L, N, 2>(x, coefficients)
    } else {
        L::splat(coefficients[N - 1])
    };
    macro_rules! steps {
        ($($i:literal)*) => { $(
            if $i + 1 < N && ($i < 2 || !apart) {
                sum = sum.mul_add(x, L::splat(coefficients[$i]));
            }
        )* };
    }
    const { assert!(N <= 10, "every coefficient has a step") };
    steps!(8 7 6 5 4 3 2 1 0);
    sum
}

/// Returns `[a / x, b / y]`. Lanes that fuse share one division, their slowest instruction; others have the time for two.
#[inline(always)]
pub(crate) fn quotients<L: Lanes>([a, x]: [L; 2], [b, y]: [L; 2]) -> [L; 2] {
    if L::fuses() {
        let both = L::quotient(L::splat(1.0), x * y);
        [a * (both * y), b * (both * x)]
    } else {
        [L::quotient(a, x), L::quotient(b, y)]
    }
}

/// Factor from a squared distance to the exponent of a Gaussian: `log2(e) / 2`, negative.
const TO_EXPONENT: f32 = -0.5 * LOG2_E;
/// Largest magnitude of the exponent in [`gaussian`].
const LEAST_EXPONENT: f32 = 115.0;
/// Largest squared distance that [`gaussian`] distinguishes: a little below the distance of the least exponent, so that no direction
/// of rounding leads beyond it.
const FURTHEST: f32 = 0.999_98 * LEAST_EXPONENT / -TO_EXPONENT;
/// Value of [`FURTHEST`] for a power of the target, a little below the largest square of [`normal_tail`].
const NATIVE_FURTHEST: f32 = 159.41;

/// Computes `exp(-s/2)` for `s >= 0`, a Gaussian of the squared distance from its centre; exactly 0 from about `2^-115` down.
///
/// The threshold is far below any other term of a sum, and so far above the denormals that products with the result are seldom
/// denormal: denormals cost as much as the rest of the model. NaN gives 0.
#[inline(always)]
pub fn gaussian<L: Lanes>(s: L) -> L {
    // `min` returns its second operand for NaN.
    gaussian_within(s.min(L::splat(FURTHEST)))
}

/// Computes [`gaussian`] for `s` up to [`FURTHEST`].
#[inline(always)]
fn gaussian_within<L: Lanes>(s: L) -> L {
    if let Some(power) = (s * TO_EXPONENT).native_exp2() {
        return L::keep(s.lt(L::splat(NATIVE_FURTHEST)), power);
    }
    // Adding 2^23 rounds to an integer and leaves it in the low bits, biased as an exponent is. The bias is 12 short,
    // so that the exponent reaches 0, and with it the power, at -115 already; the polynomial makes up for it.
    let magic = L::splat(8_388_608.0 + LEAST_EXPONENT);
    let to_exponent = L::splat(TO_EXPONENT);
    let n = s.mul_add(to_exponent, magic);
    let f = s.mul_add(to_exponent, magic - n);
    const SCALE: f32 = 4096.0;
    let p = horner(
        f,
        [
            SCALE,
            SCALE * 0.693_146_977_598_470_9,
            SCALE * 0.240_222_420_849_192_87,
            SCALE * 0.055_507_337_442_446_49,
            SCALE * 0.009_671_512_660_561_226,
            SCALE * 0.001_326_472_689_901_139_9,
        ],
    );
    p * n.bits_shl_23()
}

/// Computes [`gaussian`] and its complement to 1, which keeps its digits where it is small. They are exactly 0 and 1 from about
/// `2^-115` down, and for NaN.
#[inline(always)]
pub fn gaussian_and_complement<L: Lanes>(s: L) -> (L, L) {
    let one = L::splat(1.0);
    // The exponent without the bias of `gaussian`: as an integer, and as the power of two.
    let magic = L::splat(8_388_608.0 + 127.0);
    let (to_exponent, last) = (
        L::splat(TO_EXPONENT),
        L::splat(LEAST_EXPONENT / -TO_EXPONENT),
    );
    let some = s.lt(last);
    let s = s.min(last);
    let n = s.mul_add(to_exponent, magic);
    let f = s.mul_add(to_exponent, magic - n);
    let power = n.bits_shl_23();
    // (2^f - 1) / f.
    let p = polynomial(
        f,
        [
            0.693_147_187_899_326,
            0.240_226_496_352_892_84,
            0.055_503_575_216_887_605,
            0.009_618_263_217_921_846,
            0.001_339_070_019_198_61,
            0.000_153_952_528_257_223_89,
        ],
    );
    let rest = f * power;
    (
        L::keep(some, p.mul_add(rest, power)),
        p.mul_add(-rest, one - power),
    )
}

/// Computes `atan t` for `|t| <= 1`, in radians.
#[inline(always)]
pub fn atan_unit<L: Lanes>(t: L) -> L {
    let z = (t * t).interleaved();
    let p = horner(
        z,
        [
            -0.333_329_856_395_721_44,
            0.199_903_666_973_114,
            -0.141_857_504_844_665_53,
            0.105_731_047_689_914_7,
            -0.073_650_382_459_163_67,
            0.041_103_046_387_434_006,
            -0.015_121_388_249_099_255,
            0.002_619_541_482_999_921,
        ],
    );
    p.mul_add(z * t, t)
}

/// Computes half of the angle in `[-pi/2, pi/2]` whose sine and cosine are given, on the unit circle.
///
/// Half the angle over its sine is a smooth function of the cosine, so that no division is needed. The function is fitted less 1, so
/// that the largest term of the angle is the sine itself, which is not rounded.
#[inline(always)]
pub fn half_angle<L: Lanes>(sin: L, cos: L) -> L {
    // The constant is a float, and the others are fitted to it.
    let less_one = horner(
        cos.interleaved(),
        [
            -0.214_601_829_648_017_88,
            -0.499_999_500_396_212_94,
            0.392_663_637_608_987_15,
            -0.332_720_478_606_108_8,
            0.289_589_927_825_948_5,
            -0.244_078_159_261_104_4,
            0.180_320_774_712_520_7,
            -0.101_908_158_322_096_08,
            0.036_975_211_674_533_444,
            -0.006_241_406_884_139_656,
        ],
    );
    less_one.mul_add(sin, sin)
}

/// Computes half of `atan2(y, x)` for `x >= 0`, an angle in `[-pi/4, pi/4]`; `length` is that of `(x, y)`. Zero length gives NaN.
///
/// The function takes the half-angle tangent of the angle or of its complement, whichever is smaller: the error is half as large as
/// that of [`atan_unit`] of `y / (length + x)` at the ends.
#[inline(always)]
pub fn half_atan2<L: Lanes>(y: L, x: L, length: L) -> L {
    let [quarter, rest] = half_atan2_parts(y, x, length);
    quarter + rest
}

/// Computes [`half_atan2`] as a sum of two numbers. The first is `pi/4` with the sign of the angle beyond 56 degrees, else 0; the
/// second is the remainder, with more digits than the sum.
#[inline(always)]
pub fn half_atan2_parts<L: Lanes>(y: L, x: L, length: L) -> [L; 2] {
    let c = L::splat;
    let across = y.abs();
    let half = atan_eighth_turn(L::quotient(across.min(x), length + across.max(x)));
    let (steep, quarter) = (x.lt(across), c(FRAC_PI_4));
    let less = c(0.5 * FRAC_PI_2_LOW) - half;
    let near = (x * 1.5).lt(across);
    let rest = L::select(near, less, L::select(steep, quarter + less, half));
    [L::keep(near, quarter).times_sign(y), rest.times_sign(y)]
}

/// Computes `atan t` for `|t| <= tan(pi/8)`, in radians.
#[inline(always)]
pub fn atan_eighth_turn<L: Lanes>(t: L) -> L {
    let z = t * t;
    let p = polynomial(
        z,
        [
            -0.333_329_498_767_852_8,
            0.199_777_275_323_867_8,
            -0.138_777_986_168_861_4,
            0.080_539_561_808_109_28,
        ],
    );
    p.mul_add(z * t, t)
}

/// Computes `atan2(y, x)` for `y >= 0`, an angle in `[0, pi]`. If both are zero, the angle is 0.
#[inline(always)]
pub fn atan2_upper<L: Lanes>(y: L, x: L) -> L {
    let c = L::splat;
    let across = x.abs();
    let steep = across.lt(y);
    let (small, large) = (L::select(steep, across, y), L::select(steep, y, across));
    let a = atan_unit(L::quotient(small, large.max(c(f32::MIN_POSITIVE))));
    let a = L::select(steep, c(FRAC_PI_2) - (a - FRAC_PI_2_LOW), a);
    L::select(x.lt(c(0.0)), c(PI) - (a - 2.0 * FRAC_PI_2_LOW), a)
}

/// Computes `(sin x, cos x)` for `|x| <= pi/2`; the cosine keeps its digits where it vanishes.
#[inline(always)]
pub fn sin_cos_half_turn<L: Lanes>(x: L) -> (L, L) {
    sin_cos_twice(x * 0.5)
}

/// Computes `(sin 2x, cos 2x)` for `|x| <= pi/4`; the cosine keeps its digits where it vanishes.
#[inline(always)]
pub fn sin_cos_twice<L: Lanes>(x: L) -> (L, L) {
    // cos 2x = sin(pi/2 - |2x|), with pi/2 in two parts: the cosine keeps its digits where it vanishes.
    let y = x.abs().mul_add(L::splat(-2.0), L::splat(FRAC_PI_2)) + FRAC_PI_2_LOW;
    let Pair(sin, cos) = sin_half_turn(Pair(x + x, y));
    (sin, cos)
}

/// Computes `(sin x, cos x)` for `|x| <= pi/2` to an absolute error, for a third less work than [`sin_cos_twice`], whose cosine
/// keeps its digits where it vanishes.
#[inline(always)]
pub fn sin_cos_absolute<L: Lanes>(x: L) -> (L, L) {
    let z = (x * x).interleaved();
    let p = horner(
        z,
        [
            -0.499_999_314_546_584_9,
            0.041_663_989_424_705_51,
            -0.001_385_592_622_682_452_2,
            2.319_435_589_015_484e-5,
        ],
    );
    (sin_half_turn(x), p.mul_add(z, L::splat(1.0)))
}

/// Computes the numerator and the denominator of `tan x` for `|x| <= pi/2`.
///
/// For inversion of a distribution: an error of 1e-7 in the angle that a number is mapped to is an error of 1e-7 in the number.
#[inline(always)]
pub fn tan_half_turn<L: Lanes>(x: L) -> (L, L) {
    let z = (x * x).interleaved();
    let numerator = horner(z, [1.000_000_1, -0.112_152_473, 0.001_132_496_5]);
    (x * numerator, horner(z, [1.0, -0.445_485, 0.016_292_556_6]))
}

/// Computes `sin x` for `|x| <= pi/2`.
#[inline(always)]
pub fn sin_half_turn<L: Lanes>(x: L) -> L {
    let z = x * x;
    let p = horner(
        z,
        [
            -0.166_666_612_029_075_62,
            0.008_333_072_066_307_068,
            -0.000_198_096_604_435_704_65,
            2.606_138_195_915_264e-6,
        ],
    );
    p.mul_add(z * x, x)
}

/// Coefficients of `log2(1 + f) / f` for mantissas from `sqrt(1/2)` to `sqrt(2)`: the logarithm without its exponent.
const LOG2_MANTISSA: [f32; 9] = [
    1.442_695_003_649_184_6,
    -0.721_347_347_241_464,
    0.480_910_643_938_397_7,
    -0.360_703_645_450_798_1,
    0.287_916_182_928_988_24,
    -0.238_945_621_068_374_1,
    0.215_717_075_270_067_12,
    -0.207_264_797_130_794_1,
    0.125_826_905_124_035_44,
];

/// Computes the logarithm to the base 2 of a normal number above 0; any other number gives a finite number or NaN.
#[inline(always)]
pub fn log2<L: Lanes>(x: L) -> L {
    if let Some(log) = x.native_log2() {
        return log;
    }
    let (mantissa, exponent) = x.split_exponent();
    let f = (mantissa - 1.0).interleaved();
    polynomial(f, LOG2_MANTISSA).mul_add(f, exponent)
}

/// Computes the logarithm to the base 2 of `x` in `(0, 1]`, where `less_one`, which is `x - 1`, is known with more digits than `x`
/// has. Where `less_one` is above `sqrt(1/2) - 1`, it alone is read.
#[inline(always)]
pub fn log2_near_one<L: Lanes>(x: L, less_one: L) -> L {
    let (mantissa, exponent) = x.split_exponent();
    let f = (mantissa - 1.0).interleaved();
    let near = L::splat(-0.292_893_2).lt(less_one);
    let f = L::select(near, less_one, f);
    // `x` is rounded separately, so that next to the seam its exponent may be -1.
    let exponent = L::select(near, L::splat(0.0), exponent);
    polynomial(f, LOG2_MANTISSA).mul_add(f, exponent)
}

/// Computes `log2(1 + f)` for `f` in `(-1, 0]`, with the digits of `f`; any other number gives a finite number or NaN.
#[inline(always)]
pub fn log2_one_plus<L: Lanes>(f: L) -> L {
    log2_near_one(L::splat(1.0) + f, f)
}

/// Returns the probability that a standard normal number is above `x`, for `x >= 0`; exactly 0 from about 12.6 up. NaN gives 0.
#[inline(always)]
pub fn normal_tail<L: Lanes>(x: L) -> L {
    // The square root of `FURTHEST`. `min` returns its second operand for NaN.
    let x = x.min(L::splat(12.625_9));
    normal_tail_ratio(x) * gaussian_within(x * x)
}

/// Computes the ratio of [`normal_tail`] to the shape of the density, `Q(x) exp(x^2 / 2)`, for `0 <= x <= 12.7`. Beyond, the result
/// falls on towards 0 and never below it, up to 1e9.
///
/// The coefficients are floats that were chosen together, so that rounding adds as little as possible to the error.
#[inline(always)]
pub fn normal_tail_ratio<L: Lanes>(x: L) -> L {
    let c = L::splat;
    let over = horner(x, [11.961_291_3, 8.593_118_7, 2.821_643_8, 0.398_885_7]);
    // The leading coefficient is 1.
    let under = (x + 7.067_357_5)
        .mul_add(x, c(22.627_039))
        .mul_add(x, c(36.273_33))
        .mul_add(x, c(23.922_586_4));
    L::quotient(over, under)
}

/// Returns the number that a standard normal number exceeds with probability `q`, for `0 < q <= 1/2`; finite for any other `q`.
///
/// Each of two branches is one polynomial in `w = -log2(4 q (1 - q))`: about `1 - 2q` times a series below 7, and about `sqrt w`
/// beyond.
#[inline(always)]
pub fn normal_tail_inverse<L: Lanes>(q: L) -> L {
    let c = L::splat;
    let (zero, one) = (c(0.0), c(1.0));
    let w = zero
        .max(zero - log2((c(4.0) * q * (one - q)).interleaved()))
        .interleaved();
    let center = polynomial(
        w,
        [
            1.253_313_830_486_207_7,
            0.227_440_296_020_921_97,
            0.007_821_726_240_724_266,
            -0.001_064_573_790_210_338_9,
            -6.535_114_654_302_117e-5,
            1.905_239_925_323_288_6e-5,
            -1.341_008_659_710_808_8e-6,
            3.315_518_361_835_722e-8,
        ],
    );
    let root = w.max(c(7.0)).sqrt().interleaved();
    let tail = polynomial(
        L::quotient(one, root),
        [
            1.182_418_329_216_171_4,
            -0.228_760_861_835_545_21,
            1.138_139_258_225_113_7,
            -19.313_920_056_455_68,
            119.430_361_563_270_98,
            -374.060_854_597_092_5,
            599.169_404_834_124_2,
            -380.996_926_689_455_3,
        ],
    );
    ((one - (q + q)) * L::select(w.lt(c(7.0)), center, root * tail)).spread()
}
