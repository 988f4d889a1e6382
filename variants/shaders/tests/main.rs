//! Tests that compare printed source and traced graphs with the models themselves.

mod bits;
mod c;
mod cuda;
mod dual;
mod gradients;
mod languages;
mod material;
mod names;
mod operations;
mod python;
mod records;
mod slang;
mod support;
mod traps;
mod vulkan;
