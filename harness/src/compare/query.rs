//! Queries to a comparison that tables, plots and verdicts share.

use super::Comparison;
use crate::efficiency::EfficiencyRow;
use crate::sampler::Sampler;
use crate::subject::ModelKind;
use hairis_instruments::sequence::SequenceKind;

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

/// Returns V of the published sampler on the Gaussian model over V of another estimator, seen from [`THETA_O_DEG`]. V is as measured if
/// enough samples hit the light, and as predicted otherwise.
pub(super) fn v_gain(of: &Comparison, light: &str, other: (ModelKind, Sampler)) -> Option<f64> {
    let v = |estimator| {
        let row = of.efficiency.rows.iter().find(|row| {
            (row.model, row.sampler) == estimator
                && (row.sequence, row.theta_o_deg) == (SequenceKind::Independent, THETA_O_DEG)
                && row.light == light
        })?;
        Some(if row.tested {
            row.v.value
        } else {
            predicted(row, row.sampler)
        })
    };
    Some(v((ModelKind::Gaussian, Sampler::Published))? / v(other)?)
}

/// Returns V of a sampler as the reference of a row predicts it.
pub(super) fn predicted(row: &EfficiencyRow, sampler: Sampler) -> f64 {
    row.reference.predicted(sampler)[0]
}
