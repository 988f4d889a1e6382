//! Guide to the command `hairis`, chapter by chapter.
//!
//! | chapter | question |
//! |---|---|
//! | [`eval`] | Which values, densities and samples does a model return? |
//! | [`compare`] | How fast, how exact and how noisy is each code path and sampler, and does every bound hold? |
//! | [`study`] | How does every sampler of both bells do under every light, over a grid of hair? |
//! | [`shader`] | How does a model become source of another language? |
//! | [`fit`] | Which parameters make one model look like another? |
//! | [`claims`] | Which claims of the paper hold? |
//! | [`flags`] | Which flags, exit codes and rules for files do the commands share? |
//! | [`materials`] | How are other models and materials of one's own compared and studied? |
//! | [`rays`] | How much does it save to choose each ray from several candidates? |
//! | [`bells`] | How much variance does each sampler leave, on the Gaussian and on the Cauchy model? |
//! | [`looks`] | How different do the Gaussian and the Cauchy model look? |
//! | [`machines`] | How does a study continue after a stop, and run on a cluster? |

/// Defines the targets of links in this documentation. They come before the paths that the Markdown files have for readers of the
/// repository, and the first definition of a target counts.
macro_rules! links {
    () => {
        "[arithmetic]: https://docs.rs/hairis-shaders/latest/hairis_shaders/guide/generated/#arithmetic
[bells]: crate::guide::bells
[cauchy]: https://docs.rs/hairis/latest/hairis/guide/cauchy/
[choosing]: https://docs.rs/hairis/latest/hairis/guide/choosing/
[compare]: crate::guide::compare
[eval]: crate::guide::eval
[fit]: crate::guide::fit
[flags]: crate::guide::flags
[generated]: https://docs.rs/hairis-shaders/latest/hairis_shaders/guide/generated/
[gradients]: hairis_gradients
[looks]: crate::guide::looks
[machines]: crate::guide::machines
[materials]: crate::guide::materials
[rays]: crate::guide::rays
[resampling]: https://docs.rs/hairis/latest/hairis/guide/resampling/
[speed]: https://docs.rs/hairis-benches/latest/hairis_benches/guide/speed/
[study]: crate::guide::study

"
    };
}

/// Declares chapters, each of which is a module with a Markdown file.
macro_rules! chapters {
    ($($chapter:ident)*) => { $(
        #[doc = links!()]
        #[doc = include_str!(concat!("guide/", stringify!($chapter), ".md"))]
        pub mod $chapter {}
    )* };
}

chapters! { eval compare study shader fit claims flags materials rays bells looks machines }
