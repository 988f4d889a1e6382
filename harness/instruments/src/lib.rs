//! Modules that the harness and the renderer share: lights, random numbers, integrals, statistics; tables, plots, pages; files, flags
//! and errors.
//!
//! None of the modules depends on an experiment, a scene or a model of hair.

pub mod appended;
pub mod columns;
pub mod direction;
pub mod error;
pub mod files;
pub mod interrupt;
pub mod light;
pub mod machine;
pub mod markup;
pub mod plot;
pub mod program;
pub mod progress;
pub mod quadrature;
pub mod report;
pub mod sequence;
pub mod shard;
pub mod stats;
pub mod table;
