//! Tests of the variants: one binary.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod accuracy;
mod cauchy;
mod chiang;
mod family;
mod json;
mod kajiya_kay;
mod lambert_fiber;
mod params;
mod registry;
mod rows;
mod values;

use hairis_conformance::published::support;
