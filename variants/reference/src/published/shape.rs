//! Shape of the bells.

use crate::real::Real;

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
