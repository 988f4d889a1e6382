//! The model under test: the all-Cauchy variant with its matched sampler.

use hairis::textbook::{MatchedTextbook, Parameters, Shape};
use hairis::{Hair, Matched};
use hairis_variants::Cauchy;

/// The model.
pub(crate) type Tested = Matched<Cauchy>;
/// Its twin.
pub(crate) type Oracle = MatchedTextbook<f64>;
/// The same bell in the textbook.
pub(crate) const SHAPE: Shape = Shape::Cauchy;

/// Densities below this are compared absolutely: a Cauchy has no end.
pub(crate) const PDF_FLOOR: f64 = 0.0;

/// Whether the density vanishes where the model does.
pub(crate) const MATCHED: bool = true;

/// Every form of the model, with its factor on the widths.
pub(crate) fn subjects() -> Vec<(Tested, f32)> {
    vec![
        (Cauchy::PAPER.matched(), 1.0),
        (Cauchy::HALF_WIDTH.matched(), 1.177_41),
        (Cauchy::AREA.matched(), 0.797_884_6),
    ]
}

/// The model with the published sampler, and with the matched ones of 5, 9 and 25 bands.
pub(crate) fn samplers() -> (Hair<Cauchy>, Matched<Cauchy, 5>, Matched<Cauchy, 9>, Matched<Cauchy, 25>) {
    (Cauchy::PAPER.model(), Matched(Cauchy::PAPER), Matched(Cauchy::PAPER), Matched(Cauchy::PAPER))
}

/// The twin for these parameters at the gather point of `wo`.
pub(crate) fn twin(parameters: &Parameters<f64>, wo: [f64; 3]) -> Oracle {
    MatchedTextbook::prepare(parameters, SHAPE, wo, 9)
}
