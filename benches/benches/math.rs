//! The elementary functions of `hairis::model::math` against those of `libm`: one lane, and packets and slices on every level.
//!
//! Each runs through the dispatch of the kernels: figures include reading arguments and writing results.
//!
//! `cargo bench -p hairis-benches --bench math`, with `-- math/atan_unit` for one group. Throughput is in arguments.

#[expect(
    dead_code,
    reason = "the operations of the models are timed by the other benches"
)]
mod timing;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main};
use glam::Vec3;
use hairis::simd::Level;
use hairis_benches::entries::label;
use hairis_benches::inputs::{DIRECTIONS, Inputs, packets};
use hairis_benches::math::{
    Atan2Upper, AtanUnit, Bell, Columns, Eight, Function, SinCosAbsolute, SinCosTwice,
};
use hairis_benches::task::{Each, Slices, Task};

/// Largest error that counts as correct, relative to the value or, where that is below 1, absolute: that of the function
/// whose error is absolute is 2e-7.
const TOLERANCE: f64 = 1e-6;

fn function<F: Function>(c: &mut Criterion) {
    let [x, y] = F::RANGE.map(|[lo, hi]| move |xi: f32| lo + (hi - lo) * xi);
    let arguments: Vec<Vec3> = Inputs::draw()
        .xi
        .iter()
        .map(|xi| Vec3::new(x(xi[0]), y(xi[1]), 0.0))
        .collect();
    let group = &mut c.benchmark_group(format!("math/{}", F::NAME));
    let arrays: Vec<[f32; 3]> = arguments.iter().map(|v| v.to_array()).collect();

    show::<F, _>(group, &arguments, "libm", "scalar", {
        Each::new(1, arguments.clone(), |v| {
            let [first, second] = F::libm(v.x, v.y);
            ([first, second, 0.0], 0.0)
        })
    });
    show::<F, _>(
        group,
        &arguments,
        "one lane",
        "scalar",
        Each::new(1, arguments.clone(), |v| {
            let [first, second] = F::lanes(v.x, v.y);
            ([first, second, 0.0], 0.0)
        }),
    );
    for level in Level::available() {
        let pairs = packets(&arguments).iter().map(|v| [v.x, v.y]).collect();
        let eight = Each::new(8, pairs, move |arguments| {
            level.run(Eight {
                arguments,
                function: F::default(),
            })
        });
        show::<F, _>(group, &arguments, "x8", label(level), eight);
        let slices = Slices::new(DIRECTIONS, &arrays, move |v, mut out: [&mut [f32]; 3]| {
            level.run_rows(Columns(F::default()), v, &mut out);
            Ok(())
        });
        show::<F, _>(group, &arguments, "slices", label(level), slices);
    }
}

/// Checks the answers of one implementation of a function, then times it.
fn show<F: Function, T: Task>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    arguments: &[Vec3],
    entry: &'static str,
    level: &'static str,
    mut task: T,
) {
    let answers = task.answers();
    assert_eq!(
        answers.len(),
        arguments.len(),
        "{} {entry} {level}: answers",
        F::NAME
    );
    for (argument, answer) in arguments.iter().zip(answers) {
        let truth = F::truth(f64::from(argument.x), f64::from(argument.y));
        for (got, want) in answer.value.into_iter().flatten().zip(truth) {
            let error = (f64::from(got) - want).abs() / want.abs().max(1.0);
            assert!(
                error <= TOLERANCE,
                "{} {entry} {level}: {got} for {argument}, not {want}",
                F::NAME
            );
        }
    }
    timing::time(group, entry, level, task);
}

fn math(c: &mut Criterion) {
    function::<Bell>(c);
    function::<AtanUnit>(c);
    function::<Atan2Upper>(c);
    function::<SinCosTwice>(c);
    function::<SinCosAbsolute>(c);
}

criterion_group!(benches, math);
criterion_main!(benches);
