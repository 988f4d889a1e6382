//! The entry points of `hairis_benches` as Criterion benches.

use core::time::Duration;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput};
use hairis::simd::Level;
use hairis_benches::{Name, Op, Task, Visitor, entries};

/// Adds all entry points of an operation, one group per model: scalar code and every level.
pub(crate) fn bench(c: &mut Criterion, op: Op) {
    println!(
        "{op}: compiled for {}, eight lanes run on {}",
        Level::portable(),
        Level::detect()
    );
    for (model, _) in entries::MODELS.iter() {
        let mut group = c.benchmark_group(format!("{op}/{model}"));
        entries::visit(
            op,
            &mut Timing {
                group: &mut group,
                model,
            },
        );
        group.finish();
    }
}

struct Timing<'a, 'c> {
    group: &'a mut BenchmarkGroup<'c, WallTime>,
    model: &'static str,
}

impl Visitor for Timing<'_, '_> {
    fn wants(&self, name: &Name) -> bool {
        name.model == self.model
    }

    fn visit<T: Task>(&mut self, name: &Name, task: T) {
        time(self.group, name.entry, name.level, task);
    }
}

/// Times passes over the inputs of one entry point; the throughput is in directions.
pub(crate) fn time<T: Task>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    entry: &'static str,
    level: &'static str,
    mut task: T,
) {
    // Samples of equal length: a hundred of 20 ms, each some hundreds or thousands of passes.
    group
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    group.throughput(Throughput::Elements(
        (task.calls() * task.directions()) as u64,
    ));
    group.bench_function(BenchmarkId::new(entry, level), |b| {
        b.iter(|| {
            for index in 0..task.calls() {
                task.call(index);
            }
        });
    });
}
