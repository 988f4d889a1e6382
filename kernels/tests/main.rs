//! Tests of the kernels: one binary, a module a subject.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod by_channel;
mod family;
mod frames;
mod math;
mod params;
mod reference;
mod rows;
mod tolerance;
mod vector;

use hairis_conformance::published::{quadrature, support};
// Linked for what it has compiled already: the published model and its samplers, for every instruction set.
use hairis_variants as _;
