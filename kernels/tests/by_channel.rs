//! Tests of the matched sampler whose lobes are chosen by channel: those of the published one that name a subject, run
//! again, and its own.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod edge;
mod lobes;
mod parity;
mod props;
mod sampling;
#[path = "by_channel/subject.rs"]
mod subject;
mod support;
#[expect(dead_code, reason = "albedo, seam, gains and densities of a lobe are those of the other matched samplers")]
#[path = "matched/tolerance.rs"]
mod tolerance;
mod values;
#[path = "by_channel/variance.rs"]
mod variance;
