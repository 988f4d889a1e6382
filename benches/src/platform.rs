//! Single precision with the platform's elementary functions, for a fair baseline.

use core::ops::{Add, Div, Mul, Neg, Sub};
use hairis_reference::Real;

/// Wrapper of `f32` whose elementary functions are those of std, that is of the C library: glibc's take two thirds of the time of those
/// of the libm crate. Functions that std lacks are taken from the libm crate.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Platform(pub f32);

/// Wraps the three numbers for formulas that use the platform's functions.
#[must_use]
pub fn platform(numbers: [f32; 3]) -> [Platform; 3] {
    numbers.map(Platform)
}

macro_rules! operators {
    ($($Op:ident $function:ident $operator:tt;)*) => { $(
        impl $Op for Platform {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(self.0 $operator other.0)
            }
        }
    )* };
}
operators! {
    Add add +;
    Sub sub -;
    Mul mul *;
    Div div /;
}

impl Neg for Platform {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// Implements functions of one number by the methods of std.
macro_rules! functions {
    ($($function:ident $method:ident;)*) => { $(
        #[inline(always)]
        fn $function(self) -> Self {
            Self(self.0.$method())
        }
    )* };
}

impl Real for Platform {
    const PI: Self = Self(core::f32::consts::PI);
    const EPSILON: Self = Self(f32::EPSILON);

    functions! {
        sin sin;
        cos cos;
        tan tan;
        asin asin;
        atan atan;
        exp_m1 exp_m1;
        ln ln;
        ln_1p ln_1p;
        tanh tanh;
        round round;
        sqrt sqrt;
        abs abs;
    }

    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to f32 is the purpose"
    )]
    fn from_f64(value: f64) -> Self {
        Self(value as f32)
    }
    #[inline(always)]
    fn from_f32(value: f32) -> Self {
        Self(value)
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self.0)
    }
    #[inline(always)]
    fn erfc(self) -> Self {
        Self(libm::erfcf(self.0))
    }
    #[inline(always)]
    fn ln_gamma(self) -> Self {
        Self(libm::lgammaf(self.0))
    }
    // Flushes results that would be denormal to 0, because products with denormals are slow.
    #[inline(always)]
    fn exp(self) -> Self {
        Self(if self.0 < -87.3 { 0.0 } else { self.0.exp() })
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        Self(self.0.powf(exponent.0))
    }
    #[inline(always)]
    fn hypot(self, other: Self) -> Self {
        Self(self.0.hypot(other.0))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
}
