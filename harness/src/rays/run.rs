//! Run of every model and sampler under every light.

use super::result::{RayFigures, RayPose, RayRow};
use super::{EqualTime, Lit, RaySubject, RayTimes, measure, times};
use crate::efficiency::{Check, EfficiencyResult, THETA_O_DEG, intensity, stratified};
use crate::lights::Lights;
use hairis_instruments::light::{Light, product};
use hairis_instruments::progress::Progress;
use hairis_instruments::sequence::stream_id;
use hairis_instruments::stats::Estimate;
use serde::Serialize;
use std::collections::HashMap;

/// Results about rays that are chosen from candidates.
#[derive(Clone, Debug, Serialize)]
pub struct RaysResult {
    /// Number of pools of 32 + 32 candidates drawn per shading point; smaller pools are parts of them.
    pub pools: usize,
    /// Variances by model, sampler and light, which depend on the seed alone.
    pub rows: Vec<RayRow>,
    /// Times of this machine, in the order of the rows.
    pub times: Vec<RayTimes>,
    /// Efficiencies in equal time, in the order of the rows.
    pub equal_time: Vec<EqualTime>,
    /// Check of the means against their references.
    pub check: Check,
}

/// Settings of a run of the variances and times of rays.
#[derive(Clone, Copy, Debug)]
pub struct RaysConfig<'a> {
    /// Seed of every stream.
    pub seed: u64,
    /// Number of pools of 32 + 32 candidates per shading point.
    pub pools: usize,
    /// Number of passes of 4096 samples for references by stratified runs.
    pub passes: usize,
    /// Number of rounds in which times are measured.
    pub rounds: usize,
    /// Lights that the hair is seen under.
    pub lights: Lights<'a>,
}

impl<'a> RaysConfig<'a> {
    /// Returns the settings of the command line; if `quick`, with fewer pools, passes and rounds.
    #[must_use]
    pub fn new(seed: u64, quick: bool, lights: impl Into<Lights<'a>>) -> Self {
        let [pools, passes, rounds] = if quick { [128, 8, 9] } else { [4096, 64, 31] };
        Self {
            seed,
            pools,
            passes,
            rounds,
            lights: lights.into(),
        }
    }
}

/// Returns the stream of a cell.
fn stream(indices: [u64; 3]) -> u64 {
    stream_id(&[0x5a15_ed00_0001, stream_id(&indices)])
}

/// Measures times, on one thread and first, then variances on all threads. References of the bells are those of `efficiency`. Workers call
/// `progress` with the number of cells done and of all cells.
#[must_use]
pub fn run(
    config: &RaysConfig<'_>,
    efficiency: &EfficiencyResult,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> RaysResult {
    let subjects: Vec<RaySubject> = RaySubject::all().collect();
    let lights = config.lights.all();
    let cells = subjects.len() * lights.len();
    let times = times::measure(&subjects, &lights, config.seed, config.rounds, |done| {
        progress(done, 2 * cells)
    });
    let rows = rows(config, &subjects, &lights, efficiency, &|done, _| {
        progress(cells + done, 2 * cells)
    });
    let equal_time = rows
        .iter()
        .zip(&times)
        .map(|(row, times)| EqualTime::new(row, times))
        .collect();
    RaysResult {
        pools: config.pools,
        check: check(&rows),
        rows,
        times,
        equal_time,
    }
}

/// Measures the variances.
pub fn rows(
    config: &RaysConfig<'_>,
    subjects: &[RaySubject],
    lights: &[&dyn Light],
    efficiency: &EfficiencyResult,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Vec<RayRow> {
    let references = references(config, subjects, lights, efficiency);
    let cells: Vec<(RaySubject, usize)> = subjects
        .iter()
        .flat_map(|subject| (0..lights.len()).map(|light| (*subject, light)))
        .collect();
    Progress::new(cells.len(), progress).map(&cells, |&(subject, light)| {
        let pose = |(pose, theta_o)| {
            let at = [
                config.seed,
                stream([subject.index(), light as u64, pose as u64]),
            ];
            let reference = references[&(subject.model(), light, pose)];
            let lit = Lit {
                scatter: &subject.scatter(pose),
                light: lights[light],
            };
            measure::pose(lit, theta_o, reference, at, config.pools)
        };
        let poses: Vec<RayPose> = THETA_O_DEG.into_iter().enumerate().map(pose).collect();
        RayRow {
            model: subject.model(),
            sampler: subject.sampler(),
            light: lights[light].name().to_owned(),
            mean: RayFigures::mean(&poses.iter().map(|pose| &pose.figures).collect::<Vec<_>>()),
            poses,
        }
    })
}

/// Returns the reference of each model, by index of the light and of the pose.
fn references(
    config: &RaysConfig<'_>,
    subjects: &[RaySubject],
    lights: &[&dyn Light],
    efficiency: &EfficiencyResult,
) -> HashMap<(&'static str, usize, usize), Estimate> {
    let of_model = |subjects: &[RaySubject]| {
        let subject = subjects[0];
        (0..lights.len())
            .flat_map(move |light| (0..THETA_O_DEG.len()).map(move |pose| (subject, light, pose)))
    };
    let cells: Vec<_> = subjects
        .chunk_by(|a, b| a.model() == b.model())
        .flat_map(of_model)
        .collect();
    let reference = |&(subject, light, pose): &(RaySubject, usize, usize)| {
        let key = (subject.model(), lights[light].name(), THETA_O_DEG[pose]);
        let known = efficiency
            .rows
            .iter()
            .find(|row| (row.model.name(), &*row.light, row.theta_o_deg) == key);
        let at = [
            config.seed,
            stream([1 << 32 | subject.index(), light as u64, 0]),
        ];
        let by_run = || by_run(subject, lights[light], pose, at, config.passes);
        (
            (subject.model(), light, pose),
            known.map_or_else(by_run, |row| row.reference.estimate()),
        )
    };
    Progress::new(cells.len(), &|_, _| ())
        .map(&cells, reference)
        .into_iter()
        .collect()
}

/// Returns the mean of RGB by a stratified run over the formulas in double precision, drawn from the light.
fn by_run(
    subject: RaySubject,
    light: &dyn Light,
    pose: usize,
    [seed, stream]: [u64; 2],
    passes: usize,
) -> Estimate {
    let formulas = subject.formulas(pose);
    stratified(
        light,
        [seed, stream_id(&[stream, pose as u64])],
        passes,
        &mut |sample| {
            let (value, cos_theta) = (
                formulas.eval(sample.dir.to_array()),
                sample.dir.y.hypot(sample.dir.z),
            );
            intensity(product(sample.radiance, value.map(|s| s * cos_theta)))
        },
    )
}

/// Checks every bias against one bound.
#[must_use]
pub fn check(rows: &[RayRow]) -> Check {
    let (mut scores, mut untested) = (Vec::new(), 0);
    for row in rows {
        for pose in &row.poses {
            let place = format!(
                "{} {}, {}, theta_o {}",
                row.model, row.sampler, row.light, pose.theta_o_deg
            );
            let (tested, others): (Vec<_>, Vec<_>) = pose.z.iter().partition(|score| score.tested);
            untested += others.len();
            scores.extend(
                tested
                    .iter()
                    .map(|score| (score.z, format!("{place}: mean of {}", score.estimator))),
            );
        }
    }
    Check::of(&scores, untested)
}
