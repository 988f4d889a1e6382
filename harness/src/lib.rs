//! Compares scalar with SIMD and Gaussian with Cauchy hair scattering.

pub mod figures;
pub mod markup;
pub mod plot;
pub mod report;
pub mod table;
