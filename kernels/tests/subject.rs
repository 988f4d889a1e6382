//! The model under test: the published one. The tests that name [`crate::subject`] are run again, word for word, by
//! the package of variants on the bell it adds.

use hairis::textbook::{Parameters, Shape, Textbook};
use hairis::{Gaussian, Hair};

/// The bell.
pub(crate) type Subject = Gaussian;
/// The model.
pub(crate) type Tested = Hair<Subject>;
/// Its twin.
pub(crate) type Oracle = Textbook<f64>;
/// The same bell in the textbook.
pub(crate) const SHAPE: Shape = Shape::Gaussian;
/// The bell over the Cauchy value at its worst: `exp(-x^2/2) (1 + x^2)` at `x = 1`, `2 / sqrt(e)`.
pub(crate) const OVER_CAUCHY: f64 = 1.213_061_319_425_267;

/// Densities below this are compared absolutely: a Cauchy has no end.
pub(crate) const PDF_FLOOR: f64 = 0.0;

/// Whether the density vanishes where the model does: it does not.
pub(crate) const MATCHED: bool = false;

/// Every form of the model, with its factor on the widths.
pub(crate) fn subjects() -> Vec<(Tested, f32)> {
    vec![(Hair(Gaussian), 1.0)]
}

/// The twin for these parameters at the gather point of `wo`.
pub(crate) fn twin(parameters: &Parameters<f64>, wo: [f64; 3]) -> Oracle {
    Textbook::prepare(parameters, SHAPE, wo)
}
