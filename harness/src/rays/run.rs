//! Every model and sampler under every light.

use super::result::{RayFigures, RayRow, RaysResult};
use super::{EqualTime, RaySubject, measure, reference, times};
use crate::efficiency::{Check, EfficiencyResult, Reference, THETA_O_DEG};
use crate::light::{Environment, Light};
use crate::progress::Progress;
use crate::sequence::stream_id;
use crate::study::with_built_in_lights;
use rayon::prelude::*;

/// Settings of a run.
#[derive(Clone, Copy, Debug)]
pub struct RaysConfig<'a> {
    /// Seed of every stream.
    pub seed: u64,
    /// Pools of 32 + 32 candidates per shading point.
    pub pools: usize,
    /// Passes of 4096 samples of references by stratified runs.
    pub passes: usize,
    /// Rounds of the times.
    pub rounds: usize,
    /// The environment light.
    pub environment: &'a Environment,
}

impl<'a> RaysConfig<'a> {
    /// The sizes of the command line.
    #[must_use]
    pub const fn new(seed: u64, quick: bool, environment: &'a Environment) -> Self {
        let [pools, passes, rounds] = if quick { [256, 16, 9] } else { [4096, 64, 31] };
        Self { seed, pools, passes, rounds, environment }
    }
}

/// The streams of a cell.
fn stream(indices: [u64; 3]) -> u64 {
    stream_id(&[0x5a15_ed00_0001, stream_id(&indices)])
}

/// Measures times, on one thread and first, then variances on all. References of the bells are those of `efficiency`.
/// `progress` is called from the workers with the number of cells done and of all cells.
#[must_use]
pub fn run(
    config: &RaysConfig<'_>,
    efficiency: &EfficiencyResult,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> RaysResult {
    let subjects: Vec<RaySubject> = RaySubject::all().collect();
    with_built_in_lights(|built_in| {
        let mut lights = built_in.to_vec();
        lights.push(config.environment);
        let cells = subjects.len() * lights.len();
        let times = times::measure(&subjects, &lights, config.seed, config.rounds, |done| progress(done, 2 * cells));
        let rows = rows(config, &subjects, &lights, efficiency, &|done, _| progress(cells + done, 2 * cells));
        let equal_time = rows.iter().zip(&times).map(|(row, times)| EqualTime::new(row, times)).collect();
        RaysResult { pools: config.pools, check: check(&rows), rows, times, equal_time }
    })
}

/// The variances.
pub(super) fn rows(
    config: &RaysConfig<'_>,
    subjects: &[RaySubject],
    lights: &[&dyn Light],
    efficiency: &EfficiencyResult,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Vec<RayRow> {
    let references = references(config, subjects, lights, efficiency);
    let mut cells = Vec::new();
    for subject in subjects {
        for (index, light) in lights.iter().enumerate() {
            cells.push((*subject, index, *light));
        }
    }
    Progress::new(cells.len(), progress).map(&cells, |&(subject, index, light)| {
        let of_model = references.iter().filter(|(model, place, _)| (*model, *place) == (subject.model(), index));
        let poses: Vec<_> = of_model
            .zip(THETA_O_DEG)
            .enumerate()
            .map(|(pose, ((_, _, reference), theta_o))| {
                let at = [config.seed, stream([subject.index(), index as u64, pose as u64])];
                measure::pose(&subject.scatter(pose), light, theta_o, reference, at, config.pools)
            })
            .collect();
        let figures: Vec<RayFigures> = poses.iter().map(|pose| pose.figures.clone()).collect();
        RayRow {
            model: subject.model(),
            sampler: subject.sampler(),
            light: light.name().to_owned(),
            mean: RayFigures::mean(&figures),
            poses,
        }
    })
}

/// The reference of each model under each light, pose by pose.
fn references<'a>(
    config: &RaysConfig<'_>,
    subjects: &[RaySubject],
    lights: &[&dyn Light],
    efficiency: &EfficiencyResult,
) -> Vec<(&'a str, usize, Reference)> {
    let mut cells: Vec<(RaySubject, usize, usize)> = Vec::new();
    let mut last = "";
    for subject in subjects {
        if subject.model() != last {
            last = subject.model();
            for light in 0..lights.len() {
                cells.extend((0..THETA_O_DEG.len()).map(|pose| (*subject, light, pose)));
            }
        }
    }
    let of_cell = |&(subject, index, pose): &(RaySubject, usize, usize)| {
        let light = lights[index];
        let known = reference::known(efficiency, subject, light.name(), pose);
        let at = [config.seed, stream([1 << 32 | subject.index(), index as u64, 0])];
        let reference = known.unwrap_or_else(|| reference::by_run(subject, light, pose, at, config.passes));
        (subject.model(), index, reference)
    };
    cells.par_iter().with_max_len(1).map(of_cell).collect()
}

/// Holds every bias against one bound.
pub(super) fn check(rows: &[RayRow]) -> Check {
    let mut scores = Vec::new();
    let mut untested = 0;
    for row in rows {
        for pose in &row.poses {
            let place = format!("{} {}, {}, theta_o {}", row.model, row.sampler, row.light, pose.theta_o_deg);
            untested += pose.z.iter().filter(|score| !score.tested).count();
            let tested = pose.z.iter().filter(|score| score.tested);
            scores.extend(tested.map(|score| (score.z, format!("{place}: mean of {}", score.estimator))));
        }
    }
    Check::of(&scores, untested)
}
