//! Tests of the matched sampler: those of the published one that name a subject, run again, and its own.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod albedo;
mod batch;
#[path = "matched/density.rs"]
mod density;
mod edge;
#[path = "matched/fireflies.rs"]
mod fireflies;
mod lobes;
mod parity;
mod props;
mod quadrature;
mod sampling;
#[path = "matched/seam.rs"]
mod seam;
#[path = "matched/subject.rs"]
mod subject;
mod support;
#[path = "matched/tolerance.rs"]
mod tolerance;
mod values;
#[path = "matched/variance.rs"]
mod variance;
