//! Guide to the renderer, chapter by chapter: each module is a Markdown file of the repository.
//!
//! | chapter | question |
//! |---|---|
//! | [`scenes`] | Which scenes are there, and which materials can their hair have? |
//! | [`hair`] | Which files of hair and heads are read and written, and what happens to strands that are damaged? |
//! | [`estimates`] | How is light estimated, and where do uniform numbers come from? |
//! | [`resampled`] | What does it save to trace rays for the best of several candidates? |
//! | [`dual`] | When is dual scattering enough, which follows no paths? |
//! | [`samplers`] | What is each sampler worth on images, and how are errors measured? |
//! | [`fit`] | How is a material recovered from a picture? |
//! | [`runs`] | How does a run continue after a stop, grow, and use several machines? |
//! | [`conventions`] | Which units, maps, layers of files and exit codes are there? |
//! | [`tree`] | How does a ray find hair, and how does that compare with Embree and Mitsuba? |

/// Targets of links in this documentation. They come before the paths that the Markdown files have for readers of the
/// repository, because the first definition of a target counts.
macro_rules! links {
    () => {
        "[dual]: https://docs.rs/hairis/latest/hairis/guide/dual_scattering/
[energy]: https://docs.rs/hairis/latest/hairis/guide/energy/
[estimates]: crate::guide::estimates
[eval]: https://docs.rs/hairis-harness/latest/hairis_harness/guide/eval/
[exits]: crate::guide::conventions#exit-codes
[hair]: crate::guide::hair
[resampled]: crate::guide::resampled
[resampling]: https://docs.rs/hairis/latest/hairis/guide/resampling/

"
    };
}

/// Defines one module per chapter, whose documentation is a Markdown file.
macro_rules! chapters {
    ($($chapter:ident)*) => { $(
        #[doc = links!()]
        #[doc = include_str!(concat!("guide/", stringify!($chapter), ".md"))]
        pub mod $chapter {}
    )* };
}

chapters! { scenes hair estimates resampled dual samplers fit runs conventions tree }
