//! Tests of `numbers::even`.

use hairis_render::numbers::Even;

#[test]
fn steps_are_powers_of_the_golden_ratio() {
    for (steps, d) in [(&Even::<2>::STEPS[..], 2), (&Even::<3>::STEPS[..], 3)] {
        let g = (0..60).fold(2.0_f64, |g, _| (1.0 + g).powf(1.0 / f64::from(d + 1)));
        for (step, power) in steps.iter().zip(1..) {
            let expected = g.powi(-power) * 4_294_967_296.0;
            assert!(
                (f64::from(*step) - expected).abs() < 1.0,
                "{step} for {expected}"
            );
        }
    }
}

#[test]
fn rows_of_points_fill_the_square_evenly() {
    for first in [0, 1 << 14, 4_000_000_000] {
        let even = Even::square([123_456_789, 3_987_654_321]);
        let mut counts = [[0_u32; 4]; 4];
        for i in 0..64 {
            let [x, y] = even
                .at(first + i)
                .map(|x| (0..4).rev().find(|k| x * 4.0 >= *k as f32).unwrap_or(0));
            counts[x][y] += 1;
        }
        assert!(
            counts.iter().flatten().all(|count| (2..=6).contains(count)),
            "{counts:?}"
        );
    }
}

#[test]
fn eight_points_are_those_of_one_at_a_time() {
    let even = Even::cube([0.25, 1.0 - f32::EPSILON / 2.0, 0.0]);
    for first in [0, 7, 1_000_003] {
        let [x, y, z] = even.eight(first);
        for (lane, i) in (first..first + 8).enumerate() {
            let one = even.at(i);
            assert!(one.iter().all(|x| (0.0..1.0).contains(x)), "{one:?}");
            assert_eq!(one, [x[lane], y[lane], z[lane]]);
        }
    }
}
