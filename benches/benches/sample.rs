//! A direction with its value, density and weight: the reference in `f32`, one lane, eight lanes (at one shading point,
//! and at eight) and slices, long and shorter than a packet, on every level.
//!
//! `cargo bench -p hairis-benches --bench sample`, with `-- sample/gaussian` for one group. Throughput is in directions.

mod timing;

use criterion::{Criterion, criterion_group, criterion_main};
use hairis_benches::Op;

fn sample(c: &mut Criterion) {
    timing::bench(c, Op::Sample);
}

criterion_group!(benches, sample);
criterion_main!(benches);
