//! Value and density of a direction: the reference in `f32`, one lane, eight lanes (at one shading point, and at eight)
//! and slices, long and shorter than a packet, on every level.
//!
//! `cargo bench -p hairis-benches --bench eval`, with `-- eval/gaussian` for one group. Throughput is in directions.

mod timing;

use criterion::{Criterion, criterion_group, criterion_main};
use hairis_benches::Op;

fn eval(c: &mut Criterion) {
    timing::bench(c, Op::Eval);
}

criterion_group!(benches, eval);
criterion_main!(benches);
