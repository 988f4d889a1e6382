//! The model under test: the published one with its matched sampler.

use hairis::textbook::{MatchedTextbook, Parameters, Shape};
use hairis::{Gaussian, Hair, Matched};

/// The model.
pub(crate) type Tested = Matched<Gaussian>;
/// Its twin.
pub(crate) type Oracle = MatchedTextbook<f64>;
/// The same bell in the textbook.
pub(crate) const SHAPE: Shape = Shape::Gaussian;

/// Densities below this are compared absolutely: a Gaussian, and with it the density, is cut to 0 at `2^-115` of its peak.
pub(crate) const PDF_FLOOR: f64 = 1e-20;

/// Whether the density vanishes where the model does.
pub(crate) const MATCHED: bool = true;

/// Every form of the model, with its factor on the widths.
pub(crate) fn subjects() -> Vec<(Tested, f32)> {
    vec![(Matched(Gaussian), 1.0)]
}

/// The model with the published sampler, and with the matched ones of 5, 9 and 25 bands.
pub(crate) fn samplers() -> (Hair<Gaussian>, Matched<Gaussian, 5>, Matched<Gaussian, 9>, Matched<Gaussian, 25>) {
    (Hair(Gaussian), Matched(Gaussian), Matched(Gaussian), Matched(Gaussian))
}

/// The twin for these parameters at the gather point of `wo`.
pub(crate) fn twin(parameters: &Parameters<f64>, wo: [f64; 3]) -> Oracle {
    MatchedTextbook::prepare(parameters, SHAPE, wo, 9)
}
