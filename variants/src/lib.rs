//! Scattering models built on the public traits of [`hairis`], with a registry that lists them by name.
//!
//! | model | content | conserves energy | reciprocal | source |
//! |---|---|---|---|---|
//! | [`Cauchy`] in [`hairis::Published`] | the published model with every Gaussian a Cauchy | no | yes | Ou et al. 2012, section 3.3 |
//! | [`KajiyaKay`] | a diffuse cylinder and one cone of highlights | `kd + ks` of its parameters | one of two forms | Kajiya & Kay 1989 |
//! | [`Chiang`] | near field, absorption in place of colours | yes | no | Chiang et al. 2016; d'Eon et al. 2011 |
//! | [`chiang::ScatteringChiang`] | Chiang's fibre with a fake medulla, which widens lobes | yes | no | OSL's BSDL |
//! | [`DEon`] | far field, absorption and a diffuse part | yes | no | d'Eon 2022 as RTXCR has it; d'Eon et al. 2011 |
//! | [`WithDiffuse<M>`](WithDiffuse) | any model `M` with a Lambertian cylinder beside its lobes | where `M` does | where `M` is | Lambert's law |
//!
//! A model of your own needs no change in the kernels, as `examples/lambert_fiber` shows. A model of this crate also implements
//! [`Registered`], has parameters that implement [`Parameters`], and has a line in `registry.rs`, the only list of models. Hosts can
//! then choose the model at run time ([`ModelId`], [`AnyMaterial`]), and the harness and the benches include it.
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]
#![cfg_attr(
    hairis_one,
    allow(
        unused_imports,
        irrefutable_let_patterns,
        reason = "other models are left out"
    )
)]

#[cfg(all(test, not(all(feature = "any", feature = "serde"))))]
compile_error!(
    "tests of hairis-variants need the features `any` and `serde`: run cargo test -p hairis-variants --features any,serde"
);

mod cauchy;
pub mod chiang;
pub mod color;
mod cone;
mod cylinder;
pub mod d_eon;
mod hair;
pub mod kajiya_kay;
mod parameters;
mod registry;
mod with_diffuse;

pub use cauchy::Cauchy;
pub use chiang::{Chiang, ChiangDesc, ChiangParams};
pub use d_eon::{DEon, DEonDesc, DEonParams};
pub use hair::{RegisteredBell, hair_desc};
pub use kajiya_kay::{KajiyaKay, KajiyaKayDesc, KajiyaKayParams};
pub use parameters::{Draw, Field, FieldError, Kind, Parameters, Values};
#[cfg(feature = "any")]
pub use registry::{AnyBsdf, AnyBsdf8, AnyMaterial, AnyMaterial8};
pub use registry::{ModelId, Registered, Visitor};
pub use with_diffuse::{DiffusePresets, WithDiffuse, WithDiffuseDesc, WithDiffuseParams};

/// All-Cauchy variant of the published model, in which a [`Cauchy`] bell replaces every Gaussian.
pub type AllCauchy = hairis::Published<Cauchy>;

/// All-Cauchy variant of the published model with the matched sampler: see [`hairis::Matched`].
pub type MatchedCauchy = hairis::Matched<Cauchy>;

/// Examples of the package's README, which run as documentation tests.
#[cfg(all(doctest, feature = "any"))]
#[doc = include_str!("../README.md")]
#[derive(Debug)]
pub struct Readme;
