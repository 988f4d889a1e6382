//! Tests of `protocol::rate`.

use hairis_instruments::stats::Estimate;
use hairis_render::film::Picture;
use hairis_render::protocol::{
    Errors, Measure, Reach, Runs, average, crossing, jackknife, reach, slope, slope_of,
};

#[test]
fn the_jackknife_of_a_mean_is_its_standard_error() {
    let values = [1.0, 2.0, 4.0, 7.0];
    let estimate = jackknife(4, |kept| average(values.into_iter().enumerate(), kept));
    assert_eq!(estimate.value, 3.5);
    let expected = (values.iter().map(|v| (v - 3.5_f64).powi(2)).sum::<f64>() / 3.0 / 4.0).sqrt();
    assert!((estimate.standard_error - expected).abs() < 1e-12);
    assert!((slope(&[(1.0, 8.0), (2.0, 2.0), (4.0, 0.5)]) + 2.0).abs() < 1e-12);
}

#[test]
fn crossings_are_interpolated_in_logarithms() {
    let points = [(4.0, 0.4), (16.0, 0.1), (64.0, 0.025)];
    for (level, expected) in [
        (0.4, 4.0),
        (0.2, 8.0),
        (0.1, 16.0),
        (0.05, 32.0),
        (0.025, 64.0),
    ] {
        let at = crossing(&points, level).expect("within");
        assert!((at / expected - 1.0).abs() < 1e-12, "{level}: {at}");
    }
    assert_eq!(
        [
            crossing(&points, 0.5),
            crossing(&points, 0.02),
            crossing(&[], 1.0)
        ],
        [None; 3]
    );
}

/// Pictures with errors of 1 / S, more or less, and two seconds per sample.
fn runs(samples: u32, own: f64) -> Runs {
    let error = |by: f64| Errors {
        values: [by / f64::from(samples); 4],
        own: [own; 4],
    };
    Runs {
        samples,
        seconds: 2.0 * f64::from(samples),
        errors: [0.9, 1.0, 1.1].map(error).to_vec(),
        variance: Estimate::exact(1.0),
        picture: Picture::black([1, 1]),
        bias: vec![0.0],
        squares: vec![0.0],
    }
}

#[test]
fn samples_and_time_to_an_error_have_their_own_error() {
    let all = [4, 16, 64].map(|samples| runs(samples, 1e-6));
    let Some(Reach::At([samples, seconds])) = reach(&all, Measure::RelMse, 1.0 / 32.0) else {
        panic!("within")
    };
    assert!(
        (samples.value - 32.0).abs() < 1e-9 && (seconds.value - 64.0).abs() < 1e-9,
        "{samples:?} {seconds:?}"
    );
    // The error of the mean is 0.1 / sqrt(3), and samples go with it.
    assert!(
        (samples.standard_error / 32.0 - 0.0577).abs() < 5e-3,
        "{samples:?}"
    );
    assert_eq!(reach(&all, Measure::RelMse, 1.0), Some(Reach::Below(4)));
    assert_eq!(reach(&all, Measure::RelMse, 1e-3), Some(Reach::Above(64)));
    let slope = slope_of(&all, Measure::Mse).expect("three counts");
    assert!(
        (slope.value + 1.0).abs() < 1e-12 && slope.standard_error < 1e-12,
        "{slope:?}"
    );
}

#[test]
fn errors_below_the_reference_do_not_count() {
    let all = [4, 16, 64].map(|samples| runs(samples, 0.02));
    assert!(all[2].is_below_reference(Measure::Mse) && !all[1].is_below_reference(Measure::Mse));
    assert_eq!(
        reach(&all, Measure::Mse, 1.0 / 32.0),
        Some(Reach::Above(16))
    );
    assert!(
        slope_of(&all[..1], Measure::Mse).is_none() && slope_of(&all[2..], Measure::Mse).is_none()
    );
}
