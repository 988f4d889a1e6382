//! Tests of the renderer.

mod groom;
mod import;
mod rays;
mod segments;
