//! Tests of the kernels: one binary, a module a subject. With `--cfg hairis_one`, for developers, those of the samplers with other constants
//! than a tested one are left out, and those that are slow to compile.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]
#![cfg_attr(
    hairis_one,
    allow(dead_code, unused_imports, reason = "some tests are left out")
)]

#[cfg(not(hairis_one))]
mod by_channel;
#[cfg(not(hairis_one))]
mod conserving;
mod default_level;
mod family;
mod frames;
#[cfg(not(hairis_one))]
mod hits;
mod math;
mod params;
#[cfg(not(hairis_one))]
mod resample;
mod rows;
mod tolerance;
mod vector;

use hairis_conformance::published::support;
// At opt-level 1 rustc links generic code of other crates: this one has compiled the models for every instruction set.
use hairis_variants as _;
