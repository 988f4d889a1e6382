//! Tests of the kernels: one binary, a module a subject.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod by_channel;
mod conserving;
mod default_level;
mod family;
mod frames;
mod hits;
mod math;
mod params;
mod resample;
mod rows;
mod tolerance;
mod vector;

use hairis_conformance::published::support;
// At opt-level 1 rustc links generic code of other crates: this one has compiled the models for every instruction set.
use hairis_variants as _;
