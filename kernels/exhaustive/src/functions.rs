//! The functions of one number, with their domains, their values in double precision and the units of their errors. Those of several numbers are
//! in [`pairs`](crate::pairs).

use crate::floats::{at_place, place};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};
use hairis::model::math;
use hairis::simd::{Lanes, Row};

/// Function of up to four numbers with up to two results.
pub(crate) trait Function: Row<4, 2> + Default + Sync {
    /// Name in `hairis::model::math` or `hairis::simd::Lanes`, with the arguments where they are not the number itself.
    const NAME: &'static str;
    /// Names of the results.
    const RESULTS: &'static [&'static str];
    /// Unit of the errors.
    const UNIT: Unit;
    /// First and last number of the domain, or of what the name says.
    const DOMAIN: [f32; 2];
    /// Number of numbers that are chosen; the others follow from them or are not read.
    const NUMBERS: usize = 1;

    /// Count of steps: of one number, all floats of the domain.
    fn steps() -> u64 {
        let [first, last] = Self::DOMAIN.map(place);
        last.abs_diff(first) + 1
    }

    /// Numbers of a step.
    #[inline(always)]
    fn numbers(step: u64) -> [f32; 4] {
        let number = at_place(place(Self::DOMAIN[0]).wrapping_add_unsigned(step));
        [number, 0.0, 0.0, 0.0]
    }

    /// True if the numbers are in the domain.
    fn holds(_numbers: [f32; 4]) -> bool {
        true
    }

    /// Arguments of the function, which are the numbers and what follows from them.
    fn arguments(numbers: [f32; 4]) -> [f32; 4];

    /// Results in double precision for these arguments.
    fn exact(arguments: [f64; 4]) -> [f64; 2];

    /// Errors of the results, where they do not follow from [`exact`](Self::exact).
    fn errors(_arguments: [f64; 4], _got: [f32; 2]) -> Option<[f64; 2]> {
        None
    }
}

/// Unit of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unit {
    /// Unit in the last place of the result as a float; of denormal results that of the smallest normal number.
    Ulp,
    /// Unit in the last place times `1 + x/2`: the exponent of a Gaussian is rounded.
    UlpOfExponent,
    /// 1, or a radian.
    One,
}

impl Unit {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Ulp => "ulp",
            Self::UlpOfExponent => "ulp (1 + x/2)",
            Self::One => "1",
        }
    }

    /// Error of `got` in this unit.
    #[inline]
    pub(crate) fn error(self, x: f32, got: f32, want: f64) -> f64 {
        let error = (f64::from(got) - want).abs();
        match self {
            Self::Ulp => error * per_ulp(want),
            Self::UlpOfExponent => error * per_ulp(want) / (0.5f64).mul_add(f64::from(x), 1.0),
            Self::One => error,
        }
    }
}

/// Reciprocal of the unit in the last place of a number as a float.
#[inline]
fn per_ulp(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let exponent = x.abs().max(f64::from(f32::MIN_POSITIVE)).to_bits() & EXPONENT;
    // 2^(23 - e), with the bias of 1023 twice.
    f64::from_bits(((2046 + 23) << 52) - exponent)
}

macro_rules! functions {
    ($($name:ident, $text:literal, $results:expr, $unit:ident, $domain:expr;
        |$x:ident| $arguments:expr;
        |$a:ident, $b:ident, $c:ident| $lanes:expr;
        |$p:ident, $q:ident, $r:ident| $exact:expr;
        $(-> |$e:ident, $got:ident| $errors:expr;)?)*) => {
        $(
            #[derive(Clone, Copy, Debug, Default)]
            pub(crate) struct $name;

            impl Row<4, 2> for $name {
                #[inline(always)]
                fn row<L: Lanes>(self, [$a, $b, $c, _]: [L; 4]) -> [L; 2] {
                    $lanes
                }
            }

            impl Function for $name {
                const NAME: &'static str = $text;
                const RESULTS: &'static [&'static str] = &$results;
                const UNIT: Unit = Unit::$unit;
                const DOMAIN: [f32; 2] = $domain;
                #[inline(always)]
                fn arguments([$x, ..]: [f32; 4]) -> [f32; 4] {
                    let [a, b, c] = $arguments;
                    [a, b, c, 0.0]
                }
                #[inline(always)]
                fn exact([$p, $q, $r, _]: [f64; 4]) -> [f64; 2] {
                    $exact
                }
                $(
                    #[inline(always)]
                    fn errors([$e, ..]: [f64; 4], $got: [f32; 2]) -> Option<[f64; 2]> {
                        Some($errors)
                    }
                )?
            }
        )*

        /// Calls `$visit` with every function.
        macro_rules! each_function {
            ($visit:ident) => { $($visit!(crate::functions::$name);)* };
        }
        pub(crate) use each_function;
    };
}

/// Cosine of an angle whose sine is given, as a float.
pub(crate) fn other_side(x: f32) -> f32 {
    let x = f64::from(x);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to a float is the purpose"
    )]
    let y = ((1.0 - x) * (1.0 + x)).sqrt() as f32;
    y
}

/// Length of `(x, 1)`, as a float.
fn hypotenuse(x: f32) -> f32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to a float is the purpose"
    )]
    let length = f64::from(x).hypot(1.0) as f32;
    length
}

/// Density of a standard normal number.
fn normal(x: f64) -> f64 {
    0.398_942_280_401_432_7 * (-0.5 * x * x).exp()
}

/// Probability that a standard normal number is above `x`.
fn tail(x: f64) -> f64 {
    0.5 * libm::erfc(x * core::f64::consts::FRAC_1_SQRT_2)
}

functions! {
    Sqrt, "Lanes::sqrt", ["root"], Ulp, [0.0, f32::MAX];
    |x| [x, 0.0, 0.0]; |x, y, _z| [x.sqrt(), y]; |x, y, _z| [x.sqrt(), y];
    Reciprocal, "Lanes::quotient(1, x)", ["quotient"], Ulp, [f32::MIN_POSITIVE, 8.507_059e37];
    |x| [x, 0.0, 0.0]; |x, y, _z| [L::quotient(L::splat(1.0), x), y]; |x, y, _z| [1.0 / x, y];
    Gaussian, "gaussian", ["value"], UlpOfExponent, [0.0, 157.0];
    |s| [s, 0.0, 0.0]; |s, y, _z| [math::gaussian(s), y]; |s, y, _z| [(-0.5 * s).exp(), y];
    GaussianAndComplement, "gaussian_and_complement", ["value", "complement"], UlpOfExponent, [0.0, 157.0];
    |s| [s, 0.0, 0.0];
    |s, _y, _z| { let (value, complement) = math::gaussian_and_complement(s); [value, complement] };
    |s, _y, _z| [(-0.5 * s).exp(), -(-0.5 * s).exp_m1()];
    AtanUnit, "atan_unit", ["angle"], Ulp, [-1.0, 1.0];
    |t| [t, 0.0, 0.0]; |t, y, _z| [math::atan_unit(t), y]; |t, y, _z| [t.atan(), y];
    AtanEighthTurn, "atan_eighth_turn", ["angle"], Ulp, [-0.414_213_57, 0.414_213_57];
    |t| [t, 0.0, 0.0]; |t, y, _z| [math::atan_eighth_turn(t), y]; |t, y, _z| [t.atan(), y];
    HalfAngleOfSine, "half_angle(x, sqrt(1 - x^2))", ["angle"], Ulp, [-1.0, 1.0];
    |x| [x, other_side(x), 0.0]; |x, y, z| [math::half_angle(x, y), z]; |x, y, z| [0.5 * x.atan2(y), z];
    HalfAngleOfCosine, "half_angle(sqrt(1 - x^2), x)", ["angle"], Ulp, [0.0, 1.0];
    |x| [other_side(x), x, 0.0]; |x, y, z| [math::half_angle(x, y), z]; |x, y, z| [0.5 * x.atan2(y), z];
    HalfAtan2OfY, "half_atan2(x, 1, length)", ["angle"], Ulp, [-1e6, 1e6];
    |x| [x, hypotenuse(x), 0.0]; |x, y, z| [math::half_atan2(x, L::splat(1.0), y), z]; |x, _y, z| [0.5 * x.atan(), z];
    HalfAtan2OfX, "half_atan2(1, x, length)", ["angle"], Ulp, [0.0, 1e6];
    |x| [x, hypotenuse(x), 0.0]; |x, y, z| [math::half_atan2(L::splat(1.0), x, y), z]; |x, _y, z| [0.5 * 1f64.atan2(x), z];
    Atan2UpperOfY, "atan2_upper(x, 1)", ["angle"], Ulp, [0.0, 1e30];
    |x| [x, 0.0, 0.0]; |x, y, _z| [math::atan2_upper(x, L::splat(1.0)), y]; |x, y, _z| [x.atan(), y];
    Atan2UpperOfX, "atan2_upper(1, x)", ["angle"], Ulp, [-1e30, 1e30];
    |x| [x, 0.0, 0.0]; |x, y, _z| [math::atan2_upper(L::splat(1.0), x), y]; |x, y, _z| [1f64.atan2(x), y];
    SinHalfTurn, "sin_half_turn", ["sine"], Ulp, [-FRAC_PI_2, FRAC_PI_2];
    |x| [x, 0.0, 0.0]; |x, y, _z| [math::sin_half_turn(x), y]; |x, y, _z| [x.sin(), y];
    SinCosHalfTurn, "sin_cos_half_turn", ["sine", "cosine"], Ulp, [-FRAC_PI_2, FRAC_PI_2];
    |x| [x, 0.0, 0.0]; |x, _y, _z| { let (sin, cos) = math::sin_cos_half_turn(x); [sin, cos] };
    |x, _y, _z| x.sin_cos().into();
    SinCosTwice, "sin_cos_twice", ["sine", "cosine"], Ulp, [-FRAC_PI_4, FRAC_PI_4];
    |x| [x, 0.0, 0.0]; |x, _y, _z| { let (sin, cos) = math::sin_cos_twice(x); [sin, cos] };
    |x, _y, _z| (2.0 * x).sin_cos().into();
    SinCosAbsolute, "sin_cos_absolute", ["sine", "cosine"], One, [-FRAC_PI_2, FRAC_PI_2];
    |x| [x, 0.0, 0.0]; |x, _y, _z| { let (sin, cos) = math::sin_cos_absolute(x); [sin, cos] };
    |x, _y, _z| x.sin_cos().into();
    // An error of the quotient is an error of the angle, times cos^2.
    TanHalfTurn, "tan_half_turn", ["angle"], One, [-FRAC_PI_2, FRAC_PI_2];
    |x| [x, 0.0, 0.0]; |x, _y, _z| { let (above, below) = math::tan_half_turn(x); [above, below] };
    |x, y, _z| [x, y];
    -> |x, got| [(f64::from(got[0]).atan2(f64::from(got[1])) - x).abs(), 0.0];
    Log2, "log2", ["logarithm"], Ulp, [f32::MIN_POSITIVE, f32::MAX];
    |x| [x, 0.0, 0.0]; |x, y, _z| [math::log2(x), y]; |x, y, _z| [x.log2(), y];
    Log2OnePlus, "log2_one_plus", ["logarithm"], Ulp, [-0.999_999_94, 0.0];
    |x| [x, 0.0, 0.0]; |x, y, _z| [math::log2_one_plus(x), y];
    |x, y, _z| [x.ln_1p() * core::f64::consts::LOG2_E, y];
    NormalTail, "normal_tail", ["probability"], UlpOfExponent, [0.0, 12.5];
    |x| [x, 0.0, 0.0]; |x, y, _z| [math::normal_tail(x), y]; |x, y, _z| [tail(x), y];
    NormalTailRatio, "normal_tail_ratio", ["ratio"], Ulp, [0.0, 12.7];
    |x| [x, 0.0, 0.0]; |x, y, _z| [math::normal_tail_ratio(x), y]; |x, y, _z| [tail(x) * (0.5 * x * x).exp(), y];
    // The error of the number, by one step of Newton's method in double precision.
    NormalTailInverse, "normal_tail_inverse", ["number"], One, [1e-36, 0.5];
    |q| [q, 0.0, 0.0]; |q, y, _z| [math::normal_tail_inverse(q), y]; |q, y, _z| [q, y];
    -> |q, got| [((tail(f64::from(got[0])) - q) / normal(f64::from(got[0]))).abs(), 0.0];
}
