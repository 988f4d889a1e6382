//! Tests of derivatives against central differences of the formulas in double precision, which share no code with the kernels.

use crate::support::{Hits, Random, call, quantiles};
use hairis::simd::Level;
use hairis_gradients::AnyGradients;
use hairis_reference::exact_reference;
use hairis_variants::{Kind, ModelId, Values};

/// Arguments of the formulas.
#[derive(Clone, Copy)]
struct Point {
    exact: Values<f64>,
    wo: [f64; 3],
    h: f64,
    wi: [f64; 3],
}

/// Weighted sum of the results of the formulas.
struct Loss<'a> {
    model: ModelId,
    values: &'a Values,
    weights: [f32; 4],
}

impl Loss<'_> {
    fn at(&self, point: &Point) -> f64 {
        let formulas = exact_reference(self.model, self.values, &point.exact, point.wo, point.h);
        let ([r, g, b], pdf) = formulas.expect("legal values").eval_pdf(point.wi);
        let results = [r, g, b, pdf].into_iter().zip(self.weights);
        results.map(|(x, weight)| x * f64::from(weight)).sum()
    }

    /// Returns the derivative by a step along `moved`, or `None` if the loss is not smooth there.
    fn difference(&self, moved: &dyn Fn(f64) -> Point, step: f64) -> Option<f64> {
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

fn along(x: [f64; 3], tangent: [f64; 3], by: f64) -> [f64; 3] {
    unit(core::array::from_fn(|k| x[k] + by * tangent[k]))
}

/// Returns the errors of a model's derivatives by hits and by parameters, relative to their size or to a thousandth of the loss.
fn errors(model: ModelId, level: Level) -> [Vec<f64>; 2] {
    let mut random = Random(73);
    let [mut by_hit, mut by_parameter] = [Vec::new(), Vec::new()];
    let mut asked = 0;
    for _ in 0..40 {
        let values = random.values(model, false);
        let gradients = AnyGradients::new(model, &values).expect("legal values");
        for _ in 0..3 {
            let hits = Hits::one(&mut random);
            let [a, b, c, h, x, y, z, r, g, blue, pdf] = hits.numbers(0)[..] else {
                unreachable!("a hit and its weights")
            };
            let (wo, wi, weights) = ([a, b, c], [x, y, z], [r, g, blue, pdf]);
            let found = call(&gradients, &hits, level, true);
            let loss = Loss {
                model,
                values: &values,
                weights,
            };
            let exact = values.map(f64::from);
            let [wo, wi] = [wo, wi].map(|x| unit(x.map(f64::from)));
            let point = Point {
                exact,
                wo,
                h: f64::from(h),
                wi,
            };
            let size = loss.at(&point).abs();
            let mut see = |errors: &mut Vec<f64>, got: f64, of: f64, want: Option<f64>| {
                asked += 1;
                if let Some(want) = want {
                    let least = 1e-3 * size / of.abs().max(1e-2);
                    errors.push((got - want).abs() / want.abs().max(least).max(1e-30));
                }
            };
            let hit = &found.rows[0][4 + gradients.material().len()..];
            let hit: Vec<f64> = hit.iter().copied().map(f64::from).collect();
            for (direction, is_wo, d) in [(wo, true, &hit[..3]), (wi, false, &hit[4..])] {
                let first = unit(cross(direction, [0.48, 0.6, 0.64]));
                for tangent in [first, cross(direction, first)] {
                    let moved = |by: f64| {
                        let to = along(direction, tangent, by);
                        if is_wo {
                            Point { wo: to, ..point }
                        } else {
                            Point { wi: to, ..point }
                        }
                    };
                    let got = d.iter().zip(tangent).map(|(d, t)| d * t).sum();
                    see(&mut by_hit, got, 1.0, loss.difference(&moved, 1e-4));
                }
            }
            let moved = |by: f64| Point {
                h: point.h + by,
                ..point
            };
            see(&mut by_hit, hit[3], 1.0, loss.difference(&moved, 1e-4));
            for (index, field) in model.fields().iter().enumerate() {
                if !values.has_at(index) || matches!(field.kind, Kind::Word(_)) {
                    continue;
                }
                let numbers = exact.numbers_at(index);
                for place in 0..numbers.len() {
                    let x = numbers[place];
                    let moved = |by: f64| {
                        let mut moved = numbers.to_vec();
                        moved[place] += by;
                        let mut exact = exact;
                        exact.set_at(index, &moved).expect("a field of the model");
                        Point { exact, ..point }
                    };
                    let got = found.parameters.numbers_at(index)[place];
                    let step = 1e-4 * x.abs().max(1e-2);
                    see(&mut by_parameter, got, x, loss.difference(&moved, step));
                }
            }
        }
    }
    assert!(
        by_hit.len() + by_parameter.len() > asked * 9 / 10,
        "{model:?}: {} of {asked} are smooth",
        by_hit.len() + by_parameter.len()
    );
    [by_hit, by_parameter]
}

#[test]
fn derivatives_are_those_of_the_formulas() {
    for id in ModelId::ALL {
        for level in [Level::portable(), Level::detect()] {
            let [mut by_hit, mut by_parameter] = errors(*id, level);
            let [hit, parameter] = [quantiles(&mut by_hit), quantiles(&mut by_parameter)];
            println!("{id:?} on {level}: by hits {hit:?}, by parameters {parameter:?}");
            for found in [hit, parameter] {
                assert!(
                    found[0] < 2e-6 && found[1] < 2e-3,
                    "{id:?} on {level}: {found:?}"
                );
            }
        }
    }
}
