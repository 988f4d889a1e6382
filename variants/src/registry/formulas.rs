//! The formulas of a model chosen at run time.

/// Methods that do the same with each model; after `=>`, the enum that the result goes into.
macro_rules! each {
    ($variants:tt $($(#[$attribute:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),*) -> $out:ty $(=> $into:ident)?;)*) => {
        $(
            $(#[$attribute])*
            $vis fn $name(&self $(, $arg: $type)*) -> $out {
                formulas::each!(@match $variants self $name ($($arg),*) $($into)?)
            }
        )*
    };
    (@match [$($variant:ident)*] $self:ident $name:ident $args:tt) => {
        match $self {
            $(Self::$variant(one) => one.$name $args),*
        }
    };
    (@match [$($variant:ident)*] $self:ident $name:ident $args:tt $into:ident) => {
        match $self {
            $(Self::$variant(one) => $into::$variant(one.$name $args)),*
        }
    };
}
pub(super) use each;

macro_rules! formulas {
    ([$($variant:ident: $model:ty;)*] $variants:tt) => {
        /// The formulas of one of the models at one shading point.
        #[derive(Clone, Copy, Debug)]
        #[non_exhaustive]
        pub enum AnyReference<T: Real> {
            $(#[allow(missing_docs, reason = "named as the model")] $variant(<$model as Registered>::Reference<T>)),*
        }

        impl ModelId {
            /// The formulas for these values, seen from `wo` at the offset `h`.
            ///
            /// # Errors
            ///
            /// If a value is out of its range.
            #[inline(never)]
            pub fn reference<T: Real>(self, values: &Values, wo: [T; 3], h: T) -> Result<AnyReference<T>, ParamError> {
                Ok(match self {
                    $(Self::$variant => AnyReference::$variant(
                        <$model>::reference(&Parameters::from_values(values)?, wo, h),
                    )),*
                })
            }

            /// The formulas for the numbers of `exact`, seen from `wo` at the offset `h`. `values` are the same, rounded.
            ///
            /// # Errors
            ///
            /// If one of `values` is out of its range; `exact` is not checked.
            #[inline(never)]
            pub fn exact_reference<T: Real>(
                self,
                values: &Values,
                exact: &Values<T>,
                wo: [T; 3],
                h: T,
            ) -> Result<AnyReference<T>, ParamError> {
                Ok(match self {
                    $(Self::$variant => {
                        let formulas = <$model>::exact_formulas(&Parameters::from_values(values)?, exact);
                        AnyReference::$variant(<$model>::reference_at(&formulas, wo, h))
                    }),*
                })
            }

            /// The accuracy that comparisons with the formulas require.
            #[inline]
            #[must_use]
            pub const fn accuracy(self) -> Accuracy {
                match self {
                    $(Self::$variant => <$model as Registered>::ACCURACY),*
                }
            }

            /// Absolute error allowed of S, by channel: see [`Registered::slack`].
            ///
            /// # Errors
            ///
            /// If a value is out of its range.
            #[inline]
            pub fn slack(self, values: &Values, wo: [f64; 3], wi: [f64; 3]) -> Result<[f64; 3], ParamError> {
                Ok(match self {
                    $(Self::$variant => <$model>::slack(&Parameters::from_values(values)?, wo, wi)),*
                })
            }
        }

        impl AnyReference<f64> {
            /// The cdf of a sample: see [`Registered::cdf`].
            #[inline]
            #[must_use]
            pub fn cdf(&self, lobe: Lobe, theta_i: f64, phi: f64) -> Option<[f64; 2]> {
                match self {
                    $(Self::$variant(point) => <$model>::cdf(point, lobe, theta_i, phi)),*
                }
            }
        }

        impl<T: Real> Reference<T> for AnyReference<T> {
            formulas::each! { $variants
                #[inline(never)]
                fn eval(wi: [T; 3]) -> [T; 3];
                #[inline(never)]
                fn pdf(wi: [T; 3]) -> T;
                #[inline(never)]
                fn eval_pdf(wi: [T; 3]) -> ([T; 3], T);
                #[inline(never)]
                fn lobes(wi: [T; 3]) -> PerLobe<LobeAt<T>>;
                #[inline(never)]
                fn sample(xi: [T; 3]) -> ReferenceSample<T>;
                #[inline(never)]
                fn albedo() -> PerLobe<[T; 3]>;
            }
        }
    };
}
pub(super) use formulas;
