//! Guide to generated source code, chapter by chapter.
//!
//! | chapter | question |
//! |---|---|
//! | [`generated`] | Which functions does a file have, which languages are there, and which bits do they return? |
//! | [`tracing`] | How does a program in Rust trace, print, shrink and differentiate a model? |

// Link targets precede the ones in the Markdown file, which are for readers of the repository: the first definition of a target counts.
#[doc = "[energy]: https://docs.rs/hairis/latest/hairis/guide/energy/\n[speed]: https://docs.rs/hairis-benches/latest/hairis_benches/guide/gpu/\n[readme]: crate\n\n"]
#[doc = include_str!("guide/generated.md")]
pub mod generated {}

#[doc = include_str!("guide/tracing.md")]
pub mod tracing {}
