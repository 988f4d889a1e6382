//! Tests of the kernels: one binary, a module a subject.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod params;
mod quadrature;
mod textbook;
