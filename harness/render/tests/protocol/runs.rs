//! Tests of `protocol::runs`.

use super::noisy;
use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::Estimate;
use hairis_render::film::Picture;
use hairis_render::protocol::{Measure, Reference, Runs};

#[test]
fn noise_and_bias_are_told_apart() {
    let mut xi = Independent::new(3, 0);
    let reference = Reference::new(&noisy(&mut xi, 0.0), &noisy(&mut xi, 0.0));
    let brighter = |mut picture: Picture| {
        picture
            .pixels
            .iter_mut()
            .flatten()
            .for_each(|channel| *channel += 0.3);
        picture
    };
    let pictures: Vec<Picture> = (0..8).map(|_| brighter(noisy(&mut xi, 0.1))).collect();
    let runs = Runs::of(&pictures, &reference, 16, 1.0);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    // The mean of eight has a deviation of 0.1 / sqrt(8 * 20,000) over all pixels.
    assert!(
        (mean(&runs.bias) - 0.3).abs() < 1e-3,
        "{}",
        mean(&runs.bias)
    );
    assert!(
        (mean(&runs.squares) - 0.1).abs() < 1e-3,
        "0.3^2 + 0.1^2: {}",
        mean(&runs.squares)
    );
    let square = runs.mean(Measure::Mse).value;
    assert!(
        (mean(&runs.squares) / square - 1.0).abs() < 1e-9,
        "the map's mean is the MSE: {square}"
    );
    let Estimate {
        value,
        standard_error,
    } = runs.variance;
    assert!(
        (value - 0.16).abs() < 4.0 * standard_error,
        "16 times 0.01: {:?}",
        runs.variance
    );
    assert!(standard_error < 0.003, "{:?}", runs.variance);
}
