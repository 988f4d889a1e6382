//! The model under test: the all-Cauchy variant, with each of its factors on the widths.

use hairis::Hair;
use hairis::textbook::{Parameters, Shape, Textbook};
use hairis_variants::Cauchy;

/// The bell.
pub(crate) type Subject = Cauchy;
/// The model.
pub(crate) type Tested = Hair<Subject>;
/// Its twin.
pub(crate) type Oracle = Textbook<f64>;
/// The same bell in the textbook.
pub(crate) const SHAPE: Shape = Shape::Cauchy;
/// The bell over the Cauchy value: the published sampler follows this model exactly.
pub(crate) const OVER_CAUCHY: f64 = 1.0;

/// Densities below this are compared absolutely: a Cauchy has no end.
pub(crate) const PDF_FLOOR: f64 = 0.0;

/// Whether the density vanishes where the model does: it does not.
pub(crate) const MATCHED: bool = false;

/// Every form of the model, with its factor on the widths.
pub(crate) fn subjects() -> Vec<(Tested, f32)> {
    vec![(Cauchy::PAPER.model(), 1.0), (Cauchy::HALF_WIDTH.model(), 1.177_41), (Cauchy::AREA.model(), 0.797_884_6)]
}

/// The twin for these parameters at the gather point of `wo`.
pub(crate) fn twin(parameters: &Parameters<f64>, wo: [f64; 3]) -> Oracle {
    Textbook::prepare(parameters, SHAPE, wo)
}
