//! The model under test: the all-Cauchy variant, with each of its factors on the widths.

use hairis::Hair;
use hairis::textbook::Shape;
use hairis_variants::Cauchy;

/// The bell.
pub(crate) type Subject = Cauchy;
/// The same bell in the textbook.
pub(crate) const SHAPE: Shape = Shape::Cauchy;
/// The bell over the Cauchy value: the published sampler follows this model exactly.
pub(crate) const OVER_CAUCHY: f64 = 1.0;

/// Every form of the model, with its factor on the widths.
pub(crate) fn subjects() -> Vec<(Hair<Subject>, f32)> {
    vec![(Cauchy::PAPER.model(), 1.0), (Cauchy::HALF_WIDTH.model(), 1.177_41), (Cauchy::AREA.model(), 0.797_884_6)]
}
