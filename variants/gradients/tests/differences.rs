//! Tests of derivatives against central differences of the formulas in double precision, which share no code with the kernels.

use crate::support::{Hits, Random, call, quantiles};
use hairis::simd::Level;
use hairis_gradients::AnyGradients;
use hairis_reference::exact_reference;
use hairis_variants::{Kind, ModelId, Values};
use std::collections::BTreeMap;

/// Arguments of the formulas.
#[derive(Clone, Copy)]
pub(crate) struct Point {
    pub(crate) exact: Values<f64>,
    pub(crate) wo: [f64; 3],
    pub(crate) h: f64,
    pub(crate) wi: [f64; 3],
}

impl Point {
    /// Returns the arguments of the only hit, with the values of a material.
    pub(crate) fn of(hits: &Hits, values: &Values) -> Self {
        let [a, b, c, h, x, y, z, ..] = hits.numbers(0)[..] else {
            unreachable!("a hit and its weights")
        };
        let [wo, wi] = [[a, b, c], [x, y, z]].map(|x| unit(x.map(f64::from)));
        Self {
            exact: values.map(f64::from),
            wo,
            h: f64::from(h),
            wi,
        }
    }

    /// Moves a number of a field.
    pub(crate) fn moved(mut self, index: usize, place: usize, by: f64) -> Self {
        let mut numbers = self.exact.numbers_at(index).to_vec();
        numbers[place] += by;
        let set = self.exact.set_at(index, &numbers);
        set.expect("a field of the model");
        self
    }

    /// Moves `wo` or `wi` along a tangent.
    pub(crate) fn turned(mut self, is_wo: bool, tangent: [f64; 3], by: f64) -> Self {
        let direction = if is_wo { &mut self.wo } else { &mut self.wi };
        *direction = unit(core::array::from_fn(|k| direction[k] + by * tangent[k]));
        self
    }
}

/// Weighted sum of the results of the formulas.
pub(crate) struct Loss<'a> {
    pub(crate) model: ModelId,
    pub(crate) values: &'a Values,
    pub(crate) weights: [f32; 4],
}

impl Loss<'_> {
    pub(crate) fn at(&self, point: &Point) -> f64 {
        let formulas = exact_reference(self.model, self.values, &point.exact, point.wo, point.h);
        let ([r, g, b], pdf) = formulas.expect("legal values").eval_pdf(point.wi);
        let results = [r, g, b, pdf].into_iter().zip(self.weights);
        results.map(|(x, weight)| x * f64::from(weight)).sum()
    }

    /// Returns the derivative by a step along `moved`, or `None` if the loss is not smooth there.
    pub(crate) fn difference(&self, moved: &dyn Fn(f64) -> Point, step: f64) -> Option<f64> {
        let slope = |step: f64| {
            let [low, high] = [-step, step].map(|by| self.at(&moved(by)));
            (high - low) / (2.0 * step)
        };
        let [far, near] = [step, 0.5 * step].map(slope);
        let better = (4.0 * near - far) / 3.0;
        let is_smooth = (near - far).abs() <= 1e-4 * better.abs() + 1e-6 * self.scale(moved, step);
        is_smooth.then_some(better)
    }

    /// Returns the size of the loss divided by that of the argument, which is ten thousand steps.
    fn scale(&self, moved: &dyn Fn(f64) -> Point, step: f64) -> f64 {
        self.at(&moved(0.0)).abs() * 1e-4 / step
    }
}

fn unit(x: [f64; 3]) -> [f64; 3] {
    let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    x.map(|x| x / length)
}

fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Returns two tangents of a direction, which are at right angles.
pub(crate) fn tangents(direction: [f64; 3]) -> [[f64; 3]; 2] {
    let first = unit(cross(direction, [0.48, 0.6, 0.64]));
    [first, cross(direction, first)]
}

/// Returns the errors of a model's derivatives by argument: by those of a hit and by each field, relative to their size or to a thousandth
/// of the loss.
fn errors(model: ModelId, level: Level) -> BTreeMap<&'static str, Vec<f64>> {
    let mut random = Random(73);
    let mut all = BTreeMap::<_, Vec<f64>>::new();
    let mut asked = 0;
    for _ in 0..40 {
        let values = random.values(model, false);
        let gradients = AnyGradients::new(model, &values).expect("legal values");
        for _ in 0..3 {
            let hits = Hits::one(&mut random);
            let found = call(&gradients, &hits, level, true);
            let loss = Loss {
                model,
                values: &values,
                weights: hits.weights.each_ref().map(|column| column[0]),
            };
            let point = Point::of(&hits, &values);
            let size = loss.at(&point).abs();
            let mut see = |name, got: f64, of: f64, want: Option<f64>| {
                asked += 1;
                let errors = all.entry(name).or_default();
                if let Some(want) = want {
                    let least = 1e-3 * size / of.abs().max(1e-2);
                    errors.push((got - want).abs() / want.abs().max(least).max(1e-30));
                }
            };
            let hit = &found.rows[0][4 + gradients.material().len()..];
            let hit: Vec<f64> = hit.iter().copied().map(f64::from).collect();
            for (name, is_wo, d) in [("wo", true, &hit[..3]), ("wi", false, &hit[4..])] {
                for tangent in tangents(if is_wo { point.wo } else { point.wi }) {
                    let moved = |by: f64| point.turned(is_wo, tangent, by);
                    let got = d.iter().zip(tangent).map(|(d, t)| d * t).sum();
                    see(name, got, 1.0, loss.difference(&moved, 1e-4));
                }
            }
            let moved = |by: f64| Point {
                h: point.h + by,
                ..point
            };
            see("h", hit[3], 1.0, loss.difference(&moved, 1e-4));
            for (index, field) in model.fields().iter().enumerate() {
                if !values.has_at(index) || matches!(field.kind, Kind::Word(_)) {
                    continue;
                }
                for (place, x) in point.exact.numbers_at(index).iter().enumerate() {
                    let moved = |by: f64| point.moved(index, place, by);
                    let got = found.parameters.numbers_at(index)[place];
                    let step = 1e-4 * x.abs().max(1e-2);
                    see(field.name, got, *x, loss.difference(&moved, step));
                }
            }
        }
    }
    let smooth: usize = all.values().map(Vec::len).sum();
    assert!(
        smooth > asked * 9 / 10,
        "{model:?}: {smooth} of {asked} are smooth"
    );
    all
}

/// Checks derivatives by every argument and field, fields in place of others included, and prints a table of their errors.
#[test]
fn derivatives_are_those_of_the_formulas() {
    println!("model, level: argument, differences, median error, 999th of a thousand");
    for id in ModelId::ALL {
        for level in [Level::portable(), Level::detect()] {
            let mut all = errors(*id, level);
            let fields = id.fields().iter().filter(|field| field.rule.is_some());
            for name in ["wo", "h", "wi"]
                .into_iter()
                .chain(fields.map(|field| field.name))
            {
                let errors = all.get_mut(name).expect("derivatives by every field");
                assert!(errors.len() > 10, "{id:?}: {name}");
                let [median, most] = quantiles(errors);
                println!(
                    "{id:?}, {level}: {name}, {}, {median:.1e}, {most:.1e}",
                    errors.len()
                );
                assert!(median < 4e-6, "{id:?} on {level}: {name}: {median:e}");
            }
            let is_of_hit = |name: &str| ["wo", "h", "wi"].contains(&name);
            for of_hit in [true, false] {
                let some = all.iter().filter(|(name, _)| is_of_hit(name) == of_hit);
                let mut errors: Vec<f64> = some.flat_map(|(_, errors)| errors.clone()).collect();
                let found = quantiles(&mut errors);
                assert!(
                    found[0] < 2e-6 && found[1] < 2e-3,
                    "{id:?} on {level}: {found:?}"
                );
            }
        }
    }
}
