//! The vector layer: lanes, their backends, run-time dispatch and columns. It holds arithmetic, masks and table look-up
//! by index, and nothing of any model.

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod avx2;
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod avx512;
pub(crate) mod columns;
#[cfg(feature = "textbook")]
pub(crate) mod control;
pub(crate) mod dispatch;
pub(crate) mod lanes;
pub(crate) mod pair;
mod portable;
mod scalar;
pub(crate) mod unfused;
