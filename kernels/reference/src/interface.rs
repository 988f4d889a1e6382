//! The interface of the formulas of every model.

use crate::Real;
use core::fmt::Debug;
use hairis::{Lobe, LobeMask, PerLobe};

/// One lobe at one direction, in either precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LobeAt<T> {
    /// The lobe's part of S without its colour, per steradian.
    pub value: T,
    /// The lobe's colour, linear RGB: `value * color` summed over the lobes is S.
    pub color: [T; 3],
    /// Density of sampling the direction from this lobe alone, per steradian.
    pub pdf: T,
}

/// A sample of a [`Reference`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReferenceSample<T> {
    /// The direction; the zero vector if the sample was discarded.
    pub wi: [T; 3],
    /// S, without the cosine.
    pub value: [T; 3],
    /// Density of the mixture, per steradian.
    pub pdf: T,
    /// `value cos_theta_i / pdf`.
    pub weight: [T; 3],
    /// The lobe it was drawn from; `None` if it was discarded, in which case everything else is 0.
    pub lobe: Option<Lobe>,
}

/// A model's formulas at one shading point, in either precision: the reference of tests and reports.
///
/// Every model and sampler of the workspace implements all methods that the model has. A reference of other origin needs
/// [`eval_pdf`](Self::eval_pdf) alone: [`lobes`](Self::lobes), [`sample`](Self::sample), [`probabilities`](Self::probabilities)
/// and [`albedo`](Self::albedo) panic unless they are implemented.
///
/// ```
/// use hairis::HairParams;
/// use hairis_reference::{HairReference, Reference, Shape};
/// fn reflected(point: &dyn Reference<f64>) -> f64 {
///     point.albedo().0.iter().map(|lobe| lobe[0]).sum()
/// }
/// let brown = HairReference::prepare(&HairParams::brown().desc().map(f64::from), Shape::Gaussian, [0.0, 1.0, 0.0]);
/// assert!(reflected(&brown) < 1.0);
/// ```
pub trait Reference<T: Real>: Debug + Send + Sync {
    /// S, linear RGB, without the cosine, and the density of [`sample`](Self::sample) at `wi`, both per steradian.
    ///
    /// - Integral: the density's is 1 over the sphere, less the caps of 1e-5 rad.
    /// - Domain: 0 within 1e-5 rad of the axis.
    #[must_use]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T);

    /// The value of [`eval_pdf`](Self::eval_pdf).
    #[inline]
    #[must_use]
    fn eval(&self, wi: [T; 3]) -> [T; 3] {
        self.eval_pdf(wi).0
    }

    /// The density of [`eval_pdf`](Self::eval_pdf).
    #[inline]
    #[must_use]
    fn pdf(&self, wi: [T; 3]) -> T {
        self.eval_pdf(wi).1
    }

    /// Each lobe's value, colour and own density at `wi`; zeros in the slots the model leaves empty.
    #[must_use]
    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        let _ = wi;
        unimplemented!("this reference has no lobes")
    }

    /// The value of each of [`lobes`](Self::lobes).
    #[inline]
    #[must_use]
    fn lobe_values(&self, wi: [T; 3]) -> PerLobe<T> {
        PerLobe(self.lobes(wi).0.map(|lobe| lobe.value))
    }

    /// The density of each of [`lobes`](Self::lobes).
    #[inline]
    #[must_use]
    fn lobe_pdfs(&self, wi: [T; 3]) -> PerLobe<T> {
        PerLobe(self.lobes(wi).0.map(|lobe| lobe.pdf))
    }

    /// The probability of each lobe; all 0 if nothing scatters.
    #[must_use]
    fn probabilities(&self) -> PerLobe<T> {
        unimplemented!("this reference has no lobes")
    }

    /// The sample of three uniform numbers in `[0, 1)`: for the lobe, the inclination and the azimuth.
    ///
    /// A lobe without energy is never chosen. A sample within 1e-5 rad of the axis, or of zero density, is discarded.
    #[must_use]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let _ = xi;
        unimplemented!("this reference has no sampler")
    }

    /// Directional albedo of each lobe, linear RGB: the integral of `S cos theta_i` over all `wi`.
    ///
    /// - Accuracy: 1e-6 relative in `f64`; that of its rounding in `f32`.
    #[must_use]
    fn albedo(&self) -> PerLobe<[T; 3]> {
        unimplemented!("this reference has no albedo")
    }

    /// Probability of a smaller inclination, and of a smaller azimuth `phi_o - phi_i`, of a sample of `lobe`, rad: the `xi[1]`
    /// and `xi[2]` of the sample. `None` unless the formulas have them.
    #[must_use]
    fn cdf(&self, lobe: Lobe, theta_i: T, phi: T) -> Option<[T; 2]> {
        let _ = (lobe, theta_i, phi);
        None
    }

    /// Bound on the mean over the channels of every weight of the lobes in `mask`, if there is one in closed form.
    #[must_use]
    fn weight_bound(&self, mask: LobeMask) -> Option<T> {
        let _ = mask;
        None
    }

    /// The inclinations where the density jumps whatever the azimuth, rad.
    #[must_use]
    fn jumps(&self) -> Vec<T> {
        Vec::new()
    }
}
