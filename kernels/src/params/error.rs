//! Errors of hair parameters.

use core::fmt;

/// Refusal of hair parameters: the field at fault and its value.
///
/// ```
/// use hairis::{HairParams, ParamError};
/// use hairis::params::HairDesc;
/// let refused = HairParams::new(&HairDesc { beta_tt: 0.0, ..HairDesc::default() });
/// assert_eq!(refused, Err(ParamError::Width("beta_tt", 0.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ParamError {
    /// A width outside `[1e-4, pi]` rad, or not finite.
    Width(&'static str, f32),
    /// A longitudinal shift outside `[-pi/2, pi/2]` rad, or not finite.
    Shift(&'static str, f32),
    /// The half angle between the glints outside `[0, pi]` rad, or not finite.
    GlintAngle(&'static str, f32),
    /// An intensity that is negative or not finite: the field, the channel (0 red, 1 green, 2 blue) and the value.
    Intensity(&'static str, usize, f32),
    /// A scalar that is negative or not finite, such as the strength of the glints.
    Scalar(&'static str, f32),
    /// A factor on the widths outside `[0.5, 4]`, or not finite.
    WidthFactor(&'static str, f32),
    /// An artist's angle that is not finite or outside its range: the field, the value and the range, in degrees.
    Degrees(&'static str, f32, [f32; 2]),
    /// A number outside the range of its field, or not finite: the field, the value, the least and the most.
    Range(&'static str, f32, [f32; 2]),
    /// An artist's colour whose product with its intensity overflows: the field, the channel and the colour's value.
    Overflow(&'static str, usize, f32),
}

impl ParamError {
    /// Name of the field at fault.
    #[inline]
    #[must_use]
    pub const fn field(&self) -> &'static str {
        match *self {
            Self::Width(field, _)
            | Self::Shift(field, _)
            | Self::GlintAngle(field, _)
            | Self::Intensity(field, _, _)
            | Self::Scalar(field, _)
            | Self::WidthFactor(field, _)
            | Self::Degrees(field, _, _)
            | Self::Range(field, _, _)
            | Self::Overflow(field, _, _) => field,
        }
    }
}

impl fmt::Display for ParamError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Width(field, value) => {
                write!(f, "{field} must be a width in [1e-4, pi] rad, got {value}")
            }
            Self::Shift(field, value) => write!(
                f,
                "{field} must be an angle in [-pi/2, pi/2] rad, got {value}"
            ),
            Self::GlintAngle(field, value) => {
                write!(f, "{field} must be an angle in [0, pi] rad, got {value}")
            }
            Self::Intensity(field, channel, value) => {
                write!(
                    f,
                    "{field}[{channel}] must be finite and at least 0, got {value}"
                )
            }
            Self::Scalar(field, value) => {
                write!(f, "{field} must be finite and at least 0, got {value}")
            }
            Self::WidthFactor(field, value) => {
                write!(f, "{field} must be in [0.5, 4], got {value}")
            }
            Self::Degrees(field, value, [least, most]) => {
                write!(
                    f,
                    "{field} must be an angle in [{least}, {most}] degrees, got {value}"
                )
            }
            Self::Range(field, value, [least, most]) => {
                write!(f, "{field} must be in [{least}, {most}], got {value}")
            }
            Self::Overflow(field, channel, value) => {
                write!(
                    f,
                    "{field}[{channel}] times its intensity must be finite, got a color of {value}"
                )
            }
        }
    }
}

impl core::error::Error for ParamError {}
