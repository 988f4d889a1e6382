//! Parameters of hair: validated widths, shifts and intensities.

use core::f32::consts::{FRAC_PI_2, PI};

mod artist;
mod error;
mod presets;

pub use artist::{ArtistControls, Glints, Highlight, Transmission};
pub use error::ParamError;

/// Smallest width accepted, rad.
pub const MIN_WIDTH: f32 = 1e-4;
/// Largest width accepted, rad.
pub const MAX_WIDTH: f32 = PI;

/// The parameters of the published model, not checked yet: set the fields that differ from the default and pass it to
/// [`HairParams::new`].
///
/// - Source: Ou et al. 2012, section 3.1 and table 2 (after Sadeghi et al. 2010).
/// - Units: angles in radians; intensities linear RGB.
/// - Default: the default set of the efficiency figures: a `beta_r` of 7.5 degrees, brown hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairDesc {
    /// Longitudinal shift of R, the centre of its lobe in `theta_h`, in `[-pi/2, pi/2]`.
    pub alpha_r: f32,
    /// Longitudinal shift of TT.
    pub alpha_tt: f32,
    /// Longitudinal shift of TRT and the glints.
    pub alpha_trt: f32,
    /// Longitudinal width of R in `theta_h` (Gaussian deviation, Cauchy scale), in `[1e-4, pi]`.
    pub beta_r: f32,
    /// Longitudinal width of TT.
    pub beta_tt: f32,
    /// Longitudinal width of TRT and the glints.
    pub beta_trt: f32,
    /// Azimuthal width of TT, in `[1e-4, pi]`.
    pub gamma_tt: f32,
    /// Azimuthal width of each glint, in `[1e-4, pi]`.
    pub gamma_g: f32,
    /// Half angle between the two glints, in `[0, pi]`.
    pub phi_g: f32,
    /// Intensity of R, linear RGB, each finite and at least 0.
    pub intensity_r: [f32; 3],
    /// Intensity of TT.
    pub intensity_tt: [f32; 3],
    /// Intensity of TRT, which the glints share.
    pub intensity_trt: [f32; 3],
    /// Strength of the glints, a factor on `intensity_trt`, finite and at least 0.
    pub intensity_g: f32,
}

impl HairDesc {
    /// The default, for constants.
    pub(crate) const DEFAULT: Self = {
        let deg = PI / 180.0;
        Self {
            alpha_r: -7.5 * deg,
            alpha_tt: 3.75 * deg,
            alpha_trt: 11.25 * deg,
            beta_r: 7.5 * deg,
            beta_tt: 3.75 * deg,
            beta_trt: 15.0 * deg,
            gamma_tt: 10.0 * deg,
            gamma_g: 10.0 * deg,
            phi_g: 35.0 * deg,
            intensity_r: [0.3; 3],
            intensity_tt: [0.8, 0.6, 0.4],
            intensity_trt: [0.7, 0.5, 0.3],
            intensity_g: 0.5,
        }
    };
}

impl Default for HairDesc {
    #[inline]
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Hair parameters that passed their checks: every model built on them is total.
///
/// ```
/// use hairis::HairParams;
/// use hairis::params::HairDesc;
/// let glossy = HairParams::new(&HairDesc { beta_r: 0.05, ..*HairParams::black().desc() })?;
/// assert_eq!(glossy.desc().beta_r, 0.05);
/// # Ok::<(), hairis::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairParams(HairDesc);

impl HairParams {
    /// Checks `desc`.
    ///
    /// # Errors
    ///
    /// The first field that is out of its range (see [`HairDesc`]), with its value; NaN and infinities never pass.
    /// All intensities zero is legal: the model then evaluates to 0 and every sample is discarded.
    #[inline]
    pub fn new(desc: &HairDesc) -> Result<Self, ParamError> {
        let shifts = [
            ("alpha_r", desc.alpha_r),
            ("alpha_tt", desc.alpha_tt),
            ("alpha_trt", desc.alpha_trt),
        ];
        for (field, value) in shifts {
            check(value.abs() <= FRAC_PI_2, ParamError::Shift(field, value))?;
        }
        let widths = [
            ("beta_r", desc.beta_r),
            ("beta_tt", desc.beta_tt),
            ("beta_trt", desc.beta_trt),
            ("gamma_tt", desc.gamma_tt),
            ("gamma_g", desc.gamma_g),
        ];
        for (field, value) in widths {
            check(
                (MIN_WIDTH..=MAX_WIDTH).contains(&value),
                ParamError::Width(field, value),
            )?;
        }
        check(
            (0.0..=PI).contains(&desc.phi_g),
            ParamError::GlintAngle("phi_g", desc.phi_g),
        )?;
        let colours = [
            ("intensity_r", desc.intensity_r),
            ("intensity_tt", desc.intensity_tt),
            ("intensity_trt", desc.intensity_trt),
        ];
        for (field, rgb) in colours {
            for (channel, value) in rgb.into_iter().enumerate() {
                check(
                    is_intensity(value),
                    ParamError::Intensity(field, channel, value),
                )?;
            }
        }
        check(
            is_intensity(desc.intensity_g),
            ParamError::Scalar("intensity_g", desc.intensity_g),
        )?;
        Ok(Self(*desc))
    }

    /// The values that were checked.
    #[inline]
    #[must_use]
    pub const fn desc(&self) -> &HairDesc {
        &self.0
    }

    /// The same hair with every intensity multiplied by `factor`: with
    /// [`Material::conserving_scale`](crate::Material::conserving_scale), hair that returns at most the light it receives.
    ///
    /// # Errors
    ///
    /// If `factor` is negative or not finite, or a product overflows.
    #[inline]
    pub fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        check(is_intensity(factor), ParamError::Scalar("factor", factor))?;
        let d = self.0;
        let by = |[r, g, b]: [f32; 3]| [r * factor, g * factor, b * factor];
        Self::new(&HairDesc {
            intensity_r: by(d.intensity_r),
            intensity_tt: by(d.intensity_tt),
            intensity_trt: by(d.intensity_trt),
            ..d
        })
    }
}

#[inline]
fn is_intensity(value: f32) -> bool {
    (0.0..=f32::MAX).contains(&value)
}

#[inline]
fn check(passed: bool, error: ParamError) -> Result<(), ParamError> {
    if passed { Ok(()) } else { Err(error) }
}
