//! The section on rays chosen from candidates.

use super::super::cell::Measured;
use super::super::equal_time::{CellCounts, in_equal_time};
use super::super::rays::{By, half_visible, times_at, v};
use super::super::summary::{Gain, gain, shown, sure_ratio};
use super::view::{Estimator, View};
use crate::plot::{Axis, Bar, BarChart};
use crate::rays::{PRICES_US, VISIBLE, occluded};
use crate::report::{Drawing, Section};
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::table::{Table, number};

/// The pools, by place.
const POOLS: [By; 2] = [By::Pool(0), By::Pool(1)];

pub(super) fn section(of: &View<'_>) -> Section {
    let section = Section::new("Rays from candidates").paragraph(
        "A ray of direct light by one-sample MIS (BSDF or light, the balance heuristic), or chosen by `hairis::resample` from \
         4 + 4 or 8 + 8 candidates of the BSDF and of the light. V is that of one ray; where a share v of the directions is \
         visible it is (V + 1)/v − 1.",
    );
    let section = ModelKind::ALL.into_iter().fold(section, |section, model| section.figure(chart(of, model)));
    section.table(variances(of)).table(equal_time(of))
}

/// V of `base` over V of `other`, cell by cell.
fn ratio(of: &View<'_>, one: Estimator, light: usize, [base, other]: [By; 2]) -> Option<Gain> {
    gain(pairs(of, one, light, |measured| [v(measured, base), v(measured, other)]))
}

/// A pair of figures of every cell.
fn pairs(
    of: &View<'_>,
    one: Estimator,
    light: usize,
    pair: impl Fn(&Measured) -> [Estimate; 2],
) -> impl Iterator<Item = [Estimate; 2]> {
    (0..of.cells.len()).map(move |index| pair(of.measured(index, one, light)))
}

/// Every sampler under every light.
fn each(of: &View<'_>) -> impl Iterator<Item = (Estimator, usize, Vec<String>)> {
    let samplers = ModelKind::ALL.into_iter().flat_map(|model| Sampler::ALL.map(|sampler| (model, sampler)));
    samplers.flat_map(|one| {
        of.lights.iter().enumerate().map(move |(light, name)| {
            (one, light, vec![one.0.name().to_owned(), one.1.name().to_owned(), name.clone()])
        })
    })
}

fn keys(title: &str) -> Table {
    Table::new(title).texts(["model", "sampler", "light"])
}

/// Medians of V and of its ratios to that of MIS.
fn variances(of: &View<'_>) -> Table {
    let mut table = keys("V of one ray, medians over the grid").numbers(By::ALL.map(By::name));
    table = table.numbers(POOLS.map(|by| format!("{} / MIS", by.name()))).number("cells with less");
    table = table.numbers(VISIBLE.map(|share| format!("8 + 8 / MIS, {:.0}% visible", 100.0 * share)));
    for (one, light, mut row) in each(of) {
        let median = |by| gain(pairs(of, one, light, |measured| [v(measured, by), Estimate::exact(1.0)]));
        let cell = |found: Option<Gain>| found.map_or_else(String::new, |found| shown(found.median));
        row.extend(By::ALL.map(|by| cell(median(by))));
        row.extend(POOLS.map(|by| cell(ratio(of, one, light, [by, By::Mis]))));
        let less = POOLS.map(|by| ratio(of, one, light, [by, By::Mis]));
        row.push(less.map(|found| found.map_or_else(String::new, |found| number::percent(found.shares[1]))).join(", "));
        row.extend(VISIBLE.map(|share| {
            let visible = |measured: &Measured| [By::Pool(1), By::Mis].map(|by| occluded(v(measured, by), share));
            cell(gain(pairs(of, one, light, visible)))
        }));
        table.push(row);
    }
    table.note(
        "Without occlusion but for the last columns. Cells with less: than MIS beyond two standard errors, of 4 + 4 and of 8 + 8. \
         ±: one standard error of the median cell.",
    )
}

/// Gains over MIS in equal time, by the price of a ray.
fn equal_time(of: &View<'_>) -> Table {
    let mut table = keys("Rays from candidates over MIS in equal time, half of the directions visible");
    table = table.numbers(By::ALL.map(|by| format!("{}, ns", by.name())));
    for by in POOLS {
        table = table.numbers(PRICES_US.map(|price| format!("{}, {price} µs", by.name())));
    }
    for (one, light, mut row) in each(of) {
        let ns = |by| of.times.ray_ns(one, &of.lights[light], by);
        let is_timed = ns(By::Mis).value.is_finite();
        let cell = |text: String| if is_timed { text } else { "not timed".to_owned() };
        row.extend(By::ALL.map(|by| cell(number::plain(ns(by).value, 3))));
        for by in POOLS {
            let half = |measured: &Measured| [By::Mis, by].map(|by| half_visible(measured, by));
            let median = gain(pairs(of, one, light, half)).map(|gain| gain.median);
            row.extend(PRICES_US.map(|price| {
                let time = times_at([ns(By::Mis), ns(by)], price);
                let won = CellCounts::count(pairs(of, one, light, half).map(sure_ratio), time).won;
                let share = number::percent(won as f64 / of.cells.len() as f64);
                let gain = |median| format!("{} ({share})", number::ratio(in_equal_time(median, time).value));
                cell(median.map_or_else(String::new, gain))
            }));
        }
        table.push(row);
    }
    table.note(
        "Efficiency 1 / (V · time) over one-sample MIS at the same price of a ray: median, and the share of cells won beyond two \
         standard errors. Times of candidates, weights, look-ups of the light and the choice, of the default hair on one \
         thread of this machine; the light's directions are drawn beforehand.",
    )
}

/// V of MIS over V of a ray from 8 + 8 candidates, by light.
fn chart(of: &View<'_>, model: ModelKind) -> Drawing {
    let title = format!("Variance of MIS over that of a ray from 8 + 8 candidates, {} model", model.title());
    let mut chart = BarChart::new(title, Axis::log("V MIS / V 8 + 8 (×)"), of.light_labels());
    for sampler in Sampler::ALL {
        let bar = |light| {
            let found = ratio(of, (model, sampler), light, [By::Mis, By::Pool(1)]);
            found.map_or(Bar::new(f64::NAN), |gain| {
                let [low, high] = gain.quartiles;
                Bar::new(gain.median.value).with_interval(low, high)
            })
        };
        chart = chart.series(sampler.name(), (0..of.lights.len()).map(bar));
    }
    let caption = "By what factor less variance one ray has that is chosen from 8 + 8 candidates, without occlusion, by light. \
                   Medians over the grid; whiskers go from the first to the third quartile.";
    Drawing::new(chart.level(1.0).svg(), caption).named(format!("rays-from-candidates-{}", model.name()))
}
