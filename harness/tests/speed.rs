//! Tests of the timings.

mod contests;
mod threads;

use hairis::simd::Level;
use hairis_harness::speed::{SpeedConfig, TimedOp, run};
use hairis_variants::ModelId;

#[test]
fn every_contender_is_timed_and_right() {
    let mut last = 0.0;
    let report = run(
        &SpeedConfig {
            seconds: 0.0,
            seed: 1,
        },
        |done| last = done,
    )
    .expect("hair within range");
    // Slices take part if a shading point is given: evaluation and sampling, and short ones and packets just written unless all directions
    // are in the tails. Eight lanes at one shading point take part if it has several samples, and slices of hits if it has one. With
    // `Conserving` they take part as well, for models that do not conserve energy by their parameters: those of the published model.
    let levels = Level::available().count();
    let models = ModelId::defaults_of_names().count();
    let published = ModelId::defaults_of_names()
        .filter(|id| id.fields()[0].name == "alpha")
        .count();
    assert_eq!(
        report.rows.len(),
        models * (TimedOp::ALL.len() * (3 + levels) + 13 * levels) + published * 3 * levels,
        "a row is missing"
    );
    assert!(last >= 1.0, "progress ended at {last}");
    for row in &report.rows {
        assert!(row.passed, "wrong answers: {row:?}");
        assert!(
            row.rounds == 15 && row.ns > 0.0 && row.ns_q1 <= row.ns && row.ns <= row.ns_q3,
            "{row:?}"
        );
    }
    for op in TimedOp::ALL {
        let name = op.label();
        for model in ModelId::defaults_of_names() {
            let references = report
                .rows
                .iter()
                .filter(|row| row.contender == "reference");
            let ratios = references
                .filter(|row| (row.op, row.model) == (op, model.name()))
                .map(|row| row.ratio);
            let ratios: Vec<f64> = ratios.collect();
            assert!(
                ratios.len() == 2 && ratios.contains(&1.0),
                "{name}, {}: ratios are to one of {ratios:?}",
                model.name()
            );
        }
    }
    let row = report.row(
        TimedOp::Sample,
        "cauchy",
        "eight lanes",
        Level::portable().name(),
    );
    assert!(row.is_some(), "the portable level is always there");
}
