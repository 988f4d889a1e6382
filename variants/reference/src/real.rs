//! Number types that the formulas are written for.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Real number with elementary functions: `f32` or `f64` with those of `libm`, or a type of the caller's with others.
///
/// ```
/// use hairis_reference::Real;
/// fn full_turn<T: Real>() -> T {
///     T::from_f64(2.0) * T::PI
/// }
/// assert!(full_turn::<f64>().to_f64().cos() == 1.0);
/// ```
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number pi.
    const PI: Self;
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;
    /// Converts `value`, rounded for `f32`.
    #[must_use]
    fn from_f64(value: f64) -> Self;
    /// Converts `value` exactly.
    #[must_use]
    fn from_f32(value: f32) -> Self;
    /// Returns the value as an `f64`, exactly.
    #[must_use]
    fn to_f64(self) -> f64;
    /// Computes the complementary error function.
    #[must_use]
    fn erfc(self) -> Self;
    /// Computes the sine.
    #[must_use]
    fn sin(self) -> Self;
    /// Computes the cosine.
    #[must_use]
    fn cos(self) -> Self;
    /// Computes the tangent.
    #[must_use]
    fn tan(self) -> Self;
    /// Computes the arc sine.
    #[must_use]
    fn asin(self) -> Self;
    /// Computes the arc tangent.
    #[must_use]
    fn atan(self) -> Self;
    /// Computes the angle of the point (`x`, `self`).
    #[must_use]
    fn atan2(self, x: Self) -> Self;
    /// Computes the exponential, and returns 0 where the result would be denormal. `libm` spends five times the usual time there on
    /// raising a flag that is never read. A baseline in `f32` would then look slower than it is.
    #[must_use]
    fn exp(self) -> Self;
    /// Computes `exp(self) - 1`, without cancellation near 0.
    #[must_use]
    fn exp_m1(self) -> Self;
    /// Computes the natural logarithm.
    #[must_use]
    fn ln(self) -> Self;
    /// Computes `ln(1 + self)`, without cancellation near 0.
    #[must_use]
    fn ln_1p(self) -> Self;
    /// Computes the natural logarithm of the gamma function, for `self > 0`.
    #[must_use]
    fn ln_gamma(self) -> Self;
    /// Computes `self` to the power `exponent`.
    #[must_use]
    fn powf(self, exponent: Self) -> Self;
    /// Computes the hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;
    /// Rounds to the nearest whole number; halves round away from 0.
    #[must_use]
    fn round(self) -> Self;
    /// Computes the square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Computes `sqrt(self^2 + other^2)` without overflow.
    #[must_use]
    fn hypot(self, other: Self) -> Self;
    /// Returns the absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// Returns the smaller of two numbers; if one is NaN, the other.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// Returns the larger of two numbers; if one is NaN, the other.
    #[must_use]
    fn max(self, other: Self) -> Self;
}

macro_rules! real {
    ($t:ident, $erfc:ident, $sin:ident, $cos:ident, $tan:ident, $asin:ident, $atan:ident, $atan2:ident, $exp:ident, $sqrt:ident,
     $hypot:ident, $exp_m1:ident, $ln:ident, $ln_1p:ident, $ln_gamma:ident, $powf:ident, $round:ident, $tanh:ident, $least_exponent:literal) => {
        impl Real for $t {
            const PI: Self = core::$t::consts::PI;
            const EPSILON: Self = $t::EPSILON;
            #[inline]
            #[allow(
                clippy::cast_possible_truncation,
                trivial_numeric_casts,
                reason = "constants are meant to be rounded to f32; this function in f64 casts nothing"
            )]
            fn from_f64(value: f64) -> Self {
                value as $t
            }
            #[inline]
            fn from_f32(value: f32) -> Self {
                Self::from(value)
            }
            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline]
            fn sin(self) -> Self {
                libm::$sin(self)
            }
            #[inline]
            fn cos(self) -> Self {
                libm::$cos(self)
            }
            #[inline]
            fn erfc(self) -> Self {
                libm::$erfc(self)
            }
            #[inline]
            fn tan(self) -> Self {
                libm::$tan(self)
            }
            #[inline]
            fn asin(self) -> Self {
                libm::$asin(self)
            }
            #[inline]
            fn atan(self) -> Self {
                libm::$atan(self)
            }
            #[inline]
            fn atan2(self, x: Self) -> Self {
                libm::$atan2(self, x)
            }
            #[inline]
            fn exp(self) -> Self {
                if self < $least_exponent { 0.0 } else { libm::$exp(self) }
            }
            #[inline]
            fn exp_m1(self) -> Self {
                libm::$exp_m1(self)
            }
            #[inline]
            fn ln(self) -> Self {
                libm::$ln(self)
            }
            #[inline]
            fn ln_1p(self) -> Self {
                libm::$ln_1p(self)
            }
            #[inline]
            fn ln_gamma(self) -> Self {
                libm::$ln_gamma(self)
            }
            #[inline]
            fn tanh(self) -> Self {
                libm::$tanh(self)
            }
            #[inline]
            fn round(self) -> Self {
                libm::$round(self)
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                libm::$powf(self, exponent)
            }
            #[inline]
            fn sqrt(self) -> Self {
                libm::$sqrt(self)
            }
            #[inline]
            fn hypot(self, other: Self) -> Self {
                libm::$hypot(self, other)
            }
            #[inline]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline]
            fn min(self, other: Self) -> Self {
                <$t>::min(self, other)
            }
            #[inline]
            fn max(self, other: Self) -> Self {
                <$t>::max(self, other)
            }
        }
    };
}

real!(
    f32, erfcf, sinf, cosf, tanf, asinf, atanf, atan2f, expf, sqrtf, hypotf, expm1f, logf, log1pf,
    lgammaf, powf, roundf, tanhf, -87.3
);
real!(
    f64, erfc, sin, cos, tan, asin, atan, atan2, exp, sqrt, hypot, expm1, log, log1p, lgamma, pow,
    round, tanh, -708.3
);
