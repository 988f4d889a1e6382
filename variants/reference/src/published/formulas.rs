//! Shape of the bells, and the choice of a sampler at run time.

use super::{HairReference, MatchedReference};
use crate::interface::Reference;
use crate::real::Real;
use hairis::params::HairDesc;

/// Bell that all lobes of a model are made of; its peak is 1, because the paper's energies hold only for unit peaks (ERRATA E4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// `exp(-x^2 / (2 width^2))`, the Gaussian of the published model.
    Gaussian,
    /// `width^2 / (x^2 + width^2)`, the bell of the all-Cauchy variant of section 3.3.
    Cauchy,
}

impl Shape {
    /// Evaluates the bell of width `width` at a distance `x` from its peak.
    ///
    /// - Source: Ou et al. 2012, sections 3.1 (g) and 3.3, both scaled to a peak of 1.
    /// - Units: rad; the result has none.
    /// - Accuracy: that of `libm`. Exponents are not clamped, so that far from the peak an `f32` Gaussian may be denormal.
    ///
    /// ```
    /// use hairis_reference::Shape;
    /// assert_eq!(Shape::Cauchy.bell(0.2_f64, 0.2), 0.5);
    /// ```
    #[inline]
    #[must_use]
    pub fn bell<T: Real>(self, width: T, x: T) -> T {
        match self {
            Self::Gaussian => (-(x * x) / (T::from_f64(2.0) * width * width)).exp(),
            Self::Cauchy => width * width / (x * x + width * width),
        }
    }
}

/// The published model with a bell and a sampler chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HairFormulas {
    /// Bell of the lobes.
    pub shape: Shape,
    /// Number of bands of the matched sampler, 5, 9 or 25; `None` for the published sampler.
    pub bands: Option<usize>,
    /// True if the matched sampler chooses lobes by channel.
    pub by_channel: bool,
}

impl HairFormulas {
    /// Computes the constants of `parameters` and `wo` for the chosen bell and sampler.
    ///
    /// # Panics
    ///
    /// Panics if there is no matched sampler with this number of bands.
    #[must_use]
    pub fn prepare<T: Real>(&self, parameters: &HairDesc<T>, wo: [T; 3]) -> Box<dyn Reference<T>> {
        let Some(bands) = self.bands else {
            return Box::new(HairReference::prepare(parameters, self.shape, wo));
        };
        let matched = MatchedReference::prepare(parameters, self.shape, wo, bands);
        Box::new(if self.by_channel {
            matched.by_channel()
        } else {
            matched
        })
    }
}
