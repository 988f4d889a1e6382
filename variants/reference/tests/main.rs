//! Tests of the formulas: one binary.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod fibers;
mod published;
mod truth;

use hairis_conformance::published::quadrature;
