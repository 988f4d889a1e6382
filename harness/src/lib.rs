//! The harness of `hairis`: what its binary does, as a library so that tests can call it.

pub mod agreement;
pub mod args;
pub mod claims;
pub mod cmd;
pub mod compare;
pub mod config;
pub mod difference;
pub mod efficiency;
pub mod error;
pub mod figures;
mod files;
pub mod light;
pub mod machine;
pub mod markup;
pub mod plot;
pub mod quadrature;
pub mod report;
pub mod sampler;
pub mod sequence;
pub mod speed;
pub mod stats;
pub mod study;
pub mod subject;
pub mod table;

/// The example of the README, held to what it says.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
#[derive(Debug)]
pub struct Readme;
