//! One cell of each table.

use super::case::Case;
use super::measure::{self, CellMoments, bias_z};
use super::reference::exact_variance;
use super::result::{ConvergencePoint, EfficiencyRow, MisRow, ReferenceV, SweepRow, Technique};
use super::{EfficiencyConfig, ModelKind, Reference, ReferenceMethod, SAMPLERS, mis, stream};
use crate::light::{Constant, Light};
use crate::sampler::Sampler;
use crate::sequence::SequenceKind;
use crate::stats::{Estimate, Moments};
use hairis::HairParams;

/// A light, its place in the order of reports and the reference under it.
#[derive(Clone, Copy)]
pub(super) struct Lit<'a> {
    pub(super) light: &'a dyn Light,
    pub(super) index: u64,
    pub(super) reference: &'a Reference,
}

/// The stream of a cell of `table` at a case.
fn cell(config: &EfficiencyConfig<'_>, table: u64, case: &Case, rest: &[u64]) -> [u64; 2] {
    let mut indices = vec![table, case.model.index(), case.theta_o_deg.to_bits()];
    indices.extend_from_slice(rest);
    [config.seed, stream(&indices)]
}

fn kind_index(kind: SequenceKind) -> u64 {
    match kind {
        SequenceKind::Independent => 0,
        SequenceKind::Halton => 1,
        SequenceKind::Stratified => 2,
    }
}

/// Largest contribution in means, 0 when there was none.
fn in_means(tally: &CellMoments) -> f64 {
    if tally.max_contribution > 0.0 { tally.max_contribution / tally.moments.mean() } else { 0.0 }
}

pub(super) fn row(
    config: &EfficiencyConfig<'_>,
    case: &Case,
    sampler: Sampler,
    sequence: SequenceKind,
    lit: &Lit<'_>,
) -> EfficiencyRow {
    let budget = &config.budget;
    let at = cell(config, stream::ROW, case, &[sampler.index(), kind_index(sequence), lit.index]);
    let (tally, n, randomisations) = if sequence == SequenceKind::Independent {
        (measure::independent(case, sampler, lit.light, at, budget.independent), 1, budget.independent)
    } else {
        let size = [budget.correlated, budget.randomisations];
        (measure::means(case, sampler, sequence, lit.light, at, size), size[0], size[1])
    };
    let v = tally.moments.relative_variance().scale(n as f64);
    EfficiencyRow {
        model: case.model,
        sampler,
        sequence,
        light: lit.light.name().to_owned(),
        theta_o_deg: case.theta_o_deg,
        n,
        randomisations,
        v,
        ess_per_1000: measure::effective_per_1000(&v),
        samples_for_1_percent: v.scale(1e4),
        efficiency: config.costs.map(|costs| measure::efficiency(&v, costs.ns(case.model, sampler))),
        max_weight: tally.max_weight,
        max_contribution: in_means(&tally),
        mean: tally.moments.mean_estimate(),
        reference: *lit.reference,
        z: bias_z(&tally.moments, lit.reference),
        tested: measure::is_tested(n * randomisations, lit.reference.predicted(sampler)),
    }
}

pub(super) fn mis_row(config: &EfficiencyConfig<'_>, case: &Case, technique: Technique, lit: &Lit<'_>) -> MisRow {
    let n = config.budget.mis;
    let [kind, sampler] = match technique {
        Technique::Light => [0, 0],
        Technique::Bsdf(sampler) => [1, sampler.index()],
        Technique::Mis(sampler) => [2, sampler.index()],
    };
    let at = cell(config, stream::MIS, case, &[kind, sampler, lit.index]);
    let tally = mis::estimate(case, technique, lit.light, at, n);
    let v = tally.moments.relative_variance().scale(technique.samples_each() as f64);
    MisRow {
        model: case.model,
        technique,
        name: technique.name(),
        light: lit.light.name().to_owned(),
        theta_o_deg: case.theta_o_deg,
        samples_each: technique.samples_each(),
        n,
        v,
        samples_for_1_percent: v.scale(1e4),
        max_contribution: in_means(&tally),
        mean: tally.moments.mean_estimate(),
        reference: *lit.reference,
        z: bias_z(&tally.moments, lit.reference),
        // Samples from the light hit it however small it is.
        tested: match technique {
            Technique::Bsdf(sampler) => measure::is_tested(n, lit.reference.predicted(sampler)),
            _ => true,
        },
    }
}

pub(super) fn convergence_point(
    config: &EfficiencyConfig<'_>,
    case: &Case,
    sampler: Sampler,
    sequence: SequenceKind,
    lit: &Lit<'_>,
    n: usize,
) -> ConvergencePoint {
    let randomisations = config.budget.convergence;
    let rest = [sampler.index(), kind_index(sequence), lit.index, n as u64];
    let at = cell(config, stream::CONVERGENCE, case, &rest);
    let tally = measure::means(case, sampler, sequence, lit.light, at, [n, randomisations]);
    ConvergencePoint {
        model: case.model,
        sampler,
        sequence,
        light: lit.light.name().to_owned(),
        theta_o_deg: case.theta_o_deg,
        n,
        randomisations,
        rms: rms_error(&tally.moments, lit.reference.value),
        z: bias_z(&tally.moments, lit.reference),
        tested: measure::is_tested(n * randomisations, lit.reference.predicted(sampler)),
    }
}

/// Root mean squared relative error about `truth`, with its standard error by the delta method.
///
/// The squared errors' mean is `m2 + d^2` and their variance `m4 - m2^2 + 4 d m3 + 4 d^2 m2`, with central moments `m` and the bias `d`.
fn rms_error(means: &Moments, truth: f64) -> Estimate {
    let n = means.count() as f64;
    let [m3, m4] = means.higher_moments();
    let m2 = means.variance() * (n - 1.0) / n;
    let d = means.mean() - truth;
    let mse = m2 + d * d;
    let var = (m4 - m2 * m2 + 4.0 * d * m3 + 4.0 * d * d * m2).max(0.0);
    let rms = mse.sqrt();
    Estimate { value: rms / truth, standard_error: (var / n).sqrt() / (2.0 * rms * truth) }
}

/// One width of the sweep, at a case made for it.
pub(super) fn sweep_row(config: &EfficiencyConfig<'_>, case: &Case, sampler: Sampler, beta_r_deg: f32) -> SweepRow {
    let n = config.budget.sweep;
    let at = cell(config, stream::SWEEP, case, &[sampler.index(), u64::from(beta_r_deg.to_bits())]);
    let tally = measure::independent(case, sampler, &Constant::white(), at, n);
    let exact = exact_variance(case, sampler);
    let v = tally.moments.relative_variance();
    let reference = Reference {
        value: exact.mean,
        standard_error: 0.0,
        quadrature_error: exact.mean_error,
        method: ReferenceMethod::Quadrature,
        v: [exact.intensity; SAMPLERS.len()],
        skewness: [0.0; SAMPLERS.len()],
    };
    SweepRow {
        model: case.model,
        sampler,
        beta_r_deg,
        theta_o_deg: case.theta_o_deg,
        n,
        v,
        quadrature: exact.intensity,
        z_quadrature: agreement(v, exact.intensity),
        z: bias_z(&tally.moments, &reference),
    }
}

/// Distance of a measured V to the exact one in standard errors. Hair that scatters nothing has neither: 0.
fn agreement(v: Estimate, exact: f64) -> f64 {
    if v.value.is_nan() && exact.is_nan() { 0.0 } else { v.z_score(exact) }
}

/// V under constant light against quadrature and, for the default hair, against its recorded figures. `v` is that of the independent row.
pub(super) fn reference_v(config: &EfficiencyConfig<'_>, case: &Case, sampler: Sampler, v: Estimate) -> ReferenceV {
    let exact = exact_variance(case, sampler);
    let recorded =
        (config.params == HairParams::default()).then(|| recorded_v(case.model, sampler, case.theta_o_deg)).flatten();
    let rounded = Estimate { standard_error: v.standard_error.hypot(ROUNDING), ..v };
    ReferenceV {
        model: case.model,
        sampler,
        theta_o_deg: case.theta_o_deg,
        v,
        quadrature: exact.intensity,
        z_quadrature: agreement(v, exact.intensity),
        quadrature_luminance: exact.luminance,
        recorded,
        z_recorded: recorded.map(|p| rounded.z_score(p)),
    }
}

/// V of the default hair to three decimals, recorded by another implementation.
pub(super) fn recorded_v(model: ModelKind, sampler: Sampler, theta_o_deg: f64) -> Option<f64> {
    let figures = match (model, sampler) {
        (ModelKind::Gaussian, Sampler::Uniform) => [0.706, 0.931, 2.268],
        (ModelKind::Gaussian, Sampler::Published) => [0.209, 0.189, 0.290],
        (ModelKind::Cauchy, Sampler::Uniform) => [0.592, 0.832, 1.967],
        (ModelKind::Cauchy, Sampler::Published) => [0.150, 0.159, 0.232],
        // The recorded implementation has no other samplers.
        _ => return None,
    };
    [0.0, 45.0, 75.0].iter().position(|t| *t == theta_o_deg).map(|i| figures[i])
}

/// Deviation of the rounding to three decimals.
const ROUNDING: f64 = 0.000_5 * 0.577_350_269_189_625_8;
