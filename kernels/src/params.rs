//! Hair parameters: validated widths, shifts and intensities, presets, and an artist's controls.

use core::f32::consts::PI;

mod artist;
mod error;
mod pigment;
mod presets;
mod space;

pub use artist::{ArtistControls, Glints, Highlight, Transmission};
pub use error::{ParamError, Rule};
pub use pigment::{Pigments, melanin_absorption, melanin_concentrations, transmittance};
pub use space::RgbSpace;

/// Smallest width that [`HairParams::new`] accepts, in radians.
pub const MIN_WIDTH: f32 = 1e-4;
/// Largest width that [`HairParams::new`] accepts, in radians.
pub const MAX_WIDTH: f32 = PI;

/// Parameters of the published model, not checked yet. Set the fields that differ from the default and pass the description to
/// [`HairParams::new`]. Kernels use `f32` and formulas `f64`; fields have the names of the paper and of files.
///
/// - Source: Ou et al. 2012, section 3.1 and table 2 (after Sadeghi et al. 2010).
/// - Units: angles in radians; intensities linear RGB. Arrays of lobes hold R, TT and TRT.
/// - Default: [`HairParams::brown`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct HairDesc<T = f32> {
    /// Longitudinal shifts, the centres of the lobes in `theta_h`, each in `[-pi/2, pi/2]`. The glints have the shift of TRT.
    pub alpha: [T; 3],
    /// Longitudinal widths in `theta_h` (Gaussian deviation, Cauchy scale), each in `[1e-4, pi]`. The glints have the width of TRT.
    pub beta: [T; 3],
    /// Azimuthal width of TT, in `[1e-4, pi]`.
    pub gamma_tt: T,
    /// Azimuthal width of each glint, in `[1e-4, pi]`.
    pub gamma_g: T,
    /// Half angle between the two glints, in `[0, pi]`.
    pub phi_g: T,
    /// Intensity of R, linear RGB, each finite and at least 0.
    pub i_r: [T; 3],
    /// Intensity of TT, linear RGB, each finite and at least 0.
    pub i_tt: [T; 3],
    /// Intensity of TRT, which the glints share, linear RGB, each finite and at least 0.
    pub i_trt: [T; 3],
    /// Strength of the glints relative to `i_trt`, finite and at least 0.
    pub i_g: T,
}

impl<T: Copy> HairDesc<T> {
    /// Converts every number of the description to another type or unit.
    #[inline]
    #[must_use]
    pub fn map<U>(&self, convert: impl Fn(T) -> U) -> HairDesc<U> {
        HairDesc {
            alpha: self.alpha.map(&convert),
            beta: self.beta.map(&convert),
            gamma_tt: convert(self.gamma_tt),
            gamma_g: convert(self.gamma_g),
            phi_g: convert(self.phi_g),
            i_r: self.i_r.map(&convert),
            i_tt: self.i_tt.map(&convert),
            i_trt: self.i_trt.map(&convert),
            i_g: convert(self.i_g),
        }
    }
}

impl<T: Copy + core::ops::Mul<Output = T>> HairDesc<T> {
    /// Multiplies all five widths by `factor`; the bells, the sampler and the lobe energies follow the new widths.
    ///
    /// The Cauchy variant is published with the Gaussian widths unchanged (1). A factor of 1.177 matches the half width of the
    /// Gaussian, and 0.798 its area.
    #[inline]
    #[must_use]
    pub fn with_width_factor(self, factor: T) -> Self {
        Self {
            beta: self.beta.map(|beta| beta * factor),
            gamma_tt: self.gamma_tt * factor,
            gamma_g: self.gamma_g * factor,
            ..self
        }
    }
}

impl Default for HairDesc {
    #[inline]
    fn default() -> Self {
        *HairParams::brown().desc()
    }
}

/// Hair parameters that passed the checks of [`new`](Self::new), so that every model built on them is total.
///
/// ```
/// use hairis::HairParams;
/// use hairis::params::HairDesc;
/// let glossy = HairParams::new(&HairDesc { beta: [0.05, 0.03, 0.1], ..*HairParams::black().desc() })?;
/// assert_eq!(glossy.desc().beta[0], 0.05);
/// # Ok::<(), hairis::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "HairDesc", into = "HairDesc")
)]
pub struct HairParams(HairDesc);

impl HairParams {
    /// Checks a description and returns the parameters.
    ///
    /// # Errors
    ///
    /// Returns an error that holds the first field outside its range (see [`HairDesc`]) and its value; NaN and infinities are always
    /// rejected. All intensities may be zero: the model then evaluates to 0 and every sample is discarded.
    #[inline]
    pub fn new(desc: &HairDesc) -> Result<Self, ParamError> {
        let d = desc;
        let fields: [(_, &[f32], _); 9] = [
            ("alpha", &d.alpha, Rule::Shift),
            ("beta", &d.beta, Rule::Width),
            ("gamma_tt", &[d.gamma_tt], Rule::Width),
            ("gamma_g", &[d.gamma_g], Rule::Width),
            ("phi_g", &[d.phi_g], Rule::Azimuth),
            ("i_r", &d.i_r, Rule::NotNegative),
            ("i_tt", &d.i_tt, Rule::NotNegative),
            ("i_trt", &d.i_trt, Rule::NotNegative),
            ("i_g", &[d.i_g], Rule::NotNegative),
        ];
        for (field, numbers, rule) in fields {
            rule.check(field, numbers)?;
        }
        Ok(Self(*desc))
    }

    /// Returns the description that was checked.
    #[inline]
    #[must_use]
    pub const fn desc(&self) -> &HairDesc {
        &self.0
    }

    /// Multiplies the intensities of R, TT and TRT by `factor`. With
    /// [`Material::conserving_scale`](crate::Material::conserving_scale) the hair returns at most the light it receives.
    ///
    /// # Errors
    ///
    /// Returns an error if `factor` is negative or not finite, or if a product overflows.
    #[inline]
    pub fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        Rule::NotNegative.check("factor", &[factor])?;
        let d = self.0;
        let by = |rgb: [f32; 3]| rgb.map(|c| c * factor);
        Self::new(&HairDesc {
            i_r: by(d.i_r),
            i_tt: by(d.i_tt),
            i_trt: by(d.i_trt),
            ..d
        })
    }
}

#[cfg(feature = "serde")]
impl TryFrom<HairDesc> for HairParams {
    type Error = ParamError;

    #[inline]
    fn try_from(desc: HairDesc) -> Result<Self, ParamError> {
        Self::new(&desc)
    }
}

#[cfg(feature = "serde")]
impl From<HairParams> for HairDesc {
    #[inline]
    fn from(params: HairParams) -> Self {
        params.0
    }
}
