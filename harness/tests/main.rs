//! Tests of the harness, as one binary with a module per subject.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod accuracy;
mod cases;
mod chi2;
mod cli;
mod speed;
