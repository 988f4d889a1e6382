//! Guide to the commands of `hairis-study`, chapter by chapter.
//!
//! | chapter | question |
//! |---|---|
//! | [`study`] | How does every sampler of both bells do under every light, over a grid of hair? |
//! | [`machines`] | How does a study continue after a stop, and run on a cluster? |
//! | [`fit`] | Which parameters make one model look like another? |
//! | [`claims`] | Which claims of the paper hold? |
//! | [`looks`] | How different do the Gaussian and the Cauchy model look? |

/// Defines the targets of links in this documentation. They come before the paths that the Markdown files have for readers of the
/// repository, and the first definition of a target counts.
macro_rules! links {
    () => {
        "[eval]: https://docs.rs/hairis-harness/latest/hairis_harness/guide/eval/
[fit]: crate::guide::fit
[flags]: https://docs.rs/hairis-harness/latest/hairis_harness/guide/flags/
[gradients]: hairis_gradients
[looks]: crate::guide::looks
[machines]: crate::guide::machines
[materials]: https://docs.rs/hairis-harness/latest/hairis_harness/guide/materials/
[rays]: https://docs.rs/hairis-harness/latest/hairis_harness/guide/rays/
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

chapters! { study machines fit claims looks }
