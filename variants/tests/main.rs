//! Tests of the variants: one binary. Those of the kernels that name a subject are run again on the Cauchy.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

#[path = "../../kernels/tests/albedo.rs"]
mod albedo;
#[path = "../../kernels/tests/batch.rs"]
mod batch;
mod cauchy;
#[path = "../../kernels/tests/edge.rs"]
mod edge;
mod lambert_fiber;
#[path = "../../kernels/tests/lobes.rs"]
mod lobes;
#[path = "../../kernels/tests/parity.rs"]
mod parity;
#[path = "../../kernels/tests/props.rs"]
mod props;
#[path = "../../kernels/tests/quadrature.rs"]
mod quadrature;
#[path = "../../kernels/tests/sampling.rs"]
mod sampling;
mod subject;
#[path = "../../kernels/tests/support.rs"]
mod support;
mod tolerance;
#[path = "../../kernels/tests/values.rs"]
mod values;
#[path = "../../kernels/tests/weights.rs"]
mod weights;
