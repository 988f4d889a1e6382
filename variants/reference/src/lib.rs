//! Formulas of the models of [`hairis`] line by line, in `f32` and in `f64`: the second source of each model beside its kernel.
//!
//! In `f64` the formulas are the reference of tests and reports. In `f32` they are the scalar baseline of speed comparisons, the
//! code that people write from the papers today. The kernels share no code with the formulas, only the plain structs of their
//! parameters.
//!
//! | model | formulas | source |
//! |---|---|---|
//! | [`Published`](hairis::Published) over any bell | [`HairReference`] | Ou et al. 2012 |
//! | [`Matched`](hairis::Matched) over any bell | [`MatchedReference`] | ours |
//! | [`KajiyaKay`](hairis_variants::KajiyaKay) | [`KajiyaKayReference`] | Kajiya & Kay 1989 |
//! | [`Chiang`](hairis_variants::Chiang) | [`ChiangReference`] | Chiang et al. 2016 |
//! | [`ScatteringChiang`](hairis_variants::chiang::ScatteringChiang) | [`ChiangConstants::with_scattering`] | OSL's BSDL |
//! | [`DEon`](hairis_variants::DEon) | [`DEonReference`], and as RTXCR has it [`RtxcrReference`] | d'Eon 2022 |
//!
//! All implement [`Reference`], and `Box<dyn Reference<f64>>` is the handle of a model chosen at run time: see [`reference()`] for
//! the models of the registry, and [`HairFormulas`] for the published model. [`Formulas`] pairs a kernel with its formulas.
//!
//! [`truth`] traces light through a rough, tilted, elliptic fibre with a medulla, which all models approximate.
//!
//! - Conventions: those of [`hairis`]. `wo` is the paper's `omega_r`, `wi` its `omega_i`.
//! - Numbers: [`Real`], with the elementary functions of `libm` unless the caller provides others.
#![cfg_attr(
    hairis_one,
    allow(unused_imports, reason = "other models are left out")
)]

pub mod agreement;
mod chiang;
mod cylinder;
mod d_eon;
pub mod errata;
mod interface;
mod kajiya_kay;
mod published;
mod quadrature;
mod real;
mod registry;
mod steps;
pub mod truth;
mod with_diffuse;

pub use chiang::{ChiangConstants, ChiangFormulas, ChiangReference, Selection, bessel_i0_scaled};
pub use d_eon::{DEonReference, RtxcrFaults, RtxcrReference};
pub use interface::{LobeAt, Reference, ReferenceSample};
pub use kajiya_kay::{KajiyaKayConstants, KajiyaKayReference, cosine_power_integral};
pub use published::{CauchyDensity, HairFormulas, HairReference, MatchedReference, Shape};
pub use quadrature::integrate;
pub use real::Real;
pub use registry::{
    Accuracy, Formulas, Visitor, accuracy, exact_reference, reference, slack, visit,
};

pub use with_diffuse::{WithDiffuseConstants, WithDiffuseReference};

/// Examples of the package's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[derive(Debug)]
pub struct Readme;
