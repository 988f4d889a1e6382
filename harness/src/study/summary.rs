//! What a study comes to: gains over the published sampler and of the Cauchy model, as geometric means over the grid.

use super::cell::Measured;
use super::rows::{Strategy, place};
use super::times::{PER_POINT, Time, ns};
use crate::efficiency::ModelKind;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::table::{Table, number};

/// Relative standard error of V beyond which a cell is left out: the light was hardly seen.
const MAX_RELATIVE_ERROR: f64 = 0.25;

/// Ratios of V over the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gain {
    pub(crate) geometric_mean: Estimate,
    pub(crate) least: Estimate,
    pub(crate) most: Estimate,
    /// Cells left out.
    pub(crate) unsure: usize,
}

/// The first of two lists of V over the second, cell by cell.
///
/// The standard error of the geometric mean is that of its figures, the grid being what it is. Both samplers are held
/// against the same directions of the light: errors of the ratios are, if anything, less than said.
pub(crate) fn gain(pairs: impl Iterator<Item = [Estimate; 2]>) -> Option<Gain> {
    let sure = |v: &Estimate| v.value > 0.0 && v.standard_error <= MAX_RELATIVE_ERROR * v.value;
    let (mut ratios, mut unsure) = (Vec::new(), 0);
    for [base, other] in pairs {
        if sure(&base) && sure(&other) {
            ratios.push(base.ratio(&other));
        } else {
            unsure += 1;
        }
    }
    let by_value = |a: &&Estimate, b: &&Estimate| a.value.total_cmp(&b.value);
    let least = *ratios.iter().min_by(by_value)?;
    let most = *ratios.iter().max_by(by_value)?;
    let n = ratios.len() as f64;
    let logarithm = ratios.iter().map(|ratio| ratio.value.ln()).sum::<f64>() / n;
    let error = ratios.iter().map(|ratio| (ratio.standard_error / ratio.value).powi(2)).sum::<f64>().sqrt() / n;
    let value = logarithm.exp();
    Some(Gain { geometric_mean: Estimate { value, standard_error: value * error }, least, most, unsure })
}

/// A ratio of variances times that of the times.
pub(crate) fn in_equal_time(variance: Estimate, time: Estimate) -> Estimate {
    let value = variance.value * time.value;
    let relative = (variance.standard_error / variance.value).hypot(time.standard_error / time.value);
    Estimate { value, standard_error: value * relative }
}

/// A model, and how its directions are drawn.
type Estimator = (ModelKind, Strategy);

/// Two estimators held against each other, and the words that begin their row.
struct Comparison {
    words: [&'static str; 2],
    base: Estimator,
    other: Estimator,
}

/// What a summary is made of.
struct Figures<'a> {
    cells: &'a [Vec<Measured>],
    lights: &'a [String],
    times: &'a [Time],
}

/// The tables: the samplers of each model against `ou`, then the models against each other; variances, then variances in
/// equal time.
pub(super) fn tables(cells: &[Vec<Measured>], lights: &[String], times: &[Time]) -> Vec<Table> {
    let figures = Figures { cells, lights, times };
    let against = |base: (ModelKind, Sampler), (model, strategy): Estimator| Comparison {
        words: [model.name(), strategy.name()],
        base: (base.0, base.1.into()),
        other: (model, strategy),
    };
    let over_ou = |strategies: &[Strategy]| -> Vec<Comparison> {
        let others = strategies.iter().filter(|strategy| strategy.sampler() != Some(Sampler::Ou));
        let of_model = |model| others.clone().map(move |of| against((model, Sampler::Ou), (model, *of)));
        ModelKind::ALL.into_iter().flat_map(of_model).collect()
    };
    let (samplers, all) = (over_ou(&Sampler::ALL.map(Strategy::By)), over_ou(&Strategy::ALL));
    let models = Sampler::ALL.map(|of| against((ModelKind::Gaussian, of), (ModelKind::Cauchy, of.into())));
    let percent = 100.0 * MAX_RELATIVE_ERROR;
    let left_out = format!(
        "{} cells. Left out: cells where the standard error of a V is above {percent}% of it, or nothing was seen of the \
         light. ±: one standard error.",
        cells.len()
    );
    let timed = "Times of the default hair, eight lanes, one thread, on this machine; ±: one standard error, that of the \
                 times included.";
    let above = |who: &str| format!("Above 1, it needs fewer samples than {who}. {left_out}");
    let perfect = "perfect: directions in proportion to S cos θᵢ, drawn without regard to the light, which is what ever better \
                   samplers of the hair come to.";
    vec![
        figures.variance("V of ou over V of the sampler, over the grid", &all).note(above("ou")).note(perfect),
        figures.equal_time("The same in equal time, set-up included: geometric means", &samplers).note(timed),
        figures
            .variance("V on the Gaussian model over V on the Cauchy model, over the grid", &models)
            .note(above("on the Gaussian model")),
        figures.equal_time("The same in equal time, set-up included: geometric means", &models).note(timed),
    ]
}

impl Figures<'_> {
    /// V of both sides in every cell.
    fn pairs<'c>(&'c self, of: &'c Comparison, light: usize) -> impl Iterator<Item = [Estimate; 2]> + 'c {
        let place = move |(model, strategy): Estimator| place(model, strategy, light, self.lights.len());
        self.cells.iter().map(move |cell| [of.base, of.other].map(|of| cell[place(of)].figures.v))
    }

    /// Time of a sample; not a number if nobody draws it.
    fn ns(&self, (model, strategy): Estimator, per_point: usize) -> Estimate {
        let none = Estimate { value: f64::NAN, standard_error: f64::NAN };
        strategy.sampler().map_or(none, |sampler| ns(self.times, model, sampler, per_point))
    }

    /// A row for every light of every comparison, its first three cells filled in.
    fn each<'c>(&'c self, of: &'c [Comparison]) -> impl Iterator<Item = (Vec<String>, &'c Comparison, usize)> {
        of.iter().flat_map(move |of| {
            self.lights.iter().enumerate().map(move |(light, name)| {
                let [first, second] = of.words.map(str::to_owned);
                (vec![first, second, name.clone()], of, light)
            })
        })
    }

    fn variance(&self, title: &str, of: &[Comparison]) -> Table {
        let mut table = keys(title).number("geometric mean").number("least").number("most").number("left out");
        for (mut row, of, light) in self.each(of) {
            match gain(self.pairs(of, light)) {
                Some(gain) => {
                    row.extend([gain.geometric_mean, gain.least, gain.most].map(shown));
                    row.push(gain.unsure.to_string());
                }
                // Perfect sampling under constant light.
                None if self.pairs(of, light).all(|[_, v]| v.value == 0.0) => row.push("no limit".to_owned()),
                None => row.extend(["", "", "", "all"].map(str::to_owned)),
            }
            table.push(row);
        }
        table
    }

    fn equal_time(&self, title: &str, of: &[Comparison]) -> Table {
        let table = keys(title);
        let mut table = PER_POINT.into_iter().fold(table, |table, n| table.number(format!("{n} a point")));
        for (mut row, of, light) in self.each(of) {
            row.extend(gain(self.pairs(of, light)).iter().flat_map(|gain| {
                PER_POINT.map(|per_point| {
                    let [base, other] = [of.base, of.other].map(|of| self.ns(of, per_point));
                    shown(in_equal_time(gain.geometric_mean, base.ratio(&other)))
                })
            }));
            table.push(row);
        }
        table
    }
}

fn keys(title: &str) -> Table {
    Table::new(title).text("model").text("sampler").text("light")
}

pub(super) fn shown(of: Estimate) -> String {
    number::with_error(of.value, of.standard_error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(value: f64, standard_error: f64) -> Estimate {
        Estimate { value, standard_error }
    }

    #[test]
    fn gains_are_geometric_and_leave_out_what_is_unsure() {
        let nan = v(f64::NAN, f64::NAN);
        let pairs = [
            [v(2.0, 0.02), v(1.0, 0.0)],
            [v(8.0, 0.08), v(1.0, 0.0)],
            [v(1.0, 0.0), v(100.0, 30.0)],
            [nan, v(1.0, 0.0)],
        ];
        let gain = gain(pairs.into_iter()).expect("two cells");
        assert!((gain.geometric_mean.value - 4.0).abs() < 1e-12);
        assert!((gain.geometric_mean.standard_error - 4.0 * 0.01 / 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!((gain.least.value, gain.most.value, gain.unsure), (2.0, 8.0, 2));
        assert_eq!(super::gain([[nan, nan]].into_iter()), None, "nothing is sure");
    }
}
