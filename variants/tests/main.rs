//! Tests of the variants: one binary. With `--cfg hairis_one`, for developers, those of one model.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]
#![cfg_attr(
    hairis_one,
    allow(
        dead_code,
        unused_imports,
        reason = "tests of other models are left out"
    )
)]

#[cfg(not(hairis_one))]
mod accuracy;
#[cfg(any(not(hairis_one), hairis_one = "cauchy"))]
mod cauchy;
#[cfg(any(not(hairis_one), hairis_one = "cauchy"))]
mod cauchy_hair;
mod cauchy_rows;
#[cfg(any(not(hairis_one), hairis_one = "chiang"))]
mod chiang;
#[cfg(not(hairis_one))]
mod color;
#[cfg(any(not(hairis_one), hairis_one = "d-eon"))]
mod d_eon;
#[cfg(not(hairis_one))]
#[allow(
    dead_code,
    reason = "the samplers' tests have the subject of the suites"
)]
mod diffuse;
#[cfg(not(hairis_one))]
mod dual_scattering;
#[cfg(any(not(hairis_one), hairis_one = "cauchy"))]
mod family;
#[cfg(any(not(hairis_one), hairis_one = "chiang"))]
mod fiber;
#[cfg(not(hairis_one))]
mod json;
#[cfg(any(not(hairis_one), hairis_one = "kajiya-kay"))]
mod kajiya_kay;
#[cfg(not(hairis_one))]
mod lambert_fiber;
mod like;
#[cfg(not(hairis_one))]
mod params;
#[cfg(not(hairis_one))]
mod registry;
#[cfg(not(hairis_one))]
mod values;
#[cfg(not(hairis_one))]
mod with_diffuse;

use hairis_conformance::published::support;
