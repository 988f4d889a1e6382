//! Pictures rendered with one sampler, and their errors.

use super::jackknife::{average, jackknife};
use super::{Errors, Measure, Reference};
use crate::film::{Film, Picture};
use crate::transport::Settings;
use hairis_instruments::stats::{Estimate, Moments};

/// Pictures rendered with one sampler at one count of samples, each with a seed of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Runs {
    /// Samples per pixel.
    pub samples: u32,
    /// Time of the fastest picture, in seconds of a thread.
    pub seconds: f64,
    /// Errors of each picture; empty for half of a reference.
    pub errors: Vec<Errors>,
    /// Variance of a pixel's luminance per sample, mean over the pixels: the variance between the pictures, times their samples.
    pub variance: Estimate,
    /// First of the pictures.
    pub picture: Picture,
    /// Error in luminance of the pictures' mean, one per pixel; empty for half of a reference.
    pub bias: Vec<f64>,
    /// Mean of the squared errors in luminance of the pictures, one per pixel; empty for half of a reference.
    pub squares: Vec<f64>,
}

impl Runs {
    /// Renders half of a reference, with number 0 or 1. `film` renders with the settings that it is given, and
    /// takes the number of the picture.
    ///
    /// # Errors
    ///
    /// Returns the error of `film`.
    pub fn half<E>(
        settings: &Settings,
        samples: u32,
        half: u64,
        film: impl FnOnce(&Settings, u64) -> Result<Film, E>,
    ) -> Result<Self, E> {
        let seed = (settings.seed ^ 0x7265_6665_7265_6e63).wrapping_add(half);
        let film = film(&Settings { seed, ..*settings }, half)?;
        Ok(Self {
            samples,
            seconds: film.seconds(),
            errors: Vec::new(),
            variance: Estimate::exact(0.0),
            picture: film.picture(),
            bias: Vec::new(),
            squares: Vec::new(),
        })
    }

    /// Renders `runs` pictures, by `film` as in [`half`](Self::half), and compares them with a
    /// reference.
    ///
    /// # Errors
    ///
    /// Returns the first error of `film`.
    pub fn render<E>(
        settings: &Settings,
        reference: &Reference,
        samples: u32,
        runs: u32,
        film: impl Fn(&Settings, u64) -> Result<Film, E>,
    ) -> Result<Self, E> {
        let (mut pictures, mut seconds) = (Vec::new(), f64::INFINITY);
        for run in 0..u64::from(runs.max(1)) {
            let seed = settings.seed.wrapping_mul(1000).wrapping_add(run);
            let film = film(&Settings { seed, ..*settings }, run)?;
            seconds = seconds.min(film.seconds());
            pictures.push(film.picture());
        }
        Ok(Self::of(&pictures, reference, samples, seconds))
    }

    /// Compares pictures with a reference.
    #[must_use]
    pub fn of(pictures: &[Picture], reference: &Reference, samples: u32, seconds: f64) -> Self {
        let errors: Vec<Vec<f64>> = pictures
            .iter()
            .map(|picture| reference.signed(picture))
            .collect();
        let pixels = 0..reference.picture.pixels.len();
        let mean = |of: fn(f64) -> f64| {
            let pixel = |k: usize| {
                errors.iter().map(|errors| of(errors[k])).sum::<f64>() / errors.len() as f64
            };
            pixels.clone().map(pixel).collect()
        };
        // The reference is one number per pixel, so that errors vary as luminances do.
        let variance = |kept: Option<usize>| {
            let errors = || {
                errors
                    .iter()
                    .enumerate()
                    .filter(|(run, _)| Some(*run) != kept)
            };
            let pixel = |k: usize| {
                errors()
                    .map(|(_, errors)| errors[k])
                    .collect::<Moments>()
                    .variance()
            };
            f64::from(samples) * pixels.clone().map(pixel).sum::<f64>() / pixels.len() as f64
        };
        Self {
            samples,
            seconds,
            errors: pictures
                .iter()
                .map(|picture| reference.errors(picture))
                .collect(),
            variance: jackknife(errors.len(), variance),
            picture: pictures[0].clone(),
            bias: mean(|error| error),
            squares: mean(|error| error * error),
        }
    }

    /// Returns the mean of an error over the pictures, except one.
    pub(super) fn mean_without(&self, measure: Measure, left_out: Option<usize>) -> f64 {
        average(
            self.errors
                .iter()
                .map(|errors| errors.value(measure))
                .enumerate(),
            left_out,
        )
    }

    /// Returns the mean of an error over the pictures, with its standard error.
    #[must_use]
    pub fn mean(&self, measure: Measure) -> Estimate {
        jackknife(self.errors.len(), |kept| self.mean_without(measure, kept))
    }

    /// Returns the ratio of this error to that of `other`, with its standard error. With `with_time`, both errors
    /// are first multiplied by their render times.
    #[must_use]
    pub fn ratio(&self, other: &Self, measure: Measure, with_time: bool) -> Estimate {
        let by = if with_time {
            self.seconds / other.seconds
        } else {
            1.0
        };
        let runs = self.errors.len().min(other.errors.len());
        jackknife(runs, |kept| {
            by * self.mean_without(measure, kept) / other.mean_without(measure, kept)
        })
    }

    /// Returns true if an error is below the reference: less than twice what noise of the reference adds to the error.
    #[must_use]
    pub fn is_below_reference(&self, measure: Measure) -> bool {
        let own = average(
            self.errors
                .iter()
                .map(|errors| errors.own(measure))
                .enumerate(),
            None,
        );
        self.mean(measure).value < 2.0 * own
    }

    /// Returns the count of samples that fits into a time, in seconds of a thread, but at least 1.
    #[must_use]
    pub fn samples_in(&self, seconds: f64) -> u32 {
        let samples = f64::from(self.samples) * seconds / self.seconds.max(1e-9);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped"
        )]
        let samples = samples.round().clamp(1.0, 1e6) as u32;
        samples
    }
}
