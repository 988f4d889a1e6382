//! Comparison of samplers: references, errors, and errors of errors.

use crate::film::{Crop, Film, Picture};
use crate::scene::Scene;
use crate::transport::{Settings, film};
use hairis_harness::stats::Estimate;

/// Share of the pixels, those of the largest errors, that trimmed errors leave out.
pub const TRIMMED: f64 = 0.001;
/// Relative errors are relative to the luminance, but at least to this share of the mean: black pixels count little.
const FLOOR: f64 = 0.1;

/// A picture that others are compared with, and how noisy it is.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Mean of two pictures that share no numbers.
    pub picture: Picture,
    /// Luminances.
    luminances: Vec<f64>,
    /// Variance of each luminance, from how much the two pictures differ.
    variances: Vec<f64>,
    /// Mean luminance.
    mean: f64,
}

impl Reference {
    /// Of two pictures that share no numbers.
    #[must_use]
    pub fn new(a: &Picture, b: &Picture) -> Self {
        let mut picture = a.clone();
        for (pixel, other) in picture.pixels.iter_mut().zip(&b.pixels) {
            *pixel = core::array::from_fn(|c| 0.5 * (pixel[c] + other[c]));
        }
        let variances = a.luminances().iter().zip(b.luminances()).map(|(a, b)| 0.25 * (a - b) * (a - b)).collect();
        let luminances = picture.luminances();
        let mean = luminances.iter().sum::<f64>() / luminances.len().max(1) as f64;
        Self { picture, luminances, variances, mean }
    }

    /// Divisor that makes squared errors of a pixel relative.
    fn unit(&self, pixel: usize) -> f64 {
        self.luminances[pixel].powi(2) + (FLOOR * self.mean).powi(2)
    }

    /// Signed relative error of every pixel of a picture.
    #[must_use]
    pub fn signed(&self, picture: &Picture) -> Vec<f64> {
        let luminances = picture.luminances().into_iter().enumerate();
        luminances.map(|(k, l)| (l - self.luminances[k]) / self.unit(k).sqrt()).collect()
    }

    /// How another scene looks beside this one: the ratio of the mean luminances, and the root of the mean squared relative
    /// difference. The noise of both is subtracted.
    #[must_use]
    pub fn difference(&self, other: &Self) -> (f64, f64) {
        let square = |k: usize| {
            let (apart, noise) = (self.luminances[k] - other.luminances[k], self.variances[k] + other.variances[k]);
            (apart * apart - noise) / self.unit(k)
        };
        let count = self.luminances.len().max(1);
        let mean = (0..self.luminances.len()).map(square).sum::<f64>() / count as f64;
        (other.mean / self.mean, mean.max(0.0).sqrt())
    }

    /// Errors of a picture; what the reference's own noise adds is subtracted.
    #[must_use]
    pub fn errors(&self, picture: &Picture) -> Errors {
        let luminances = picture.luminances();
        let of = |unit: &dyn Fn(usize) -> f64| {
            let square = |k: usize| (luminances[k] - self.luminances[k]).powi(2) / unit(k);
            let mut squares: Vec<f64> = (0..luminances.len()).map(square).collect();
            squares.sort_by(f64::total_cmp);
            let own = (0..squares.len()).map(|k| self.variances[k] / unit(k)).sum::<f64>() / squares.len() as f64;
            let mean = |squares: &[f64]| squares.iter().sum::<f64>() / squares.len().max(1) as f64 - own;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a count")]
            let kept = squares.len() - (squares.len() as f64 * TRIMMED).ceil() as usize;
            (mean(&squares), mean(&squares[..kept]), own)
        };
        let (square, _, _) = of(&|_| 1.0);
        let (relative, trimmed, own) = of(&|k| self.unit(k));
        Errors { square, relative, trimmed, own }
    }
}

/// Mean errors of a picture's luminance, squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Mean square error.
    pub square: f64,
    /// Relative mean square error.
    pub relative: f64,
    /// The same without the pixels of the largest errors: see [`TRIMMED`].
    pub trimmed: f64,
    /// Relative error due to noise of the reference, which was subtracted.
    pub own: f64,
}

/// Renders with one sampler at one count of samples, each with a seed of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Runs {
    /// Samples of a pixel.
    pub samples: u32,
    /// Time of the fastest, in seconds of a thread.
    pub seconds: f64,
    /// Errors of each; none for half of a reference.
    pub errors: Vec<Errors>,
    /// The first picture.
    pub picture: Picture,
}

impl Runs {
    /// Renders half of a reference: 0 or 1.
    #[must_use]
    pub fn half(scene: &Scene, settings: &Settings, samples: u32, half: u64) -> Self {
        let seed = (settings.seed ^ 0x7265_6665_7265_6e63).wrapping_add(half);
        let film = film(scene, &Settings { seed, ..*settings }, Crop::whole(scene.camera.size()), samples);
        Self { samples, seconds: film.seconds(), errors: Vec::new(), picture: film.picture() }
    }

    /// Renders `runs` pictures and compares them with a reference.
    #[must_use]
    pub fn render(scene: &Scene, settings: &Settings, reference: &Reference, samples: u32, runs: u32) -> Self {
        let whole = Crop::whole(scene.camera.size());
        let one = |run: u32| -> Film {
            let seed = settings.seed.wrapping_mul(1000).wrapping_add(u64::from(run));
            film(scene, &Settings { seed, ..*settings }, whole, samples)
        };
        let films: Vec<Film> = (0..runs.max(1)).map(one).collect();
        let pictures: Vec<Picture> = films.iter().map(Film::picture).collect();
        Self {
            samples,
            seconds: films.iter().map(Film::seconds).fold(f64::INFINITY, f64::min),
            errors: pictures.iter().map(|picture| reference.errors(picture)).collect(),
            picture: pictures[0].clone(),
        }
    }

    /// Mean of an error over the pictures, with its standard error.
    #[must_use]
    pub fn mean(&self, error: impl Fn(&Errors) -> f64) -> Estimate {
        jackknife(self.errors.len(), |kept| average(self.errors.iter().map(&error).enumerate(), kept))
    }

    /// How many times as large an error times time is here as in `other`, with its standard error.
    #[must_use]
    pub fn ratio(&self, other: &Self, error: impl Fn(&Errors) -> f64, with_time: bool) -> Estimate {
        let by = if with_time { self.seconds / other.seconds } else { 1.0 };
        let runs = self.errors.len().min(other.errors.len());
        jackknife(runs, |kept| {
            let mean = |runs: &Self| average(runs.errors.iter().map(&error).enumerate(), kept);
            by * mean(self) / mean(other)
        })
    }

    /// Whether the error is too small for the noise of the reference.
    #[must_use]
    pub fn is_below_reference(&self) -> bool {
        self.mean(|errors| errors.relative).value < 2.0 * self.errors[0].own
    }

    /// Samples that fit into a time, in seconds of a thread: at least 1.
    #[must_use]
    pub fn samples_in(&self, seconds: f64) -> u32 {
        let samples = f64::from(self.samples) * seconds / self.seconds.max(1e-9);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let samples = samples.round().clamp(1.0, 1e6) as u32;
        samples
    }
}

/// Mean of values but for that of one place.
fn average(values: impl Iterator<Item = (usize, f64)>, left_out: Option<usize>) -> f64 {
    let (sum, count) = values
        .filter(|(place, _)| Some(*place) != left_out)
        .fold((0.0, 0.0), |(sum, count), (_, value)| (sum + value, count + 1.0));
    sum / count
}

/// A statistic of `count` runs with its standard error, from the statistic without each of them.
///
/// The error of a mean is the usual one; that of a ratio of means counts how they vary together.
#[must_use]
pub fn jackknife(count: usize, statistic: impl Fn(Option<usize>) -> f64) -> Estimate {
    let value = statistic(None);
    let without: Vec<f64> = (0..count).map(|run| statistic(Some(run))).collect();
    let n = count as f64;
    let mean = without.iter().sum::<f64>() / n;
    let squares: f64 = without.iter().map(|one| (one - mean).powi(2)).sum();
    let standard_error = if count < 2 { f64::NAN } else { ((n - 1.0) / n * squares).sqrt() };
    Estimate { value, standard_error }
}

/// Slope of `log y` against `log x`.
#[must_use]
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (xy, xx) = logs.iter().fold((0.0, 0.0), |(a, b), l| (a + (l.0 - x) * (l.1 - y), b + (l.0 - x).powi(2)));
    xy / xx
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_harness::sequence::Independent;

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
    fn noise_of_the_reference_is_subtracted() {
        // Pictures of deviation 0.1 about 1, compared with a reference of two pictures of deviation 0.2.
        let mut xi = Independent::new(1, 0);
        let mut noisy = |deviation: f64| {
            let mut picture = Picture::black([200, 100]);
            for pixel in &mut picture.pixels {
                // A sum of twelve numbers has variance 1.
                *pixel = [1.0 + deviation * ((0..12).map(|_| xi.next_f64()).sum::<f64>() - 6.0); 3];
            }
            picture
        };
        let reference = Reference::new(&noisy(0.2), &noisy(0.2));
        let errors = reference.errors(&noisy(0.1));
        assert!((errors.square / 0.01 - 1.0).abs() < 0.15, "{errors:?}");
        assert!((errors.own / 0.02 - 1.0).abs() < 0.1, "{errors:?}");
        assert!(errors.trimmed < errors.relative);
        let exact = Reference::new(&noisy(0.0), &noisy(0.0));
        let brighter = Picture { size: [200, 100], pixels: vec![[1.1; 3]; 20_000] };
        assert!(exact.signed(&brighter).iter().all(|error| (error - 0.1 / 1.01_f64.sqrt()).abs() < 1e-9));
    }
}
