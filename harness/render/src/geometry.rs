//! Strands of hair, procedural hair, and the meshes of heads.

mod bounds;
mod groom;
mod mesh;
mod spiral;
mod spline;
mod strands;

pub use bounds::Bounds;
pub(crate) use groom::random::{Random, Stream};
pub use groom::{Groom, HEAD, Kind};
pub use mesh::Mesh;
pub(crate) use spiral::golden_spiral;
pub use spline::{Basis, Flattening, Spline};
pub use strands::{Builder, GeometryError, Strands};
