//! Harness of `hairis`: the functions of its binary, as a library so that tests can call them.

pub mod agreement;
pub mod args;
pub mod cmd;
pub mod compare;
pub mod efficiency;
pub mod figures;
#[cfg(any(doc, doctest))]
pub mod guide;
pub mod journal;
pub mod lights;
pub mod materials;
pub mod rays;
pub mod sampler;
pub mod sealed;
pub mod speed;
pub mod subject;
pub mod timer;
pub mod times;
pub mod variance;

/// Example of the workspace README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
#[derive(Debug)]
pub struct Readme;
