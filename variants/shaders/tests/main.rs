//! Tests: translations against the models themselves.

mod bits;
mod c;
mod languages;
mod support;
mod vulkan;
