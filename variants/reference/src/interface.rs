//! Interface of the formulas of every model.

use crate::real::Real;
use core::fmt::Debug;
use hairis::{Lobe, LobeMask, PerLobe};

/// Value, colour and density of one lobe at one direction, in either precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LobeAt<T> {
    /// The lobe's part of S without its colour, per steradian.
    pub value: T,
    /// The lobe's colour, linear RGB: `value * color` summed over the lobes is S.
    pub color: [T; 3],
    /// Density of sampling the direction from this lobe alone, per steradian.
    pub pdf: T,
}

/// Direction that a [`Reference`] sampled, with its value, density and weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReferenceSample<T> {
    /// Sampled direction; the zero vector if the sample was discarded.
    pub wi: [T; 3],
    /// S at `wi`, without the cosine, linear RGB, per steradian.
    pub value: [T; 3],
    /// Density of the mixture, per steradian.
    pub pdf: T,
    /// Throughput weight `value cos_theta_i / pdf`.
    pub weight: [T; 3],
    /// Lobe that the direction was drawn from; `None` if the sample was discarded, in which case everything else is 0.
    pub lobe: Option<Lobe>,
}

/// Formulas of a model at one shading point, in either precision: the reference of tests and reports.
///
/// Every model and sampler of the workspace implements all methods that the model has. A reference of other origin needs only
/// [`eval_pdf`](Self::eval_pdf); [`lobes`](Self::lobes), [`sample`](Self::sample), [`probabilities`](Self::probabilities) and
/// [`albedo`](Self::albedo) panic unless they are implemented.
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
    /// Evaluates S, linear RGB, without the cosine, and the density of [`sample`](Self::sample) at `wi`, both per steradian.
    ///
    /// - Integral: that of the density is 1 over the sphere, less the caps of 1e-5 rad.
    /// - Domain: 0 within 1e-5 rad of the axis.
    #[must_use]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T);

    /// Evaluates S at `wi`, the value of [`eval_pdf`](Self::eval_pdf).
    #[inline]
    #[must_use]
    fn eval(&self, wi: [T; 3]) -> [T; 3] {
        self.eval_pdf(wi).0
    }

    /// Evaluates the density of sampling `wi`, that of [`eval_pdf`](Self::eval_pdf).
    #[inline]
    #[must_use]
    fn pdf(&self, wi: [T; 3]) -> T {
        self.eval_pdf(wi).1
    }

    /// Evaluates each lobe's value, colour and own density at `wi`, which are zeros in the slots that the model leaves empty.
    #[must_use]
    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        let _ = wi;
        unimplemented!("this reference has no lobes")
    }

    /// Evaluates the value of each lobe at `wi`, as [`lobes`](Self::lobes) returns it.
    #[inline]
    #[must_use]
    fn lobe_values(&self, wi: [T; 3]) -> PerLobe<T> {
        PerLobe(self.lobes(wi).0.map(|lobe| lobe.value))
    }

    /// Evaluates the density of each lobe at `wi`, as [`lobes`](Self::lobes) returns it.
    #[inline]
    #[must_use]
    fn lobe_pdfs(&self, wi: [T; 3]) -> PerLobe<T> {
        PerLobe(self.lobes(wi).0.map(|lobe| lobe.pdf))
    }

    /// Returns the probability of each lobe; all are 0 if nothing scatters.
    #[must_use]
    fn probabilities(&self) -> PerLobe<T> {
        unimplemented!("this reference has no lobes")
    }

    /// Draws a sample by three uniform numbers in `[0, 1)`, for the lobe, the inclination and the azimuth.
    ///
    /// A lobe without energy is never chosen. A sample within 1e-5 rad of the axis, or of zero density, is discarded.
    #[must_use]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let _ = xi;
        unimplemented!("this reference has no sampler")
    }

    /// Returns the directional albedo of each lobe, linear RGB: the integral of `S cos theta_i` over all `wi`.
    ///
    /// - Accuracy: 1e-6 relative in `f64`; limited by rounding in `f32`.
    #[must_use]
    fn albedo(&self) -> PerLobe<[T; 3]> {
        unimplemented!("this reference has no albedo")
    }

    /// Estimates the albedo of all lobes together, as the mean over the channels, as [`Model::energy`](hairis::model::Model::energy) does.
    ///
    /// Provided: the mean of [`albedo`](Self::albedo).
    #[must_use]
    fn energy(&self) -> T {
        let sum = |rgb: [T; 3]| rgb[0] + rgb[1] + rgb[2];
        let of_lobes = self.albedo().0.into_iter().map(sum);
        of_lobes.fold(T::default(), |sum, lobe| sum + lobe) / T::from_f64(3.0)
    }

    /// Returns the probabilities of a smaller inclination and of a smaller azimuth `phi_o - phi_i`, in rad, for a sample of `lobe`:
    /// the `xi[1]` and `xi[2]` of the sample. `None` unless the formulas have them.
    #[must_use]
    fn cdf(&self, lobe: Lobe, theta_i: T, phi: T) -> Option<[T; 2]> {
        let _ = (lobe, theta_i, phi);
        None
    }

    /// Returns a bound on the mean over the channels of every weight of the lobes in `mask`, if there is a bound in closed form.
    #[must_use]
    fn weight_bound(&self, mask: LobeMask) -> Option<T> {
        let _ = mask;
        None
    }

    /// Returns the relative errors that each lobe's value and density may have in the kernels, which compute in single precision. They
    /// follow from the rounding of angles and the steepness of the lobe at `wi`. `None` unless the formulas have them, next to the axis, and
    /// where rounding decides whether a lobe has the azimuth.
    #[must_use]
    fn lobe_errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        let _ = wi;
        None
    }

    /// Returns the relative error that a channel of a lobe's colour may have in the kernels, of a model that computes its colours.
    #[must_use]
    fn color_error(&self, lobe: Lobe, channel: usize) -> T {
        let _ = (lobe, channel);
        T::default()
    }

    /// Returns the absolute errors that S and the density may have in the kernels: those of the lobes and of their colours, weighed as the
    /// lobes are. A lobe's probability has the error of its colour.
    ///
    /// ```
    /// use hairis::HairParams;
    /// use hairis_reference::{HairReference, Reference, Shape};
    /// let brown = HairParams::brown().desc().map(f64::from);
    /// let hair = HairReference::prepare(&brown, Shape::Gaussian, [0.0, 1.0, 0.0]);
    /// let at = [0.0, 0.0, 1.0];
    /// let (value, pdf) = hair.error_bound(at).expect("off the axis");
    /// assert!(value[0] < 1e-5 * hair.eval(at)[0] && pdf < 1e-5 * hair.pdf(at));
    /// ```
    #[must_use]
    fn error_bound(&self, wi: [T; 3]) -> Option<([T; 3], T)> {
        let errors = self.lobe_errors(wi)?;
        let (lobes, shares) = (self.lobes(wi), self.probabilities());
        let (mut value, mut pdf) = ([T::default(); 3], T::default());
        for lobe in Lobe::ALL {
            let (at, [of_value, of_pdf]) = (&lobes[lobe], errors[lobe]);
            let (mut sum, mut wrong) = (T::default(), T::default());
            for (c, value) in value.iter_mut().enumerate() {
                let (color, error) = (at.color[c], self.color_error(lobe, c));
                *value = *value + at.value * color * (of_value + error);
                (sum, wrong) = (sum + color, wrong + color * error);
            }
            let of_share = if sum > T::default() { wrong / sum } else { sum };
            pdf = pdf + at.pdf * shares[lobe] * (of_pdf + of_share);
        }
        Some((value, pdf))
    }

    /// Returns the inclinations, in rad, at which the density jumps whatever the azimuth.
    #[must_use]
    fn jumps(&self) -> Vec<T> {
        Vec::new()
    }
}
