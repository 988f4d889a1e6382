//! Tests of the renderer.

mod segments;
