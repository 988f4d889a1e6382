#![doc = include_str!("guide/d_eon.md")]

mod params;

pub use params::{DEonDesc, DEonParams};
