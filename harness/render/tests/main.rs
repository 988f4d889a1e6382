//! Tests of the renderer.

mod groom;
mod segments;
