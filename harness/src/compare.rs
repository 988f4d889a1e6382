//! The main job: speed, agreement and sample efficiency in one run, with every figure's origin.

mod charts;
mod page;
mod rays;
mod tables;

pub use page::report;
pub use tables::{Depth, tables};

use crate::agreement::{self, AgreementResult};
use crate::efficiency::{self, EfficiencyConfig, EfficiencyResult, SAMPLERS, SampleCosts};
use crate::light::Environment;
use crate::machine::Machine;
use crate::rays::{self as ray_figures, RaysConfig, RaysResult};
use crate::speed::{self, SpeedConfig, SpeedReport};
use crate::study::output::Times;
use crate::subject::ModelKind;
use hairis::ParamError;
use serde::Serialize;

/// Settings of a comparison.
#[derive(Clone, Copy, Debug)]
pub struct CompareConfig<'a> {
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// A tenth of the samples: for a first look, and for tests.
    pub quick: bool,
    /// The environment light.
    pub environment: &'a Environment,
    /// Description of the environment in the report: a file, or the procedural sky.
    pub environment_name: &'a str,
}

/// Everything that was found; `compare.json` is this.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The command's settings.
    pub settings: CompareSettings,
    /// Where it ran, and what ran.
    pub machine: Machine,
    /// Time a direction.
    pub speed: SpeedReport,
    /// Errors against the reference in double precision.
    pub agreement: Vec<AgreementResult>,
    /// Variance a sample.
    pub efficiency: EfficiencyResult,
    /// One ray for many candidates.
    pub rays: RaysResult,
}

/// The settings of a comparison.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CompareSettings {
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Whether it was the short run.
    pub quick: bool,
    /// The environment light.
    pub environment: String,
    /// Repairs to the environment, and remarks on it.
    pub environment_notes: Vec<String>,
}

/// The parts of a comparison, in the order in which they run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Timing; nothing else runs meanwhile.
    Speed,
    /// Errors against the oracle.
    Agreement,
    /// Variances.
    Efficiency,
    /// Rays chosen from candidates; they are timed first, and nothing else runs meanwhile.
    Rays,
}

impl Part {
    /// Name in a progress bar.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Agreement => "agreement",
            Self::Efficiency => "sample efficiency",
            Self::Rays => "rays",
        }
    }
}

/// Runs the comparison. `progress` is told the part and the share of it that is done, from 0 to 1.
///
/// # Errors
///
/// Never in practice: the hair that is compared is within the accepted ranges.
pub fn run(config: &CompareConfig<'_>, progress: &(dyn Fn(Part, f64) + Sync)) -> Result<Comparison, ParamError> {
    let speed = speed::run(&SpeedConfig::new(config.seed, config.quick), |done| progress(Part::Speed, done))?;
    let costs = sample_costs(&Times::measure(config.seed, config.quick, None));

    progress(Part::Agreement, 0.0);
    let agreement = agreement::run(config.seed, if config.quick { 4_000 } else { 40_000 })?;
    progress(Part::Agreement, 1.0);

    let variance =
        EfficiencyConfig { costs: Some(costs), ..EfficiencyConfig::new(config.seed, config.quick, config.environment) };
    let efficiency = efficiency::run(&variance, &|done, total| {
        #[expect(clippy::cast_precision_loss, reason = "counts of cells, below a thousand")]
        progress(Part::Efficiency, done as f64 / total as f64);
    })?;

    let settings_of_rays = RaysConfig::new(config.seed, config.quick, config.environment);
    let rays = ray_figures::run(&settings_of_rays, &efficiency, &|done, total| {
        #[expect(clippy::cast_precision_loss, reason = "counts of cells, below a thousand")]
        progress(Part::Rays, done as f64 / total as f64);
    });

    let settings = CompareSettings {
        seed: config.seed,
        quick: config.quick,
        environment: config.environment_name.to_owned(),
        environment_notes: config.environment.notes(),
    };
    Ok(Comparison { settings, machine: Machine::current(), speed, agreement, efficiency, rays })
}

/// Samples at a shading point over which its preparation is spread, as in direct lighting.
const SAMPLES_A_POINT: usize = 16;

/// Times of a sample on eight lanes, set-up included.
fn sample_costs(times: &Times) -> SampleCosts {
    let of = |model| SAMPLERS.map(|sampler| times.ns(model, sampler, SAMPLES_A_POINT).value);
    SampleCosts { gaussian: of(ModelKind::Gaussian), cauchy: of(ModelKind::Cauchy) }
}

impl Comparison {
    /// Failures: wrong answers, errors beyond their bounds, biased estimates. Empty if there are none.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let slow = self.speed.rows.iter().filter(|row| !row.passed).map(|row| {
            format!("speed: {} {} {} {} gave wrong answers", row.op.label(), row.model, row.contender, row.level)
        });
        let far = self.agreement.iter().filter(|row| !row.passed).map(|row| {
            format!(
                "agreement: {} {} {} {} {} {}: {:.2e} is beyond {:.0e}",
                row.model,
                row.sampler.unwrap_or_default(),
                row.path,
                row.level,
                row.region.label(),
                row.quantity.label(),
                row.worst,
                row.bound
            )
        });
        let biased = self.efficiency.check.failures.iter().map(|what| format!("efficiency: {what}"));
        let rays = self.rays.check.failures.iter().map(|what| format!("rays: {what}"));
        slow.chain(far).chain(biased).chain(rays).collect()
    }
}
