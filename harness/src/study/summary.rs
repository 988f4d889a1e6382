//! Summary of a study: gains over the published sampler and of the Cauchy model, as geometric means over the grid, and
//! in how many cells.

use super::cell::Measured;
use super::equal_time::{CellCounts, NOTHING, Sign, in_equal_time, time_ratio};
use super::output::Times;
use super::rows::{Strategy, place};
use super::times::PER_POINT;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::table::{Table, number};

/// Relative standard error of V beyond which a cell is left out: the light was hardly hit.
const MAX_RELATIVE_ERROR: f64 = 0.25;

/// Ratios of V over the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gain {
    pub(crate) geometric_mean: Estimate,
    /// The middle cell, with its own standard error: that of the median is smaller.
    pub(crate) median: Estimate,
    /// First and third quartile.
    pub(crate) quartiles: [f64; 2],
    /// Shares of the cells that are above 1 and below it by more than two standard errors.
    pub(crate) shares: [f64; 2],
    pub(crate) least: Estimate,
    pub(crate) most: Estimate,
    /// Cells left out.
    pub(crate) unsure: usize,
}

/// The first V over the second; `None` if one of them is unsure.
pub(super) fn sure_ratio([base, other]: [Estimate; 2]) -> Option<Estimate> {
    let sure = |v: &Estimate| v.value > 0.0 && v.standard_error <= MAX_RELATIVE_ERROR * v.value;
    (sure(&base) && sure(&other)).then(|| base.ratio(&other))
}

/// The first of two lists of V over the second, cell by cell.
///
/// The standard error of the geometric mean is that of its figures, for this grid. Both samplers use the same directions of
/// the light: errors of the ratios are, if anything, overestimated.
pub(crate) fn gain(pairs: impl Iterator<Item = [Estimate; 2]>) -> Option<Gain> {
    let (mut ratios, mut unsure) = (Vec::new(), 0);
    for pair in pairs {
        match sure_ratio(pair) {
            Some(ratio) => ratios.push(ratio),
            None => unsure += 1,
        }
    }
    ratios.sort_by(|a, b| a.value.total_cmp(&b.value));
    let (least, most) = (*ratios.first()?, *ratios.last()?);
    let n = ratios.len() as f64;
    let at = |quarter: usize| ratios[(ratios.len() - 1) * quarter / 4];
    let share = |sign| ratios.iter().filter(|ratio| Sign::of(**ratio) == sign).count() as f64 / (n + unsure as f64);
    let logarithm = ratios.iter().map(|ratio| ratio.value.ln()).sum::<f64>() / n;
    let error = ratios.iter().map(|ratio| (ratio.standard_error / ratio.value).powi(2)).sum::<f64>().sqrt() / n;
    let value = logarithm.exp();
    Some(Gain {
        geometric_mean: Estimate { value, standard_error: value * error },
        median: at(2),
        quartiles: [at(1), at(3)].map(|ratio| ratio.value),
        shares: [Sign::Above, Sign::Below].map(share),
        least,
        most,
        unsure,
    })
}

/// A model, and how its directions are drawn.
type ModelStrategy = (ModelKind, Strategy);

/// Two compared estimators, and the label of their row.
struct ComparedEstimators {
    words: [&'static str; 2],
    base: ModelStrategy,
    other: ModelStrategy,
}

/// Inputs of a summary.
struct SummaryInputs<'a> {
    cells: &'a [Vec<Measured>],
    lights: &'a [String],
    times: &'a Times,
}

/// The tables: the samplers of each model against `published`, then the models against each other; variances, then variances in
/// equal time.
pub(super) fn tables(cells: &[Vec<Measured>], lights: &[String], times: &Times) -> Vec<Table> {
    let figures = SummaryInputs { cells, lights, times };
    let against = |base: (ModelKind, Sampler), (model, strategy): ModelStrategy| ComparedEstimators {
        words: [model.name(), strategy.name()],
        base: (base.0, base.1.into()),
        other: (model, strategy),
    };
    let over_published = |strategies: &[Strategy]| -> Vec<ComparedEstimators> {
        let others = strategies.iter().filter(|strategy| strategy.sampler() != Some(Sampler::Published));
        let of_model = |model| others.clone().map(move |of| against((model, Sampler::Published), (model, *of)));
        ModelKind::ALL.into_iter().flat_map(of_model).collect()
    };
    let (samplers, all) = (over_published(&Sampler::ALL.map(Strategy::By)), over_published(&Strategy::ALL));
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
    let perfect = "In equal time a sample pays until it takes so many times that of the published sampler. perfect: \
                   directions in proportion to S cos θᵢ, drawn without regard to the light, which is what ever better \
                   samplers of the hair come to.";
    let counted = format!(
        "Won and lost: by more than two standard errors, those of the variances and of the times. Of {} cells; those left \
         out above are undecided.",
        cells.len()
    );
    let look_up = "The time of a look-up of the light in its direction is added to that of every sample.";
    let [alone, with] = [false, true];
    vec![
        figures
            .variance("V of the published sampler over V of another, over the grid", &all)
            .note(above("the published sampler"))
            .note(perfect),
        figures.equal_time("The same in equal time, set-up included: medians", &samplers, alone).note(timed),
        figures.equal_time("The same with a look-up of the light: medians", &samplers, with).note(look_up),
        figures
            .counts("Cells won / undecided / lost against the published sampler in equal time", &samplers, alone)
            .note(&counted),
        figures.counts("Cells won / undecided / lost with a look-up of the light", &samplers, with).note(look_up),
        figures
            .variance("V on the Gaussian model over V on the Cauchy model, over the grid", &models)
            .note(above("on the Gaussian model")),
        figures.equal_time("The same in equal time, set-up included: medians", &models, alone).note(timed),
    ]
}

impl SummaryInputs<'_> {
    /// V of both sides in every cell.
    fn pairs<'c>(&'c self, of: &'c ComparedEstimators, light: usize) -> impl Iterator<Item = [Estimate; 2]> + 'c {
        let place = move |(model, strategy): ModelStrategy| place(model, strategy, light, self.lights.len());
        self.cells.iter().map(move |cell| [of.base, of.other].map(|of| cell[place(of)].figures.v))
    }

    /// Time of the one over that of the other, alone or with a look-up of the light.
    fn time(&self, of: &ComparedEstimators, light: usize, per_point: usize, with_look_up: bool) -> Estimate {
        let ns = |(model, strategy): ModelStrategy| {
            strategy.sampler().map_or(Estimate::UNKNOWN, |sampler| self.times.ns(model, sampler, per_point))
        };
        let more = if with_look_up { self.times.look_up(light) } else { NOTHING };
        time_ratio(ns(of.base), ns(of.other), more)
    }

    /// A row for every light of every comparison, its first three cells filled in.
    fn each<'c>(
        &'c self,
        of: &'c [ComparedEstimators],
    ) -> impl Iterator<Item = (Vec<String>, &'c ComparedEstimators, usize)> {
        of.iter().flat_map(move |of| {
            self.lights.iter().enumerate().map(move |(light, name)| {
                let [first, second] = of.words.map(str::to_owned);
                (vec![first, second, name.clone()], of, light)
            })
        })
    }

    fn variance(&self, title: &str, of: &[ComparedEstimators]) -> Table {
        let mut table =
            keys(title).numbers(["median", "cells above 1 / below 1", "geometric mean", "least", "most", "left out"]);
        for (mut row, of, light) in self.each(of) {
            match gain(self.pairs(of, light)) {
                Some(gain) => {
                    row.extend([shown(gain.median), gain.shares.map(number::percent).join(" / ")]);
                    row.extend([gain.geometric_mean, gain.least, gain.most].map(shown));
                    row.push(gain.unsure.to_string());
                }
                // Perfect sampling under constant light.
                None if self.pairs(of, light).all(|[_, v]| v.value == 0.0) => row.push("no limit".to_owned()),
                None => row.extend(["", "", "", "", "", "all"].map(str::to_owned)),
            }
            table.push(row);
        }
        table
    }

    /// A table of equal time, a column for each number of samples per point: what `cell` makes of a ratio of times.
    fn timed(
        &self,
        title: &str,
        of: &[ComparedEstimators],
        with_look_up: bool,
        cell: impl Fn(&ComparedEstimators, usize, Estimate) -> String,
    ) -> Table {
        let mut table = keys(title).numbers(PER_POINT.map(|n| format!("{n} a point")));
        for (mut row, of, light) in self.each(of) {
            row.extend(PER_POINT.map(|per_point| {
                let time = self.time(of, light, per_point, with_look_up);
                if time.value.is_nan() { "not timed".to_owned() } else { cell(of, light, time) }
            }));
            table.push(row);
        }
        table
    }

    fn equal_time(&self, title: &str, of: &[ComparedEstimators], with_look_up: bool) -> Table {
        self.timed(title, of, with_look_up, |of, light, time| {
            let gain = gain(self.pairs(of, light));
            gain.map_or_else(String::new, |gain| shown(in_equal_time(gain.median, time)))
        })
    }

    fn counts(&self, title: &str, of: &[ComparedEstimators], with_look_up: bool) -> Table {
        let cell = |of: &ComparedEstimators, light: usize, time: Estimate| {
            CellCounts::count(self.pairs(of, light).map(sure_ratio), time).to_string()
        };
        self.timed(title, of, with_look_up, cell)
    }
}

fn keys(title: &str) -> Table {
    Table::new(title).texts(["model", "sampler", "light"])
}

pub(super) fn shown(of: Estimate) -> String {
    number::estimate(&of)
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
        assert_eq!((gain.median.value, gain.quartiles, gain.shares), (2.0, [2.0, 2.0], [0.5, 0.0]));
        assert_eq!(super::gain([[nan, nan]].into_iter()), None, "nothing is sure");
    }
}
