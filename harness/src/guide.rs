//! Guide to the command `hairis`, chapter by chapter.
//!
//! | chapter | question |
//! |---|---|
//! | [`eval`] | Which values, densities and samples does a model return? |
//! | [`compare`] | How fast, how exact and how noisy is each code path and sampler, and does every bound hold? |
//! | [`flags`] | Which flags, exit codes and rules for files do the commands share? |
//! | [`materials`] | How are other models and materials of one's own compared and studied? |
//! | [`rays`] | How much does it save to choose each ray from several candidates? |
//! | [`bells`] | How much variance does each sampler leave, on the Gaussian and on the Cauchy model? |

/// Defines the targets of links in this documentation. They come before the paths that the Markdown files have for readers of the
/// repository, and the first definition of a target counts.
macro_rules! links {
    () => {
        "[bells]: crate::guide::bells
[cauchy]: https://docs.rs/hairis/latest/hairis/guide/cauchy/
[choosing]: https://docs.rs/hairis/latest/hairis/guide/choosing/
[compare]: crate::guide::compare
[eval]: crate::guide::eval
[flags]: crate::guide::flags
[machines]: https://docs.rs/hairis-study/latest/hairis_study/guide/machines/
[materials]: crate::guide::materials
[rays]: crate::guide::rays
[resampling]: https://docs.rs/hairis/latest/hairis/guide/resampling/
[speed]: https://docs.rs/hairis-benches/latest/hairis_benches/guide/speed/
[study]: https://docs.rs/hairis-study/latest/hairis_study/guide/study/

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

chapters! { eval compare flags materials rays bells }
