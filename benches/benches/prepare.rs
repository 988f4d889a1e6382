//! Cost of a hit in a path tracer: a shading point alone, and a shading point with 1, 4 and 16 samples of it, whether
//! the lanes of a packet are eight directions at one shading point or eight shading points.
//!
//! `cargo bench -p hairis-benches --bench prepare`, with `-- path-4/gaussian` for one group. Throughput is in shading
//! points for `prepare` and in samples for `path`.

mod timing;

use criterion::{Criterion, criterion_group, criterion_main};
use hairis_benches::Op;

fn prepare(c: &mut Criterion) {
    for op in [Op::Prepare, Op::Path(1), Op::Path(4), Op::Path(16)] {
        timing::bench(c, op);
    }
}

criterion_group!(benches, prepare);
criterion_main!(benches);
