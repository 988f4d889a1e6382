//! Tests of `geometry`.

mod spline;
mod strands;
