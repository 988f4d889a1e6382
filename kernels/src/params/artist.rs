//! Hair described in an artist's terms: colour, intensity, position and width of each highlight, in degrees.

use super::{HairDesc, HairParams, MAX_WIDTH, Rule};
use crate::params::error::ParamError;
use core::f32::consts::{FRAC_PI_2, PI};

const RAD_PER_DEG: f32 = PI / 180.0;
/// Smallest and largest width accepted, in degrees.
const WIDTHS: [f32; 2] = [0.01, 180.0];
/// Smallest and largest shift accepted, in degrees.
const SHIFTS: [f32; 2] = [-90.0, 90.0];
/// Smallest and largest separation of the glints accepted, in degrees.
const SEPARATIONS: [f32; 2] = [0.0, 360.0];

/// Controls of a highlight that runs around the fibre: the primary (R) or the secondary (TRT).
///
/// - Source: Sadeghi et al. 2010, section 4: colour, intensity, longitudinal shift and width of a lobe.
/// - Default: the primary highlight of [`ArtistControls::default`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Colour, linear RGB, each finite and at least 0; usually in [0, 1].
    pub color: [f32; 3],
    /// Factor on `color`, finite and at least 0.
    pub intensity: f32,
    /// Position of the highlight along the fibre, in degrees in [-90, 90]: the lobe's `alpha`, with the same sign.
    ///
    /// A positive shift turns the lobe towards the tip (the lobe peaks where `theta_i + theta_o` is twice the shift), so that on
    /// hair that curves over a head the highlight moves towards the *root*. A negative shift moves it towards the *tip*. Real hair
    /// has its primary highlight at -5 to -10 degrees and its secondary highlight at +7 to +15.
    pub shift_deg: f32,
    /// Width along the fibre, in degrees in [0.01, 180]: the lobe's `beta`, the standard deviation in `theta_h`. At half its height
    /// the highlight itself is about 2.35 times as wide, in `theta_h`.
    pub width_deg: f32,
}

impl Default for Highlight {
    #[inline]
    fn default() -> Self {
        Self {
            color: [1.0; 3],
            intensity: 0.025,
            shift_deg: -7.5,
            width_deg: 7.5,
        }
    }
}

/// Controls of the light that shines through the fibre (TT): the rim of hair lit from behind.
///
/// - Default: the transmission of [`ArtistControls::default`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmission {
    /// Colour, linear RGB, each finite and at least 0; usually in [0, 1].
    pub color: [f32; 3],
    /// Factor on `color`, finite and at least 0.
    pub intensity: f32,
    /// Position of the highlight along the fibre, like [`Highlight::shift_deg`]; +2.5 to +5 degrees in real hair.
    pub shift_deg: f32,
    /// Width along the fibre, like [`Highlight::width_deg`].
    pub width_deg: f32,
    /// Width around the fibre, in degrees in [0.01, 180]: `gamma_tt`. With small values the hair lights up only from right behind.
    pub azimuthal_width_deg: f32,
}

impl Default for Transmission {
    #[inline]
    fn default() -> Self {
        Self {
            color: [0.6, 0.4, 0.24],
            intensity: 3.0,
            shift_deg: 3.75,
            width_deg: 3.75,
            azimuthal_width_deg: 10.0,
        }
    }
}

/// Controls of the two bright spots inside the secondary highlight, whose colour, shift and width they share.
///
/// - Default: the glints of [`ArtistControls::default`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glints {
    /// Strength relative to the secondary highlight, finite and at least 0: `i_g`. A strength of 0 switches the glints off.
    pub strength: f32,
    /// Full angle from one glint to the other around the fibre, in degrees in [0, 360]: twice `phi_g`.
    pub separation_deg: f32,
    /// Width of each glint around the fibre, in degrees in [0.01, 180]: `gamma_g`.
    pub azimuthal_width_deg: f32,
}

impl Default for Glints {
    #[inline]
    fn default() -> Self {
        Self {
            strength: 0.8,
            separation_deg: 70.0,
            azimuthal_width_deg: 10.0,
        }
    }
}

/// Hair in an artist's terms, which [`HairParams::from_artist`] converts to the parameters of the model.
///
/// Every control acts alone, unlike the physical quantities behind a hair (Sadeghi et al. 2010, section 4). A colour times an
/// intensity is the `i_*` of a [`HairDesc`], a shift its `alpha`, and a width its `beta` or `gamma_*`, with degrees for radians.
/// Half the separation of the glints is its `phi_g`. The default is [`HairParams::default`], except for rounding.
///
/// ```
/// use hairis::HairParams;
/// use hairis::params::{ArtistControls, Highlight};
/// let red_sheen = ArtistControls {
///     secondary: Highlight { color: [0.9, 0.3, 0.1], intensity: 0.5, shift_deg: 11.0, width_deg: 14.0 },
///     ..ArtistControls::default()
/// };
/// let hair = HairParams::from_artist(&red_sheen)?;
/// assert_eq!(hair.desc().i_trt, [0.45, 0.15, 0.05]);
/// assert!((hair.desc().beta[2].to_degrees() - 14.0).abs() < 1e-5);
/// # Ok::<(), hairis::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArtistControls {
    /// Primary highlight (R), which has the colour of the light: keep its colour white or nearly so.
    pub primary: Highlight,
    /// Light from behind (TT), which passed the pigment once.
    pub transmission: Transmission,
    /// Secondary highlight (TRT), which has the colour of the hair; it is wider, and on the root's side of the primary highlight.
    pub secondary: Highlight,
    /// Glints of the secondary highlight.
    pub glints: Glints,
}

impl Default for ArtistControls {
    #[inline]
    fn default() -> Self {
        Self {
            primary: Highlight::default(),
            transmission: Transmission::default(),
            secondary: Highlight {
                color: [0.36, 0.16, 0.0576],
                intensity: 0.1,
                shift_deg: 11.25,
                width_deg: 15.0,
            },
            glints: Glints::default(),
        }
    }
}

impl HairParams {
    /// Converts an artist's controls to the parameters of the model, and checks them.
    ///
    /// # Errors
    ///
    /// Returns an error that holds the first control outside its range under its own name (for instance `"secondary.width_deg"`) and
    /// its value as given, in degrees if the control is an angle. NaN and infinities are always rejected, and so is a colour whose
    /// product with its intensity overflows.
    #[inline]
    pub fn from_artist(controls: &ArtistControls) -> Result<Self, ParamError> {
        let ArtistControls {
            primary: r,
            transmission: tt,
            secondary: trt,
            glints,
        } = controls;
        Rule::NotNegative.check("glints.strength", &[glints.strength])?;
        Self::new(&HairDesc {
            alpha: [
                shift("primary.shift_deg", r.shift_deg)?,
                shift("transmission.shift_deg", tt.shift_deg)?,
                shift("secondary.shift_deg", trt.shift_deg)?,
            ],
            beta: [
                width("primary.width_deg", r.width_deg)?,
                width("transmission.width_deg", tt.width_deg)?,
                width("secondary.width_deg", trt.width_deg)?,
            ],
            gamma_tt: width("transmission.azimuthal_width_deg", tt.azimuthal_width_deg)?,
            gamma_g: width("glints.azimuthal_width_deg", glints.azimuthal_width_deg)?,
            phi_g: (degrees("glints.separation_deg", glints.separation_deg, SEPARATIONS)? * 0.5)
                .min(PI),
            i_r: tint("primary.color", r.color, "primary.intensity", r.intensity)?,
            i_tt: tint(
                "transmission.color",
                tt.color,
                "transmission.intensity",
                tt.intensity,
            )?,
            i_trt: tint(
                "secondary.color",
                trt.color,
                "secondary.intensity",
                trt.intensity,
            )?,
            i_g: glints.strength,
        })
    }
}

/// Converts `value` to radians, if it is within `range` degrees.
#[inline]
fn degrees(field: &'static str, value: f32, range: [f32; 2]) -> Result<f32, ParamError> {
    Rule::Degrees(range).check(field, &[value])?;
    Ok(value * RAD_PER_DEG)
}

/// Converts a shift to radians, within the exact bound of [`HairParams::new`] whatever the rounding.
#[inline]
fn shift(field: &'static str, value: f32) -> Result<f32, ParamError> {
    Ok(degrees(field, value, SHIFTS)?.clamp(-FRAC_PI_2, FRAC_PI_2))
}

/// Converts a width to radians; the smallest, 1.7e-4, is above [`MIN_WIDTH`](super::MIN_WIDTH).
#[inline]
fn width(field: &'static str, value: f32) -> Result<f32, ParamError> {
    Ok(degrees(field, value, WIDTHS)?.min(MAX_WIDTH))
}

/// Multiplies a colour by its intensity.
#[inline]
fn tint(
    color_field: &'static str,
    color: [f32; 3],
    intensity_field: &'static str,
    intensity: f32,
) -> Result<[f32; 3], ParamError> {
    Rule::NotNegative.check(intensity_field, &[intensity])?;
    Rule::NotNegative.check(color_field, &color)?;
    let rgb = color.map(|value| value * intensity);
    match rgb.iter().position(|product| !product.is_finite()) {
        None => Ok(rgb),
        Some(channel) => Err(ParamError::new(
            color_field,
            Some(channel),
            Rule::FiniteProduct,
            color[channel],
        )),
    }
}
