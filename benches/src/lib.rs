//! Entry points of the models on fixed inputs, with the expected answers.
//!
//! [`entries::visit`] passes every entry point on every level to a [`Visitor`]: the Criterion benches time all of them, and the program
//! `entry` runs one of them for callgrind and for timing by hand. The module `contenders` (feature `contenders`) contains the calls
//! that `hairis compare` times, on inputs that `hairis compare` draws.

pub mod check;
#[cfg(feature = "contenders")]
pub mod contenders;
pub mod cpu;
pub mod entries;
#[cfg(any(doc, doctest))]
pub mod guide;
pub mod inputs;
pub mod math;
pub mod platform;
pub mod resample;
pub mod task;
pub mod turns;

pub use entries::{Name, Op, Visitor};
pub use task::Task;
