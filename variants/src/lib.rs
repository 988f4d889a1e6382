//! Scattering models on top of the public traits of [`hairis`].
//!
//! | model | what it changes | source | status |
//! |---|---|---|---|
//! | [`Cauchy`] in [`hairis::Hair`] | every Gaussian of the published model becomes a Cauchy | Ou et al. 2012, section 3.3 | complete |
//!
//! A model of one's own touches no file of the kernels: `examples/lambert_fiber.rs` is one.
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]

mod cauchy;

pub use cauchy::Cauchy;

/// The all-Cauchy variant of the published model, see [`Cauchy`].
pub type AllCauchy = hairis::Hair<Cauchy>;

/// The all-Cauchy variant with the sampler that follows it closer, see [`hairis::Matched`].
pub type MatchedCauchy = hairis::Matched<Cauchy>;
