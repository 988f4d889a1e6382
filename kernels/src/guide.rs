//! Guide: how to shade hair with this crate, chapter by chapter.
//!
//! | chapter | question |
//! |---|---|
//! | [`first_hair`] | How does a renderer shade a hit on a hair? |
//! | [`choosing`] | Which model and which sampler suit a scene? |
//! | [`embedding`] | Which call suits which host, and what does the library ask of it? |
//! | [`platforms`] | On which CPU, how exact, in which floating-point environment? |
//! | [`energy`] | How does hair return no more light than it receives? |
//! | [`dual_scattering`] | How does a renderer without paths shade light that many hairs scattered? |
//! | [`resampling`] | How does one ray serve many candidate directions? |
//! | [`cauchy`] | Is the all-Cauchy model worth its change of look? |
//! | [`writing_a_model`] | How does a scattering model of one's own get lanes, dispatch and tests? |
//! | [`errata`] | Which statements of the paper do not hold? |
//!
//! The examples are tests of the package.

/// Chapters as Markdown files: each module is one of them. Targets of links in this documentation come before the paths that the files
/// have for readers of the repository, and the first definition of a target counts.
macro_rules! chapters {
    ($($chapter:ident = $file:literal;)*) => { $(
        #[doc = "[cauchy]: crate::guide::cauchy\n[errata]: crate::guide::errata\n"]
        #[doc = "[variants]: https://docs.rs/hairis-variants"]
        #[doc = "[fiber]: https://docs.rs/crate/hairis-variants/latest/source/examples/lambert_fiber/lambert_fiber.rs"]
        #[doc = "[speed]: https://docs.rs/hairis-benches/latest/hairis_benches/guide/speed/"]
        #[doc = "[dual]: https://docs.rs/hairis-render/latest/hairis_render/guide/dual/"]
        #[doc = "[hits]: https://docs.rs/hairis-benches/latest/hairis_benches/guide/hits/\n\n"]
        #[doc = include_str!($file)]
        pub mod $chapter {}
    )* };
}

chapters! {
    first_hair = "guide/first_hair.md";
    choosing = "guide/choosing.md";
    embedding = "../EMBEDDING.md";
    platforms = "guide/platforms.md";
    energy = "guide/energy.md";
    dual_scattering = "guide/dual_scattering.md";
    resampling = "guide/resampling.md";
    cauchy = "guide/cauchy.md";
    writing_a_model = "guide/writing_a_model.md";
    errata = "../ERRATA.md";
}
