//! Materials of hair that are read from JSON, shared by the programs of the harness.
//!
//! - [`material`]: models of the registry with their parameters.
//! - [`files`]: materials of files, each with a unique name.
//! - [`json`]: JSON values, and refusals that name the field at fault.

mod color;
pub mod files;
pub mod json;
pub mod material;

pub use files::numbered;
pub use json::Json;
pub use material::MaterialSpec;
