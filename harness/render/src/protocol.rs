//! Comparison of samplers: references, errors, and standard errors of errors.

mod jackknife;
mod rate;
mod runs;

pub use jackknife::{average, jackknife};
pub use rate::{Reach, crossing, reach, slope, slope_of};
pub use runs::Runs;

use crate::film::Picture;

/// Share of the pixels that trimmed errors leave out, which are the pixels of the largest errors.
pub const TRIMMED: f64 = 0.001;
/// Share of the mean luminance whose square is added to that of a pixel in relative errors, so that black pixels count little.
const FLOOR: f64 = 0.1;

/// Measure of the error of a picture: a mean over its pixels of the squared error in luminance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Mean square error.
    Mse,
    /// Mean square error without the pixels of the largest errors: see [`TRIMMED`].
    TrimmedMse,
    /// Relative mean square error.
    RelMse,
    /// Relative mean square error without the pixels of the largest errors.
    TrimmedRelMse,
}

impl Measure {
    /// All measures, in the order in which [`Errors`] holds them.
    pub const ALL: [Self; 4] = [
        Self::Mse,
        Self::TrimmedMse,
        Self::RelMse,
        Self::TrimmedRelMse,
    ];

    /// Returns the name of the measure as reports write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mse => "MSE",
            Self::TrimmedMse => "trimmed MSE",
            Self::RelMse => "relMSE",
            Self::TrimmedRelMse => "trimmed relMSE",
        }
    }
}

/// Errors of a picture, in the order of [`Measure::ALL`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Errors, from which the part that is due to noise of the reference is subtracted.
    pub values: [f64; 4],
    /// Parts of the errors that were due to noise of the reference, and were subtracted.
    pub own: [f64; 4],
}

impl Errors {
    /// Returns one of the errors, with noise of the reference subtracted.
    #[must_use]
    pub fn value(&self, measure: Measure) -> f64 {
        self.values[measure as usize]
    }

    /// Returns the part of an error that was due to noise of the reference.
    #[must_use]
    pub fn own(&self, measure: Measure) -> f64 {
        self.own[measure as usize]
    }
}

/// Picture with which others are compared, and an estimate of its noise.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Mean of two pictures that share no numbers.
    pub picture: Picture,
    /// Time of both pictures, in seconds of a thread, or 0 if the time is not known.
    pub seconds: f64,
    /// Luminance of each pixel.
    luminances: Vec<f64>,
    /// Variance of each luminance, from the difference of the two pictures.
    variances: Vec<f64>,
    /// Mean luminance of the picture.
    mean: f64,
}

impl Reference {
    /// Creates a reference from two pictures that share no numbers: their mean, and its noise from their difference.
    #[must_use]
    pub fn new(a: &Picture, b: &Picture) -> Self {
        let mut picture = a.clone();
        for (pixel, other) in picture.pixels.iter_mut().zip(&b.pixels) {
            *pixel = core::array::from_fn(|c| 0.5 * (pixel[c] + other[c]));
        }
        let variances = a
            .luminances()
            .iter()
            .zip(b.luminances())
            .map(|(a, b)| 0.25 * (a - b) * (a - b))
            .collect();
        let luminances = picture.luminances();
        let mean = luminances.iter().sum::<f64>() / luminances.len().max(1) as f64;
        Self {
            picture,
            seconds: 0.0,
            luminances,
            variances,
            mean,
        }
    }

    /// Sets the time that the picture took, in seconds of one thread.
    #[must_use]
    pub fn with_seconds(self, seconds: f64) -> Self {
        Self { seconds, ..self }
    }

    /// Returns the divisor that makes squared errors of a pixel relative.
    fn unit(&self, pixel: usize) -> f64 {
        self.luminances[pixel].powi(2) + (FLOOR * self.mean).powi(2)
    }

    /// Returns the signed error in luminance of every pixel of a picture.
    #[must_use]
    pub fn signed(&self, picture: &Picture) -> Vec<f64> {
        picture
            .luminances()
            .iter()
            .zip(&self.luminances)
            .map(|(a, b)| a - b)
            .collect()
    }

    /// Converts signed errors in luminance, one per pixel, to relative errors.
    #[must_use]
    pub fn relative(&self, errors: &[f64]) -> Vec<f64> {
        errors
            .iter()
            .enumerate()
            .map(|(k, error)| error / self.unit(k).sqrt())
            .collect()
    }

    /// Converts squared errors in luminance, one per pixel, to squared relative errors.
    #[must_use]
    pub fn relative_squares(&self, squares: &[f64]) -> Vec<f64> {
        squares
            .iter()
            .enumerate()
            .map(|(k, square)| square / self.unit(k))
            .collect()
    }

    /// Compares the look of another scene with this one: the ratio of the mean luminances, and the root of the mean squared
    /// relative difference, from which the noise of both is subtracted.
    #[must_use]
    pub fn difference(&self, other: &Self) -> (f64, f64) {
        let squares = self.relative_squares(&self.squares(other));
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        (other.mean / self.mean, mean.max(0.0).sqrt())
    }

    /// Returns the squared difference in luminance of every pixel of another scene, from which the noise of both is subtracted.
    #[must_use]
    pub fn squares(&self, other: &Self) -> Vec<f64> {
        let square = |k: usize| {
            let apart = self.luminances[k] - other.luminances[k];
            apart * apart - (self.variances[k] + other.variances[k])
        };
        (0..self.luminances.len()).map(square).collect()
    }

    /// Returns the standard error of the mean luminance of some of the pixels, over that mean.
    #[must_use]
    pub fn noise(&self, pixels: &[usize]) -> f64 {
        let sum = |of: &[f64]| pixels.iter().map(|k| of[*k]).sum::<f64>();
        sum(&self.variances).sqrt() / sum(&self.luminances)
    }

    /// Returns the errors of a picture, from which the part that is due to noise of the reference is subtracted.
    #[must_use]
    pub fn errors(&self, picture: &Picture) -> Errors {
        let signed = self.signed(picture);
        let mut errors = Errors::default();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of a count"
        )]
        let kept = signed.len() - (signed.len() as f64 * TRIMMED).ceil() as usize;
        for is_relative in [false, true] {
            let unit = |k: usize| if is_relative { self.unit(k) } else { 1.0 };
            let pixel =
                |(k, error): (usize, &f64)| [error * error / unit(k), self.variances[k] / unit(k)];
            let mut pixels: Vec<[f64; 2]> = signed.iter().enumerate().map(pixel).collect();
            pixels.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let measures = if is_relative {
                [Measure::RelMse, Measure::TrimmedRelMse]
            } else {
                [Measure::Mse, Measure::TrimmedMse]
            };
            for (measure, count) in measures.into_iter().zip([pixels.len(), kept]) {
                let mean = |part: usize| {
                    pixels[..count].iter().map(|pixel| pixel[part]).sum::<f64>() / count as f64
                };
                let own = mean(1);
                errors.values[measure as usize] = mean(0) - own;
                errors.own[measure as usize] = own;
            }
        }
        errors
    }
}
