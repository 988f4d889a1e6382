//! Tests of `stats::moments`.

use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::{Estimate, Moments};

fn exponential(xi: &mut Independent) -> f64 {
    -(1.0 - xi.next_f64()).ln()
}

#[test]
fn known_small_set() {
    let m: Moments = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]
        .into_iter()
        .collect();
    assert_eq!(m.count(), 8);
    assert!((m.mean() - 5.0).abs() < 1e-15);
    assert!((m.variance() - 32.0 / 7.0).abs() < 1e-14);
    let [m3, m4] = m.higher_moments();
    // Sums of cubes and fourth powers of (-3,-1,-1,-1,0,0,2,4): 42 and 356.
    assert!((m3 - 42.0 / 8.0).abs() < 1e-13, "third {m3}");
    assert!((m4 - 356.0 / 8.0).abs() < 1e-13, "fourth {m4}");
}

#[test]
fn a_large_offset_does_not_eat_the_variance() {
    let mut xi = Independent::new(3, 1);
    let moments: Moments = (0..5_000).map(|_| 1e6 + exponential(&mut xi)).collect();
    assert!(
        (moments.variance() - 1.0).abs() < 0.15,
        "{}",
        moments.variance()
    );
}

#[test]
fn relative_variance_error_covers_as_a_standard_error_should() {
    // 2000 runs of 1000 samples. The mean of z and its variance have standard errors of 0.022 and about 0.035; the bounds leave room
    // for the order 1/sqrt(n) bias of the delta method (-0.14 and 1.16 measured for the exponential, -0.005 and 0.996 for the uniform).
    type Draw = fn(&mut Independent) -> f64;
    let uniform: Draw = |xi| xi.next_f64();
    let cases: [(Draw, f64, f64, &str); 2] = [
        (exponential, 1.0, 4.0, "exponential"),
        (uniform, 1.0 / 3.0, 0.237_037_037, "uniform"),
    ];
    for (draw, v, n_var, name) in cases {
        let mut z = Moments::new();
        let mut se = Moments::new();
        for run in 0..2_000 {
            let mut xi = Independent::new(11, run);
            let m: Moments = (0..1_000).map(|_| draw(&mut xi)).collect();
            let e = m.relative_variance();
            z.push(e.z_score(v));
            se.push(e.standard_error);
        }

        assert!(z.mean().abs() < 0.2, "{name}: mean z {}", z.mean());
        assert!(
            (z.variance() - 1.0).abs() < 0.25,
            "{name}: variance of z {}",
            z.variance()
        );
        let want = (n_var / 1_000.0_f64).sqrt();
        assert!(
            (se.mean() / want - 1.0).abs() < 0.05,
            "{name}: mean error {} want {want}",
            se.mean()
        );
    }
}

#[test]
fn degenerate_inputs() {
    assert!(Moments::new().variance().is_nan());
    assert!(Moments::new().relative_variance().value.is_nan());
    let one: Moments = [2.0].into_iter().collect();
    assert!(one.variance().is_nan() && one.mean() == 2.0);
    let zero: Moments = [0.0, 0.0].into_iter().collect();
    assert!(zero.relative_variance().value.is_nan());
    let constant: Moments = [3.0; 10].into_iter().collect();
    assert_eq!(
        constant.relative_variance(),
        Estimate {
            value: 0.0,
            standard_error: 0.0
        }
    );
    let tiny: Moments = [1e-70, 3e-70].into_iter().collect();
    assert!((tiny.relative_variance().value - 0.5).abs() < 1e-12);
    assert!(
        [1.0, f64::NAN]
            .into_iter()
            .collect::<Moments>()
            .mean()
            .is_nan()
    );
}

#[test]
fn estimates_combine() {
    let a = Estimate {
        value: 6.0,
        standard_error: 0.3,
    };
    let b = Estimate {
        value: 2.0,
        standard_error: 0.1,
    };
    let r = a.ratio(&b);
    assert!(
        (r.value - 3.0).abs() < 1e-15
            && (r.standard_error - 3.0 * 0.05 * 2.0_f64.sqrt()).abs() < 1e-15
    );
    let p = a.times(&b);
    assert!(
        (p.value - 12.0).abs() < 1e-15
            && (p.standard_error - 12.0 * 0.05 * 2.0_f64.sqrt()).abs() < 1e-15
    );
    let mean = Estimate::geometric_mean(&[a, b]);
    assert!((mean.value * mean.value - 12.0).abs() < 1e-14, "{mean:?}");
    assert!(
        (2.0 * mean.standard_error / mean.value - 0.05 * 2.0_f64.sqrt()).abs() < 1e-15,
        "{mean:?}"
    );
    assert!(Estimate::geometric_mean(&[]).value.is_nan());
    let effective = Estimate {
        value: 3.0,
        standard_error: 0.4,
    }
    .effective_per_1000();
    assert_eq!((effective.value, effective.standard_error), (250.0, 25.0));
    assert_eq!(
        a.scale(-2.0),
        Estimate {
            value: -12.0,
            standard_error: 0.6
        }
    );
    assert_eq!(
        Estimate {
            value: 1.0,
            standard_error: 0.0
        }
        .z_score(1.0),
        0.0
    );
    assert_eq!(a.z_score(5.4), (6.0 - 5.4) / 0.3);
}
