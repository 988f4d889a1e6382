//! Times of one ray of direct light, and gains over one-sample MIS in equal time; see [`rays`](hairis_harness::rays).

use super::equal_time::time_ratio;
use super::finished::Study;
use super::rows::Row;
use hairis_harness::rays::PRICES_US;
use hairis_harness::variance::{By, MIS, POOLS, RAYS, half_visible};
use hairis_instruments::columns::Columns;
use hairis_instruments::stats::Estimate;

/// Adds the columns of times and of gains over one-sample MIS in equal time, with half of the directions visible.
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

/// Returns the time of a ray by the first over that by the second, each with its tracing at this price.
pub(super) fn times_at(pair: [Estimate; 2], price_us: f64) -> Estimate {
    time_ratio(pair, Estimate::exact(1e3 * price_us))
}
