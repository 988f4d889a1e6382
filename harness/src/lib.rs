//! The comparison of hair scattering kernels: lights, number sequences, quadrature and statistics, and what a report says of the machine.

pub mod agreement;
pub mod light;
pub mod quadrature;
pub mod sequence;
pub mod speed;
pub mod stats;
pub mod subject;
