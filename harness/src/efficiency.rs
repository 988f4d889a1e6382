//! Sample efficiency of the published and the matched sampler: variance, bias and convergence of both models under five lights.
//!
//! # What is measured
//!
//! Measured are the estimators of direct lighting, `L S cos theta_i / pdf` as one number (the mean of its RGB), of both models through the
//! eight-lane path. `V` is the relative variance of one sample: a mean of `N` independent samples has a relative error of `sqrt(V / N)`.
//!
//! - One number out of three: every figure is of the mean of RGB, the intensity by which the sampler weights its lobes. Quadrature shows
//!   that the recorded table of "luminance V" is of the mean of RGB as well (test `the_recorded_figures_are_of_the_mean_of_rgb`):
//!   `published` on the Gaussian model at `theta_o = 45` has V = 0.1890 for the mean of RGB, 0.1923 for the luminance of Rec. 709, and the
//!   table has 0.189. All twelve figures agree with the mean of RGB to 6e-4.
//! - Correlated samples (stratified, Halton) have no variance of their own. For them `V = N Var(mean) / mean^2`, with `Var(mean)` the
//!   variance of the mean of `N` samples over `R` independent randomisations. V / N is then again the squared relative error, but only at
//!   that `N`, so each row states its `N`. Independent numbers follow the same formula, with `N` 1 and `R` the number of samples.
//! - Standard errors of V are those of [`Moments::relative_variance`](hairis_instruments::stats::Moments::relative_variance).
//! - The effective sample size of 1000 samples is `1000 / (1 + V)`: Kish's for independent numbers, the same function of V elsewhere.
//! - Every mean is compared with a reference, see [`Reference`], and gives a bias z-score. Contributions of rare hits are skewed, which
//!   distorts the tails of a plain z. Hall's transformation (1992, On the removal of skewness by transformation) removes the skewness.
//!   [`Check`] collects the scores.
//! - A run that is expected to hit a small light only a few times is no test, because it misses the light and underestimates both mean and
//!   error. The expectation follows from the V of [`Reference::v`]. A z-score enters the check if the effective number of samples,
//!   `n / (1 + V)`, and the expected number of hits that carry the skewness, `n / skewness^2`, are at least [`MIN_EFFECTIVE`]. The other
//!   scores and their V are printed and marked; the V of the reference is then the better figure.
//!
//! # The scene
//!
//! The fibre lies along world x, and (u, v, w) is the world's (x, y, z). The viewer is at azimuth [`PHI_O_DEG`], 60 degrees from straight
//! up (+y), inclined by [`THETA_O_DEG`]. Therefore one glint, 35 degrees from the viewer in azimuth, runs along azimuth 25 and meets the
//! area light above, which spans 27 degrees on either side of 0. The [`Sun`](hairis_instruments::light::Sun) stands at inclination
//! [`SUN_DEG`](crate::lights::SUN_DEG)`[0]` = -60 and azimuth 25 degrees: the centre of the R lobe and of that glint for `theta_o = 45`,
//! well inside the TRT lobe for 75, in the tails for 0 and 85. The sun of the procedural [`Sky`](hairis_instruments::light::Sky) is near
//! inclination 26 degrees, the centre of the TRT lobe for `theta_o = 0`.
//!
//! # Determinism
//!
//! A result depends on the configuration only. Each cell of a table draws from a stream of its own and is computed by one thread.

mod case;
mod cells;
mod measure;
mod reference;
mod result;
mod run;

pub use case::Case;
pub use cells::recorded_v;
pub use measure::{CellMoments, bias_z, is_tested, moments};
pub use reference::{
    ExactVariance, by_quadrature, exact_variance, of_environment, perfect_v, ray_v, stratified,
};
pub use result::{
    Check, ConvergencePoint, EfficiencyResult, EfficiencyRow, EfficiencySettings, MisRow,
    Reference, ReferenceMethod, ReferenceV, SweepRow, Technique,
};
pub use run::{check, run, z_bound};

use crate::lights::Lights;
use crate::sampler::Sampler;
use crate::subject::ModelKind;
use hairis::params::HairDesc;
use hairis::{HairParams, ParamError};
use hairis_instruments::sequence::stream_id;
use hairis_instruments::stats::Estimate;
use serde::Serialize;

/// Inclinations of the viewer from which every estimator is measured, in degrees.
pub const THETA_O_DEG: [f64; 4] = [0.0, 45.0, 75.0, 85.0];

/// Azimuth of the viewer from straight up, in degrees.
pub const PHI_O_DEG: f64 = 60.0;

/// Widths `beta_r` of the sweep, in degrees; `beta_tt` is half of `beta_r`, and `beta_trt` is twice.
pub const BETA_R_DEG: [f32; 6] = [2.5, 5.0, 7.5, 10.0, 15.0, 20.0];

/// Inclination of the viewer in the convergence table, in degrees.
pub const CONVERGENCE_THETA_O_DEG: f64 = 45.0;

/// Least effective number of samples, `n / (1 + V)` with the V of the reference, for a mean to be tested.
///
/// With 100 Poisson hits, Hall's score passes 4.86 a third as often as a normal deviate does, and the plain score 15 times as often (summed
/// exactly).
pub const MIN_EFFECTIVE: f64 = 100.0;

/// Chance that a run without any fault fails its [`Check`], over all its figures together.
pub const FALSE_ALARM: f64 = 1e-3;

/// Samplers that are compared, in the order of reports. "Stratified uniform" is the first sampler with
/// [`SequenceKind::Stratified`](hairis_instruments::sequence::SequenceKind::Stratified) numbers.
///
/// The matched sampler is the documented default one; `hairis study` measures every sampler.
pub const SAMPLERS: [Sampler; 3] = [Sampler::Uniform, Sampler::Published, Sampler::Matched];

/// Figures of [`SAMPLERS`], in their order.
pub type EachSampler<T> = [T; SAMPLERS.len()];

/// Returns the figure of one sampler, or NaN for a sampler that is not compared.
fn of_sampler(each: &EachSampler<f64>, sampler: Sampler) -> f64 {
    SAMPLERS
        .iter()
        .zip(each)
        .find(|(of, _)| **of == sampler)
        .map_or(f64::NAN, |(_, figure)| *figure)
}

/// Time of one sample of one model on the eight-lane path, in ns: set-up amortised over 16 samples, lights excluded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SampleCosts {
    /// Times with the Gaussian model, in the order of [`SAMPLERS`].
    pub gaussian: EachSampler<f64>,
    /// Times with the Cauchy model, in the same order.
    pub cauchy: EachSampler<f64>,
}

impl SampleCosts {
    /// Returns the time of a sample of `sampler` for `model`, in ns, or NaN for a sampler that is not compared.
    #[must_use]
    pub fn ns(&self, model: ModelKind, sampler: Sampler) -> f64 {
        let each = match model {
            ModelKind::Gaussian => &self.gaussian,
            ModelKind::Cauchy => &self.cauchy,
        };
        of_sampler(each, sampler)
    }

    /// Returns `1 / (V seconds)` of samples of relative variance `v`.
    #[must_use]
    pub fn efficiency(&self, v: &Estimate, model: ModelKind, sampler: Sampler) -> Estimate {
        Estimate::exact(1e9).ratio(&v.scale(self.ns(model, sampler)))
    }
}

/// Numbers of samples per table; [`new`](Self::new) returns those of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Budget {
    /// Independent samples per row.
    pub independent: usize,
    /// Samples `N` of one randomisation of correlated numbers.
    pub correlated: usize,
    /// Randomisations `R` of correlated numbers per row.
    pub randomisations: usize,
    /// Pairs (or samples, for techniques alone) per row of multiple importance sampling.
    pub mis: usize,
    /// Independent samples per row of the sweep.
    pub sweep: usize,
    /// Randomisations per point of the convergence table.
    pub convergence: usize,
    /// Largest N of the convergence table, which begins at 4 and doubles.
    pub convergence_n: usize,
    /// Texels above which the reference of an environment is a stratified run instead of quadrature.
    pub quadrature_texels: usize,
    /// Randomisations of 4096 samples of the stratified run, which also predicts the variance under the environment.
    pub reference_passes: usize,
}

impl Budget {
    /// Returns the numbers of samples of the command line: about 100 s of processor time, 50 s on two idle cores; if `quick`, about 9 s
    /// and 5 s.
    #[must_use]
    pub fn new(quick: bool) -> Self {
        let pick = |full: usize, short: usize| if quick { short } else { full };
        Self {
            independent: pick(2_000_000, 125_000),
            correlated: 64,
            randomisations: pick(4_096, 256),
            mis: pick(500_000, 16_384),
            sweep: pick(1_000_000, 32_768),
            convergence: pick(256, 32),
            convergence_n: 4_096,
            quadrature_texels: pick(1024 * 512, 128 * 64),
            reference_passes: pick(256, 32),
        }
    }
}

/// Settings of a run of the sample-efficiency tables.
#[derive(Clone, Copy, Debug)]
pub struct EfficiencyConfig<'a> {
    /// Seed of every stream.
    pub seed: u64,
    /// Numbers of samples per table.
    pub budget: Budget,
    /// Lights that the hair is seen under.
    pub lights: Lights<'a>,
    /// Parameters of the hair.
    pub params: HairParams,
    /// Times of a sample, measured elsewhere. Without them there are no figures of `1 / (V time)`.
    pub costs: Option<SampleCosts>,
}

impl<'a> EfficiencyConfig<'a> {
    /// Returns the settings of the command line for the default hair, without times.
    ///
    /// # Examples
    /// ```
    /// use hairis_harness::efficiency::{Budget, EfficiencyConfig};
    /// let sky = hairis_instruments::light::Sky::default().environment();
    /// let config = EfficiencyConfig::new(1, true, &sky);
    /// assert_eq!(config.budget, Budget::new(true));
    /// ```
    #[must_use]
    pub fn new(seed: u64, quick: bool, lights: impl Into<Lights<'a>>) -> Self {
        Self {
            seed,
            budget: Budget::new(quick),
            lights: lights.into(),
            params: HairParams::bright(),
            costs: None,
        }
    }
}

/// Returns the hair of the sweep: `base` with `beta_r` and the two dependent widths, in degrees.
///
/// # Errors
/// Returns an error if a width leaves its range.
pub fn with_beta(base: &HairParams, beta_r_deg: f32) -> Result<HairParams, ParamError> {
    let beta_r = beta_r_deg.to_radians();
    HairParams::new(&HairDesc {
        beta: [beta_r, 0.5 * beta_r, 2.0 * beta_r],
        ..*base.desc()
    })
}

/// Returns the mean of a colour, on which all figures are based.
#[must_use]
pub fn intensity(rgb: [f64; 3]) -> f64 {
    (rgb[0] + rgb[1] + rgb[2]) / 3.0
}

/// Stream numbers of the tables.
mod stream {
    pub(super) const REFERENCE: u64 = 0;
    pub(super) const ROW: u64 = 1;
    pub(super) const MIS: u64 = 2;
    pub(super) const CONVERGENCE: u64 = 3;
    pub(super) const SWEEP: u64 = 4;
}

/// Returns the stream of a cell, salted so that no other part of the harness draws from it.
fn stream(indices: &[u64]) -> u64 {
    stream_id(&[0xeff1_c1e4_c700_0001, stream_id(indices)])
}
