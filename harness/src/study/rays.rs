//! One ray of direct light in a cell: by one-sample MIS, and chosen from candidates; see [`rays`](crate::rays).

use super::cell::Measured;
use super::columns::Columns;
use super::equal_time::{in_equal_time, time_ratio};
use super::output::Times;
use super::rows::Row;
use crate::rays::{HALF, PRICES_US, RaySubject, RayTimes, SIZES as ALL_SIZES, Unoccluded, VISIBLE, occluded};
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;

/// Candidates of each technique in a pool.
pub(super) const SIZES: [u32; 2] = [4, 8];

/// V of one ray of a cell, by one-sample MIS and by [`SIZES`].
pub(super) type Rays = Unoccluded<{ SIZES.len() }>;

/// How a ray of direct light is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    /// One-sample MIS.
    Mis,
    /// A pool, by place in [`SIZES`].
    Pool(usize),
}

impl By {
    pub(super) const ALL: [Self; 1 + SIZES.len()] = [Self::Mis, Self::Pool(0), Self::Pool(1)];

    /// Name in tables.
    pub(super) fn name(self) -> String {
        match self {
            Self::Mis => "MIS".to_owned(),
            Self::Pool(size) => format!("{0} + {0}", SIZES[size]),
        }
    }

    /// Name in columns.
    fn column(self) -> String {
        match self {
            Self::Mis => "mis".to_owned(),
            Self::Pool(size) => format!("{0}_{0}", SIZES[size]),
        }
    }
}

/// V of one ray without occlusion; not a number where there is none.
pub(super) fn v(measured: &Measured, by: By) -> Estimate {
    measured.rays.map_or(Estimate::UNKNOWN, |rays| match by {
        By::Mis => rays.mis,
        By::Pool(size) => rays.chosen[size],
    })
}

/// The same with half of the directions visible.
pub(super) fn half_visible(measured: &Measured, by: By) -> Estimate {
    occluded(v(measured, by), HALF)
}

/// Adds the columns of V.
pub(super) fn columns(mut columns: Columns, rows: &[Row<'_>]) -> Columns {
    for by in By::ALL {
        let each =
            |of: fn(Estimate, f64) -> f64, share: f64| rows.iter().map(move |row| of(v(row.measured, by), share));
        columns = columns.estimate(&format!("v_{}", by.column()), rows.iter().map(|row| v(row.measured, by)));
        for share in VISIBLE {
            let name = format!("v_{}_visible_{:.0}", by.column(), 100.0 * share);
            columns = columns.number(name, each(|v, share| occluded(v, share).value, share));
        }
    }
    columns.number("pool_bias", rows.iter().map(|row| row.measured.rays.and_then(|rays| rays.bias).unwrap_or(f64::NAN)))
}

/// Adds the columns of times and of gains over one-sample MIS in equal time, half of the directions visible.
pub(super) fn efficiencies(mut columns: Columns, rows: &[Row<'_>], lights: &[String], times: &Times) -> Columns {
    let ns = |row: &Row<'_>, by: By| {
        let sampler = row.strategy.sampler();
        sampler.map_or(Estimate::UNKNOWN, |sampler| times.ray_ns((row.model, sampler), &lights[row.light], by))
    };
    let all_ns: Vec<[Estimate; By::ALL.len()]> = rows.iter().map(|row| By::ALL.map(|by| ns(row, by))).collect();
    for (place, by) in By::ALL.into_iter().enumerate() {
        columns = columns.estimate(&format!("ray_ns_{}", by.column()), all_ns.iter().map(|ns| ns[place]));
    }
    for (place, by) in By::ALL.into_iter().enumerate().skip(1) {
        for price in PRICES_US {
            let gain = |(row, ns): (&Row<'_>, &[Estimate; By::ALL.len()])| {
                let v = [By::Mis, by].map(|by| half_visible(row.measured, by));
                in_equal_time(v[0].ratio(&v[1]), times_at([ns[0], ns[place]], price))
            };
            let name = format!("gain_{}_at_{price}_us", by.column());
            columns = columns.estimate(&name, rows.iter().zip(&all_ns).map(gain));
        }
    }
    columns
}

/// Time of a ray by the first over that by the second, each with its tracing at this price.
pub(super) fn times_at([base, other]: [Estimate; 2], price_us: f64) -> Estimate {
    time_ratio(base, other, Estimate::exact(1e3 * price_us))
}

/// The models and samplers of the study.
pub(super) fn subjects() -> Vec<RaySubject> {
    RaySubject::all().filter(|subject| ModelKind::ALL.iter().any(|model| model.name() == subject.model())).collect()
}

/// Time of a ray without its tracing, in ns; not a number if it was not measured.
pub(super) fn ns(times: &[RayTimes], (model, sampler): (ModelKind, Sampler), light: &str, by: By) -> Estimate {
    let is = |of: &&RayTimes| of.model == model.name() && of.sampler == sampler.name() && of.light == light;
    times.iter().find(is).map_or(Estimate::UNKNOWN, |found| match by {
        By::Mis => found.mis(),
        By::Pool(size) => {
            let place = ALL_SIZES.iter().position(|count| *count == SIZES[size]);
            place.map_or(Estimate::UNKNOWN, |place| found.chosen(place))
        }
    })
}
