//! Materials of hair from JSON, shared by the programs.
//!
//! - [`material`]: a model of the registry with its parameters.
//! - [`json`]: values, and refusals that name the field at fault.

pub mod json;
pub mod material;

pub use json::Json;
pub use material::MaterialSpec;
