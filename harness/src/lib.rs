//! The harness of `hairis`: what its binary does, as a library so that tests can call it.

pub mod args;
pub mod cmd;
pub mod config;
pub mod error;
pub mod light;
pub mod machine;
pub mod quadrature;
pub mod sequence;
pub mod stats;
