//! Guide to the figures, chapter by chapter.
//!
//! | chapter | question |
//! |---|---|
//! | [`speed`] | How long does a direction take, with which call, on which instruction set? |
//! | [`hand`] | How close do the kernels come to code that is written with intrinsics? |
//! | [`hits`] | What do energy conservation, several materials and derivatives cost per hit? |
//! | [`gpu`] | How many generated calls does a GPU make per second? |

// Targets of links come before the paths in the Markdown files, which are for readers of the repository: the first
// definition of a target counts.

#[doc = "[resampling]: https://docs.rs/hairis/latest/hairis/guide/resampling/\n\n"]
#[doc = include_str!("guide/speed.md")]
pub mod speed {}

#[doc = "[accuracy]: https://docs.rs/hairis/latest/hairis/guide/platforms/#accuracy\n\n"]
#[doc = include_str!("guide/hand.md")]
pub mod hand {}

#[doc = "[gradients]: https://docs.rs/hairis-gradients\n\n"]
#[doc = include_str!("guide/hits.md")]
pub mod hits {}

#[doc = "[ports]: https://docs.rs/crate/hairis-benches/latest/source/benches/cuda/\n\n"]
#[doc = include_str!("guide/gpu.md")]
pub mod gpu {}
