//! The harness of `hairis`: the functions of its binary, as a library so that tests can call them.

pub mod agreement;
pub mod args;
pub mod claims;
pub mod cmd;
pub mod compare;
pub mod difference;
pub mod efficiency;
pub mod error;
pub mod figures;
pub mod files;
pub mod light;
pub mod machine;
pub mod markup;
pub mod plot;
pub mod progress;
pub mod quadrature;
pub mod rays;
pub mod report;
pub mod sampler;
pub mod sequence;
pub mod speed;
pub mod stats;
pub mod study;
pub mod subject;
pub mod table;

/// Example of the workspace README.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
#[derive(Debug)]
pub struct Readme;
