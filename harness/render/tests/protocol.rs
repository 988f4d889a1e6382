//! Tests of `protocol`.

mod rate;
mod runs;

use hairis_instruments::sequence::Independent;
use hairis_render::film::Picture;
use hairis_render::protocol::{Measure, Reference};

/// Pictures about 1; a sum of twelve uniform numbers has variance 1.
pub(super) fn noisy(xi: &mut Independent, deviation: f64) -> Picture {
    let mut picture = Picture::black([200, 100]);
    for pixel in &mut picture.pixels {
        *pixel = [1.0 + deviation * ((0..12).map(|_| xi.next_f64()).sum::<f64>() - 6.0); 3];
    }
    picture
}

#[test]
fn noise_of_the_reference_is_subtracted() {
    // Pictures of deviation 0.1, compared with a reference of two pictures of deviation 0.2.
    let mut xi = Independent::new(1, 0);
    let reference = Reference::new(&noisy(&mut xi, 0.2), &noisy(&mut xi, 0.2));
    let errors = reference.errors(&noisy(&mut xi, 0.1));
    assert!(
        (errors.value(Measure::Mse) / 0.01 - 1.0).abs() < 0.15,
        "{errors:?}"
    );
    assert!(
        (errors.own(Measure::Mse) / 0.02 - 1.0).abs() < 0.1,
        "{errors:?}"
    );
    for [all, trimmed] in [
        [Measure::Mse, Measure::TrimmedMse],
        [Measure::RelMse, Measure::TrimmedRelMse],
    ] {
        assert!(errors.value(trimmed) < errors.value(all), "{errors:?}");
    }
    let exact = Reference::new(&noisy(&mut xi, 0.0), &noisy(&mut xi, 0.0));
    let brighter = Picture {
        size: [200, 100],
        pixels: vec![[1.1; 3]; 20_000],
    };
    let signed = exact.signed(&brighter);
    assert!(
        exact
            .relative(&signed)
            .iter()
            .all(|error| (error - 0.1 / 1.01_f64.sqrt()).abs() < 1e-9)
    );
    let squares: Vec<f64> = signed.iter().map(|error| error * error).collect();
    assert!(
        exact
            .relative_squares(&squares)
            .iter()
            .all(|square| (square - 0.01 / 1.01).abs() < 1e-9)
    );
}

#[test]
fn trimmed_errors_leave_the_worst_pixels_out() {
    let black = Picture {
        size: [200, 100],
        pixels: vec![[1.0; 3]; 20_000],
    };
    let mut picture = black.clone();
    picture
        .pixels
        .iter_mut()
        .for_each(|pixel| *pixel = [1.1; 3]);
    picture.pixels[..20]
        .iter_mut()
        .for_each(|pixel| *pixel = [101.0; 3]);
    let errors = Reference::new(&black, &black).errors(&picture);
    assert!(
        (errors.value(Measure::TrimmedMse) - 0.01).abs() < 1e-9,
        "{errors:?}"
    );
    assert!(
        (errors.value(Measure::Mse) - 10.01).abs() < 1e-3,
        "20 of 20,000 pixels with a square of 10,000: {errors:?}"
    );
}
