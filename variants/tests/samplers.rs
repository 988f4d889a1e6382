//! Tests of models that only the feature `every-sampler` puts into the list, and of samplers that differ from a tested one by a choice. They
//! are a program of their own, which `cargo test` leaves out: `cargo test --workspace --test samplers`, as CI does.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

#[allow(dead_code, reason = "the main tests have the matched sampler")]
mod cauchy_hair;
#[allow(dead_code, reason = "the main tests have the matched sampler")]
mod cauchy_rows;
#[allow(dead_code, reason = "the main tests have its formulas")]
mod diffuse;
#[allow(dead_code, reason = "the main tests have its far field")]
mod fiber;
#[path = "../../kernels/tests/hair.rs"]
#[allow(dead_code, reason = "the tests of the kernels have the other samplers")]
mod hair;
// The bounds of hair, not those of the all-Cauchy variant.
#[path = "../../kernels/tests/rows.rs"]
mod rows;
mod scattering;

use diffuse::Diffuse;
use fiber::ChiangFibers;
use hair::{Bands, PublishedHair};
use hairis_conformance::published::{Family, support};
use hairis_conformance::{AsConserving, conformance};

conformance!(chiang_diffuse, AsConserving(Diffuse(ChiangFibers::<false>)));
conformance!(
    cauchy_diffuse,
    AsConserving(Diffuse(Family::<cauchy_hair::PublishedHair>::new())),
    but hits
);
conformance!(
    gaussian_diffuse,
    AsConserving(Diffuse(Family::<PublishedHair>::new())),
    sampler
);
conformance!(
    gaussian_diffuse_matched,
    AsConserving(Diffuse(Family::<Bands<9>>::new())),
    sampler
);
conformance!(
    chiang_by_channel,
    AsConserving(ChiangFibers::<true>),
    sampler
);
