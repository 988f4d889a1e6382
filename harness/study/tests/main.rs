//! Tests of studies, fits and claims, as one binary with a module per subject.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod claims;
mod cli;
mod difference;
mod fit;
mod lights;
mod study;
mod truth;
