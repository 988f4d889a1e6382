//! Rules that give a model's values without a fit.

use super::{FitConfig, Look};
use crate::difference::least;
use hairis::model::Bell as _;
use hairis_materials::material::single;
use hairis_variants::{Cauchy, ModelId, Values};

/// Names of the rules, in the order of [`rules`]: each is a factor on a Cauchy bell's width by which it replaces a Gaussian one.
pub const RULES: [&str; 4] = ["equal", "half-width", "area", "best factor"];

/// Returns the values that a fit to a look starts from: those of the look if both models have the same fields, or else the measured preset.
#[must_use]
pub fn first_start(from: &Look, to: ModelId) -> Values {
    if from.model.fields() == to.fields() {
        from.values
    } else {
        to.measured()
    }
}

/// Returns the values of each of [`RULES`] if both models have the same fields; otherwise, and between equal models, the first start alone.
/// The best common factor on the widths has the least `distance`.
///
/// # Errors
///
/// Returns the first error of `distance`.
pub fn rules<E>(
    from: &Look,
    to: ModelId,
    config: &FitConfig,
    mut distance: impl FnMut(&Values) -> Result<f64, E>,
) -> Result<Vec<Values>, E> {
    let first = first_start(from, to);
    if from.model.fields() != to.fields() || from.model.name() == to.name() {
        return Ok(vec![first]);
    }
    let with = |factor: f64| {
        let k = if to.name() == ModelId::Cauchy.name() {
            factor
        } else {
            factor.recip()
        };
        with_widths(&first, k, &config.fixed)
    };
    let best = least(|factor| distance(&with(factor)))?;
    let named = [Cauchy::HALF_WIDTH, Cauchy::AREA].map(|rule| f64::from(rule.width_factor()));
    let scaled = named.into_iter().chain([best]).map(with);
    Ok([first].into_iter().chain(scaled).collect())
}

/// Returns values with the widths times a factor. Widths are the angles that are drawn by their logarithm.
fn with_widths(values: &Values, factor: f64, fixed: &[String]) -> Values {
    let mut scaled = *values;
    for (index, field) in values.fields().iter().enumerate() {
        let is_width = field.unit == "rad" && field.draw.is_some_and(|draw| draw.log);
        let is_fixed = fixed.iter().any(|name| name == field.name);
        let Some([least, most]) = field.range().filter(|_| is_width && !is_fixed) else {
            continue;
        };
        let numbers = values.numbers_at(index).iter();
        let numbers: Vec<f32> = numbers
            .map(|x| single(f64::from(*x) * factor).clamp(least, most))
            .collect();
        scaled
            .set_at(index, &numbers)
            .expect("a field of the model");
    }
    scaled
}
