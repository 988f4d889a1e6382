//! The comparison of hair scattering kernels: the commands of the binary, lights, number sequences, quadrature and statistics, and what a report says of the machine.

pub mod args;
pub mod cmd;
pub mod config;
pub mod error;
pub mod light;
pub mod machine;
pub mod quadrature;
pub mod sequence;
pub mod stats;
