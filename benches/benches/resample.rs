//! Candidates for rays: proposals and weights of slices and of eight hits, a pool of 32 + 32 candidates of which 16 rays are
//! chosen, and reservoirs of eight hits, on every level.
//!
//! `cargo bench -p hairis-benches --bench resample`, with `-- resample/gaussian` for one group. Throughput is in candidates.

mod timing;

use criterion::{Criterion, criterion_group, criterion_main};
use hairis_benches::Op;

fn resample(c: &mut Criterion) {
    timing::bench(c, Op::Resample);
}

criterion_group!(benches, resample);
criterion_main!(benches);
