//! Hair scattering, eight lanes at a time.
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]

mod error;
mod lobe;
mod params;
#[cfg(feature = "textbook")]
pub mod textbook;

pub use error::ParamError;
pub use lobe::{Lobe, LobeMask, PerLobe};
pub use params::{ArtistControls, Glints, HairDesc, HairParams, Highlight, MAX_WIDTH, MIN_WIDTH, Transmission};
