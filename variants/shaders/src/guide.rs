//! Guide to generated source code, chapter by chapter.
//!
//! | chapter | question |
//! |---|---|
//! | [`generated`] | Which functions does a file have, which languages are there, and which bits do they return? |
//! | [`slang`] | How does a program in Slang differentiate a model, and which bits does it have? |
//! | [`tracing`] | How does a program in Rust trace, print, shrink and differentiate a model? |

// Link targets precede the ones in the Markdown file, which are for readers of the repository: the first definition of a target counts.
#[doc = "[energy]: https://docs.rs/hairis/latest/hairis/guide/energy/\n[speed]: https://docs.rs/hairis-benches/latest/hairis_benches/guide/gpu/\n[dual]: https://docs.rs/hairis/latest/hairis/guide/dual_scattering/\n[readme]: crate\n[slang]: mod@slang\n\n"]
#[doc = include_str!("guide/generated.md")]
pub mod generated {}

#[doc = "[fit]: https://docs.rs/crate/hairis-shaders/latest/source/examples/slang_fit.py\n[functions]: generated#functions\n\n"]
#[doc = include_str!("guide/slang.md")]
pub mod slang {}

#[doc = include_str!("guide/tracing.md")]
pub mod tracing {}
