//! Handle of a model that is chosen at run time.

use crate::columns::{GradColumns, GradError, Weights};
use crate::generated::Differentiable;
use crate::gradients::Gradients;
use hairis::columns::HitColumns;
use hairis::simd::Level;
use hairis::{Gaussian, Matched, ParamError, Published};
use hairis_variants::{AllCauchy, Cauchy, Chiang, DEon, KajiyaKay, ModelId, Values};

macro_rules! any {
    ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
        /// Derivatives of a material of any model of the list, chosen at run time: see [`Gradients`].
        #[derive(Clone, Copy, Debug)]
        #[non_exhaustive]
        pub enum AnyGradients {
            $($(#[$doc])* $variant(Gradients<$model>)),*
        }

        impl AnyGradients {
            /// Makes the derivatives at these values of a model's parameters: see [`Gradients::from_values`].
            ///
            /// # Errors
            ///
            /// Returns an error if a value is out of its range.
            ///
            /// ```
            /// use hairis_gradients::AnyGradients;
            /// use hairis_variants::ModelId;
            /// let chiang = AnyGradients::new(ModelId::Chiang, &ModelId::Chiang.defaults())?;
            /// assert!(chiang.material().len() > 3);
            /// # Ok::<(), hairis::ParamError>(())
            /// ```
            #[inline(never)]
            pub fn new(model: ModelId, values: &Values) -> Result<Self, ParamError> {
                Ok(match model {
                    $(ModelId::$variant => Self::$variant(Gradients::from_values(values)?),)*
                    _ => unreachable!("every model of the list has derivatives"),
                })
            }

            /// Returns the names of the numbers of a material, in the order of [`GradColumns::d_material`].
            #[inline]
            #[must_use]
            pub const fn material(&self) -> &'static [&'static str] {
                match self {
                    $(Self::$variant(_) => <$model as Differentiable>::MATERIAL),*
                }
            }

            /// Selects an instruction set in place of the one that was detected.
            #[inline]
            #[must_use]
            pub const fn with_level(self, level: Level) -> Self {
                match self {
                    $(Self::$variant(one) => Self::$variant(one.with_level(level))),*
                }
            }

            /// Computes S at hits and the derivatives of its weighted sum: see [`Gradients::eval_grad`].
            ///
            /// # Errors
            ///
            /// Returns the errors of [`Gradients::eval_grad`].
            #[inline(never)]
            pub fn eval_grad(
                &self,
                hits: HitColumns<'_>,
                wi: [&[f32]; 3],
                weights: Weights<'_>,
                out: GradColumns<'_, '_>,
            ) -> Result<(), GradError> {
                match self {
                    $(Self::$variant(one) => one.eval_grad(hits, wi, weights, out)),*
                }
            }

            /// Computes S and the density at hits and the derivatives of their weighted sum: see [`Gradients::eval_pdf_grad`].
            ///
            /// # Errors
            ///
            /// Returns the errors of [`Gradients::eval_pdf_grad`].
            #[inline(never)]
            pub fn eval_pdf_grad(
                &self,
                hits: HitColumns<'_>,
                wi: [&[f32]; 3],
                weights: Weights<'_>,
                out: GradColumns<'_, '_>,
            ) -> Result<(), GradError> {
                match self {
                    $(Self::$variant(one) => one.eval_pdf_grad(hits, wi, weights, out)),*
                }
            }

            /// Turns derivatives by the numbers of the material into derivatives by parameters: see [`Gradients::by_parameters`].
            #[inline(never)]
            #[must_use]
            pub fn by_parameters(&self, d_material: &[f64]) -> Values<f64> {
                match self {
                    $(Self::$variant(one) => one.by_parameters(d_material)),*
                }
            }
        }
    };
}
hairis_variants::for_each_model! { any }
