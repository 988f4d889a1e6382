//! Strands, and what makes them.

mod bounds;
mod strands;

pub use bounds::Bounds;
pub use strands::{Builder, GeometryError, Strands};
