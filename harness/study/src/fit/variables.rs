//! Numbers of a model's fields, as variables of an optimiser.

use hairis_materials::material::single;
use hairis_variants::{Field, Kind, Values};

/// Least number of a field whose logarithm is a variable.
const LEAST: f64 = 1e-4;
/// Largest number of a field without a limit.
const MOST: f64 = 1e3;
/// Share of a number by which starts differ.
const SPREAD: f64 = 0.3;

/// Variable of the optimiser: one number of a field.
#[derive(Clone, Copy, Debug)]
struct Variable {
    index: usize,
    place: usize,
    /// Whether the variable is the logarithm of the number.
    is_log: bool,
    /// Change of the number per unit of the variable.
    scale: f64,
    /// Least and largest variable.
    range: [f64; 2],
}

/// Free numbers of values: those of fields that are given, not fixed, no extras, and not words.
#[derive(Clone, Debug)]
pub struct Variables {
    base: Values,
    all: Vec<Variable>,
}

impl Variables {
    /// Makes the variables of values, without the fields of fixed names.
    #[must_use]
    pub fn new(base: &Values, fixed: &[String]) -> Self {
        let mut all = Vec::new();
        for (index, field) in base.fields().iter().enumerate() {
            let stays = matches!(field.kind, Kind::Word(_)) || field.is_extra();
            if stays || !base.has_at(index) || fixed.iter().any(|name| name == field.name) {
                continue;
            }
            for (place, number) in base.numbers_at(index).iter().enumerate() {
                all.push(variable(field, [index, place], f64::from(*number)));
            }
        }
        Self { base: *base, all }
    }

    /// Returns the variables of the values.
    #[must_use]
    pub fn start(&self) -> Vec<f64> {
        let of = |one: &Variable| one.of(f64::from(self.base.numbers_at(one.index)[one.place]));
        self.clamped(self.all.iter().map(of).collect())
    }

    /// Returns the distance of starts from each other, per variable.
    pub(super) fn spreads(&self) -> impl Iterator<Item = f64> + '_ {
        self.all.iter().map(|one| {
            let number = f64::from(self.base.numbers_at(one.index)[one.place]);
            if one.is_log {
                SPREAD
            } else {
                SPREAD * (number / one.scale).abs().max(0.3)
            }
        })
    }

    /// Returns the least and the largest of each variable.
    #[must_use]
    pub fn bounds(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|end| self.all.iter().map(|one| one.range[end]).collect())
    }

    /// Clamps variables to their bounds.
    #[must_use]
    pub fn clamped(&self, mut x: Vec<f64>) -> Vec<f64> {
        for (x, one) in x.iter_mut().zip(&self.all) {
            *x = x.clamp(one.range[0], one.range[1]);
        }
        x
    }

    /// Converts variables to values.
    pub(super) fn values(&self, x: &[f64]) -> Values {
        let mut values = self.base;
        for (x, one) in x.iter().zip(&self.all) {
            let mut numbers = values.numbers_at(one.index).to_vec();
            let [least, most] = self.base.fields()[one.index].range().unwrap_or([0.0; 2]);
            numbers[one.place] = single(one.number(*x)).clamp(least, most);
            values
                .set_at(one.index, &numbers)
                .expect("a field of the model");
        }
        values
    }

    /// Returns the derivatives by the variables, given those by the numbers.
    pub(super) fn derivatives(&self, x: &[f64], by_number: &Values<f64>) -> Vec<f64> {
        let derivative = |(x, one): (&f64, &Variable)| {
            let slope = if one.is_log {
                one.number(*x)
            } else {
                one.scale
            };
            by_number.numbers_at(one.index)[one.place] * slope
        };
        x.iter().zip(&self.all).map(derivative).collect()
    }
}

fn variable(field: &Field, [index, place]: [usize; 2], number: f64) -> Variable {
    let [least, most] = field
        .range()
        .map_or([0.0, MOST], |range| range.map(f64::from));
    let is_log = field.draw.is_some_and(|draw| draw.log);
    let scale = if field.unit == "rad" {
        0.1
    } else {
        number.abs().max(0.05)
    };
    let mut one = Variable {
        index,
        place,
        is_log,
        scale,
        range: [0.0; 2],
    };
    let most = most.min(MOST.max(2.0 * number));
    let least = if is_log { least.max(LEAST) } else { least };
    one.range = [one.of(least), one.of(most)];
    one
}

impl Variable {
    fn of(&self, number: f64) -> f64 {
        if self.is_log {
            number.max(LEAST).ln()
        } else {
            number / self.scale
        }
    }

    fn number(&self, x: f64) -> f64 {
        if self.is_log { x.exp() } else { x * self.scale }
    }
}
