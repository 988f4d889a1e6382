//! Compares scalar with SIMD and Gaussian with Cauchy hair scattering.

pub mod markup;
pub mod plot;
pub mod table;
