//! Tests of the kernels: one binary, a module a subject.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod albedo;
mod batch;
mod edge;
mod lobes;
mod math;
mod params;
mod parity;
mod props;
mod quadrature;
mod sampling;
mod subject;
mod support;
mod textbook;
mod tolerance;
mod values;
mod weights;
