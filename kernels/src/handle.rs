//! Handles of any model: a material and a BSDF, in one lane and in eight, over slices and over slices of hits.

mod batch;
mod bsdf;
mod hits;
pub(crate) mod kernels;

pub use bsdf::{Bsdf, Bsdf8, Material, Material8};
pub use hits::{HitsError, MaterialTable};
