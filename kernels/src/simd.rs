//! The vector layer: lanes, their backends, run-time dispatch and columns. It holds arithmetic, masks and table look-up
//! by index, and nothing of any model.

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod avx2;
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod avx512;
pub(crate) mod columns;
pub(crate) mod control;
pub(crate) mod dispatch;
pub(crate) mod lanes;
pub(crate) mod pair;
mod portable;
mod scalar;
pub(crate) mod unfused;

pub use crate::frame::Vec3x;
pub use crate::lane_struct;
pub use columns::Row;
#[doc(hidden)]
pub use control::{control, set_control};
#[doc(hidden)]
pub use dispatch::Constant;
pub use dispatch::{Kernel, Level};
pub(crate) use lanes::fresh_lanes3;
pub use lanes::{Broadcast, LaneStruct, Lanes, Scalar, lanes3, lanes4, store3, store4};
pub use pair::Pair;
/// Eight lanes in memory: the vector of the crate `wide`.
pub use wide::f32x8;
