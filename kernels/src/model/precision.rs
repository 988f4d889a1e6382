//! Arithmetic that the constants of a material are computed in: double precision on a host, and single precision in generated
//! source.

use crate::model::math::{gaussian_and_complement, horner, sin_cos_half_turn};
use crate::simd::{Broadcast, Lanes};
use core::f32::consts::{FRAC_1_PI, PI};
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Sub};

/// Numbers in which the constants of a material are computed. Where the target has them, they have more digits and range than the
/// constants. Sealed.
///
/// [`Model::material`](crate::model::Model::material) computes in `f64`. [`Single`] has no more digits than the constants, but its
/// functions are free of control flow, so that they run on lanes that record.
pub trait Precision:
    sealed::Sealed
    + Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// Type of the parameters, and of the constants of a material.
    type Lane: Lanes<Stored = Self::Lane> + Broadcast<Self::Lane>;
    /// True if the type has more range than the constants. Otherwise colours are scaled before they are multiplied, and integrals
    /// are closed forms instead of sums.
    const IS_DOUBLE: bool;
    /// Divisor in place of 0, below what sums and products of legal parameters may be.
    const LEAST: f64;

    /// Converts a constant of a formula.
    fn constant(x: f64) -> Self;
    /// Converts a parameter.
    fn of(x: Self::Lane) -> Self;
    /// Rounds the number to a constant of the material.
    fn rounded(self) -> Self::Lane;
    /// Returns the larger of two numbers, neither of which is NaN.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Returns true if `self < other`; false for NaN.
    fn lt(self, other: Self) -> <Self::Lane as Lanes>::Mask;
    /// Returns `yes` where the mask is set and `no` elsewhere.
    fn select(mask: <Self::Lane as Lanes>::Mask, yes: Self, no: Self) -> Self;
    /// Computes `x^n`, for `n` from 1 to 255.
    #[must_use]
    fn power(self, n: u8) -> Self;
    /// Computes the hyperbolic tangent of a number of at least 0.
    #[must_use]
    fn tanh(self) -> Self;
    /// Computes `1 - exp(-x)` of a number of at least 0.
    #[must_use]
    fn one_less_exp(self) -> Self;
    /// Computes sine and cosine of an angle within 12 rad.
    fn sin_cos(self) -> [Self; 2];
    /// Computes `gamma(x + 1/2) / gamma(x + 1)` of a number of at least 1/2.
    #[must_use]
    fn half_gamma_ratio(self) -> Self;
}

pub(crate) mod sealed {
    /// Supertrait that keeps implementations of [`Precision`](super::Precision) in this crate.
    pub trait Sealed {}
}

impl sealed::Sealed for f64 {}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to a float is the purpose"
)]
impl Precision for f64 {
    type Lane = f32;
    const IS_DOUBLE: bool = true;
    const LEAST: f64 = f64::MIN_POSITIVE;

    #[inline]
    fn constant(x: f64) -> Self {
        x
    }
    #[inline]
    fn of(x: f32) -> Self {
        Self::from(x)
    }
    #[inline]
    fn rounded(self) -> f32 {
        self as f32
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        Self::max(self, other)
    }
    #[inline]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline]
    fn power(self, n: u8) -> Self {
        libm::pow(self, Self::from(n))
    }
    #[inline]
    fn tanh(self) -> Self {
        libm::tanh(self)
    }
    #[inline]
    fn one_less_exp(self) -> Self {
        -libm::expm1(-self)
    }
    #[inline]
    fn sin_cos(self) -> [Self; 2] {
        [libm::sin(self), libm::cos(self)]
    }
    #[inline]
    fn half_gamma_ratio(self) -> Self {
        libm::exp(libm::lgamma(self + 0.5) - libm::lgamma(self + 1.0))
    }
}

/// Lanes as numbers of [`Precision`]: single precision, for generated source.
///
/// - Accuracy: constants are within a few units in the last place of those computed in double precision (test `single` of
///   `hairis-shaders`).
#[derive(Clone, Copy, Debug)]
pub struct Single<L>(pub L);

impl<L> sealed::Sealed for Single<L> {}

macro_rules! operators {
    ($($Op:ident $op:ident;)*) => { $(
        impl<L: Lanes> $Op for Single<L> {
            type Output = Self;
            #[inline]
            #[track_caller]
            fn $op(self, other: Self) -> Self {
                Self($Op::$op(self.0, other.0))
            }
        }
    )* };
}
operators! { Add add; Sub sub; Mul mul; }

impl<L: Lanes> Div for Single<L> {
    type Output = Self;
    #[inline]
    #[track_caller]
    fn div(self, other: Self) -> Self {
        Self(L::quotient(self.0, other.0))
    }
}

impl<L: Lanes<Stored = L> + Broadcast<L>> Precision for Single<L> {
    type Lane = L;
    const IS_DOUBLE: bool = false;
    const LEAST: f64 = f32::MIN_POSITIVE as f64;

    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to a float is the purpose"
    )]
    #[inline]
    fn constant(x: f64) -> Self {
        Self(L::splat(x as f32))
    }
    #[inline]
    fn of(x: L) -> Self {
        Self(x)
    }
    #[inline]
    fn rounded(self) -> L {
        self.0
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    #[inline]
    fn lt(self, other: Self) -> L::Mask {
        self.0.lt(other.0)
    }
    #[inline]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self(L::select(mask, yes.0, no.0))
    }
    #[inline]
    fn power(self, n: u8) -> Self {
        let mut square = self.0;
        let mut product = None;
        let mut rest = n;
        while rest > 0 {
            if rest & 1 == 1 {
                product = Some(product.map_or(square, |before: L| before * square));
            }
            rest >>= 1;
            if rest > 0 {
                square = square * square;
            }
        }
        Self(product.unwrap_or(L::splat(1.0)))
    }
    #[inline]
    fn tanh(self) -> Self {
        let (gaussian, complement) = gaussian_and_complement(self.0 * 4.0);
        Self(L::quotient(complement, gaussian + 1.0))
    }
    #[inline]
    fn one_less_exp(self) -> Self {
        Self(gaussian_and_complement(self.0 + self.0).1)
    }
    #[inline]
    fn sin_cos(self) -> [Self; 2] {
        // Half turns are counted by rounding a sum to an integer; the last bit of the count is the sign.
        let magic = L::splat(8_388_608.0 + 127.0);
        let turns = (self.0 * FRAC_1_PI + magic) - magic;
        let half = ((turns * 0.5 + magic) - magic) * 2.0;
        // pi in two parts: the first has few digits, so that its multiples are exact.
        let rest = (self.0 - turns * 3.140_625) - turns * (9.676_535_9e-4);
        let bound = L::splat(0.5 * PI);
        let (sin, cos) = sin_cos_half_turn(rest.min(bound).max(-bound));
        let odd = L::splat(0.5).lt((turns - half).abs());
        [Self(L::negate(odd, sin)), Self(L::negate(odd, cos))]
    }
    /// Computes Stirling's series of the ratio about `x + 1/4`, two steps further up.
    #[inline]
    fn half_gamma_ratio(self) -> Self {
        let (x, one) = (self.0, L::splat(1.0));
        let far = x + 2.25;
        let z = L::quotient(one, far * far);
        let series = horner(
            z,
            [
                1.0,
                -0.015_625,
                2.563_476_6e-3,
                -1.279_830_9e-3,
                1.343_511e-3,
            ],
        );
        let steps = L::quotient((x + 1.0) * (x + 2.0), (x + 0.5) * (x + 1.5));
        Self(L::quotient(series * steps, far.sqrt()))
    }
}
