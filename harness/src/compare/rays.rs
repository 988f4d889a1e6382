//! Tables and plot of one ray that is chosen from many candidates.

use super::Comparison;
use super::query::Depth;
use crate::lights::{environment, in_words};
use crate::rays::{
    EqualTime, HALF, OneRay, PRICES_US, RayRow, RayTimes, SIZES, VISIBLE, equal_time,
};
use core::iter;
use hairis_instruments::plot::{Axis, Series, lines};
use hairis_instruments::report::Drawing;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::{Table, number};

/// Candidates of each technique for which V is shown.
const SHOWN: [u32; 3] = [4, 8, 16];

/// Pools in the plot: number of candidates of each technique, and of rays.
const PLOTTED: [[u32; 2]; 5] = [[4, 1], [8, 1], [16, 4], [16, 8], [32, 16]];

/// Samplers in the summary: the published one, the default, and those of models with a single sampler.
const DEFAULTS: [&str; 4] = ["published", "matched", "its own", "mean"];

/// Model and sampler of the plot and of the sentence.
const EXAMPLE: [&str; 2] = ["gaussian", "published"];

/// Row with its times and efficiencies.
type Measured<'a> = (&'a RayRow, &'a RayTimes, &'a EqualTime);

fn measured(of: &Comparison) -> impl Iterator<Item = Measured<'_>> {
    let rays = &of.rays;
    rays.rows
        .iter()
        .zip(&rays.times)
        .zip(&rays.equal_time)
        .map(|((row, times), equal)| (row, times, equal))
}

fn under_environment(of: &Comparison) -> impl Iterator<Item = Measured<'_>> {
    let lights = &of.efficiency.settings.lights;
    let environment = environment(lights).map(|place| &lights[place]);
    measured(of).filter(move |(row, ..)| Some(&row.light) == environment)
}

fn example(of: &Comparison) -> Option<Measured<'_>> {
    under_environment(of).find(|(row, ..)| [row.model, row.sampler] == EXAMPLE)
}

/// Returns the tables. The summary has the samplers in [`DEFAULTS`] under the environment.
pub(super) fn tables(of: &Comparison, depth: Depth) -> Vec<Table> {
    if depth == Depth::Summary {
        let rows = under_environment(of).filter(|(row, ..)| DEFAULTS.contains(&row.sampler));
        let rows: Vec<Measured<'_>> = rows.collect();
        return vec![variances(&rows, &[1.0]), in_equal_time(&rows)];
    }
    let rows: Vec<Measured<'_>> = measured(of).collect();
    let shares: Vec<f64> = iter::once(1.0).chain(VISIBLE).collect();
    vec![variances(&rows, &shares), in_equal_time(&rows), fronts(of)]
}

fn keys(row: &RayRow) -> [String; 3] {
    [row.model, row.sampler, &row.light].map(str::to_owned)
}

fn pool_name(candidates_each: u32) -> String {
    format!("{candidates_each} + {candidates_each}")
}

/// Returns one ray of the BSDF, of the light, of MIS, and from each of the pools of [`SHOWN`].
fn shown(row: &RayRow) -> Vec<&OneRay> {
    let pools = SIZES
        .iter()
        .zip(&row.mean.chosen)
        .filter(|(size, _)| SHOWN.contains(size))
        .map(|(_, one)| one);
    [&row.mean.bsdf, &row.mean.light, &row.mean.mis]
        .into_iter()
        .chain(pools)
        .collect()
}

/// Returns V of MIS over V from each pool of [`SHOWN`], given V of [`shown`].
fn over_pools(v: &[Estimate]) -> impl Iterator<Item = Estimate> {
    v.iter().skip(3).map(|pool| v[2].ratio(pool))
}

/// Returns the table of V of one ray if these shares of the directions are visible.
fn variances(rows: &[Measured<'_>], shares: &[f64]) -> Table {
    let mut table = Table::new("V of one ray")
        .texts(["model", "sampler", "light", "visible"])
        .numbers(["BSDF", "light", "MIS"])
        .numbers(SHOWN.map(pool_name))
        .numbers(SHOWN.map(|count| format!("MIS / {}", pool_name(count))))
        .numbers(["16 rays of 32 + 32"]);
    for (row, ..) in rows {
        for (place, share) in shares.iter().enumerate() {
            let v = |one: &OneRay| {
                place
                    .checked_sub(1)
                    .map_or(one.unoccluded, |place| one.visible[place])
            };
            let v: Vec<Estimate> = shown(row).into_iter().map(v).collect();
            let sixteen = row
                .mean
                .half
                .iter()
                .find(|pool| (pool.candidates_each, pool.rays) == (32, 16));
            let per_ray = sixteen
                .filter(|_| *share == HALF)
                .map(|pool| pool.v.scale(16.0));
            let estimates = v
                .iter()
                .copied()
                .chain(over_pools(&v))
                .chain(per_ray)
                .map(|v| number::estimate(&v));
            table.push(
                keys(row)
                    .into_iter()
                    .chain([number::percent(*share)])
                    .chain(estimates),
            );
        }
    }
    table.note(
        "Relative variance of direct light from one ray, geometric mean over the inclinations, ± one standard error. A ray passes \
         with the probability visible, drawn for each direction on its own: its V is (V + 1)/v − 1, exactly. Of sixteen rays \
         from a pool it is measured; V times 16, to be compared with one ray.",
    )
}

fn best_gain(equal: &EqualTime, price: f64) -> String {
    equal.best(price).map_or_else(String::new, |point| {
        number::ratio(point.gain_over(&equal.mis[0], price))
    })
}

fn break_even(price: Option<f64>) -> String {
    match price {
        Some(price) if price > 0.0 => number::plain(price, 2),
        Some(_) => "any".to_owned(),
        None => "never".to_owned(),
    }
}

fn in_equal_time(rows: &[Measured<'_>]) -> Table {
    let mut table = Table::new("Rays in equal time, half of the directions visible")
        .texts(["model", "sampler", "light"])
        .numbers(["MIS, ns", "candidate, ns", "of 32 + 32, 16 rays"])
        .numbers(PRICES_US.map(|price| format!("8 + 8, {price} µs")))
        .numbers(PRICES_US.map(|price| format!("best, {price} µs")))
        .numbers(["4 + 4 from, µs", "8 + 8 from, µs", "any pool from, µs"]);
    for (row, times, equal) in rows {
        let ns = [
            times.mis_ns,
            times.candidate_ns(),
            times.shared_candidate_ns(),
        ]
        .map(|ns| number::plain(ns, 3));
        let eight = equal
            .pool(8, 1)
            .map_or([const { String::new() }; 4], |eight| {
                eight.gain.map(number::ratio)
            });
        let name = |price| equal.best(price).map_or_else(String::new, point_name);
        let best = PRICES_US.map(|price| format!("{} ({})", best_gain(equal, price), name(price)));
        let first = equal
            .pools
            .iter()
            .filter_map(|point| point.break_even_us)
            .min_by(f64::total_cmp);
        let [four, eight_from] =
            [4, 8].map(|count| equal.pool(count, 1).and_then(|point| point.break_even_us));
        let from = [four, eight_from, first].map(break_even);
        table.push(
            keys(row)
                .into_iter()
                .chain(ns)
                .chain(eight)
                .chain(best)
                .chain(from),
        );
    }
    table.note(
        "Efficiency 1 / (V · time) over one-sample MIS at the same price of a ray. Times are those of candidates, weights, \
         look-ups of the light and the choice on one thread, per candidate of 16 + 16 with one ray and of 32 + 32 with 16 \
         rays; numbers, the light's directions and the preparation of the shading point are left out of both. In brackets: \
         candidates, and rays chosen from them.",
    )
}

fn point_name(point: &equal_time::Point) -> String {
    match point.candidates_each {
        0 => format!("MIS: {}", point.rays),
        count => format!("{}: {}", pool_name(count), point.rays),
    }
}

fn fronts(of: &Comparison) -> Table {
    let mut table = Table::new("Pareto fronts of time and V under the environment").texts([
        "model",
        "sampler",
        "price of a ray",
        "front",
    ]);
    for (row, _, equal) in under_environment(of) {
        for (place, price) in PRICES_US.into_iter().enumerate() {
            let points = equal.mis.iter().chain(&equal.pools);
            let mut front: Vec<_> = points.filter(|point| point.on_front[place]).collect();
            front.sort_by(|a, b| a.time_ns(price).total_cmp(&b.time_ns(price)));
            let names: Vec<String> = front.into_iter().map(point_name).collect();
            table.push([
                row.model,
                row.sampler,
                &format!("{price} µs"),
                &names.join(", "),
            ]);
        }
    }
    table.note(
        "Candidates of the BSDF and of the light, and rays chosen from them; or rays by one-sample MIS. From the fastest to the \
         most exact; half of the directions visible. All points are in compare.json.",
    )
}

/// Draws the gains over one-sample MIS against the price of a ray.
pub(super) fn chart(of: &Comparison) -> Option<Drawing> {
    let (row, _, equal) = example(of)?;
    let words = in_words(&row.light);
    let mut series = Vec::new();
    for point in PLOTTED
        .iter()
        .filter_map(|[count, rays]| equal.pool(*count, *rays))
    {
        let prices = (0..=48).map(|step| 10.0_f64.powf(-3.0 + f64::from(step) / 12.0));
        let gains = prices.map(|price| (price, point.gain_over(&equal.mis[0], price)));
        let rays = if point.rays == 1 { "ray" } else { "rays" };
        series.push(Series::curve(
            format!(
                "{}, {} {rays}",
                pool_name(point.candidates_each),
                point.rays
            ),
            gains,
        ));
    }
    series.push(Series::guide("one-sample MIS", [(1e-3, 1.0), (10.0, 1.0)]));
    let title = format!(
        "Efficiency over one-sample MIS, {} model, {words}",
        row.model
    );
    let chart = lines(
        &title,
        Axis::log("price of a ray (µs)"),
        Axis::log("times as efficient (×)"),
        &series,
    );
    let caption = format!(
        "Rays chosen from pools of candidates against rays by one-sample MIS in equal time, by the price of a ray: {} model, {} \
         sampler, {words}, half of the directions visible, geometric mean over the inclinations.",
        row.model, row.sampler
    );
    Some(Drawing::new("rays-by-price", chart, caption))
}

/// Returns the finding about rays in a sentence.
pub(super) fn finding(of: &Comparison) -> Option<String> {
    let (row, _, equal) = example(of)?;
    let v: Vec<Estimate> = shown(row).iter().map(|one| one.unoccluded).collect();
    let mut gains = over_pools(&v).map(|gain| number::plain(gain.value, 3));
    Some(format!(
        "A ray chosen from 4 + 4 candidates has 1/{} of the variance of one-sample MIS under {}, from 8 + 8 candidates 1/{} \
         ({} model, {} sampler, without occlusion); with half of the directions visible, pools are {} as efficient where a ray \
         costs 1 µs.",
        gains.next()?,
        in_words(&row.light),
        gains.next()?,
        row.model,
        row.sampler,
        best_gain(equal, 1.0)
    ))
}
