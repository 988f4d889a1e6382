//! Hair scattering, eight lanes at a time.
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]

mod bell;
mod bsdf;
mod dispatch;
mod error;
mod frame;
mod hair;
mod lanes;
mod lobe;
pub mod math;
mod model;
mod params;
mod quadrature;
pub mod random;
#[cfg(feature = "textbook")]
pub mod textbook;
mod truncated;

pub use bell::{Bell, Gaussian};
pub use bsdf::{Bsdf, Bsdf8, Gather, Gather8};
pub use dispatch::Level;
pub use error::ParamError;
pub use frame::{FiberFrame, FiberFrame8, Vec3x, Vec3x8};
pub use hair::{GRAZING, Hair, HairGather, HairMaterial};
pub use lanes::{Broadcast, Lanes, lanes3, store3, store4};
pub use lobe::{Lobe, LobeMask, PerLobe};
pub use model::{Drawn, Eval, Eval8, Hit, Hit8, LobeEval, LobeEval8, Model, Sample, Sample8};
pub use params::{ArtistControls, Glints, HairDesc, HairParams, Highlight, MAX_WIDTH, MIN_WIDTH, Transmission};

#[doc(hidden)]
pub use wide;
