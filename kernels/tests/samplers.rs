//! Tests of the samplers that differ from a tested one by constants. They are a program of their own, which `cargo test` leaves out:
//! `cargo test --workspace --test samplers`, as CI does.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod by_channel;
#[allow(dead_code, reason = "the main tests have the other models")]
mod hair;
#[allow(dead_code, reason = "the main tests have the other models")]
mod rows;

use hair::Bands;
use hairis_conformance::published::{Family, support};
use hairis_conformance::{AsConserving, conformance, published};
// At opt-level 1 rustc links generic code of other crates: this one has compiled the models for every instruction set.
use hairis_variants as _;

conformance!(matched_5, AsConserving(Family::<Bands<5>>::new()), sampler);
conformance!(
    matched_25,
    AsConserving(Family::<Bands<25>>::new()),
    sampler
);
conformance!(
    matched_by_channel,
    AsConserving(Family::<Bands<9, true>>::new()),
    sampler
);

published!(by_channel_family, crate::hair::Bands<9, true>, common);
