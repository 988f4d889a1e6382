//! One ray of direct light in a cell: by one-sample MIS, and chosen from candidates; see [`rays`](crate::rays).

use super::cell::Measured;
use super::equal_time::time_ratio;
use super::output::Study;
use super::rows::Row;
use crate::rays::{HALF, PRICES_US, VISIBLE, occluded};
use hairis_instruments::columns::Columns;
use hairis_instruments::stats::Estimate;

/// Candidates of each technique in a pool.
pub(super) const SIZES: [u32; 2] = [4, 8];

/// Estimator of a ray: the name in tables, the name in columns, and the candidates of each technique, if it chooses.
pub(super) struct By {
    pub(super) name: &'static str,
    column: &'static str,
    pub(super) candidates_each: Option<u32>,
}

/// The estimators of a ray: one-sample MIS, and choices from pools of [`SIZES`].
pub(super) const RAYS: [By; 1 + SIZES.len()] = [
    By {
        name: "MIS",
        column: "mis",
        candidates_each: None,
    },
    By {
        name: "4 + 4",
        column: "4_4",
        candidates_each: Some(SIZES[0]),
    },
    By {
        name: "8 + 8",
        column: "8_8",
        candidates_each: Some(SIZES[1]),
    },
];

/// Places in [`RAYS`] of one-sample MIS and of the pools.
pub(super) const MIS: usize = 0;
pub(super) const POOLS: [usize; SIZES.len()] = [1, 2];

/// V of one ray without occlusion, by place in [`RAYS`]; not a number where there is none.
pub(super) fn v(measured: &Measured, by: usize) -> Estimate {
    measured.rays.map_or(Estimate::UNKNOWN, |rays| rays[by])
}

/// V with half of the directions visible.
pub(super) fn half_visible(measured: &Measured, by: usize) -> Estimate {
    occluded(v(measured, by), HALF)
}

/// Adds the columns of V.
pub(super) fn columns(mut columns: Columns, rows: &[Row<'_>]) -> Columns {
    for (by, By { column, .. }) in RAYS.iter().enumerate() {
        let v = || rows.iter().map(move |row| v(row.measured, by));
        columns = columns.estimate(&format!("v_{column}"), v());
        for share in VISIBLE {
            let name = format!("v_{column}_visible_{:.0}", 100.0 * share);
            columns = columns.number(name, v().map(|v| occluded(v, share).value));
        }
    }
    columns.number(
        "pool_bias",
        rows.iter().map(|row| row.measured.bias.unwrap_or(f64::NAN)),
    )
}

/// Adds the columns of times and of gains over one-sample MIS in equal time, half of the directions visible.
pub(super) fn efficiencies(mut columns: Columns, rows: &[Row<'_>], study: &Study) -> Columns {
    let ns: Vec<_> = rows
        .iter()
        .map(|row| [0, 1, 2].map(|by| study.ray_ns(row.of, row.light, by)))
        .collect();
    for (by, By { column, .. }) in RAYS.iter().enumerate() {
        columns = columns.estimate(&format!("ray_ns_{column}"), ns.iter().map(|ns| ns[by]));
    }
    for by in POOLS {
        for price in PRICES_US {
            let gain = |(row, ns): (&Row<'_>, &[Estimate; 3])| {
                let v = [MIS, by].map(|by| half_visible(row.measured, by));
                v[0].ratio(&v[1]).times(&times_at([ns[MIS], ns[by]], price))
            };
            let name = format!("gain_{}_at_{price}_us", RAYS[by].column);
            columns = columns.estimate(&name, rows.iter().zip(&ns).map(gain));
        }
    }
    columns
}

/// Time of a ray by the first over that by the second, each with its tracing at this price.
pub(super) fn times_at(pair: [Estimate; 2], price_us: f64) -> Estimate {
    time_ratio(pair, Estimate::exact(1e3 * price_us))
}
