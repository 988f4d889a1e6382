//! Tests of the kernels: one binary, a module a subject. With `--cfg hairis_one`, for developers, those that are slow to compile are left
//! out. Samplers that differ from a tested one by constants have a binary of their own.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]
#![cfg_attr(
    hairis_one,
    allow(dead_code, unused_imports, reason = "some tests are left out")
)]

#[cfg(not(hairis_one))]
mod conserving;
mod default_level;
mod family;
mod frames;
mod hair;
mod handles;
#[cfg(not(hairis_one))]
mod hits;
mod lobe_model;
mod math;
mod params;
mod random;
#[cfg(not(hairis_one))]
mod resample;
mod rows;
mod tolerance;
mod vector;

use hairis_conformance::published::support;
// At opt-level 1 rustc links generic code of other crates: this one has compiled the models for every instruction set.
use hairis_variants as _;
