//! Integration tests of the renderer.

mod agreement;
mod bits;
mod cli;
mod fit;
mod furnace;
mod groom;
mod heads;
mod import;
mod rays;
mod segments;
mod support;
