//! Scattering models on top of the public traits of [`hairis`].
//!
//! | model | content | conserves energy | reciprocal | source |
//! |---|---|---|---|---|
//! | [`Cauchy`] in [`hairis::Published`] | the published model with every Gaussian a Cauchy | no | yes | Ou et al. 2012, section 3.3 |
//! | [`KajiyaKay`] | a diffuse cylinder and one cone of highlights | `kd + ks` of its parameters | one of two forms | Kajiya & Kay 1989 |
//! | [`Chiang`] | near field, absorption in place of colours | yes | no | Chiang et al. 2016; d'Eon et al. 2011 |
//!
//! A model of your own needs no change in the kernels: `examples/lambert_fiber` is one. A model of
//! this crate also has
//! [`Parameters`], an implementation of [`Registered`], and a line in `registry.rs`, the only list of models. Hosts can then
//! choose it at run time ([`ModelId`], [`AnyMaterial`]), and the harness and the benches include it.
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]

#[cfg(all(test, not(all(feature = "any", feature = "serde"))))]
compile_error!(
    "tests of hairis-variants need the features `any` and `serde`: run cargo test -p hairis-variants --features any,serde"
);

mod cauchy;
pub mod chiang;
mod hair;
pub mod kajiya_kay;
mod parameters;
mod registry;

pub use cauchy::Cauchy;
pub use chiang::{Chiang, ChiangDesc, ChiangParams};
pub use hair::{RegisteredBell, hair_desc};
pub use kajiya_kay::{KajiyaKay, KajiyaKayDesc, KajiyaKayParams};
pub use parameters::{Draw, Field, FieldError, Kind, Parameters, Values};
#[cfg(feature = "any")]
pub use registry::{AnyBsdf, AnyBsdf8, AnyMaterial, AnyMaterial8};
pub use registry::{ModelId, Registered, Visitor};

/// The all-Cauchy variant of the published model, see [`Cauchy`].
pub type AllCauchy = hairis::Published<Cauchy>;

/// The all-Cauchy variant with the matched sampler, see [`hairis::Matched`].
pub type MatchedCauchy = hairis::Matched<Cauchy>;

/// Examples of the package's README.
#[cfg(all(doctest, feature = "any"))]
#[doc = include_str!("../README.md")]
#[derive(Debug)]
pub struct Readme;
