//! Cells of the tables, each of which one thread computes.

use super::case::Case;
use super::measure::{bias_z, is_tested, moments};
use super::reference::exact_variance;
use super::result::{ConvergencePoint, EfficiencyRow, MisRow, ReferenceV, SweepRow, Technique};
use super::{EfficiencyConfig, ModelKind, Reference, stream};
use crate::sampler::Sampler;
use hairis::HairParams;
use hairis_instruments::light::{Constant, Light};
use hairis_instruments::sequence::SequenceKind;
use hairis_instruments::stats::{Estimate, Moments};

/// Case under a light, with the light's place in the order of reports, and the reference.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) config: &'a EfficiencyConfig<'a>,
    pub(super) case: &'a Case,
    pub(super) light: &'a dyn Light,
    pub(super) index: usize,
    pub(super) reference: &'a Reference,
}

/// Returns seed and stream of a cell of `table` at a case.
fn cell(config: &EfficiencyConfig<'_>, table: u64, case: &Case, rest: &[u64]) -> [u64; 2] {
    let mut indices = vec![table, case.model.index(), case.theta_o_deg.to_bits()];
    indices.extend_from_slice(rest);
    [config.seed, stream(&indices)]
}

impl Place<'_> {
    pub(super) fn row(&self, sampler: Sampler, sequence: SequenceKind) -> EfficiencyRow {
        let Self {
            config,
            case,
            light,
            index,
            reference,
        } = *self;
        let budget = &config.budget;
        let at = cell(
            config,
            stream::ROW,
            case,
            &[sampler.index(), sequence as u64, index as u64],
        );
        let [n, randomisations] = match sequence {
            SequenceKind::Independent => [1, budget.independent],
            _ => [budget.correlated, budget.randomisations],
        };
        let tally = moments(
            case,
            Technique::Bsdf(sampler),
            light,
            at,
            sequence,
            [n, randomisations],
        );
        let v = tally.moments.relative_variance().scale(n as f64);
        EfficiencyRow {
            model: case.model,
            sampler,
            sequence,
            light: light.name().to_owned(),
            theta_o_deg: case.theta_o_deg,
            n,
            randomisations,
            v,
            ess_per_1000: v.effective_per_1000(),
            samples_for_1_percent: v.scale(1e4),
            efficiency: config
                .costs
                .map(|costs| costs.efficiency(&v, case.model, sampler)),
            max_weight: tally.max_weight,
            max_contribution: tally.max_in_means(),
            mean: tally.moments.mean_estimate(),
            reference: *reference,
            z: bias_z(&tally.moments, reference.estimate()),
            tested: is_tested(n * randomisations, reference.predicted(sampler)),
        }
    }

    pub(super) fn mis_row(&self, technique: Technique) -> MisRow {
        let Self {
            config,
            case,
            light,
            index,
            reference,
        } = *self;
        let n = config.budget.mis;
        let [kind, sampler] = match technique {
            Technique::Light => [0, 0],
            Technique::Bsdf(sampler) => [1, sampler.index()],
            Technique::Mis(sampler) => [2, sampler.index()],
        };
        let at = cell(config, stream::MIS, case, &[kind, sampler, index as u64]);
        let tally = moments(
            case,
            technique,
            light,
            at,
            SequenceKind::Independent,
            [1, n],
        );
        let v = tally
            .moments
            .relative_variance()
            .scale(technique.samples_each() as f64);
        MisRow {
            model: case.model,
            technique,
            name: technique.name(),
            light: light.name().to_owned(),
            theta_o_deg: case.theta_o_deg,
            samples_each: technique.samples_each(),
            n,
            v,
            samples_for_1_percent: v.scale(1e4),
            max_contribution: tally.max_in_means(),
            mean: tally.moments.mean_estimate(),
            reference: *reference,
            z: bias_z(&tally.moments, reference.estimate()),
            tested: match technique {
                Technique::Bsdf(sampler) => is_tested(n, reference.predicted(sampler)),
                // Samples from the light hit it, however small it is.
                _ => true,
            },
        }
    }

    pub(super) fn convergence_point(
        &self,
        sampler: Sampler,
        sequence: SequenceKind,
        n: usize,
    ) -> ConvergencePoint {
        let Self {
            config,
            case,
            light,
            index,
            reference,
        } = *self;
        let randomisations = config.budget.convergence;
        let rest = [sampler.index(), sequence as u64, index as u64, n as u64];
        let at = cell(config, stream::CONVERGENCE, case, &rest);
        let tally = moments(
            case,
            Technique::Bsdf(sampler),
            light,
            at,
            sequence,
            [n, randomisations],
        );
        ConvergencePoint {
            model: case.model,
            sampler,
            sequence,
            light: light.name().to_owned(),
            theta_o_deg: case.theta_o_deg,
            n,
            randomisations,
            rms: rms_error(&tally.moments, reference.value),
            z: bias_z(&tally.moments, reference.estimate()),
            tested: is_tested(n * randomisations, reference.predicted(sampler)),
        }
    }
}

/// Returns the root mean squared relative error about `truth`, with its standard error by the delta method.
///
/// The mean of the squared errors is `m2 + d^2` and their variance `m4 - m2^2 + 4 d m3 + 4 d^2 m2`, with central moments `m` and the bias
/// `d`.
fn rms_error(means: &Moments, truth: f64) -> Estimate {
    let n = means.count() as f64;
    let [m3, m4] = means.higher_moments();
    let m2 = means.variance() * (n - 1.0) / n;
    let d = means.mean() - truth;
    let mse = m2 + d * d;
    let var = (m4 - m2 * m2 + 4.0 * d * m3 + 4.0 * d * d * m2).max(0.0);
    let rms = mse.sqrt();
    Estimate {
        value: rms / truth,
        standard_error: (var / n).sqrt() / (2.0 * rms * truth),
    }
}

/// Measures one width of the sweep, at a case made for that width.
pub(super) fn sweep_row(
    config: &EfficiencyConfig<'_>,
    case: &Case,
    sampler: Sampler,
    beta_r_deg: f32,
) -> SweepRow {
    let n = config.budget.sweep;
    let at = cell(
        config,
        stream::SWEEP,
        case,
        &[sampler.index(), u64::from(beta_r_deg.to_bits())],
    );
    let (technique, light) = (Technique::Bsdf(sampler), Constant);
    let tally = moments(
        case,
        technique,
        &light,
        at,
        SequenceKind::Independent,
        [1, n],
    );
    let exact = exact_variance(case, sampler);
    let (v, [quadrature, _]) = (tally.moments.relative_variance(), exact.v);
    SweepRow {
        model: case.model,
        sampler,
        beta_r_deg,
        theta_o_deg: case.theta_o_deg,
        n,
        v,
        quadrature,
        z_quadrature: agreement(v, quadrature),
        z: bias_z(&tally.moments, exact.mean),
    }
}

/// Returns the distance of a measured V to the exact one in standard errors. Hair that scatters nothing has neither, and gives 0.
fn agreement(v: Estimate, exact: f64) -> f64 {
    if v.value.is_nan() && exact.is_nan() {
        0.0
    } else {
        v.z_score(exact)
    }
}

/// Compares V under constant light with quadrature and, for the default hair, with its recorded figures. `v` is that of the independent
/// row.
pub(super) fn reference_v(
    config: &EfficiencyConfig<'_>,
    case: &Case,
    sampler: Sampler,
    v: Estimate,
) -> ReferenceV {
    let [quadrature, quadrature_luminance] = exact_variance(case, sampler).v;
    let is_default = config.params == HairParams::bright();
    let recorded = recorded_v(case.model, sampler, case.theta_o_deg).filter(|_| is_default);
    let rounded = Estimate {
        standard_error: v.standard_error.hypot(ROUNDING),
        ..v
    };
    ReferenceV {
        model: case.model,
        sampler,
        theta_o_deg: case.theta_o_deg,
        v,
        quadrature,
        z_quadrature: agreement(v, quadrature),
        quadrature_luminance,
        recorded,
        z_recorded: recorded.map(|p| rounded.z_score(p)),
    }
}

/// Returns V of the default hair to three decimals, as another implementation recorded it.
#[must_use]
pub fn recorded_v(model: ModelKind, sampler: Sampler, theta_o_deg: f64) -> Option<f64> {
    let figures = match (model, sampler) {
        (ModelKind::Gaussian, Sampler::Uniform) => [0.706, 0.931, 2.268],
        (ModelKind::Gaussian, Sampler::Published) => [0.209, 0.189, 0.290],
        (ModelKind::Cauchy, Sampler::Uniform) => [0.592, 0.832, 1.967],
        (ModelKind::Cauchy, Sampler::Published) => [0.150, 0.159, 0.232],
        // The recorded implementation has no other samplers.
        _ => return None,
    };
    [0.0, 45.0, 75.0]
        .iter()
        .position(|t| *t == theta_o_deg)
        .map(|i| figures[i])
}

/// Standard deviation of rounding to three decimals.
const ROUNDING: f64 = 0.000_5 * 0.577_350_269_189_625_8;
