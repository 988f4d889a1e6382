//! Modules that the harness and the renderer share: lights, random numbers, integrals, statistics; tables, plots, pages; and files,
//! flags and errors, which are those of [`hairis_program`].
//!
//! None of the modules depends on an experiment, a scene or a model of hair.

pub mod appended;
pub mod columns;
pub mod direction;
pub mod light;
pub mod machine;
pub mod markup;
pub mod pixels;
pub mod plot;
pub mod progress;
pub mod quadrature;
pub mod record;
pub mod report;
pub mod sequence;
pub mod shard;
pub mod stats;
pub mod table;
pub mod terminal;
mod wrap;

pub use hairis_program::{error, files, interrupt, program};
