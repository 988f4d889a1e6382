//! Derivatives by parameters, computed from the derivatives by the numbers of a material.

use crate::generated::Differentiable;
use crate::gradients::Gradients;
use hairis_variants::{Kind, Parameters, Values};

impl<M: Differentiable> Gradients<M> {
    /// Turns derivatives by the numbers of the material into derivatives by parameters: one per number of each field that has a value,
    /// and 0 for words. A field that the handle was made with in place of another one, such as a colour in place of an absorption, has
    /// derivatives like any other: see [`Parameters::chain`].
    ///
    /// - `d_material`: derivatives by the numbers of the material, as [`GradColumns::d_material`](crate::GradColumns::d_material) sums
    ///   them. Missing entries are 0, and entries beyond [`NUMBERS`](Self::NUMBERS) are ignored.
    /// - Accuracy: that of single precision, as for the other derivatives. On the edge of a parameter's range, where the model is cut
    ///   off, they are one-sided. The test `derivatives_are_those_of_the_formulas` states the errors.
    #[inline(never)]
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "parts of the largest, in [-1, 1]"
    )]
    pub fn by_parameters(&self, d_material: &[f64]) -> Values<f64> {
        let (kept_values, fields) = (self.params.values(), M::Params::FIELDS);
        let kept = || (0..fields.len()).filter(|index| kept_values.has_at(*index));
        // Sums over many hits may exceed the range of single precision, so they are scaled.
        let largest = d_material.iter().fold(0.0, |a: f64, d| a.max(d.abs()));
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let mut found = M::by_parameters(
            kept().flat_map(|index| kept_values.numbers_at(index).iter().copied()),
            d_material.iter().map(|d| (d / scale) as f32),
        );
        let mut derivatives = Values::none(fields);
        for index in kept() {
            let count = kept_values.numbers_at(index).len();
            let mut all = [0.0; Values::MOST];
            for (to, derivative) in all.iter_mut().take(count).zip(&mut found) {
                if !matches!(fields[index].kind, Kind::Word(_)) {
                    *to = f64::from(derivative) * scale;
                }
            }
            let set = derivatives.set_at(index, &all[..count]);
            debug_assert!(set.is_ok(), "a field of the model");
        }
        M::Params::chain(&self.values, &derivatives)
    }
}
