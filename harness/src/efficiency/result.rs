//! Tables as plain data, which reports print and JSON keeps.

use super::{Budget, EachSampler, ModelKind, SAMPLERS, SampleCosts, of_sampler};
use crate::sampler::Sampler;
use hairis_instruments::sequence::SequenceKind;
use hairis_instruments::stats::Estimate;
use serde::Serialize;

/// Tables of the comparison of sample efficiency.
#[derive(Clone, Debug, Serialize)]
pub struct EfficiencyResult {
    /// Settings that the tables depend on.
    pub settings: EfficiencySettings,
    /// Measured V under constant light, against quadrature and against the recorded figures.
    pub reference_v: Vec<ReferenceV>,
    /// Variance and bias of every estimator under every light.
    pub rows: Vec<EfficiencyRow>,
    /// Variance of light sampling and of multiple importance sampling.
    pub mis_rows: Vec<MisRow>,
    /// Error of the mean against the number of samples.
    pub convergence: Vec<ConvergencePoint>,
    /// V against the width of the lobes, under constant light.
    pub beta_sweep: Vec<SweepRow>,
    /// Check of all figures against their references.
    pub check: Check,
}

/// Settings that the figures depend on, besides the hair and the environment.
#[derive(Clone, Debug, Serialize)]
pub struct EfficiencySettings {
    /// Seed of every stream.
    pub seed: u64,
    /// Numbers of samples per table.
    pub budget: Budget,
    /// Inclinations of the viewer, in degrees.
    pub theta_o_deg: [f64; 4],
    /// Azimuth of the viewer, in degrees.
    pub phi_o_deg: f64,
    /// Inclination and azimuth of the sun, in degrees.
    pub sun_deg: [f64; 2],
    /// Inclination of the viewer in the convergence table, in degrees.
    pub convergence_theta_o_deg: f64,
    /// Names of the lights, in the order of reports.
    pub lights: Vec<String>,
    /// Times of a sample, if given.
    pub costs: Option<SampleCosts>,
}

/// Origin of a reference: quadrature, or a long run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReferenceMethod {
    /// Deterministic quadrature over the double-precision oracle.
    Quadrature,
    /// Long stratified run over the oracle, drawn from the light, for maps too large for quadrature.
    StratifiedRun,
}

/// Expected value of an estimator: the integral of `L S cos theta_i`, as the mean of RGB.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Reference {
    /// Integral of the mean of RGB.
    pub value: f64,
    /// Standard error of the integral, 0 for quadrature.
    pub standard_error: f64,
    /// Bound estimate of the quadrature's error, absolute.
    pub quadrature_error: f64,
    /// Origin of the integral.
    pub method: ReferenceMethod,
    /// V of one independent sample, in the order of [`SAMPLERS`](super::SAMPLERS): by quadrature, or for an environment by a stratified run
    /// from the light, good to about a percent.
    pub v: EachSampler<f64>,
    /// Skewness of one independent sample, in the same order, from the same run. The skewness is 0 for lights of one brightness, whose V
    /// suffices.
    pub skewness: EachSampler<f64>,
}

impl Reference {
    /// Returns an integral by quadrature, without the variances.
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

    /// Returns the integral with its standard error.
    #[must_use]
    pub const fn estimate(&self) -> Estimate {
        Estimate {
            value: self.value,
            standard_error: self.standard_error,
        }
    }

    /// Returns V and skewness of one independent sample, or NaN for a sampler that is not compared.
    #[must_use]
    pub fn predicted(&self, sampler: Sampler) -> [f64; 2] {
        [&self.v, &self.skewness].map(|each| of_sampler(each, sampler))
    }
}

/// V under constant light, as measured, by quadrature, and as recorded.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceV {
    /// Hair model of the row.
    pub model: ModelKind,
    /// Sampler of the row.
    pub sampler: Sampler,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// V as measured with independent numbers.
    pub v: Estimate,
    /// V by quadrature, for the mean of RGB, as all figures here.
    pub quadrature: f64,
    /// Distance of the measured V to the quadrature, in standard errors.
    pub z_quadrature: f64,
    /// V by quadrature for the luminance of Rec. 709, for comparison.
    pub quadrature_luminance: f64,
    /// V of the default hair, as another implementation recorded it.
    pub recorded: Option<f64>,
    /// Distance of the measured V to the recorded one, in standard errors, which include that of rounding.
    pub z_recorded: Option<f64>,
}

/// Estimator under one light, with its variance and bias.
#[derive(Clone, Debug, Serialize)]
pub struct EfficiencyRow {
    /// Hair model of the row.
    pub model: ModelKind,
    /// Sampler of the directions.
    pub sampler: Sampler,
    /// Kind of numbers that the sampler consumed.
    pub sequence: SequenceKind,
    /// Name of the light.
    pub light: String,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Samples `N` of each mean whose variance defines V; 1 for independent numbers.
    pub n: usize,
    /// Number of such means.
    pub randomisations: usize,
    /// Relative variance per sample.
    pub v: Estimate,
    /// Effective sample size of 1000 samples, `1000 / (1 + V)`.
    pub ess_per_1000: Estimate,
    /// Samples for a relative error of 1%, `V / 1e-4`.
    pub samples_for_1_percent: Estimate,
    /// Efficiency `1 / (V seconds)`, if the time of a sample is known.
    pub efficiency: Option<Estimate>,
    /// Largest weight `S cos theta_i / pdf`, as the mean of RGB, whatever the light.
    pub max_weight: f64,
    /// Largest contribution of a sample, in means.
    pub max_contribution: f64,
    /// Mean of all samples.
    pub mean: Estimate,
    /// Expected value of the mean.
    pub reference: Reference,
    /// Bias in standard errors, corrected for skewness.
    pub z: f64,
    /// Whether there were enough effective samples for `z` to be a test, and for V to be reliable.
    pub tested: bool,
}

/// Technique of a row of multiple importance sampling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Technique {
    /// Samples from the light alone.
    Light,
    /// Samples from the scattering function alone.
    Bsdf(Sampler),
    /// Equal numbers of samples from both, combined by the power heuristic of exponent 2.
    Mis(Sampler),
}

impl Technique {
    /// Returns every technique, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        [Self::Light]
            .into_iter()
            .chain(SAMPLERS.map(Self::Bsdf))
            .chain(SAMPLERS.map(Self::Mis))
    }

    /// Returns the name of the technique in reports.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Light => "light only".to_owned(),
            Self::Bsdf(sampler) => format!("{} only", sampler.name()),
            Self::Mis(sampler) => format!("{} + light", sampler.name()),
        }
    }

    /// Returns the number of samples that a contribution takes.
    #[must_use]
    pub fn samples_each(self) -> usize {
        if matches!(self, Self::Mis(_)) { 2 } else { 1 }
    }
}

/// Technique of drawing samples for one light, with independent numbers.
///
/// V is per sample of a budget shared by all techniques: `T Var(estimate) / mean^2` if the estimate took `T` samples in all. A technique
/// alone spends the whole budget on itself; with both, `T / 2` go to either, so V is twice the relative variance of a pair.
#[derive(Clone, Debug, Serialize)]
pub struct MisRow {
    /// Hair model of the row.
    pub model: ModelKind,
    /// Technique that draws the samples.
    pub technique: Technique,
    /// Name of the technique in reports.
    pub name: String,
    /// Name of the light.
    pub light: String,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Samples that a contribution took: 1, or 2 for a pair.
    pub samples_each: usize,
    /// Number of contributions.
    pub n: usize,
    /// Relative variance per sample at an equal total number of samples.
    pub v: Estimate,
    /// Samples for a relative error of 1%, both kinds counted together.
    pub samples_for_1_percent: Estimate,
    /// Largest contribution, in means.
    pub max_contribution: f64,
    /// Mean of all contributions.
    pub mean: Estimate,
    /// Expected value of the mean.
    pub reference: Reference,
    /// Bias in standard errors, corrected for skewness.
    pub z: f64,
    /// Whether there were enough effective samples for `z` to be a test, and for V to be reliable.
    pub tested: bool,
}

/// Error of a mean of `n` samples, against the reference.
#[derive(Clone, Debug, Serialize)]
pub struct ConvergencePoint {
    /// Hair model of the point.
    pub model: ModelKind,
    /// Sampler of the directions.
    pub sampler: Sampler,
    /// Kind of numbers that the sampler consumed.
    pub sequence: SequenceKind,
    /// Name of the light.
    pub light: String,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Number of samples per mean.
    pub n: usize,
    /// Number of randomisations.
    pub randomisations: usize,
    /// Root of the mean squared relative error against the reference.
    pub rms: Estimate,
    /// Bias over all randomisations in standard errors, corrected for skewness.
    pub z: f64,
    /// Whether there were enough effective samples for `z` to be a test.
    pub tested: bool,
}

/// Row of the sweep: one width under constant light, with independent numbers.
#[derive(Clone, Debug, Serialize)]
pub struct SweepRow {
    /// Hair model of the row.
    pub model: ModelKind,
    /// Sampler of the directions.
    pub sampler: Sampler,
    /// Width of R, in degrees.
    pub beta_r_deg: f32,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Number of samples.
    pub n: usize,
    /// Relative variance per sample, as measured.
    pub v: Estimate,
    /// V by quadrature.
    pub quadrature: f64,
    /// Distance of the measured V to the quadrature, in standard errors.
    pub z_quadrature: f64,
    /// Bias of the mean in standard errors, corrected for skewness.
    pub z: f64,
}

/// Check of all z-scores against one bound.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Number of figures compared with a reference.
    pub tests: usize,
    /// Number of figures with too few effective samples for a comparison.
    pub untested: usize,
    /// Chance of a false alarm over all tests together.
    pub false_alarm: f64,
    /// Bound on `|z|`, for which the chance is shared out over the tests by Sidak's formula.
    pub bound: f64,
    /// Largest `|z|`, infinite if any was NaN.
    pub largest_z: f64,
    /// One line for each figure beyond the bound.
    pub failures: Vec<String>,
}

impl Check {
    /// Returns true if every figure agrees with its reference. Otherwise `compare` ends with exit code 1.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.failures.is_empty()
    }
}
