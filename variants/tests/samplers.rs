//! Tests of samplers that differ from a tested one by a choice. They are a program of their own, which `cargo test` leaves out:
//! `cargo test --workspace --test samplers`, as CI does.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod fiber;

use fiber::ChiangFibers;
use hairis_conformance::published::support;
use hairis_conformance::{AsConserving, conformance};

conformance!(
    chiang_by_channel,
    AsConserving(ChiangFibers::<true>),
    sampler
);
