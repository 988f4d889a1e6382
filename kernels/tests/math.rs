//! The elementary functions against double precision, over dense scans of their ranges.

/// The scalar result of a function of two numbers, after it was compared with eight lanes.
macro_rules! both {
    ($x:expr, $f:expr, $worst:expr) => {
        $crate::math::both($x, $f, $f, $worst)
    };
}

mod tails;

use crate::support::{Draws, narrow};
use crate::tolerance as bound;
use core::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, PI};
use hairis::model::math::{
    atan_eighth_turn, atan_unit, atan2_upper, gaussian, gaussian_and_complement, half_angle,
    half_atan2, half_atan2_parts, log2_near_one, log2_one_plus, sin_cos_absolute, sin_cos_twice,
    tan_half_turn,
};
use hairis::simd::{Lanes, Level, f32x8};
use hairis_conformance::comparison::LargestError;

const POINTS: u32 = 1 << 20;

/// Distance in units of the last place of `want` as a float, denormals counting as the smallest normal.
fn ulp(got: f32, want: f64) -> f64 {
    let exponent = want.abs().max(f64::from(f32::MIN_POSITIVE)).log2().floor();
    (f64::from(got) - want).abs() / (exponent - 23.0).exp2()
}

/// `POINTS` numbers from `lo` to `hi`, both included, and special ones in between.
fn scan(lo: f32, hi: f32) -> impl Iterator<Item = f32> {
    let (a, b) = (f64::from(lo), f64::from(hi));
    let even = (0..=POINTS)
        .map(move |i| narrow(a + (b - a) * f64::from(i) / f64::from(POINTS)).clamp(lo, hi));
    // Every magnitude down to the denormals, on both sides of 0.
    let small = (0..2048).flat_map(move |i| {
        let x = hi * narrow((-f64::from(i) / 13.0).exp2());
        [x, -x, 0.0, -0.0, f32::from_bits(i), f32::MIN_POSITIVE]
    });
    even.chain(small.filter(move |x| (lo..=hi).contains(x)))
}

/// Both lanes: the scalar result, after it was compared with that of every position of the eight.
fn both(
    x: [f32; 2],
    one: impl Fn([f32; 2]) -> f32,
    eight: impl Fn([f32x8; 2]) -> f32x8,
    worst: &mut LargestError,
) -> f32 {
    let scalar = one(x);
    let wide = eight(x.map(f32x8::splat));
    for lane in wide.to_array() {
        if Level::portable().fuses() {
            worst.see(ulp(lane, f64::from(scalar)), || format!("{x:?}"));
        } else {
            assert_eq!(
                lane.to_bits(),
                scalar.to_bits(),
                "eight lanes and one at {x:?}: {lane} {scalar}"
            );
        }
    }
    scalar
}

#[test]
fn gaussian_is_accurate_and_then_zero() {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    let zero = 2.0 * 115.0 * core::f32::consts::LN_2;
    for s in scan(0.0, 0.99 * zero).chain(scan(0.0, 2.0)) {
        let got = both!([s, 0.0], |[s, _]| gaussian(s), &mut lanes);
        // One lane does not fuse: the exponent is rounded, and the power is as far off as it is large.
        worst.see(
            ulp(got, (-f64::from(s) / 2.0).exp()) / (1.0 + f64::from(s) / 2.0),
            || format!("{s}"),
        );
    }
    worst.check("GAUSSIAN", bound::GAUSSIAN);
    lanes.check("GAUSSIAN_LANES", bound::GAUSSIAN_LANES);
    let mut last = 1.0;
    for s in scan(0.99 * zero, 1.2 * zero).filter(|s| *s >= 0.99 * zero) {
        let got = gaussian(s);
        assert!(
            got >= 0.0 && got <= (-113.0_f32).exp2(),
            "exp(-{s}/2) is {got}"
        );
        assert!(s < 1.01 * zero || got == 0.0, "exp(-{s}/2) is {got}, not 0");
        assert!(
            got == 0.0 || got >= 0.5e-35,
            "exp(-{s}/2) is {got}, almost a denormal"
        );
        last = got;
    }
    assert!(last == 0.0, "far out");
    for s in [200.0, 1e4, 8e6, 1e30, f32::MAX, f32::INFINITY, f32::NAN] {
        assert_eq!(gaussian(s), 0.0, "exp(-{s}/2)");
        assert_eq!(
            gaussian(f32x8::splat(s)),
            f32x8::ZERO,
            "exp(-{s}/2), eight lanes"
        );
    }
    assert_eq!(
        (gaussian(0.0_f32), gaussian(-0.0_f32)),
        (1.0, 1.0),
        "exp(0)"
    );
}

#[test]
fn atan_unit_is_accurate() {
    let (mut worst, mut absolute, mut lanes) = (
        LargestError::default(),
        LargestError::default(),
        LargestError::default(),
    );
    for x in scan(-1.0, 1.0) {
        let (got, want) = (
            both!([x, 0.0], |[x, _]| atan_unit(x), &mut lanes),
            f64::from(x).atan(),
        );
        worst.see(ulp(got, want), || format!("{x:e}"));
        absolute.see((f64::from(got) - want).abs(), || format!("{x:e}"));
    }
    worst.check("ATAN_UNIT", bound::ATAN_UNIT);
    absolute.check("ATAN_UNIT_RAD", bound::ATAN_UNIT_RAD);
    lanes.check("ATAN_UNIT_LANES", bound::MATH_LANES);
    assert!(atan_unit(f32::NAN).is_nan(), "NaN");
    assert_eq!(atan_unit(0.0_f32), 0.0, "0");
}

#[test]
fn atan2_upper_is_accurate_at_every_magnitude() {
    let (mut worst, mut absolute, mut lanes) = (
        LargestError::default(),
        LargestError::default(),
        LargestError::default(),
    );
    let mut draws = Draws(5);
    for i in 0..POINTS {
        let angle = match i % 4 {
            0 => draws.scale(1e-9, 1.0),
            1 => f64::from(PI) - draws.scale(1e-6, 1.0),
            2 => f64::from(FRAC_PI_2) + draws.sign() * draws.scale(1e-6, 1.0),
            _ => draws.between(0.0, f64::from(PI)),
        };
        let size = draws.scale(1e-15, 1e15);
        let (y, x) = (narrow(size * angle.sin()).abs(), narrow(size * angle.cos()));
        let (got, want) = (
            both!([y, x], |[y, x]| atan2_upper(y, x), &mut lanes),
            f64::from(y).atan2(f64::from(x)),
        );
        worst.see(ulp(got, want), || format!("y {y:e} x {x:e}"));
        absolute.see((f64::from(got) - want).abs(), || format!("y {y:e} x {x:e}"));
    }
    worst.check("ATAN2_UPPER", bound::ATAN2_UPPER);
    absolute.check("ATAN2_UPPER_RAD", bound::ATAN2_UPPER_RAD);
    lanes.check("ATAN2_UPPER_LANES", bound::MATH_LANES);
    let exact = [
        (0.0, 0.0, 0.0),
        (0.0, -0.0, 0.0),
        (0.0, 1.0, 0.0),
        (0.0, -1.0, PI),
        (1.0, 0.0, FRAC_PI_2),
        (1.0, -0.0, FRAC_PI_2),
        (f32::MAX, 1.0, FRAC_PI_2),
        (1.0, f32::MIN, PI),
    ];
    for (y, x, want) in exact {
        assert_eq!(atan2_upper(y, x), want, "atan2({y}, {x})");
    }
}

#[test]
fn half_atan2_is_accurate_at_both_ends() {
    let (mut worst, mut absolute, mut lanes) = (
        LargestError::default(),
        LargestError::default(),
        LargestError::default(),
    );
    let mut draws = Draws(6);
    for i in 0..POINTS {
        let angle = match i % 3 {
            0 => draws.scale(1e-9, 1.0),
            1 => f64::from(FRAC_PI_2) - draws.scale(1e-9, 1.0),
            _ => draws.between(0.0, f64::from(FRAC_PI_2)),
        };
        let size = draws.scale(0.25, 7.0);
        let (y, x) = (
            narrow(draws.sign() * size * angle.sin()),
            narrow(size * angle.cos()).abs(),
        );
        let (got, want) = (
            both!(
                [y, x],
                |[y, x]| half_atan2(y, x, Lanes::mul_add(x, x, y * y).sqrt()),
                &mut lanes
            ),
            0.5 * f64::from(y).atan2(f64::from(x)),
        );
        worst.see(ulp(got, want), || format!("y {y:e} x {x:e}"));
        absolute.see((f64::from(got) - want).abs(), || format!("y {y:e} x {x:e}"));
    }
    worst.check("HALF_ATAN2", bound::HALF_ATAN2);
    absolute.check("HALF_ATAN2_RAD", bound::HALF_ATAN2_RAD);
    lanes.check("HALF_ATAN2_LANES", bound::HALF_ATAN2_LANES);
    assert_eq!(
        [
            half_atan2(0.0_f32, 1.0, 1.0),
            half_atan2(-1.0_f32, 0.0, 1.0)
        ],
        [0.0, -FRAC_PI_4],
        "the ends"
    );
}

/// Next to a quarter turn the parts have the digits that their sum has lost.
#[test]
fn the_parts_of_half_atan2_are_accurate_next_to_a_quarter_turn() {
    let mut worst = LargestError::default();
    let mut draws = Draws(7);
    for _ in 0..POINTS {
        let (y, x) = (narrow(draws.sign()), narrow(draws.scale(1e-9, 0.02)));
        let [base, rest] = half_atan2_parts(y, x, (x * x + y * y).sqrt());
        assert_eq!(base, FRAC_PI_4 * y, "y {y} x {x:e}");
        let want = 0.5 * f64::from(y).atan2(f64::from(x));
        worst.see((f64::from(base) + f64::from(rest) - want).abs(), || {
            format!("y {y} x {x:e}")
        });
    }
    worst.check("HALF_ATAN2_PARTS_RAD", bound::HALF_ATAN2_PARTS_RAD);
}

#[test]
fn half_of_an_angle_from_its_sine_and_cosine_is_accurate() {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    let mut draws = Draws(8);
    for i in 0..POINTS {
        let angle = draws.sign()
            * match i % 3 {
                0 => draws.scale(1e-9, 1.0),
                1 => f64::from(FRAC_PI_2) - draws.scale(1e-9, 1.0),
                _ => draws.between(0.0, f64::from(FRAC_PI_2)),
            };
        let (sin, cos) = (narrow(angle.sin()), narrow(angle.cos()));
        let (got, want) = (
            both!([sin, cos], |[sin, cos]| half_angle(sin, cos), &mut lanes),
            0.5 * f64::from(sin).atan2(f64::from(cos)),
        );
        worst.see((f64::from(got) - want).abs(), || format!("{angle:e}"));
    }
    worst.check(
        "HALF_ANGLE_RAD, the rounding of sine and cosine included",
        bound::HALF_ANGLE_RAD,
    );
    lanes.check("HALF_ANGLE_LANES", bound::HALF_ANGLE_LANES);
    assert_eq!(half_angle(0.0_f32, 1.0), 0.0, "the middle");
    assert!(
        half_angle(f32::NAN, 0.0).is_nan() && half_angle(0.5, f32::NAN).is_nan(),
        "NaN"
    );
}

#[test]
fn numerator_and_denominator_of_a_tangent_are_accurate() {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    for x in scan(-FRAC_PI_2, FRAC_PI_2) {
        let n = both!([x, 0.0], |[x, _]| tan_half_turn(x).0, &mut lanes);
        let d = both!(
            [x, 0.0],
            |[x, _]| tan_half_turn(x).1,
            &mut LargestError::default()
        );
        worst.see(
            (f64::from(n).atan2(f64::from(d)) - f64::from(x)).abs(),
            || format!("{x:e}"),
        );
    }
    worst.check("TAN_HALF_TURN_RAD", bound::TAN_HALF_TURN_RAD);
    lanes.check("TAN_HALF_TURN_LANES", bound::MATH_LANES);
    assert_eq!(tan_half_turn(0.0_f32), (0.0, 1.0), "at 0");
    assert!(tan_half_turn(f32::NAN).0.is_nan(), "NaN");
}

#[test]
fn sine_and_cosine_are_accurate_where_they_vanish() {
    let (mut sine, mut cosine, mut absolute) = (
        LargestError::default(),
        LargestError::default(),
        LargestError::default(),
    );
    let (mut sine_lanes, mut cosine_lanes) = (LargestError::default(), LargestError::default());
    let near_the_pole = (0..=4096).map(|i| f32::from_bits(FRAC_PI_4.to_bits() - i));
    for x in scan(-FRAC_PI_4, FRAC_PI_4).chain(near_the_pole) {
        let (s, c) = (
            both!([x, 0.0], |[x, _]| sin_cos_twice(x).0, &mut sine_lanes),
            both!([x, 0.0], |[x, _]| sin_cos_twice(x).1, &mut cosine_lanes),
        );
        let (want_s, want_c) = (2.0 * f64::from(x)).sin_cos();
        sine.see(ulp(s, want_s), || format!("{x:e}"));
        cosine.see(ulp(c, want_c), || format!("{x:e}"));
        absolute.see(
            (f64::from(s) - want_s)
                .abs()
                .max((f64::from(c) - want_c).abs()),
            || format!("{x:e}"),
        );
    }
    sine.check("SIN_TWICE", bound::SIN_TWICE);
    cosine.check("COS_TWICE", bound::COS_TWICE);
    absolute.check("SIN_COS_TWICE_ABS", bound::SIN_COS_TWICE_ABS);
    sine_lanes.check("SIN_LANES", bound::MATH_LANES);
    cosine_lanes.check("COS_LANES", bound::MATH_LANES);
    assert_eq!(sin_cos_twice(0.0_f32), (0.0, 1.0), "at 0");
    assert!(sin_cos_twice(f32::NAN).0.is_nan(), "NaN");
}

#[test]
fn the_sine_and_cosine_of_inversion_are_accurate_absolutely() {
    let (mut worst, mut sine_lanes, mut cosine_lanes) = (
        LargestError::default(),
        LargestError::default(),
        LargestError::default(),
    );
    for x in scan(-FRAC_PI_2, FRAC_PI_2) {
        let s = both!([x, 0.0], |[x, _]| sin_cos_absolute(x).0, &mut sine_lanes);
        let c = both!(
            [x, 0.0],
            |[x, _]| sin_cos_absolute(x).1,
            &mut LargestError::default()
        );
        let c8 = sin_cos_absolute(f32x8::splat(x)).1.to_array()[3];
        cosine_lanes.see(f64::from(c - c8).abs(), || format!("{x:e}"));
        let (want_s, want_c) = f64::from(x).sin_cos();
        worst.see(
            (f64::from(s) - want_s)
                .abs()
                .max((f64::from(c) - want_c).abs()),
            || format!("{x:e}"),
        );
    }
    worst.check("SIN_COS_ABSOLUTE", bound::SIN_COS_ABSOLUTE);
    sine_lanes.check("SIN_ABSOLUTE_LANES", bound::MATH_LANES);
    cosine_lanes.check("COS_ABSOLUTE_LANES", bound::COS_ABSOLUTE_LANES);
}

#[test]
fn a_gaussian_s_complement_keeps_its_digits_where_it_is_small() {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    let mut beside = LargestError::default();
    for s in scan(0.0, 170.0)
        .chain(scan(0.0, 2.0))
        .chain(scan(0.0, 1e-6))
    {
        let got = both!([s, 0.0], |[s, _]| gaussian_and_complement(s).1, &mut lanes);
        worst.see(ulp(got, -(-f64::from(s) / 2.0).exp_m1()), || {
            format!("{s:e}")
        });
        let exp = if s < 157.0 {
            (-f64::from(s) / 2.0).exp()
        } else {
            continue;
        };
        beside.see(
            ulp(gaussian_and_complement(s).0, exp) / (1.0 + f64::from(s) / 2.0),
            || format!("{s:e}"),
        );
    }
    beside.check("GAUSSIAN", bound::GAUSSIAN);
    worst.check("COMPLEMENT", bound::COMPLEMENT);
    lanes.check("COMPLEMENT_LANES", bound::COMPLEMENT_LANES);
    for s in [200.0, 1e30, f32::MAX, f32::INFINITY, f32::NAN] {
        assert_eq!(gaussian_and_complement(s), (0.0, 1.0), "exp(-{s}/2)");
    }
    assert_eq!(gaussian_and_complement(0.0_f32), (1.0, 0.0), "exp(0)");
}

#[test]
fn a_logarithm_next_to_one_keeps_the_digits_of_the_difference() {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    let least = -1.0 + f32::EPSILON / 2.0;
    for f in scan(least, 0.0).chain(scan(-1e-6, 0.0)) {
        let got = both!([f, 0.0], |[f, _]| log2_one_plus(f), &mut lanes);
        worst.see(
            ulp(got, f64::from(f).ln_1p() / core::f64::consts::LN_2),
            || format!("{f:e}"),
        );
    }
    worst.check("LOG2_ONE_PLUS", bound::LOG2_ONE_PLUS);
    lanes.check("LOG2_ONE_PLUS_LANES", bound::LOG2_ONE_PLUS_LANES);
    assert!(
        !log2_one_plus(-1.0_f32).is_infinite(),
        "the end of the range"
    );
}

/// Moves either number to both sides of the seam at `sqrt(1/2)`.
#[test]
fn a_logarithm_is_that_of_either_number_at_the_seam() {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    for side in -40_i32..40 {
        for off in -8_i32..9 {
            let moved = |x: f32, by: i32| f32::from_bits(x.to_bits().wrapping_add_signed(by));
            let x = moved(FRAC_1_SQRT_2, side);
            // A place of the difference is half of one of `x`.
            let less_one = moved(x - 1.0, off);
            let got = both!(
                [x, less_one],
                |[x, less]| log2_near_one(x, less),
                &mut lanes
            );
            worst.see((f64::from(got) - f64::from(x).log2()).abs(), || {
                format!("{x:e}, {less_one:e}")
            });
        }
    }
    worst.check("LOG2_SEAM", bound::LOG2_SEAM);
    lanes.check("LOG2_ONE_PLUS_LANES", bound::LOG2_ONE_PLUS_LANES);
}

#[test]
fn the_arc_tangent_of_an_eighth_of_a_turn_is_accurate() {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    let most = core::f32::consts::FRAC_PI_8.tan();
    for x in scan(-most, most) {
        worst.see(
            ulp(
                both!([x, 0.0], |[x, _]| atan_eighth_turn(x), &mut lanes),
                f64::from(x).atan(),
            ),
            || format!("{x:e}"),
        );
    }
    worst.check("ATAN_EIGHTH", bound::ATAN_EIGHTH);
    lanes.check("ATAN_EIGHTH_LANES", bound::MATH_LANES);
}
