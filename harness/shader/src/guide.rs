//! Guide to the command `hairis shader`.
//!
//! | chapter | question |
//! |---|---|
//! | [`shader`] | How does a model become source of another language? |

#[doc = "[arithmetic]: https://docs.rs/hairis-shaders/latest/hairis_shaders/guide/generated/#arithmetic
[eval]: https://docs.rs/hairis-harness/latest/hairis_harness/guide/eval/
[generated]: https://docs.rs/hairis-shaders/latest/hairis_shaders/guide/generated/

"]
#[doc = include_str!("guide/shader.md")]
pub mod shader {}
