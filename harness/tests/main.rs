//! Tests of the harness, as one binary with a module per subject.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod accuracy;
mod agreement;
mod build;
mod cases;
mod chi2;
mod cli;
mod efficiency;
mod figures;
mod journal;
mod lights;
mod materials;
mod rays;
mod sampler;
mod speed;
mod subject;
mod times;
mod variance;
