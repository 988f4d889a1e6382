//! Materials of hair from JSON, shared by the programs.
//!
//! - [`material`]: a model of the registry with its parameters.
//! - [`files`]: materials of files, by name.
//! - [`json`]: values, and refusals that name the field at fault.

pub mod files;
pub mod json;
pub mod material;

pub use files::numbered;
pub use json::Json;
pub use material::MaterialSpec;
