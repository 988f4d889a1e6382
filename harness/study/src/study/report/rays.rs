//! Section of the report on rays that are chosen from candidates.

use super::super::equal_time::count_cells;
use super::super::estimator::{Estimator, on_each_model, samplers};
use super::super::finished::Study;
use super::super::rays::times_at;
use super::super::summary::shown;
use super::super::view::{Gain, gain, sure_ratio};
use super::charts::{MEDIANS, each_model, median_bar, samplers_on};
use hairis_harness::rays::{PRICES_US, VISIBLE, occluded};
use hairis_harness::variance::{MIS, POOLS, RAYS, half_visible, ray_v};
use hairis_instruments::plot::Axis;
use hairis_instruments::report::{Drawing, Section};
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::{Table, number};

pub(super) fn section(of: &Study) -> Section {
    let section = Section::new("Rays from candidates").paragraph(
        "A ray of direct light by one-sample MIS (BSDF or light, the balance heuristic), or chosen by `hairis::resample` from \
         4 + 4 or 8 + 8 candidates of the BSDF and of the light. V is that of one ray; where a share v of the directions is \
         visible it is (V + 1)/v − 1.",
    );
    section
        .figures(charts(of))
        .tables([variances(of), equal_time(of)])
}

/// Returns V of a ray by `base` over V of a ray by `other`, cell by cell.
fn ratio(of: &Study, one: Estimator, light: usize, [base, other]: [usize; 2]) -> Option<Gain> {
    gain(
        of.rows_of(one, light)
            .map(|row| [base, other].map(|by| ray_v(row.measured, by))),
    )
}

/// Returns the table of medians of V and of its ratios to that of MIS.
fn variances(of: &Study) -> Table {
    let headers = RAYS.iter().map(|by| by.name.to_owned());
    let headers = headers.chain(POOLS.map(|by| format!("{} / MIS", RAYS[by].name)));
    let headers = headers.chain(["cells with less".to_owned()]);
    let headers =
        headers.chain(VISIBLE.map(|share| format!("8 + 8 / MIS, {:.0}% visible", 100.0 * share)));
    let title = "V of one ray, medians over the grid";
    let table = of.table(title, headers, on_each_model(samplers()), &|one, light| {
        let rows = || of.rows_of(one, light);
        let median = |found: &Option<Gain>| {
            found
                .as_ref()
                .map_or_else(String::new, |found| shown(found.median))
        };
        let plain = |by| gain(rows().map(|row| [ray_v(row.measured, by), Estimate::exact(1.0)]));
        let of_mis = POOLS.map(|by| ratio(of, one, light, [by, MIS]));
        let less = |found: &Option<Gain>| {
            found
                .as_ref()
                .map_or_else(String::new, |of| number::percent(of.shares[1]))
        };
        let visible = |share| {
            gain(
                rows()
                    .map(|row| [POOLS[1], MIS].map(|by| occluded(ray_v(row.measured, by), share))),
            )
        };
        let mut cells: Vec<String> = (0..RAYS.len()).map(|by| median(&plain(by))).collect();
        cells.extend(of_mis.each_ref().map(median));
        cells.push(of_mis.each_ref().map(less).join(", "));
        cells.extend(VISIBLE.map(|share| median(&visible(share))));
        cells
    });
    table.note(
        "Without occlusion but for the last columns. Cells with less: than MIS beyond two standard errors, of 4 + 4 and of 8 + 8. \
         ±: one standard error of the median cell.",
    )
}

/// Returns the table of gains over MIS in equal time, by the price of a ray.
fn equal_time(of: &Study) -> Table {
    let prices = POOLS.map(|by| PRICES_US.map(|price| format!("{}, {price} µs", RAYS[by].name)));
    let headers = RAYS
        .iter()
        .map(|by| format!("{}, ns", by.name))
        .chain(prices.into_iter().flatten());
    let title = "Rays from candidates over MIS in equal time, half of the directions visible";
    let table = of.table(title, headers, on_each_model(samplers()), &|one, light| {
        let ns = [0, 1, 2].map(|by| of.ray_ns(one, light, by));
        if !ns[MIS].value.is_finite() {
            return vec!["not timed".to_owned(); RAYS.len() + POOLS.len() * PRICES_US.len()];
        }
        let mut cells: Vec<String> = ns.iter().map(|ns| number::plain(ns.value, 3)).collect();
        for by in POOLS {
            let pairs = || {
                of.rows_of(one, light)
                    .map(|row| [MIS, by].map(|by| half_visible(row.measured, by)))
            };
            let median = gain(pairs()).map(|gain| gain.median);
            cells.extend(PRICES_US.map(|price| {
                let time = times_at([ns[MIS], ns[by]], price);
                let [won, ..] = count_cells(pairs().map(sure_ratio), time);
                let share = number::percent(won as f64 / of.cells.len() as f64);
                let gain = |median: Estimate| {
                    format!("{} ({share})", number::ratio(median.times(&time).value))
                };
                median.map_or_else(String::new, gain)
            }));
        }
        cells
    });
    table.note(
        "Efficiency 1 / (V · time) over one-sample MIS at the same price of a ray: median, and the share of cells won beyond two \
         standard errors. Times of candidates, weights, look-ups of the light and the choice, of the default hair on one \
         thread of this machine; the light's directions are drawn beforehand.",
    )
}

/// Draws V of MIS over V of a ray from 8 + 8 candidates, by light.
fn charts(of: &Study) -> Vec<Drawing> {
    let caption = "By what factor less variance one ray has that is chosen from 8 + 8 candidates, without occlusion, by light.";
    each_model(
        "rays-from-candidates",
        &format!("{caption} {MEDIANS}"),
        &|model| {
            let title = format!(
                "Variance of MIS over that of a ray from 8 + 8 candidates, {} model",
                model.title()
            );
            let axis = Axis::log("V MIS / V 8 + 8 (×)");
            of.by_light(&title, axis, 1.0, &mut samplers_on(model), &|one, light| {
                median_bar(ratio(of, one, light, [MIS, POOLS[1]]), 1.0)
            })
        },
    )
}
