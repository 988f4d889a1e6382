//! Functions of several numbers, on sets that stand for all.
//!
//! - **Ratios.** Angles and quotients depend on the ratio of their numbers: both times a power of two give the same bits, unless a
//!   step leaves the normal numbers. The first number has every exponent from -26 to 26 relative to that of the second, either sign,
//!   and each of both mantissas lies once in each of 2^11 equal intervals, all pairs of intervals: beyond 2^26 the angle is the ratio, or
//!   a right angle, to the last bit.
//! - **Scales.** Every pair of exponents that the function admits, with 64 pairs of mantissas.
//! - **Sine and cosine.** Every exponent by 2^15 mantissas for either of them, either sign, and the other as a float up to two places
//!   from the one that is nearest.
//! - **Numbers near 1.** The same for a number and its difference from 1, and every difference next to `sqrt(1/2) - 1`, where the logarithm
//!   changes from the one to the other.
//! - **Cancellation.** Differences of two products that agree in none to all 24 of their first bits, with all signs, a million of each,
//!   and factors from 2^-31 to 2^31: halves of much smaller products are denormal.
//!
//! Low bits of mantissas follow from the number of the step. A climb from the worst thousand follows.

use crate::floats::{at_place, place};
use crate::functions::{Function, Unit, other_side};
use hairis::model::math;
use hairis::simd::{Lanes, Row};

/// Number of intervals of a mantissa, as a power of two, in pairs of mantissas.
const INTERVALS: u32 = 11;
/// Largest difference of exponents.
const APART: i32 = 26;
/// Number of differences of exponents.
const RATIOS: u64 = 2 * APART.unsigned_abs() as u64 + 1;
/// Number of pairs of mantissas with every pair of exponents.
const MANTISSAS: u64 = 64;

/// Mixes the bits of a number (splitmix64).
#[inline]
fn mixed(step: u64) -> u64 {
    let z = step.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Takes so many digits off a number that is read from its end.
#[inline]
const fn digit(rest: &mut u64, base: u64) -> u64 {
    let digit = *rest % base;
    *rest /= base;
    digit
}

/// Converts a digit, which is below 2^16.
#[inline]
fn small(digit: u64) -> i32 {
    i32::from(u16::try_from(digit).expect("a small digit"))
}

/// Returns the normal float of these bits of the fraction, exponent and sign.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "23 bits, and an exponent")]
fn float(fraction: u64, exponent: i32, negative: u64) -> f32 {
    let exponent = u32::try_from(exponent + 127).expect("the exponent of a normal number");
    f32::from_bits((fraction as u32 & 0x7f_ffff) | exponent << 23 | (negative as u32) << 31)
}

/// Steps of ratios.
const RATIO_STEPS: u64 = (2 * RATIOS) << (2 * INTERVALS);

/// Returns the count of steps of ratios and of scales, with exponents up to this one in magnitude.
const fn pair_steps(most: i32) -> u64 {
    let exponents = 2 * most.unsigned_abs() as u64 + 1;
    RATIO_STEPS + 2 * MANTISSAS * exponents * exponents
}

/// Returns two numbers by the number of their step, the second above 0.
#[inline]
fn pair(step: u64, most: i32) -> [f32; 2] {
    let (bits, mut rest) = (mixed(step), step);
    let negative = digit(&mut rest, 2);
    let fractions = [bits & 0x7f_ffff, bits >> 32 & 0x7f_ffff];
    if step >= RATIO_STEPS {
        rest -= RATIO_STEPS / 2;
        let exponents = 2 * u64::from(most.unsigned_abs()) + 1;
        let [e, f] = [(); 2].map(|()| small(digit(&mut rest, exponents)) - most);
        return [float(fractions[0], e, negative), float(fractions[1], f, 0)];
    }
    let low = 23 - INTERVALS;
    let [one, other] = fractions
        .map(|fraction| fraction & ((1 << low) - 1) | digit(&mut rest, 1 << INTERVALS) << low);
    [
        float(one, small(rest) - APART, negative),
        float(other, 0, 0),
    ]
}

/// Rounds to a float.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to a float is the purpose"
)]
#[inline]
const fn narrow(x: f64) -> f32 {
    x as f32
}

/// Length of `(x, y)`, as a float.
#[inline]
fn length(x: f32, y: f32) -> f32 {
    let [x, y] = [x, y].map(f64::from);
    narrow((x * x + y * y).sqrt())
}

/// Number of places by which the other of sine and cosine is off.
const OFF: u64 = 5;
/// Number of intervals of the mantissa of either of sine and cosine, as a power of two.
const SIDE_INTERVALS: u32 = 15;
/// Steps of either of sine and cosine: signs, exponents from -24 to -1, mantissas.
const SIDE_STEPS: u64 = (OFF * 2 * 24) << SIDE_INTERVALS;

/// Returns one of sine and cosine, and by how many places, from -2 to 2, the other is off.
#[inline]
fn side(step: u64) -> [f32; 2] {
    let mut rest = step;
    let off = digit(&mut rest, OFF) as f32 - 2.0;
    let negative = digit(&mut rest, 2);
    let fraction = digit(&mut rest, 1 << SIDE_INTERVALS) << (23 - SIDE_INTERVALS)
        | mixed(step) >> (64 - 23 + SIDE_INTERVALS);
    [float(fraction, -1 - small(rest), negative), off]
}

/// Number of floats around a seam, as a power of two.
const SEAM_PLACES: u32 = 15;
/// Steps of a difference from 1: those of sine and cosine, and those around the seam.
const NEAR_ONE_STEPS: u64 = SIDE_STEPS + (OFF << SEAM_PLACES);

/// Returns a difference from 1, and by how many places, from -2 to 2, its sum with 1 is off.
#[inline]
fn near_one(step: u64) -> [f32; 2] {
    let Some(mut rest) = step.checked_sub(SIDE_STEPS) else {
        let [x, off] = side(step);
        return [-x.abs(), off];
    };
    let off = digit(&mut rest, OFF) as f32 - 2.0;
    let near = place(core::f32::consts::FRAC_1_SQRT_2 - 1.0) - (1 << (SEAM_PLACES - 1));
    [at_place(near + rest as i64), off]
}

/// Moves a float by so many places, but not above 1 or to 0.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
fn moved(x: f32, off: f32) -> f32 {
    at_place((place(x) + off as i64).clamp(1, place(1.0)))
}

fn holds_side([x, off, ..]: [f32; 4]) -> bool {
    x.abs() < 1.0 && x != 0.0 && off.abs() <= 2.0 && off == off.trunc()
}

/// Number of steps with each count of common bits.
const DIFFERENCES: u64 = 1 << 20;

/// Returns four factors whose products agree in their first bits.
#[inline]
fn factors(step: u64) -> [f32; 4] {
    let mut rest = step;
    let signs = digit(&mut rest, 4);
    let agreeing = small(digit(&mut rest, 25));
    let (bits, more) = (mixed(2 * step), mixed(2 * step + 1));
    let exponent = |shift: u32| small(more >> shift & 0xffff) % 11 - 5;
    // Of each product one factor has any exponent of the range, so that scales do not matter either.
    let scale = small(more & 0xffff) % 51 - 25;
    let a = float(bits, scale + exponent(16), signs & 1);
    let b = float(bits >> 32, exponent(32), signs >> 1);
    let c = float(bits >> 20, scale.clamp(-20, 20) + exponent(48), 0);
    let off = 1.0 + f64::from(float(more >> 8, -agreeing, more >> 63));
    let d = narrow(f64::from(a) * f64::from(b) / f64::from(c) * off);
    [a, b, c, d]
}

fn holds_factors(factors: [f32; 4]) -> bool {
    factors
        .iter()
        .all(|x| (0.5f32.powi(31)..2f32.powi(31)).contains(&x.abs()))
}

macro_rules! pairs {
    ($($name:ident, $text:literal, $result:literal, $numbers:literal, $domain:expr;
        $steps:expr; |$step:ident| $at:expr; |$all:ident| $holds:expr;
        |[$x:ident, $y:ident, $z:ident, $w:ident]| $arguments:expr;
        |[$a:ident, $b:ident, $c:ident, $d:ident]| $lanes:expr;
        |[$p:ident, $q:ident, $r:ident, $s:ident]| $exact:expr;)*) => {
        $(
            #[derive(Clone, Copy, Debug, Default)]
            pub(crate) struct $name;

            impl Row<4, 2> for $name {
                #[inline(always)]
                #[allow(unused_variables, reason = "most read fewer arguments")]
                fn row<L: Lanes>(self, [$a, $b, $c, $d]: [L; 4]) -> [L; 2] {
                    [$lanes, $a]
                }
            }

            impl Function for $name {
                const NAME: &'static str = $text;
                const RESULTS: &'static [&'static str] = &[$result];
                const UNIT: Unit = Unit::Ulp;
                const DOMAIN: [f32; 2] = $domain;
                const NUMBERS: usize = $numbers;
                fn steps() -> u64 {
                    $steps
                }
                #[inline(always)]
                fn numbers($step: u64) -> [f32; 4] {
                    let mut numbers = [0.0; 4];
                    numbers[..$numbers].copy_from_slice(&$at);
                    numbers
                }
                fn holds($all: [f32; 4]) -> bool {
                    $holds
                }
                #[inline(always)]
                #[allow(unused_variables, reason = "most have fewer numbers")]
                fn arguments([$x, $y, $z, $w]: [f32; 4]) -> [f32; 4] {
                    $arguments
                }
                #[inline(always)]
                #[allow(unused_variables, reason = "most read fewer arguments")]
                fn exact([$p, $q, $r, $s]: [f64; 4]) -> [f64; 2] {
                    [$exact, $p]
                }
            }
        )*

        /// Calls `$visit` with every function of several numbers.
        macro_rules! each_pair {
            ($visit:ident) => { $($visit!(crate::pairs::$name);)* };
        }
        pub(crate) use each_pair;
    };
}

/// Largest magnitude of an exponent whose quotient is a normal number or 0.
const ANY: i32 = 126;
/// Largest magnitude of an exponent whose length is finite.
const LENGTH: i32 = 120;

fn within([y, x, ..]: [f32; 4], most: i32) -> bool {
    let exponent = |x: f32| (x.abs().to_bits() >> 23) as i32 - 127;
    x > 0.0 && y != 0.0 && exponent(x).abs() <= most && exponent(y).abs() <= most
}

pairs! {
    Quotient, "Lanes::quotient(y, x), y/x", "quotient", 2, [-2.6e36, 2.6e36];
    pair_steps(60); |step| pair(step, 60); |all| within(all, 60);
    |[y, x, z, w]| [y, x, 0.0, 0.0]; |[y, x, z, w]| L::quotient(y, x); |[y, x, z, w]| y / x;
    Atan2Upper, "atan2_upper(y, x), x/y", "angle", 2, [-f32::MAX, f32::MAX];
    // The sign is that of x.
    pair_steps(ANY); |step| { let [x, y] = pair(step, ANY); [y, x] }; |all| within([all[1], all[0], 0.0, 0.0], ANY);
    |[y, x, z, w]| [y, x, 0.0, 0.0]; |[y, x, z, w]| math::atan2_upper(y, x); |[y, x, z, w]| y.atan2(x);
    HalfAtan2, "half_atan2(y, x, length), y/x", "angle", 2, [-f32::MAX, f32::MAX];
    pair_steps(LENGTH); |step| pair(step, LENGTH); |all| within(all, LENGTH);
    |[y, x, z, w]| [y, x, length(x, y), 0.0]; |[y, x, z, w]| math::half_atan2(y, x, z); |[y, x, z, w]| 0.5 * y.atan2(x);
    HalfAngleSine, "half_angle(sine, cosine off by 2 places)", "angle", 2, [-1.0, 1.0];
    SIDE_STEPS; |step| side(step); |all| holds_side(all);
    |[x, off, z, w]| [x, moved(other_side(x), off), 0.0, 0.0]; |[y, x, z, w]| math::half_angle(y, x); |[y, x, z, w]| 0.5 * y.atan2(x);
    HalfAngleCosine, "half_angle(sine off by 2 places, cosine)", "angle", 2, [0.0, 1.0];
    SIDE_STEPS; |step| side(step); |all| holds_side(all);
    |[x, off, z, w]| [moved(other_side(x), off).copysign(x), x.abs(), 0.0, 0.0]; |[y, x, z, w]| math::half_angle(y, x); |[y, x, z, w]| 0.5 * y.atan2(x);
    Log2NearOne, "log2_near_one(1 + f off by 2 places, f)", "logarithm", 2, [-1.0, 0.0];
    NEAR_ONE_STEPS; |step| near_one(step); |all| holds_side(all) && all[0] < 0.0;
    |[f, off, z, w]| [moved(narrow(1.0 + f64::from(f)), off), f, 0.0, 0.0]; |[x, f, z, w]| math::log2_near_one(x, f);
    |[x, f, z, w]| if f > -0.292_893_2 { f.ln_1p() * core::f64::consts::LOG2_E } else { x.log2() };
    Difference, "Lanes::difference_of_products, factors", "difference", 4, [-2_147_483_648.0, 2_147_483_648.0];
    4 * 25 * DIFFERENCES; |step| factors(step); |all| holds_factors(all);
    |[a, b, c, d]| [a, b, c, d]; |[a, b, c, d]| L::difference_of_products(a, b, c, d); |[a, b, c, d]| a * b - c * d;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_intervals_is_there_once() {
        let per_exponent = 2_u64 << (2 * INTERVALS);
        let interval =
            |x: f32| usize::try_from((x.to_bits() & 0x7f_ffff) >> (23 - INTERVALS)).expect("few");
        let mut found = vec![false; 2 << (2 * INTERVALS)];
        for step in (RATIOS - 1) * per_exponent..RATIOS * per_exponent {
            let [y, x] = pair(step, ANY);
            let scale = at_place(i64::from(APART + 127) << 23);
            assert!((1.0..2.0).contains(&x), "{x}");
            assert!((1.0..2.0).contains(&(y.abs() / scale)), "{y}");
            let place = interval(y) << INTERVALS | interval(x);
            found[2 * place + usize::from(y < 0.0)] = true;
        }
        assert!(found.into_iter().all(|found| found), "one step for each");
    }

    #[test]
    fn every_pair_of_exponents_is_there() {
        let exponent = |x: f32| x.to_bits() >> 23 & 0xff;
        let steps = RATIO_STEPS..pair_steps(LENGTH);
        let mut found = vec![false; 1 << 16];
        for step in steps {
            let [e, f] = pair(step, LENGTH).map(exponent);
            found[(e << 8 | f) as usize] = true;
        }
        assert_eq!(found.into_iter().filter(|found| *found).count(), 241 * 241);
    }

    #[test]
    fn numbers_and_differences_are_on_different_sides_of_the_seam() {
        let half = core::f32::consts::FRAC_1_SQRT_2;
        let apart = (SIDE_STEPS..NEAR_ONE_STEPS)
            .map(near_one)
            .map(|[f, off]| [f < half - 1.0, moved(1.0 + f, off) < half]);
        let apart: Vec<bool> = apart.filter(|[f, x]| f != x).map(|[f, _]| f).collect();
        assert!(apart.contains(&true) && apart.contains(&false));
    }

    #[test]
    fn all_steps_are_in_the_domains() {
        for step in (0..pair_steps(LENGTH)).step_by(10_007) {
            let [y, x] = pair(step, LENGTH);
            assert!(within([y, x, 0.0, 0.0], LENGTH), "{y} {x}");
        }
        for step in (0..SIDE_STEPS).step_by(1009) {
            let [x, off] = side(step);
            assert!(holds_side([x, off, 0.0, 0.0]), "{x} {off}");
        }
        for step in (0..NEAR_ONE_STEPS).step_by(1009) {
            let [f, off] = near_one(step);
            assert!(holds_side([f, off, 0.0, 0.0]) && f < 0.0, "{f} {off}");
        }
    }
}
