//! The main job: speed, agreement and sample efficiency in one run, with every figure's origin.

mod charts;
mod page;
mod tables;

pub use page::report;
pub use tables::{Depth, tables};

use crate::agreement::{self, AgreementConfig, AgreementResult};
use crate::efficiency::{self, EfficiencyConfig, EfficiencyResult, ModelKind, SampleCosts};
use crate::light::Environment;
use crate::machine::Machine;
use crate::speed::{self, Op, SpeedConfig, SpeedReport};
use hairis::ParamError;
use serde::Serialize;

/// What to compare.
#[derive(Clone, Copy, Debug)]
pub struct CompareConfig<'a> {
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// A tenth of the samples: for a first look, and for tests.
    pub quick: bool,
    /// The environment light.
    pub environment: &'a Environment,
    /// What the environment is, for the report: a file, or the procedural sky.
    pub environment_name: &'a str,
}

/// Everything that was found; `compare.json` is this.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The command's settings.
    pub settings: Settings,
    /// Where it ran, and what ran.
    pub machine: Machine,
    /// Time a direction.
    pub speed: SpeedReport,
    /// Errors against the textbook in double precision.
    pub agreement: Vec<AgreementResult>,
    /// Variance a sample.
    pub efficiency: EfficiencyResult,
}

/// The settings of a comparison.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Settings {
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Whether it was the short run.
    pub quick: bool,
    /// The environment light.
    pub environment: String,
    /// What was repaired in the environment, and what is odd about it.
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
}

impl Part {
    /// What a progress bar calls it.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Agreement => "agreement",
            Self::Efficiency => "sample efficiency",
        }
    }
}

/// Runs the comparison. `progress` is told the part and the share of it that is done, from 0 to 1.
///
/// # Errors
///
/// Never in practice: the hair that is compared is within the accepted ranges.
pub fn run(config: &CompareConfig<'_>, progress: &(dyn Fn(Part, f64) + Sync)) -> Result<Comparison, ParamError> {
    let timing = if config.quick { SpeedConfig::quick(config.seed) } else { SpeedConfig::full(config.seed) };
    let speed = speed::run(&timing, |done| progress(Part::Speed, done))?;

    let errors = if config.quick { AgreementConfig::quick(config.seed) } else { AgreementConfig::full(config.seed) };
    progress(Part::Agreement, 0.0);
    let agreement = agreement::run(&errors)?;
    progress(Part::Agreement, 1.0);

    let variance = EfficiencyConfig {
        costs: sample_costs(&speed),
        ..EfficiencyConfig::new(config.seed, config.quick, config.environment)
    };
    let efficiency = efficiency::run(&variance, &|done, total| {
        #[expect(clippy::cast_precision_loss, reason = "counts of cells, below a thousand")]
        progress(Part::Efficiency, done as f64 / total as f64);
    })?;

    let settings = Settings {
        seed: config.seed,
        quick: config.quick,
        environment: config.environment_name.to_owned(),
        environment_notes: config.environment.notes(),
    };
    Ok(Comparison { settings, machine: Machine::current(), speed, agreement, efficiency })
}

/// Samples at a gather point over which its preparation is spread, as in direct lighting.
const SAMPLES_A_POINT: f64 = 16.0;

/// Time of a sample on eight lanes, set-up included: a uniform direction is free but for its evaluation.
fn sample_costs(speed: &SpeedReport) -> Option<SampleCosts> {
    let ns = |op, model: ModelKind| speed.row(op, model.name(), "eight lanes", speed.detected_level).map(|row| row.ns);
    let costs = |model| {
        let setup = ns(Op::Prepare, model)? / SAMPLES_A_POINT;
        Some([ns(Op::EvalPdf, model)? + setup, ns(Op::Sample, model)? + setup])
    };
    Some(SampleCosts { gaussian: costs(ModelKind::Gaussian)?, cauchy: costs(ModelKind::Cauchy)? })
}

impl Comparison {
    /// What failed: wrong answers, errors beyond their bounds, biased estimates. Empty if nothing did.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let slow =
            self.speed.rows.iter().filter(|row| !row.passed).map(|row| {
                format!("speed: {} {} {} {} gave wrong answers", row.op, row.model, row.contender, row.level)
            });
        let far = self.agreement.iter().filter(|row| !row.passed).map(|row| {
            format!(
                "agreement: {} {} {} {} {}: {:.2e} is beyond {:.0e}",
                row.model, row.path, row.level, row.region, row.quantity, row.worst, row.bound
            )
        });
        let biased = self.efficiency.check.failures.iter().map(|what| format!("efficiency: {what}"));
        slow.chain(far).chain(biased).collect()
    }
}
