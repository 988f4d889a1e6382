//! Tests of derivatives at the ends of all ranges against one-sided differences of the formulas in double precision.

use crate::differences::{Loss, Point, tangents};
use crate::support::{Found, Hits, Random, call};
use core::fmt;
use hairis::simd::Level;
use hairis_gradients::AnyGradients;
use hairis_variants::{Field, ModelId, Values};
use std::collections::BTreeMap;

/// Results whose derivatives are compared, with their weights.
const RESULTS: [(&str, [f32; 4]); 2] = [
    ("S", [1.0, 0.7, -0.4, 0.0]),
    ("density", [0.0, 0.0, 0.0, 1.0]),
];
/// Number of materials that are taken to their ends.
const MATERIALS: usize = 8;

/// Returns the derivative from within by a number that `moved` moves, or `None` if it is infinite.
///
/// The loss is infinitely steep if it has a term in the root of the step, or jumps. Differences then grow ever faster as the step shrinks.
fn one_sided(
    loss: &Loss<'_>,
    moved: &dyn Fn(f64) -> Point,
    [step, scale]: [f64; 2],
) -> Option<f64> {
    let at_end = loss.at(&moved(0.0));
    let slope = |step: f64| (loss.at(&moved(step)) - at_end) / step;
    let [a, b, c] = [step, step / 16.0, step / 256.0].map(slope);
    let of_root = (c - b) * (step * scale).sqrt() / 12.0;
    let least = 1e-4 * at_end.abs() + 1e-9 * (c * scale).abs();
    let is_infinite = (c - b).abs() > 2.0 * (b - a).abs() && of_root.abs() > least;
    (!is_infinite).then(|| 2.0 * slope(step / 512.0) - c)
}

/// Derivatives at one end: their count, those that are infinite, and the largest error.
#[derive(Default)]
struct Row {
    cases: usize,
    infinite: usize,
    error: f64,
    worst: String,
}

/// Rows by end, argument and result.
#[derive(Default)]
struct Table(BTreeMap<[String; 3], Row>);

impl Table {
    /// Compares a derivative with the expected one, relative to its size or to a thousandth of `least`.
    fn compare(
        &mut self,
        key: [&str; 3],
        got: f64,
        want: Option<f64>,
        least: f64,
        case: &dyn fmt::Debug,
    ) {
        let row = self.0.entry(key.map(str::to_owned)).or_default();
        row.cases += 1;
        row.infinite += usize::from(want.is_none());
        let want = want.unwrap_or(0.0);
        let error = (got - want).abs() / want.abs().max(1e-3 * least);
        if error > row.error || error.is_nan() {
            row.error = error;
            row.worst = format!("{got:e} where {want:e} is right: {case:?}");
        }
    }

    /// Prints the rows, and returns what is wrong.
    fn print(&self, On(model, level): On) -> Vec<String> {
        println!("{model:?}, {level}: end, derivative, cases, infinite from within, largest error");
        let mut wrong = Vec::new();
        for ([end, by, result], row) in &self.0 {
            let Row {
                cases,
                infinite,
                error,
                ..
            } = row;
            println!("{end}, {result} by {by}, {cases}, {infinite}, {error:.0e}");
            // Rounding of angles is a thousandth of the narrowest width.
            if *error >= 1e-2 || error.is_nan() {
                wrong.push(format!("{model:?}, {end}, {result} by {by}: {}", row.worst));
            }
        }
        wrong
    }
}

/// Returns the ends of a field's range that models reach: not those of single precision.
fn ends(field: &Field) -> impl Iterator<Item = (f32, f64)> {
    let range = field
        .range()
        .map(|[least, most]| [(least, 1.0), (most, -1.0)]);
    let ends = range.into_iter().flatten();
    ends.filter(|(end, _)| end.abs() < 1e9)
}

/// Draws hits for a material at the end of a field's range: of the whole sphere, next to the peak of the lobes, at the silhouette, and seen
/// from the pole.
fn hits(random: &mut Random) -> [Hits; 4] {
    let [sphere, mut peak, mut silhouette, mut pole] = [(); 4].map(|()| Hits::one(random));
    let [u, v, w] = [&peak.wo[0], &peak.wi[1], &peak.wi[2]].map(|column| column[0]);
    let across = (1.0 - u * u).sqrt() / v.hypot(w);
    for (column, x) in peak.wi.iter_mut().zip([-u, across * v, across * w]) {
        column[0] = x;
    }
    silhouette.h[0] = random.choose(&[-1.0, 1.0]);
    set(&mut pole.wo, [random.choose(&[-1.0, 1.0]), 0.0, 0.0]);
    [sphere, peak, silhouette, pole]
}

/// Returns the fields of a material with their numbers.
fn text(values: &Values) -> Vec<(&'static str, &[f32])> {
    let fields = values
        .fields()
        .iter()
        .filter(|field| values.has(field.name));
    fields
        .map(|field| (field.name, values.numbers(field.name)))
        .collect()
}

fn set(direction: &mut [Vec<f32>; 3], to: [f32; 3]) {
    for (column, x) in direction.iter_mut().zip(to) {
        column[0] = x;
    }
}

/// Model on a level.
#[derive(Clone, Copy)]
struct On(ModelId, Level);

/// Returns the derivatives of a hit, with the loss and its arguments.
fn derivatives<'a>(
    On(model, level): On,
    values: &'a Values,
    hits: &mut Hits,
    weights: [f32; 4],
) -> (Found, Loss<'a>, Point) {
    for (column, weight) in hits.weights.iter_mut().zip(weights) {
        column[0] = weight;
    }
    let gradients = AnyGradients::new(model, values).expect("legal values");
    let found = call(&gradients, hits, level, true);
    let loss = Loss {
        model,
        values,
        weights,
    };
    (found, loss, Point::of(hits, values))
}

/// Compares derivatives by a field at an end of its range: of each number alone, and of all of them together.
fn compare_field(table: &mut Table, on: On, base: &Values, index: usize, random: &mut Random) {
    let field = &on.0.fields()[index];
    let width = field.kind.width();
    for (end, sign) in ends(field) {
        for (place, is_alone) in (0..width).flat_map(|place| [(place, true), (place, false)]) {
            let mut numbers = vec![end; width];
            if is_alone && base.has_at(index) {
                numbers.copy_from_slice(base.numbers_at(index));
            } else if is_alone {
                numbers.fill(0.5);
            }
            numbers[place] = end;
            let values = base.with(field.name, &numbers);
            for mut hits in hits(random) {
                for (result, weights) in RESULTS {
                    let (found, loss, point) = derivatives(on, &values, &mut hits, weights);
                    let x = f64::from(end);
                    let scale = if x == 0.0 { 0.01 } else { x.abs() };
                    let moved = |by: f64| point.moved(index, place, sign * by);
                    let least = (loss.at(&point).abs() + 1e-6) / scale;
                    let want = one_sided(&loss, &moved, [1e-5 * scale, scale]);
                    // Numbers of a material count as 0 where a derivative by one of them is infinite, and others do not.
                    if want.is_none() && hits.h[0].abs() == 1.0 {
                        continue;
                    }
                    let got = sign * found.parameters.numbers_at(index)[place];
                    let key = [&format!("{} at {end}", field.name), field.name, result];
                    table.compare(key, got, want, least, &(text(&values), hits.numbers(0)));
                }
            }
        }
    }
}

/// Compares derivatives by the offset and by directions at a silhouette, or seen along the fibre.
fn compare_hit(table: &mut Table, end: &str, on: On, values: &Values, hits: &mut Hits) {
    for (result, weights) in RESULTS {
        let (found, loss, point) = derivatives(on, values, hits, weights);
        let rows = &found.rows[0];
        let hit: Vec<f64> = rows[rows.len() - 7..]
            .iter()
            .copied()
            .map(f64::from)
            .collect();
        let least = loss.at(&point).abs() + 1e-6;
        let case = (text(values), hits.numbers(0));
        let inwards = if point.h > 0.0 { -1.0 } else { 1.0 };
        let moved = |by: f64| Point {
            h: point.h + inwards * by,
            ..point
        };
        let want = one_sided(&loss, &moved, [1e-9, 1.0]);
        // The angle of the hit, whose sine is the offset, is infinitely steep. Where S is next to nothing, another term hides it.
        let is_root = on.0.is_near_field() && point.h.abs() == 1.0;
        assert!(!is_root || want.is_none() || least < 1e-3, "{case:?}");
        let want = want.filter(|_| !is_root);
        table.compare([end, "h", result], inwards * hit[3], want, least, &case);
        for (name, is_wo, d) in [("wo", true, &hit[..3]), ("wi", false, &hit[4..])] {
            let is_pole = is_wo && point.wo[0].abs() == 1.0;
            for tangent in tangents(if is_wo { point.wo } else { point.wi }) {
                let got: f64 = d.iter().zip(tangent).map(|(d, t)| d * t).sum();
                let moved = |by: f64| point.turned(is_wo, tangent, by);
                // At the pole the azimuth jumps.
                let want = (!is_pole).then(|| loss.difference(&moved, 1e-4));
                if let Some(want) = want.map_or(Some(None), |want| want.map(Some)) {
                    table.compare([end, name, result], got, want, least, &case);
                }
            }
        }
    }
}

#[test]
fn derivatives_at_the_ends_are_limits_from_within() {
    let mut wrong = Vec::new();
    for id in ModelId::ALL {
        for level in [Level::portable(), Level::detect()] {
            let (on, mut table, mut random) = (On(*id, level), Table::default(), Random(75));
            for material in 0..MATERIALS {
                let values = if material == 0 {
                    id.measured()
                } else {
                    random.values(*id, false)
                };
                // Fields of a model and the hit are tested on the model alone. Beside a diffuse part S is never next to nothing, so that
                // differences would not find its roots.
                let count = id.fields().len();
                let (fields, hits_at_ends) = if id.name().ends_with("-diffuse") {
                    (count - 2..count, 0)
                } else {
                    (0..count, 4)
                };
                for index in fields {
                    compare_field(&mut table, on, &values, index, &mut random);
                }
                for _ in 0..hits_at_ends {
                    let [_, _, mut silhouette, mut pole] = hits(&mut random);
                    compare_hit(&mut table, "h at -1 and 1", on, &values, &mut silhouette);
                    compare_hit(&mut table, "wo at a pole", on, &values, &mut pole);
                }
            }
            wrong.extend(table.print(on));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Checks that a direction along the fibre, where S is 0, has no derivatives.
#[test]
fn wi_at_a_pole_has_no_derivatives() {
    for id in ModelId::ALL {
        let mut random = Random(76);
        for pole in [-1.0, 1.0] {
            let values = random.values(*id, false);
            let mut hits = Hits::one(&mut random);
            set(&mut hits.wi, [pole, 0.0, 0.0]);
            let on = On(*id, Level::detect());
            let (found, ..) = derivatives(on, &values, &mut hits, [1.0; 4]);
            assert!(found.rows[0].iter().all(|x| *x == 0.0), "{id:?}: {found:?}");
        }
    }
}
