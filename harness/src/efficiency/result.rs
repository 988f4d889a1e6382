//! The tables, as plain data: what reports print and JSON keeps.

use super::{Budget, EachSampler, ModelKind, SAMPLERS, SampleCosts, of_sampler};
use crate::sampler::Sampler;
use hairis_instruments::sequence::SequenceKind;
use hairis_instruments::stats::Estimate;
use serde::Serialize;

/// Every table of the comparison of sample efficiency.
#[derive(Clone, Debug, Serialize)]
pub struct EfficiencyResult {
    /// Numbers of samples.
    pub settings: EfficiencySettings,
    /// Under constant light: measured V against quadrature and against the recorded figures.
    pub reference_v: Vec<ReferenceV>,
    /// Variance and bias of every estimator under every light.
    pub rows: Vec<EfficiencyRow>,
    /// Light sampling and multiple importance sampling.
    pub mis_rows: Vec<MisRow>,
    /// Error against the number of samples.
    pub convergence: Vec<ConvergencePoint>,
    /// V against the width of the lobes, under constant light.
    pub beta_sweep: Vec<SweepRow>,
    /// Whether the figures agree with their references.
    pub check: Check,
}

/// Settings that the figures depend on, besides the hair and the environment.
#[derive(Clone, Debug, Serialize)]
pub struct EfficiencySettings {
    /// Seed of every stream.
    pub seed: u64,
    /// Sample counts.
    pub budget: Budget,
    /// Inclinations of the viewer, in degrees.
    pub theta_o_deg: [f64; 4],
    /// Azimuth of the viewer, in degrees.
    pub phi_o_deg: f64,
    /// Inclination and azimuth of the sun, in degrees.
    pub sun_deg: [f64; 2],
    /// Inclination of the viewer in the convergence table, in degrees.
    pub convergence_theta_o_deg: f64,
    /// The lights, in the order of reports.
    pub lights: Vec<String>,
    /// Times of a sample, when given.
    pub costs: Option<SampleCosts>,
}

/// Origin of a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReferenceMethod {
    /// Deterministic quadrature over the double-precision oracle.
    Quadrature,
    /// A long stratified run over the oracle, drawn from the light: for maps too large for quadrature.
    StratifiedRun,
}

/// The value an estimator ought to have: the integral of `L S cos theta_i`, as the mean of RGB.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Reference {
    /// The integral.
    pub value: f64,
    /// Its standard error: 0 for quadrature.
    pub standard_error: f64,
    /// Bound estimate of the quadrature's error, absolute.
    pub quadrature_error: f64,
    /// Its origin.
    pub method: ReferenceMethod,
    /// V of one independent sample, in the order of [`SAMPLERS`](super::SAMPLERS): by quadrature, or for an environment by a stratified run from the light, good to about a percent.
    pub v: EachSampler<f64>,
    /// Skewness of one independent sample, in the same order, from the same run; 0 for lights of one brightness, whose V suffices.
    pub skewness: EachSampler<f64>,
}

impl Reference {
    /// An integral by quadrature, without the variances.
    pub(super) const fn by_quadrature(value: f64, error: f64) -> Self {
        Self {
            value,
            standard_error: 0.0,
            quadrature_error: error,
            method: ReferenceMethod::Quadrature,
            v: [f64::NAN; SAMPLERS.len()],
            skewness: [0.0; SAMPLERS.len()],
        }
    }

    /// The integral with its standard error.
    pub(crate) const fn estimate(&self) -> Estimate {
        Estimate {
            value: self.value,
            standard_error: self.standard_error,
        }
    }

    /// V and skewness of one independent sample; not numbers for a sampler that is not compared.
    pub(crate) fn predicted(&self, sampler: Sampler) -> [f64; 2] {
        [&self.v, &self.skewness].map(|each| of_sampler(each, sampler))
    }
}

/// V under constant light, three times.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceV {
    /// The model.
    pub model: ModelKind,
    /// The sampler.
    pub sampler: Sampler,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// As measured with independent numbers.
    pub v: Estimate,
    /// By quadrature: of the mean of RGB, as every figure here.
    pub quadrature: f64,
    /// Distance of the measured V to that, in standard errors.
    pub z_quadrature: f64,
    /// By quadrature: of the luminance of Rec. 709, for comparison.
    pub quadrature_luminance: f64,
    /// For the default hair, the figure recorded by another implementation.
    pub recorded: Option<f64>,
    /// Distance of the measured V to it, in standard errors; that of its rounding is added.
    pub z_recorded: Option<f64>,
}

/// One estimator under one light.
#[derive(Clone, Debug, Serialize)]
pub struct EfficiencyRow {
    /// The model.
    pub model: ModelKind,
    /// The sampler.
    pub sampler: Sampler,
    /// The numbers it consumed.
    pub sequence: SequenceKind,
    /// Name of the light.
    pub light: String,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Samples `N` of the means whose variance V is defined by: 1 for independent numbers.
    pub n: usize,
    /// Number of such means.
    pub randomisations: usize,
    /// Relative variance per sample.
    pub v: Estimate,
    /// Effective sample size of 1000 samples, `1000 / (1 + V)`.
    pub ess_per_1000: Estimate,
    /// Samples for a relative error of 1%, `V / 1e-4`.
    pub samples_for_1_percent: Estimate,
    /// `1 / (V seconds)`, when the time of a sample is known.
    pub efficiency: Option<Estimate>,
    /// Largest mean of RGB of a weight `S cos theta_i / pdf`, whatever the light.
    pub max_weight: f64,
    /// Largest contribution of a sample, in means.
    pub max_contribution: f64,
    /// The mean of all samples.
    pub mean: Estimate,
    /// Its expected value.
    pub reference: Reference,
    /// Bias in standard errors, corrected for skewness.
    pub z: f64,
    /// Whether there were enough effective samples for `z` to be a test, and for V to be trusted.
    pub tested: bool,
}

/// Technique of a row of multiple importance sampling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Technique {
    /// From the light alone.
    Light,
    /// From the scattering function alone.
    Bsdf(Sampler),
    /// Equal numbers of samples from both, by the power heuristic of exponent 2.
    Mis(Sampler),
}

impl Technique {
    /// Every technique, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        [Self::Light]
            .into_iter()
            .chain(SAMPLERS.map(Self::Bsdf))
            .chain(SAMPLERS.map(Self::Mis))
    }

    /// Name in reports.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Light => "light only".to_owned(),
            Self::Bsdf(sampler) => format!("{} only", sampler.name()),
            Self::Mis(sampler) => format!("{} + light", sampler.name()),
        }
    }

    /// Samples a contribution takes.
    pub(crate) fn samples_each(self) -> usize {
        if matches!(self, Self::Mis(_)) { 2 } else { 1 }
    }
}

/// One way of drawing samples for one light, independent numbers.
///
/// V is per sample of a budget shared by all techniques: `T Var(estimate) / mean^2` where the estimate took `T` samples in all. A technique alone spends all
/// of them on itself; with both, `T / 2` go to either, so V is twice the relative variance of a pair.
#[derive(Clone, Debug, Serialize)]
pub struct MisRow {
    /// The model.
    pub model: ModelKind,
    /// Technique.
    pub technique: Technique,
    /// Its name in reports.
    pub name: String,
    /// Name of the light.
    pub light: String,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Samples a contribution took: 1, or 2 for a pair.
    pub samples_each: usize,
    /// Number of contributions.
    pub n: usize,
    /// Relative variance per sample at an equal total number of samples.
    pub v: Estimate,
    /// Samples for a relative error of 1%, of both kinds together.
    pub samples_for_1_percent: Estimate,
    /// Largest contribution, in means.
    pub max_contribution: f64,
    /// The mean of all contributions.
    pub mean: Estimate,
    /// Its expected value.
    pub reference: Reference,
    /// Bias in standard errors, corrected for skewness.
    pub z: f64,
    /// Whether there were enough effective samples for `z` to be a test, and for V to be trusted.
    pub tested: bool,
}

/// Error of a mean of `n` samples.
#[derive(Clone, Debug, Serialize)]
pub struct ConvergencePoint {
    /// The model.
    pub model: ModelKind,
    /// The sampler.
    pub sampler: Sampler,
    /// The numbers it consumed.
    pub sequence: SequenceKind,
    /// Name of the light.
    pub light: String,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Samples of a mean.
    pub n: usize,
    /// Randomisations.
    pub randomisations: usize,
    /// Root of the mean squared relative error against the reference.
    pub rms: Estimate,
    /// Bias over all randomisations in standard errors, corrected for skewness.
    pub z: f64,
    /// Whether there were enough effective samples for `z` to be a test.
    pub tested: bool,
}

/// One width of the sweep, constant light, independent numbers.
#[derive(Clone, Debug, Serialize)]
pub struct SweepRow {
    /// The model.
    pub model: ModelKind,
    /// The sampler.
    pub sampler: Sampler,
    /// Width of R, in degrees.
    pub beta_r_deg: f32,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Samples.
    pub n: usize,
    /// Relative variance per sample, as measured.
    pub v: Estimate,
    /// Value by quadrature.
    pub quadrature: f64,
    /// Distance of the two, in standard errors.
    pub z_quadrature: f64,
    /// Bias of the mean in standard errors, corrected for skewness.
    pub z: f64,
}

/// All z-scores against one bound.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Number of figures compared with a reference.
    pub tests: usize,
    /// Number of figures with too few effective samples for a comparison.
    pub untested: usize,
    /// Chance of a false alarm over all of them.
    pub false_alarm: f64,
    /// Bound on `|z|`: the chance is shared out over the tests by Sidak's formula.
    pub bound: f64,
    /// Largest `|z|`; infinite when one was no number.
    pub largest_z: f64,
    /// One line for each figure beyond the bound.
    pub failures: Vec<String>,
}

impl Check {
    /// Whether every figure agrees with its reference. When not, `compare` ends with exit code 1.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.failures.is_empty()
    }
}
