//! Vector layer: lanes, their backends, run-time dispatch and columns. It holds arithmetic, masks and table look-up by index, and
//! nothing of any model.
//!
//! # Soundness
//!
//! Functions of [`Lanes`] are safe, although some backends execute instructions that a CPU may lack. The types of these backends are
//! private, and no public item names one, neither as a bound nor as an associated type (the lints `private_bounds` and
//! `private_interfaces` are errors here). Other crates meet the types only as the parameter of [`Kernel::run`] and [`Row::row`]. A
//! [`Level`] calls these functions, and exists only where its instructions were found. Code that a kernel keeps, such as a pointer
//! to a function over its lanes, may run later and on another thread, because the CPU has the instructions for as long as the
//! process runs (test `lanes_work_outside_the_call_that_they_came_from`).
//!
//! A backend cannot be named:
//!
//! ```compile_fail,E0603
//! let one = <hairis::simd::avx2::Avx2 as hairis::simd::Lanes>::splat(1.0);
//! ```
//!
//! Inference does not find a backend either, neither from the numbers that it reads nor from those that it stores:
//!
//! ```compile_fail,E0283
//! use hairis::simd::{Broadcast, f32x8};
//! let lanes = f32x8::ZERO.lanes();
//! ```
//!
//! ```compile_fail,E0283
//! use hairis::simd::{Lanes, f32x8};
//! fn one<L: Lanes<Stored = f32x8>>() -> f32x8 {
//!     L::splat(1.0).store()
//! }
//! let one = one();
//! ```
//!
//! Other crates cannot add lanes:
//!
//! ```compile_fail,E0277
//! #[derive(Clone, Copy, Debug)]
//! struct Mine(f32);
//! impl hairis::simd::Schedule for Mine {}
//! fn is_scalar<C: hairis::simd::Scalar>() {}
//! is_scalar::<Mine>();
//! ```
#![deny(private_bounds, private_interfaces)]

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod avx2;
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod avx512;
pub(crate) mod choice;
pub(crate) mod columns;
pub(crate) mod control;
pub(crate) mod dispatch;
mod lane_struct;
pub(crate) mod lanes;
pub(crate) mod pair;
pub(crate) mod portable;
mod scalar;
pub(crate) mod schedule;
pub(crate) mod storage;
pub(crate) mod table;
#[cfg(feature = "trace")]
pub mod trace;

pub use crate::frame::Vec3x;
pub use crate::lane_struct;
pub use choice::Choice;
pub use columns::Row;
#[doc(hidden)]
pub use control::{control, set_control};
pub use dispatch::{Kernel, Level};
pub use lane_struct::{LaneStruct, Path, Spread};
pub(crate) use lanes::fresh_lanes3;
pub use lanes::{Broadcast, Lanes, Scalar, lanes3, lanes4, store3, store4};
pub use pair::Pair;
pub use schedule::Schedule;
/// Eight lanes in memory: the vector type of the crate `wide`.
pub use wide::f32x8;
