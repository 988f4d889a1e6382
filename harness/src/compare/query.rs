//! Queries to a comparison that tables, plots and verdicts share.

use super::Comparison;
use crate::efficiency::{EfficiencyRow, Technique};
use crate::sampler::Sampler;
use crate::subject::ModelKind;
use hairis_instruments::sequence::SequenceKind;
use hairis_instruments::stats::Estimate;

/// Extent of a set of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depth {
    /// Rows that fit a terminal.
    Summary,
    /// Every row.
    Full,
}

/// Inclination of the viewer in the verdicts, degrees.
pub(super) const THETA_O_DEG: f64 = 45.0;

/// Returns the rows of a light that are seen from [`THETA_O_DEG`], with independent numbers.
fn rows<'a>(of: &'a Comparison, light: &'a str) -> impl Iterator<Item = &'a EfficiencyRow> {
    of.efficiency.rows.iter().filter(move |row| {
        (row.sequence, row.theta_o_deg) == (SequenceKind::Independent, THETA_O_DEG)
            && row.light == light
    })
}

/// Returns V of a row: as measured if enough samples hit the light, and as predicted otherwise.
fn v(row: &EfficiencyRow) -> Estimate {
    if row.tested {
        row.v
    } else {
        Estimate::exact(predicted(row, row.sampler))
    }
}

/// Returns V of the published sampler on the Gaussian model over V of another estimator, seen from [`THETA_O_DEG`].
pub(super) fn v_gain(
    of: &Comparison,
    light: &str,
    other: (ModelKind, Sampler),
) -> Option<Estimate> {
    let v = |estimator| {
        rows(of, light)
            .find(|row| (row.model, row.sampler) == estimator)
            .map(v)
    };
    Some(v((ModelKind::Gaussian, Sampler::Published))?.ratio(&v(other)?))
}

/// Returns V of the published sampler over that of the matched one on the Gaussian model, each combined with light sampling: the geometric
/// mean over the lights, seen from [`THETA_O_DEG`].
pub(super) fn v_gain_with_light(of: &Comparison) -> Option<Estimate> {
    let v = |light: &str, sampler| {
        let mut rows = of.efficiency.mis_rows.iter();
        let row = rows.find(|row| {
            (row.model, row.technique) == (ModelKind::Gaussian, Technique::Mis(sampler))
                && (row.light.as_str(), row.theta_o_deg) == (light, THETA_O_DEG)
        })?;
        row.tested.then_some(row.v)
    };
    let lights = of.efficiency.settings.lights.iter();
    let gains: Vec<Estimate> = lights
        .filter_map(|light| Some(v(light, Sampler::Published)?.ratio(&v(light, Sampler::Matched)?)))
        .collect();
    (!gains.is_empty()).then(|| Estimate::geometric_mean(&gains))
}

/// Returns the sampler of a model whose variance after a given time is least under a light, seen from [`THETA_O_DEG`].
pub(super) fn most_efficient(of: &Comparison, light: &str, model: ModelKind) -> Option<Sampler> {
    let of_model = rows(of, light).filter(|row| row.model == model);
    // The time of a sample is 1 / (V efficiency).
    let efficiency = |row: &EfficiencyRow| {
        Some(row.efficiency?.value * row.v.value / v(row).value).filter(|value| value.is_finite())
    };
    of_model
        .filter_map(|row| Some((row.sampler, efficiency(row)?)))
        .max_by(|(_, a), (_, b)| a.total_cmp(b))
        .map(|(sampler, _)| sampler)
}

/// Returns V of a sampler as the reference of a row predicts it.
pub(super) fn predicted(row: &EfficiencyRow, sampler: Sampler) -> f64 {
    row.reference.predicted(sampler)[0]
}
