//! A hair renderer that measures what scattering models and their samplers are worth on images.
//!
//! - [`geometry`]: strands of hair, procedural hair, and meshes of heads.
//! - [`formats`]: files of hair, which are read and written.
//! - [`tree`]: the search for the segment that a ray meets first.
//!
//! # Conventions
//!
//! - **Unit.** Lengths are in centimetres.
//! - **Strands.** Polylines from root to tip with a radius per node. A segment is the truncated cone between two nodes. It
//!   is numbered by its node on the root side, so that the tips' numbers belong to no segment.
//! - **Hits.** A ray meets a segment where it passes nearer to the axis than the radius there: the ribbon through the axis
//!   that faces the ray. The distance is measured at the axis. The published model is far-field, and treats a fibre as a line.

pub mod args;
pub mod camera;
pub mod cmd;
mod environment;
pub mod figures;
pub mod film;
pub mod fit;
pub mod formats;
pub mod geometry;
#[cfg(any(doc, doctest))]
pub mod guide;
pub mod hair;
pub mod layers;
pub mod lights;
mod linear;
pub mod material;
pub mod memory;
pub mod numbers;
pub mod part;
pub mod picture;
pub mod portrait;
pub mod protocol;
pub mod saver;
pub mod scalp;
pub mod scene;
pub mod scenes;
pub mod transport;
pub mod tree;
