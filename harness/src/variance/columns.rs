//! Columns of figures, as tables of studies and materials share them.

use super::{Measured, POOL_SIZES};
use crate::rays::{HALF, VISIBLE, occluded};
use hairis_instruments::columns::Columns;
use hairis_instruments::stats::Estimate;

/// Estimator of a ray.
#[derive(Clone, Copy, Debug)]
pub struct By {
    /// Name in tables.
    pub name: &'static str,
    /// Name in columns.
    pub column: &'static str,
    /// Number of candidates of each technique, if it chooses from candidates.
    pub candidates_each: Option<u32>,
}

/// Estimators of a ray: one-sample MIS, and choices from pools of [`POOL_SIZES`].
pub const RAYS: [By; 1 + POOL_SIZES.len()] = [
    By {
        name: "MIS",
        column: "mis",
        candidates_each: None,
    },
    By {
        name: "4 + 4",
        column: "4_4",
        candidates_each: Some(POOL_SIZES[0]),
    },
    By {
        name: "8 + 8",
        column: "8_8",
        candidates_each: Some(POOL_SIZES[1]),
    },
];

/// Index in [`RAYS`] of one-sample MIS.
pub const MIS: usize = 0;
/// Indices in [`RAYS`] of the pools.
pub const POOLS: [usize; POOL_SIZES.len()] = [1, 2];

/// Returns V of one ray without occlusion, by index in [`RAYS`], or NaN if it was not measured.
#[must_use]
pub fn ray_v(measured: &Measured, by: usize) -> Estimate {
    measured.rays.map_or(Estimate::UNKNOWN, |rays| rays[by])
}

/// Returns V with half of the directions visible.
#[must_use]
pub fn half_visible(measured: &Measured, by: usize) -> Estimate {
    occluded(ray_v(measured, by), HALF)
}

/// Adds the columns of V of one ray.
fn rays(mut columns: Columns, rows: &[&Measured]) -> Columns {
    for (by, By { column, .. }) in RAYS.iter().enumerate() {
        let v = || rows.iter().map(move |row| ray_v(row, by));
        columns = columns.estimate(&format!("v_{column}"), v());
        for share in VISIBLE {
            let name = format!("v_{column}_visible_{:.0}", 100.0 * share);
            columns = columns.number(name, v().map(|v| occluded(v, share).value));
        }
    }
    columns.number(
        "pool_bias",
        rows.iter().map(|row| row.bias.unwrap_or(f64::NAN)),
    )
}

/// Adds the columns of figures, after those that identify a row.
#[must_use]
pub fn figures_of(columns: Columns, rows: &[&Measured]) -> Columns {
    let figures = |of: fn(&Measured) -> f64| rows.iter().map(move |row| of(row));
    let columns = columns
        .estimate("mean", rows.iter().map(|row| row.figures.mean))
        .estimate("v", rows.iter().map(|row| row.figures.v))
        .number(
            "ess_per_1000",
            figures(|m| 1_000.0 / (1.0 + m.figures.v.value)),
        )
        .number(
            "samples_for_1_percent",
            figures(|m| m.figures.v.value * 1e4),
        )
        .number("max_weight", figures(|m| m.max_weight))
        .number(
            "weight_bound",
            figures(|m| m.weight_bound.unwrap_or(f64::NAN)),
        )
        .number("max_contribution", figures(|m| m.max_contribution))
        .estimate("kl", rows.iter().map(|row| row.figures.kl));
    rays(columns, rows)
}
