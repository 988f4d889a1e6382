//! Tests of the matched sampler on the all-Cauchy variant: those of the kernels, run again.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

#[path = "../../kernels/tests/albedo.rs"]
mod albedo;
#[path = "../../kernels/tests/batch.rs"]
mod batch;
#[path = "../../kernels/tests/matched/density.rs"]
mod density;
#[path = "../../kernels/tests/edge.rs"]
mod edge;
#[path = "../../kernels/tests/matched/fireflies.rs"]
mod fireflies;
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
#[path = "../../kernels/tests/matched/seam.rs"]
mod seam;
#[path = "matched/subject.rs"]
mod subject;
#[path = "../../kernels/tests/support.rs"]
mod support;
#[path = "matched/tolerance.rs"]
mod tolerance;
#[path = "../../kernels/tests/values.rs"]
mod values;
#[path = "../../kernels/tests/matched/variance.rs"]
mod variance;
