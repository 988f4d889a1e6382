//! The shape of the bells and the parameters of the model, in either precision.

use super::{HairReference, MatchedReference};
use crate::{Real, Reference};
use hairis::{HairParams, PerLobe};

/// The bell all the lobes of a model are made of; its peak is 1 (the paper's energies hold only so, ERRATA E4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// `exp(-x^2 / (2 width^2))`: the published model.
    Gaussian,
    /// `width^2 / (x^2 + width^2)`: the all-Cauchy variant of section 3.3.
    Cauchy,
}

impl Shape {
    /// The bell of width `width` at a distance `x` from its peak.
    ///
    /// - Source: Ou et al. 2012, sections 3.1 (g) and 3.3, both scaled to a peak of 1.
    /// - Units: rad; the result has none.
    /// - Accuracy: that of `libm`. Exponents are not clamped: far from the peak an `f32` Gaussian may be denormal.
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
    /// The bell.
    pub shape: Shape,
    /// Number of bands of the matched sampler, 5, 9 or 25; `None` for the published sampler.
    pub bands: Option<usize>,
    /// Whether the matched sampler chooses lobes by channel.
    pub by_channel: bool,
}

impl HairFormulas {
    /// Computes the constants of `parameters` and `wo`.
    ///
    /// # Panics
    ///
    /// If there is no matched sampler of so many bands.
    #[must_use]
    pub fn prepare<T: Real>(
        &self,
        parameters: &Parameters<T>,
        wo: [T; 3],
    ) -> Box<dyn Reference<T>> {
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

/// Parameters of [`HairReference::prepare`](super::HairReference::prepare): a [`HairDesc`](hairis::params::HairDesc) in either precision.
/// Arrays are R, TT, TRT, or linear RGB. Nothing is checked: make it from [`HairParams`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<T> {
    /// Longitudinal shifts of R, TT and TRT, rad.
    pub alpha: [T; 3],
    /// Longitudinal widths of R, TT and TRT in `theta_h`, rad.
    pub beta: [T; 3],
    /// Azimuthal width of TT, rad.
    pub gamma_tt: T,
    /// Azimuthal width of each glint, rad.
    pub gamma_g: T,
    /// Half angle between the glints, rad.
    pub phi_g: T,
    /// Intensity of R.
    pub intensity_r: [T; 3],
    /// Intensity of TT.
    pub intensity_tt: [T; 3],
    /// Intensity of TRT, which the glints share.
    pub intensity_trt: [T; 3],
    /// Strength of the glints, a factor on `intensity_trt`.
    pub intensity_g: T,
}

impl<T: Real> From<&HairParams> for Parameters<T> {
    #[inline]
    fn from(params: &HairParams) -> Self {
        let d = params.desc();
        Self {
            alpha: [d.alpha_r, d.alpha_tt, d.alpha_trt].map(T::from_f32),
            beta: [d.beta_r, d.beta_tt, d.beta_trt].map(T::from_f32),
            gamma_tt: T::from_f32(d.gamma_tt),
            gamma_g: T::from_f32(d.gamma_g),
            phi_g: T::from_f32(d.phi_g),
            intensity_r: d.intensity_r.map(T::from_f32),
            intensity_tt: d.intensity_tt.map(T::from_f32),
            intensity_trt: d.intensity_trt.map(T::from_f32),
            intensity_g: T::from_f32(d.intensity_g),
        }
    }
}

impl<T: Real> Parameters<T> {
    /// The colour of each lobe; the glint's has its strength in its value.
    pub(super) fn colours(&self) -> PerLobe<[T; 3]> {
        PerLobe([
            self.intensity_r,
            self.intensity_tt,
            self.intensity_trt,
            self.intensity_trt,
        ])
    }

    /// The same hair with all five widths multiplied by `factor`; the bells, the sampler and the energies follow.
    ///
    /// The Cauchy variant is published with the Gaussian widths unchanged (1). 1.177 matches the half width of the
    /// Gaussian, 0.798 its area.
    #[inline]
    #[must_use]
    pub fn with_width_factor(&self, factor: T) -> Self {
        Self {
            beta: self.beta.map(|beta| beta * factor),
            gamma_tt: self.gamma_tt * factor,
            gamma_g: self.gamma_g * factor,
            ..*self
        }
    }
}
