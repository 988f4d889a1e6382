//! Variables of a fit, which scale or shift the numbers of a model's fields.

use hairis_materials::material::single;
use hairis_variants::{Field, Kind, Values};

/// Longest step of a variable that is the logarithm of a factor.
const LOG_STEP: f64 = 0.3;
/// Longest step of any other variable.
const STEP: f64 = 0.05;
/// Largest logarithm of a factor.
const MOST_LOG: f64 = 10.0;
/// Number that takes the place of 0 if a factor on it is to be found.
const LEAST: f64 = 1e-3;
/// Fields that stay as they are unless freed, besides extras: neither colours, widths nor shifts of fibres' lobes.
const HELD: &[&str] = &["i_r", "phi_g", "i_g", "eta", "diffuse", "diffuse_color"];
/// Fields whose numbers share factors, either by group, or by channel with this power.
const TIED: &[(&str, Tie)] = &[
    ("alpha", Tie::Group("shifts")),
    ("beta", Tie::Group("widths")),
    ("gamma_tt", Tie::Group("widths")),
    ("gamma_g", Tie::Group("widths")),
    ("i_tt", Tie::Channel(1.0)),
    ("i_trt", Tie::Channel(2.0)),
];

#[derive(Clone, Copy)]
enum Tie {
    Group(&'static str),
    Channel(f64),
}

/// Place of a number: the index of its field, and the index within the field.
type Place = [usize; 2];

/// Variable of a fit, 0 at the start: `number = base exp(power x)`, or `base + x`.
#[derive(Clone, Debug)]
struct Variable {
    key: String,
    /// Numbers that depend on the variable, with their powers.
    members: Vec<(Place, f64)>,
    is_log: bool,
    /// Least and largest value of the variable.
    range: [f64; 2],
}

/// Variables of a fit, which scale or shift the numbers of a model's fields. Words stay as they are.
///
/// The published model has one factor on all shifts, one on all widths, and one per channel on the transmittance of a passage through
/// the fibre, which TT makes once and TRT twice. In other models, every number except the index of refraction and extras is a
/// variable of its own.
#[derive(Clone, Debug)]
pub struct Variables {
    base: Values,
    all: Vec<Variable>,
}

impl Variables {
    /// Creates the variables of a fit from `start`. Numbers of fields that are `fixed` stay, and numbers of fields that are `free` are
    /// variables of their own.
    #[must_use]
    pub fn new(start: &Values, fixed: &[String], free: &[String]) -> Self {
        let (mut base, mut all) = (*start, Vec::<Variable>::new());
        for (index, field) in start.fields().iter().enumerate() {
            let is_in = |names: &[String]| names.iter().any(|name| name == field.name);
            let is_free = is_in(free);
            let stays = HELD.contains(&field.name) || field.is_extra();
            let is_held = is_in(fixed) || (stays && !is_free);
            let Some(range) = field.range().filter(|_| !is_held && start.has_at(index)) else {
                continue;
            };
            let range = range.map(f64::from);
            let tie = TIED
                .iter()
                .find(|(name, _)| *name == field.name && !is_free);
            let mut numbers = start.numbers_at(index).to_vec();
            for (place, number) in numbers.iter_mut().enumerate() {
                let label = label(field, place);
                let (key, power, is_log) = match tie {
                    Some((_, Tie::Group(key))) => ((*key).to_owned(), 1.0, true),
                    Some((_, Tie::Channel(power))) => (format!("colour {place}"), *power, true),
                    None => (label, 1.0, range[0] >= 0.0),
                };
                if is_log && *number == 0.0 && tie.is_none() {
                    *number = single(LEAST.min(range[1]));
                }
                if is_log && *number == 0.0 {
                    continue;
                }
                let limits = limits(f64::from(*number), power, is_log, range);
                let member = ([index, place], power);
                match all.iter_mut().find(|one| one.key == key) {
                    Some(one) => {
                        one.members.push(member);
                        one.range[0] = one.range[0].max(limits[0]);
                        one.range[1] = one.range[1].min(limits[1]);
                    }
                    None => all.push(Variable {
                        key,
                        members: vec![member],
                        is_log,
                        range: limits,
                    }),
                }
            }
            let set = base.set_at(index, &numbers);
            debug_assert!(set.is_ok(), "a field of the model");
        }
        Self { base, all }
    }

    /// Returns the count of variables that the fit is to find.
    #[must_use]
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Returns true if there is no variable to find.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    fn members(&self) -> impl Iterator<Item = (usize, Place, f64)> + '_ {
        let of_variable = |(k, one): (usize, &Variable)| {
            let members = one.members.clone().into_iter();
            members.map(move |(place, power)| (k, place, power))
        };
        self.all.iter().enumerate().flat_map(of_variable)
    }

    /// Returns the names of the numbers that depend on the variables: the field, with a label where the field has several.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let fields = self.base.fields();
        self.members()
            .map(|(_, [index, place], _)| label(&fields[index], place))
            .collect()
    }

    /// Returns the numbers that depend on the variables, in the order of [`names`](Self::names).
    #[must_use]
    pub fn numbers(&self, x: &[f64]) -> Vec<f64> {
        let number = |(k, at, power)| self.number(k, at, power, x[k]);
        self.members().map(number).collect()
    }

    fn number(&self, k: usize, at: Place, power: f64, x: f64) -> f64 {
        let base = f64::from(self.base.numbers_at(at[0])[at[1]]);
        if self.all[k].is_log {
            base * (power * x).exp()
        } else {
            base + x
        }
    }

    /// Returns the derivative of each number by its variable.
    #[must_use]
    pub fn slopes(&self, x: &[f64]) -> Vec<f64> {
        let slope = |(k, at, power): (usize, Place, f64)| {
            if self.all[k].is_log {
                power * self.number(k, at, power, x[k])
            } else {
                1.0
            }
        };
        self.members().map(slope).collect()
    }

    /// Spreads one number per variable to all numbers that depend on that variable.
    #[must_use]
    pub fn spread(&self, of_variables: &[f64]) -> Vec<f64> {
        self.members().map(|(k, ..)| of_variables[k]).collect()
    }

    /// Returns the values of the material for these variables, clamped to the ranges of their fields.
    #[must_use]
    pub fn values(&self, x: &[f64]) -> Values {
        let mut values = self.base;
        for (k, at, power) in self.members() {
            let mut numbers = values.numbers_at(at[0]).to_vec();
            let [least, most] = self.base.fields()[at[0]].range().unwrap_or_default();
            numbers[at[1]] = single(self.number(k, at, power, x[k])).clamp(least, most);
            let set = values.set_at(at[0], &numbers);
            debug_assert!(set.is_ok(), "a field of the model");
        }
        values
    }

    /// Returns derivatives by the variables, from derivatives by numbers of the fields and from [`slopes`](Self::slopes).
    #[must_use]
    pub fn derivatives(&self, by_numbers: &Values<f64>, slopes: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.len()];
        for ((k, [index, place], _), slope) in self.members().zip(slopes) {
            sums[k] += slope * by_numbers.numbers_at(index)[place];
        }
        sums
    }

    /// Returns the variables after a step, which is shortened to the longest allowed one. The variables are clamped to their ranges.
    #[must_use]
    pub fn after(&self, x: &[f64], step: &[f64]) -> Vec<f64> {
        let most = |one: &Variable| if one.is_log { LOG_STEP } else { STEP };
        let shares = self
            .all
            .iter()
            .zip(step)
            .map(|(one, s)| s.abs() / most(one));
        let longest = shares.fold(1.0, f64::max);
        let moved = self.all.iter().zip(x).zip(step);
        moved
            .map(|((one, x), step)| (x + step / longest).clamp(one.range[0], one.range[1]))
            .collect()
    }
}

/// Returns the least and the largest variable with which a number lies within a range.
fn limits(number: f64, power: f64, is_log: bool, [least, most]: [f64; 2]) -> [f64; 2] {
    if !is_log {
        return [least - number, most - number];
    }
    let log = |end: f64| ((end / number).max(0.0).ln() / power).clamp(-MOST_LOG, MOST_LOG);
    if number < 0.0 {
        [-MOST_LOG, log(least)]
    } else {
        [log(least), log(most)]
    }
}

fn label(field: &Field, place: usize) -> String {
    match field.kind {
        Kind::Numbers(labels) => format!("{}.{}", field.name, labels[place]),
        Kind::Rgb => format!("{}.{}", field.name, ["r", "g", "b"][place]),
        Kind::Number | Kind::Word(_) => field.name.to_owned(),
    }
}
