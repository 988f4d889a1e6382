//! Errors of parameters, and the rules that parameters must obey.

use core::f32::consts::{FRAC_PI_2, PI};
use core::fmt;

/// Rule that each number of a field obeys, with its range.
///
/// ```
/// use hairis::params::Rule;
/// assert!(Rule::Width.accepts(0.1) && !Rule::Width.accepts(f32::NAN));
/// assert_eq!(Rule::Range([1.0, 4.0]).to_string(), "in [1, 4]");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Rule {
    /// A width in `[1e-4, pi]` rad.
    Width,
    /// A longitudinal shift in `[-pi/2, pi/2]` rad.
    Shift,
    /// An angle in `[0, pi]` rad.
    Azimuth,
    /// A number that is finite and at least 0.
    NotNegative,
    /// An angle in this range of degrees, both ends included.
    Degrees([f32; 2]),
    /// A number in this range, both ends included.
    Range([f32; 2]),
    /// A colour whose product with its intensity is finite.
    FiniteProduct,
}

impl Rule {
    /// Returns the smallest and the largest number that obey the rule.
    #[inline]
    #[must_use]
    pub const fn range(self) -> [f32; 2] {
        match self {
            Self::Width => [super::MIN_WIDTH, super::MAX_WIDTH],
            Self::Shift => [-FRAC_PI_2, FRAC_PI_2],
            Self::Azimuth => [0.0, PI],
            Self::NotNegative | Self::FiniteProduct => [0.0, f32::MAX],
            Self::Degrees(range) | Self::Range(range) => range,
        }
    }

    /// Returns true if `value` obeys the rule; NaN never does.
    #[inline]
    #[must_use]
    pub fn accepts(self, value: f32) -> bool {
        let [least, most] = self.range();
        (least..=most).contains(&value)
    }

    /// Checks that the numbers of `field` obey the rule.
    ///
    /// # Errors
    ///
    /// Returns an error that holds the first number that breaks the rule, with its position if the field has several numbers.
    #[inline]
    pub fn check(self, field: &'static str, numbers: &[f32]) -> Result<(), ParamError> {
        for (number, value) in numbers.iter().enumerate() {
            if !self.accepts(*value) {
                return Err(ParamError {
                    field,
                    number: (numbers.len() > 1).then_some(number),
                    rule: self,
                    value: *value,
                });
            }
        }
        Ok(())
    }
}

impl fmt::Display for Rule {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Width => f.write_str("a width in [1e-4, pi] rad"),
            Self::Shift => f.write_str("an angle in [-pi/2, pi/2] rad"),
            Self::Azimuth => f.write_str("an angle in [0, pi] rad"),
            Self::NotNegative => f.write_str("finite and at least 0"),
            Self::Degrees([least, most]) => {
                write!(f, "an angle in [{least}, {most}] degrees")
            }
            Self::Range([least, most]) => write!(f, "in [{least}, {most}]"),
            Self::FiniteProduct => {
                f.write_str("so small that its product with the intensity is finite")
            }
        }
    }
}

/// Error about a rejected parameter: the field at fault, its value, and the rule that the value breaks.
///
/// ```
/// use hairis::HairParams;
/// use hairis::params::{HairDesc, Rule};
/// let error = HairParams::new(&HairDesc { beta: [0.1, 0.0, 0.2], ..HairDesc::default() }).unwrap_err();
/// assert_eq!((error.field(), error.number(), error.value()), ("beta", Some(1), 0.0));
/// assert_eq!(error.rule(), Rule::Width);
/// assert_eq!(error.to_string(), "beta[1] must be a width in [1e-4, pi] rad, got 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamError {
    field: &'static str,
    number: Option<usize>,
    rule: Rule,
    value: f32,
}

impl ParamError {
    /// Makes the error that rejects `value`; `number` is its position in a field of several numbers.
    #[inline]
    #[must_use]
    pub const fn new(field: &'static str, number: Option<usize>, rule: Rule, value: f32) -> Self {
        Self {
            field,
            number,
            rule,
            value,
        }
    }

    /// Returns the name of the field at fault, as the caller spells it.
    #[inline]
    #[must_use]
    pub const fn field(&self) -> &'static str {
        self.field
    }

    /// Returns the position of the number at fault in its field: a lobe, or 0 red, 1 green, 2 blue. `None` if the field is one
    /// number.
    #[inline]
    #[must_use]
    pub const fn number(&self) -> Option<usize> {
        self.number
    }

    /// Returns the rule that the value breaks.
    #[inline]
    #[must_use]
    pub const fn rule(&self) -> Rule {
        self.rule
    }

    /// Returns the value at fault, as the caller gave it.
    #[inline]
    #[must_use]
    pub const fn value(&self) -> f32 {
        self.value
    }
}

impl fmt::Display for ParamError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            field,
            number,
            rule,
            value,
        } = self;
        f.write_str(field)?;
        if let Some(number) = number {
            write!(f, "[{number}]")?;
        }
        write!(f, " must be {rule}, got {value}")
    }
}

impl core::error::Error for ParamError {}
