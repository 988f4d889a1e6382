//! Modules that programs around `hairis` share, whatever they compute: flags, errors and exit codes, files that are written as a whole,
//! signals, and runs of a program in its tests.

pub mod error;
pub mod files;
pub mod interrupt;
pub mod program;
mod signal;
pub mod trial;
