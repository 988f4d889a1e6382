//! Handles of any model: materials and BSDFs, of one lane and of eight, with calls on columns and on columns of hits.

mod bsdf;
mod columns;
mod conserving;
mod dynamic;
mod hits;
pub(crate) mod kernels;
mod material;

pub use bsdf::{Bsdf, Bsdf8};
pub use dynamic::{DynBsdf, DynBsdf8};
pub use hits::{HitsError, MaterialTable};
pub use material::{Material, Material8};

/// Traits of handles that `derive` would bound by the traits of the model.
macro_rules! handle_impls {
    ($($name:ident $field:ident $constants:ident<$C:ty>;)*) => { $(
        impl<M: $crate::model::Model> Clone for $name<M> {
            #[inline]
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<M: $crate::model::Model> Copy for $name<M> {}
        impl<M: $crate::model::Model<$constants<$C>: PartialEq>> PartialEq for $name<M> {
            #[inline]
            fn eq(&self, other: &Self) -> bool {
                self.$field == other.$field
            }
        }
        impl<M: $crate::model::Model> core::fmt::Debug for $name<M> {
            #[inline]
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.debug_tuple(stringify!($name)).field(&self.$field).finish()
            }
        }
    )* };
}
use handle_impls;

/// Methods that select and return the level of a handle.
macro_rules! level_methods {
    () => {
        /// Selects another instruction set; handles made from this one inherit it.
        #[inline]
        #[must_use]
        pub const fn with_level(self, level: Level) -> Self {
            Self { level, ..self }
        }

        /// Returns the instruction set that calls of eight lanes and of columns run on.
        #[inline]
        #[must_use]
        pub const fn level(&self) -> Level {
            self.level
        }
    };
}
pub(crate) use level_methods;
