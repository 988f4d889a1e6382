//! Derivatives by parameters, from those by the numbers of a material.

use crate::Gradients;
use crate::generated::Differentiable;
use hairis::simd::{LaneStruct, Path};
use hairis_variants::{Kind, Parameters, Values};

/// Step of a difference, in parts of the parameter. The difference of fourth order errs by 5% of a power of 20, the highest of any
/// model, and by rounding in single precision.
const STEP: f32 = 1.0 / 48.0;
/// Least magnitude that a step is a part of.
const LEAST: f32 = 0.05;

impl<M: Differentiable> Gradients<M> {
    /// Derivatives by parameters: one per number of each field that the parameters keep, 0 for words.
    ///
    /// - `d_material`: derivatives by the numbers of the material, as [`GradColumns::d_material`](crate::GradColumns::d_material) sums
    ///   them; entries beyond [`NUMBERS`](Self::NUMBERS) are ignored.
    /// - Accuracy: the numbers of a material are differentiated by differences in single precision, one-sided on the edge of a
    ///   parameter's range. The test `derivatives_are_those_of_the_formulas` states the errors.
    #[inline(never)]
    #[must_use]
    pub fn by_parameters(&self, d_material: &[f64]) -> Values<f64> {
        let (values, fields) = (self.params.values(), M::Params::FIELDS);
        let mut derivatives = Values::none(fields);
        for (index, field) in fields.iter().enumerate() {
            if !values.has_at(index) {
                continue;
            }
            let numbers = values.numbers_at(index);
            let mut all = [0.0; Values::MOST];
            for (place, derivative) in all.iter_mut().enumerate().take(numbers.len()) {
                if !matches!(field.kind, Kind::Word(_)) {
                    *derivative = self.difference(&values, index, place, d_material);
                }
            }
            let set = derivatives.set_at(index, &all[..numbers.len()]);
            debug_assert!(set.is_ok(), "a field of the model");
        }
        derivatives
    }

    /// Derivative of the weighted sum of a material's numbers by one number of the field at `index`.
    fn difference(&self, values: &Values, index: usize, place: usize, d_material: &[f64]) -> f64 {
        let mut numbers = [0.0; Values::MOST];
        let own = values.numbers_at(index);
        numbers[..own.len()].copy_from_slice(own);
        let (x, count) = (own[place], own.len());
        let mut at = |to: f32| {
            numbers[place] = to;
            let mut values = *values;
            values.set_at(index, &numbers[..count]).ok()?;
            weighted(
                &M::MODEL.material(&M::Params::from_values(&values).ok()?),
                d_material,
            )
        };
        let step = x.abs().max(LEAST) * STEP;
        let mut slope =
            |from: f32, to: f32| Some((at(to)? - at(from)?) / (f64::from(to) - f64::from(from)));
        // Each pair of slopes without its leading error: four times, then twice as large with the double step.
        if let (Some(near), Some(far)) = (
            slope(x - step, x + step),
            slope(x - 2.0 * step, x + 2.0 * step),
        ) {
            return (4.0 * near - far) / 3.0;
        }
        // Of second order: a smaller step.
        for step in [0.25 * step, -0.25 * step] {
            if let (Some(near), Some(far)) = (slope(x, x + step), slope(x, x + 2.0 * step)) {
                return 2.0 * near - far;
            }
        }
        0.0
    }
}

/// Weighted sum of a material's numbers; `None` if it is not finite.
fn weighted<S: LaneStruct<Number = f32>>(material: &S, weights: &[f64]) -> Option<f64> {
    let (mut sum, mut weights) = (0.0, weights.iter());
    material.visit(&Path::Root, &mut |_, number| {
        if let Some(weight) = weights.next()
            && *weight != 0.0
        {
            sum += f64::from(number) * weight;
        }
    });
    sum.is_finite().then_some(sum)
}
