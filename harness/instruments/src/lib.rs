//! What the harness and the renderer both measure and report with: lights, numbers, integrals and estimates; tables, plots and
//! pages; files, flags and errors of a program.
//!
//! Nothing here knows an experiment, a scene or a model of hair.

pub mod columns;
pub mod direction;
pub mod error;
pub mod files;
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
