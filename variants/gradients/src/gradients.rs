//! Handle of a material whose model is known at compile time.

use crate::columns::{Call, GradColumns, GradError, Weights};
use crate::generated::{Differentiable, sealed};
use core::fmt;
use hairis::ParamError;
use hairis::columns::HitColumns;
use hairis::simd::Level;
use hairis_variants::{Parameters, Values};

/// Derivatives of a material: a handle that is made once per material, and called with slices of hits.
pub struct Gradients<M: Differentiable> {
    /// Values that the derivatives by parameters are by.
    pub(crate) values: Values,
    pub(crate) params: M::Params,
    pub(crate) material: M::Material<f32>,
    level: Level,
}

impl<M: Differentiable> Clone for Gradients<M> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Differentiable> Copy for Gradients<M> {}

impl<M: Differentiable> fmt::Debug for Gradients<M> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Gradients")
            .field("params", &self.params)
            .field("level", &self.level)
            .finish_non_exhaustive()
    }
}

impl<M: Differentiable> Gradients<M> {
    /// Count of the numbers of a material, and thus of the derivatives by the material.
    pub const NUMBERS: usize = M::MATERIAL.len();

    /// Makes the derivatives at these parameters, on the best instruction set of the CPU.
    #[inline]
    #[must_use]
    pub fn new(params: &M::Params) -> Self {
        Self {
            values: params.values(),
            params: *params,
            material: M::MODEL.material(params),
            level: Level::detect(),
        }
    }

    /// Makes the derivatives at the parameters of these values. [`by_parameters`](Self::by_parameters) then returns derivatives by the
    /// fields that the values have, such as a colour in place of an absorption.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range.
    #[inline]
    pub fn from_values(values: &Values) -> Result<Self, ParamError> {
        let params = M::Params::from_values(values)?;
        Ok(Self {
            values: *values,
            ..Self::new(&params)
        })
    }

    /// Selects an instruction set in place of the one that was detected.
    #[inline]
    #[must_use]
    pub const fn with_level(self, level: Level) -> Self {
        Self { level, ..self }
    }

    /// Computes S of many directions, each at a hit of its own, and the derivatives of its weighted sum.
    ///
    /// S has the bits of [`Material::eval_hits`](hairis::Material::eval_hits). The crate documents the
    /// [rules](crate#rules-where-a-model-is-not-smooth) where a model is not smooth.
    ///
    /// # Errors
    ///
    /// Returns an error if the columns differ in length, or if the count of the derivatives by the material differs from that of its
    /// numbers. Nothing is written then.
    #[inline]
    pub fn eval_grad(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        weights: Weights<'_>,
        out: GradColumns<'_, '_>,
    ) -> Result<(), GradError> {
        self.run::<false>(hits, wi, weights, out)
    }

    /// Computes S and the density, and the derivatives of their weighted sum. Otherwise like [`eval_grad`](Self::eval_grad), but for
    /// [`Matched`](hairis::Matched) several times slower.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`eval_grad`](Self::eval_grad).
    #[inline]
    pub fn eval_pdf_grad(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        weights: Weights<'_>,
        out: GradColumns<'_, '_>,
    ) -> Result<(), GradError> {
        self.run::<true>(hits, wi, weights, out)
    }

    #[inline]
    fn run<const HAS_PDF: bool>(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        weights: Weights<'_>,
        out: GradColumns<'_, '_>,
    ) -> Result<(), GradError> {
        let mut call = Call::new(hits, wi, weights, out, Self::NUMBERS)?;
        M::run::<HAS_PDF>(sealed::Rows(&mut call), &self.material, self.level);
        Ok(())
    }
}
