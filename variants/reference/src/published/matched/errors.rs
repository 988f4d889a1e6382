//! Bounds on the errors of the matched sampler's densities.

use super::{MatchedReference, intensities};
use crate::published::errors;
use crate::real::Real;
use hairis::{Lobe, PerLobe};

/// Energy up to which the kernels may not sample a lobe, to the scale of the brightest lobe and of the largest area: they do not below a tenth
/// of this.
const FAINT: f64 = 1e-35;
/// Intensity, in that of the brightest lobe, up to which the kernels may draw a lobe more often: they do below a tenth of this.
const DIM: f64 = 1e-14;

impl<T: Real> MatchedReference<T> {
    /// Returns the relative error of the constant for W in a band in the kernels: that of the angle between the inclinations.
    fn height_error(&self, band: usize) -> T {
        let (two, half) = (T::from_f64(2.0), T::from_f64(0.5));
        let middle = (half * (self.sines[band] + self.sines[band + 1])).asin();
        let steepness = (half * (self.book.theta_o - middle)).tan().abs();
        T::from_f64(errors::ROUNDINGS) + two * T::from_f64(errors::INCLINATION) * steepness
    }

    /// Returns the relative error of a lobe's integral in the kernels, by the rounding at the ends of bands and that of the constants.
    fn extent_error(&self, lobe: Lobe) -> T {
        let (zero, p, shape) = (T::default(), &self.book.parameters, self.book.shape);
        let (cut, areas) = (&self.longitudinal[lobe], &self.areas[lobe]);
        let off = T::from_f64(errors::INCLINATION) / p.beta[lobe.index().min(2)];
        if self.extents[lobe] <= zero {
            return zero;
        }
        let (mut moved, mut before) = (zero, zero);
        for (j, sine) in self.sines[..=self.bands].iter().enumerate() {
            let x = self.offset(lobe, sine.asin());
            let after = if j < self.bands {
                self.heights[j]
            } else {
                zero
            };
            moved = moved + (after - before).abs() * errors::integral(shape, cut, x, off);
            before = after;
        }
        for j in 0..self.bands {
            moved = moved + (areas[j + 1] - areas[j]) * self.height_error(j);
        }
        let azimuth = match lobe {
            Lobe::TT => errors::around(shape, &self.transmission, p.gamma_tt),
            Lobe::GLINT => errors::around(shape, &self.glint, p.gamma_g),
            _ => zero,
        };
        moved / areas[self.bands] + azimuth
    }

    /// Returns the errors of the published sampler for S, and those of the density: it is the value over the integrals of all lobes. All of it is
    /// wrong for a lobe with next to no energy, which the kernels do not sample.
    ///
    /// `None` also for lobes of next to no intensity, which the kernels draw more often, so that they are drawn when they are alone.
    pub(super) fn errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        let (zero, one) = (T::default(), T::from_f64(1.0));
        let intensity = intensities(&self.book.parameters);
        let (mut brightest, mut largest, mut total) = (zero, zero, zero);
        for lobe in Lobe::FOUR {
            brightest = brightest.max(intensity[lobe]);
            if self.energies[lobe] > zero {
                largest = largest.max(self.areas[lobe][self.bands]);
            }
            total = total + self.probabilities[lobe] * self.extent_error(lobe);
        }
        let dim = brightest * T::from_f64(DIM);
        if Lobe::FOUR
            .into_iter()
            .any(|lobe| intensity[lobe] > zero && intensity[lobe] < dim)
        {
            return None;
        }
        let lobes = errors::lobes(&self.book, &self.book.angles(wi)?);
        let others = total + self.height_error(self.band(wi[0]));
        let least = brightest * largest * T::from_f64(FAINT);
        let mut errors = PerLobe::default();
        for lobe in Lobe::FOUR {
            let [of_value, _] = lobes[lobe];
            let is_sampled = least < self.energies[lobe];
            errors[lobe] = [of_value, if is_sampled { of_value + others } else { one }];
        }
        Some(errors)
    }
}
