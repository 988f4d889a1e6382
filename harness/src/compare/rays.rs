//! Tables and the plot of one ray for many candidates.

use super::{Comparison, Depth};
use crate::light::in_words;
use crate::plot::{Axis, LineChart, Series};
use crate::rays::{EqualTime, OneRay, PRICES_US, RayRow, RayTimes, SIZES, VISIBLE, equal_time};
use crate::report::Drawing;
use crate::table::{Table, number};

/// Candidates of each technique whose V is shown.
const SHOWN: [u32; 3] = [4, 8, 16];

/// Pools in the plot: candidates of each technique, and rays.
const PLOTTED: [[u32; 2]; 5] = [[4, 1], [8, 1], [16, 4], [16, 8], [32, 16]];

/// Samplers in the summary: the published one, the default, and those that models have on their own.
const DEFAULTS: [&str; 4] = ["published", "matched", "its own", "mean"];

/// The model and sampler of the plot and of the sentence.
const EXAMPLE: [&str; 2] = ["gaussian", "published"];

/// A row with its times and efficiencies.
type Measured<'a> = (&'a RayRow, &'a RayTimes, &'a EqualTime);

fn measured(of: &Comparison) -> impl Iterator<Item = Measured<'_>> {
    let rays = &of.rays;
    rays.rows.iter().zip(&rays.times).zip(&rays.equal_time).map(|((row, times), equal)| (row, times, equal))
}

/// Name of the environment light.
fn environment(of: &Comparison) -> &str {
    of.efficiency.settings.lights.last().map_or("", String::as_str)
}

fn under_environment(of: &Comparison) -> impl Iterator<Item = Measured<'_>> {
    measured(of).filter(|(row, ..)| row.light == environment(of))
}

fn example(of: &Comparison) -> Option<Measured<'_>> {
    under_environment(of).find(|(row, ..)| [row.model, row.sampler] == EXAMPLE)
}

/// A table whose rows begin with the model, the sampler and the light.
fn by_light(title: &str) -> Table {
    Table::new(title).texts(["model", "sampler", "light"])
}

fn keys(row: &RayRow) -> Vec<String> {
    [row.model, row.sampler, &row.light].map(str::to_owned).to_vec()
}

/// The tables.
pub(super) fn tables(of: &Comparison, depth: Depth) -> Vec<Table> {
    match depth {
        Depth::Summary => vec![summary(of)],
        Depth::Full => vec![unoccluded(of), visible(of), in_equal_time(of), fronts(of)],
    }
}

fn chosen(row: &RayRow, candidates_each: u32) -> Option<&OneRay> {
    let size = SIZES.iter().position(|count| *count == candidates_each)?;
    row.mean.chosen.get(size)
}

fn pool_name(candidates_each: u32) -> String {
    format!("{candidates_each} + {candidates_each}")
}

/// Headers of V of one ray, and their cells.
fn v_headers() -> impl Iterator<Item = String> {
    ["BSDF", "light", "MIS"].map(str::to_owned).into_iter().chain(SHOWN.map(pool_name))
}

fn v_cells(row: &RayRow, digits: impl Fn(&OneRay) -> String) -> Vec<String> {
    let plain = [&row.mean.bsdf, &row.mean.light, &row.mean.mis];
    plain.into_iter().chain(SHOWN.iter().filter_map(|count| chosen(row, *count))).map(digits).collect()
}

fn microseconds(price: f64) -> String {
    format!("{} µs", number::plain(price, 1))
}

fn break_even(price: Option<f64>) -> String {
    match price {
        Some(price) if price > 0.0 => number::plain(price, 2),
        Some(_) => "any".to_owned(),
        None => "never".to_owned(),
    }
}

fn summary(of: &Comparison) -> Table {
    let title = format!("One ray for many candidates, under {}", in_words(environment(of)));
    let mut table = Table::new(title).texts(["model", "sampler"]).numbers(v_headers());
    table = table.numbers(PRICES_US.map(microseconds)).number("from, µs");
    for (row, _, equal) in under_environment(of).filter(|(row, ..)| DEFAULTS.contains(&row.sampler)) {
        let mut cells = vec![row.model.to_owned(), row.sampler.to_owned()];
        cells.extend(v_cells(row, |one| number::plain(one.unoccluded.value, 3)));
        cells.extend(PRICES_US.map(|price| best_gain(equal, price)));
        cells.push(break_even(equal.pool(8, 1).and_then(|point| point.break_even_us)));
        table.push(cells);
    }
    table.note(
        "V of direct light from one ray without occlusion, geometric mean over the inclinations: drawn from the BSDF, from the \
         light, by one-sample MIS, and chosen from a pool. Then, with half of the directions visible, the efficiency of the best \
         pool over one-sample MIS at this price of a ray; from what price on one ray of 8 + 8 candidates is ahead.",
    )
}

fn best_gain(equal: &EqualTime, price: f64) -> String {
    equal.best(price).map_or_else(String::new, |point| number::ratio(point.gain_over(&equal.mis[0], price)))
}

fn unoccluded(of: &Comparison) -> Table {
    let mut table = by_light("V of one ray without occlusion").numbers(v_headers());
    table = table.numbers(SHOWN.map(|count| format!("MIS / {}", pool_name(count))));
    for (row, ..) in measured(of) {
        let mut cells = keys(row);
        cells.extend(v_cells(row, |one| number::estimate(&one.unoccluded)));
        let gain = |count| Some(row.mean.mis.unoccluded.ratio(&chosen(row, count)?.unoccluded));
        cells.extend(SHOWN.map(|count| gain(count).map_or_else(String::new, |gain| number::estimate(&gain))));
        table.push(cells);
    }
    table.note(
        "Relative variance of direct light from one ray, geometric mean over the inclinations, ± one standard error.",
    )
}

fn visible(of: &Comparison) -> Table {
    let mut table = by_light("V of one ray with visibility").text("visible").numbers(v_headers());
    table = table.number("16 rays of 32 + 32");
    for (row, ..) in measured(of) {
        for (place, share) in VISIBLE.into_iter().enumerate() {
            let mut cells = keys(row);
            cells.push(number::percent(share));
            cells.extend(v_cells(row, |one| number::estimate(&one.visible[place])));
            let sixteen = row.mean.half.iter().find(|pool| (pool.candidates_each, pool.rays) == (32, 16));
            let per_ray = sixteen.filter(|_| share == crate::rays::HALF).map(|pool| pool.v.scale(16.0));
            cells.push(per_ray.map_or_else(String::new, |v| number::estimate(&v)));
            table.push(cells);
        }
    }
    table.note(
        "A ray passes with this probability, drawn for each direction on its own: V of one ray is (V + 1)/v − 1, exactly. Of \
         sixteen rays from a pool it is measured; V times 16, to be compared with one ray.",
    )
}

fn in_equal_time(of: &Comparison) -> Table {
    let mut table = by_light("Rays in equal time, half of the directions visible")
        .numbers(["MIS, ns", "candidate, ns", "of 32 + 32, 16 rays"])
        .numbers(PRICES_US.map(|price| format!("8 + 8, {}", microseconds(price))))
        .numbers(PRICES_US.map(|price| format!("best, {}", microseconds(price))))
        .numbers(["4 + 4 from, µs", "8 + 8 from, µs", "any pool from, µs"]);
    for (row, times, equal) in measured(of) {
        let mut cells = keys(row);
        cells.extend([times.mis_ns, times.candidate_ns(), times.shared_candidate_ns()].map(|ns| number::plain(ns, 3)));
        let eight = equal.pool(8, 1).map_or([const { String::new() }; 4], |eight| eight.gain.map(number::ratio));
        cells.extend(eight);
        let best = |point| format!(" ({})", point_name(point));
        cells.extend(PRICES_US.map(|price| best_gain(equal, price) + &equal.best(price).map_or(String::new(), best)));
        cells.extend([4, 8].map(|count| break_even(equal.pool(count, 1).and_then(|point| point.break_even_us))));
        let first = equal.pools.iter().filter_map(|point| point.break_even_us).min_by(f64::total_cmp);
        cells.push(break_even(first));
        table.push(cells);
    }
    table.note(
        "Efficiency 1 / (V · time) over one-sample MIS at the same price of a ray. Times are those of candidates, weights, \
         look-ups of the light and the choice on one thread, per candidate of 16 + 16 with one ray and of 32 + 32 with 16 rays; numbers, the light's directions and the preparation of the shading \
         point are left out of both. In brackets: candidates, and rays chosen from them.",
    )
}

fn point_name(point: &equal_time::Point) -> String {
    match point.candidates_each {
        0 => format!("MIS: {}", point.rays),
        count => format!("{}: {}", pool_name(count), point.rays),
    }
}

fn fronts(of: &Comparison) -> Table {
    let title = format!("Pareto fronts of time and V, under {}", in_words(environment(of)));
    let mut table = Table::new(title).texts(["model", "sampler", "price of a ray", "front"]);
    for (row, _, equal) in under_environment(of) {
        for (place, price) in PRICES_US.into_iter().enumerate() {
            let mut front: Vec<_> =
                equal.mis.iter().chain(&equal.pools).filter(|point| point.on_front[place]).collect();
            front.sort_by(|a, b| a.time_ns(price).total_cmp(&b.time_ns(price)));
            let names: Vec<String> = front.into_iter().map(point_name).collect();
            table.push([row.model.to_owned(), row.sampler.to_owned(), microseconds(price), names.join(", ")]);
        }
    }
    table.note(
        "Candidates of the BSDF and of the light, and rays chosen from them; or rays by one-sample MIS. From the fastest to the \
         most exact; half of the directions visible. All points are in compare.json.",
    )
}

/// Gains over one-sample MIS against the price of a ray.
pub(super) fn chart(of: &Comparison) -> Option<Drawing> {
    let (row, _, equal) = example(of)?;
    let words = in_words(&row.light);
    let title = format!("Efficiency over one-sample MIS, {} model, {words}", row.model);
    let mut chart = LineChart::new(title, Axis::log("price of a ray (µs)"), Axis::log("times as efficient (×)"));
    let prices = || (0..=48).map(|step| 10.0_f64.powf(-3.0 + f64::from(step) / 12.0));
    for point in PLOTTED.iter().filter_map(|[count, rays]| equal.pool(*count, *rays)) {
        let gains = prices().map(|price| (price, point.gain_over(&equal.mis[0], price)));
        let rays = if point.rays == 1 { "ray" } else { "rays" };
        let name = format!("{}, {} {rays}", pool_name(point.candidates_each), point.rays);
        chart = chart.series(Series::curve(name, gains));
    }
    let caption = format!(
        "Rays chosen from pools of candidates against rays by one-sample MIS in equal time, by the price of a ray: {} model, {} \
         sampler, {words}, half of the directions visible, geometric mean over the inclinations.",
        row.model, row.sampler
    );
    Some(Drawing::new(chart.reference("one-sample MIS", 0.0, (1.0, 1.0)).svg(), caption).named("rays-by-price"))
}

/// The answer in a sentence.
pub(super) fn finding(of: &Comparison) -> Option<String> {
    let (row, _, equal) = example(of)?;
    let [four, eight] = [4, 8].map(|count| Some(row.mean.mis.unoccluded.ratio(&chosen(row, count)?.unoccluded)));
    Some(format!(
        "A ray chosen from 4 + 4 candidates has 1/{} of the variance of one-sample MIS under {}, from 8 + 8 candidates 1/{} \
         ({} model, {} sampler, without occlusion); with half of the directions visible, pools are {} as efficient where a ray \
         costs 1 µs.",
        number::plain(four?.value, 3),
        in_words(&row.light),
        number::plain(eight?.value, 3),
        row.model,
        row.sampler,
        best_gain(equal, 1.0)
    ))
}
