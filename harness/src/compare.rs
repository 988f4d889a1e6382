//! Main command of the harness: speed, agreement and sample efficiency in one run, with the origin of every figure.

mod charts;
mod page;
mod query;
mod rays;
mod tables;

pub use page::report;
pub use tables::summary as summary_tables;

use crate::agreement::{self, AgreementResult};
use crate::efficiency::{self, EfficiencyConfig, EfficiencyResult, SAMPLERS, SampleCosts};
use crate::materials::{self, MaterialPose, MaterialRow, NamedMaterial};
use crate::rays::{self as ray_figures, RaysConfig, RaysResult};
use crate::speed::{self, SpeedConfig, SpeedReport};
use crate::subject::ModelKind;
use crate::times::{Rounds, Times};
use crate::variance::SampleBudget;
use hairis::ParamError;
use hairis_instruments::light::Environment;
use hairis_instruments::machine;
use hairis_instruments::machine::Machine;
use hairis_instruments::table::Table;
use serde::Serialize;

/// Results of a comparison, written to `compare.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Settings of the command.
    pub settings: CompareSettings,
    /// Machine and build that ran the comparison.
    pub machine: Machine,
    /// Time per direction.
    pub speed: SpeedReport,
    /// Errors against the reference in double precision.
    pub agreement: Vec<AgreementResult>,
    /// Variance per sample.
    pub efficiency: EfficiencyResult,
    /// Variance and time of one ray chosen from many candidates.
    pub rays: RaysResult,
    /// Materials that the flags name, each from the inclinations of `efficiency`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<MaterialPose>,
}

/// Settings of a comparison, as the flags give them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CompareSettings {
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Whether to take a sixteenth of the samples, for a first look and for tests.
    pub quick: bool,
    /// Description of the environment light: a file, or the procedural sky.
    pub environment: String,
    /// Repairs to the environment, and remarks on it.
    pub environment_notes: Vec<String>,
}

/// Runs the comparison. `progress` is called with the name of the part that runs and the share of it that is done, from 0 to 1. Nothing
/// else runs while speed is measured, nor while rays are timed, which is the first step of their part.
///
/// # Errors
///
/// Returns an error only if drawn hair is rejected, which does not happen in practice because all hair is within the accepted ranges.
pub fn run(
    settings: CompareSettings,
    environment: &Environment,
    materials: &[NamedMaterial],
    progress: &(dyn Fn(&'static str, f64) + Sync),
) -> Result<Comparison, ParamError> {
    let CompareSettings { seed, quick, .. } = settings;
    let share = |part| move |done: usize, total: usize| progress(part, done as f64 / total as f64);
    let speed = speed::run(&SpeedConfig::new(seed, quick), |done| {
        progress("speed", done)
    })?;
    let costs = sample_costs(&Times::measure(seed, Rounds::of(quick), None));

    progress("agreement", 0.0);
    let agreement = agreement::run(seed, if quick { 2_000 } else { 40_000 })?;
    progress("agreement", 1.0);

    let variance = EfficiencyConfig {
        costs: Some(costs),
        ..EfficiencyConfig::new(seed, quick, environment)
    };
    let efficiency = efficiency::run(&variance, &share("sample efficiency"))?;
    let rays = ray_figures::run(
        &RaysConfig::new(seed, quick, environment),
        &efficiency,
        &share("rays"),
    );
    let materials = materials::run(
        materials,
        seed,
        SampleBudget::of(quick),
        environment.into(),
        &efficiency::THETA_O_DEG,
        &share("materials"),
    )?;
    Ok(Comparison {
        settings,
        machine: machine!(),
        speed,
        agreement,
        efficiency,
        rays,
        materials,
    })
}

/// Samples of a shading point that share its preparation, as in direct lighting.
const SAMPLES_A_POINT: usize = 16;

/// Returns the times of a sample on eight lanes, set-up included.
fn sample_costs(times: &Times) -> SampleCosts {
    let of = |model| SAMPLERS.map(|sampler| times.ns(model, sampler, SAMPLES_A_POINT).value);
    SampleCosts {
        gaussian: of(ModelKind::Gaussian),
        cauchy: of(ModelKind::Cauchy),
    }
}

impl Comparison {
    fn material_rows(&self) -> Vec<MaterialRow<'_>> {
        self.materials.iter().flat_map(MaterialPose::rows).collect()
    }

    /// Returns the table of the materials that the flags name.
    fn material_table(&self) -> Option<Table> {
        let rows = self.material_rows();
        (!rows.is_empty()).then(|| materials::table(&rows))
    }

    /// Returns one line for each failure: wrong answers, errors beyond their bounds, and biased estimates. Empty if all checks pass.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let slow = self.speed.rows.iter().filter(|row| !row.passed).map(|row| {
            format!(
                "speed: {} {} {} {} gave wrong answers",
                row.op.label(),
                row.model,
                row.contender,
                row.level
            )
        });
        let far = self.agreement.iter().filter(|row| !row.passed).map(|row| {
            let AgreementResult { model, path, level, region, quantity, worst, bound, .. } = row;
            let (region, quantity, sampler) = (region.label(), quantity.label(), row.sampler.unwrap_or_default());
            format!(
                "agreement: {model} {sampler} {path} {level} {region} {quantity}: {worst:.2e} is beyond {bound:.0e}"
            )
        });
        let biased = self
            .efficiency
            .check
            .failures
            .iter()
            .map(|what| format!("efficiency: {what}"));
        let rays = self
            .rays
            .check
            .failures
            .iter()
            .map(|what| format!("rays: {what}"));
        let of_materials = materials::failures(&self.material_rows());
        let of_materials = of_materials.iter().map(|what| format!("materials: {what}"));
        let all = slow.chain(far).chain(biased).chain(rays);
        all.chain(of_materials).collect()
    }
}

/// Returns the values without repetitions, in the order in which they first occur.
fn distinct<T: PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut all = Vec::new();
    for value in values {
        if !all.contains(&value) {
            all.push(value);
        }
    }
    all
}
