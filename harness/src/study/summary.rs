//! Summary of a study: gains over the published sampler and of the Cauchy model, as geometric means over the grid, and
//! in how many cells.

use super::equal_time::{count_cells, in_equal_time};
use super::output::Study;
use super::rows::{Estimator, Strategy, on_each_model, published, samplers, strategies};
use super::times::{PER_POINT, Times};
use super::view::{Counted, MAX_RELATIVE_ERROR, View, gain, sure_ratio};
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::table::{Table, number};

/// Estimators, and the one that each is compared with.
struct Compared {
    base: fn(Estimator) -> Estimator,
    others: Vec<Estimator>,
}

/// The same strategy on the Gaussian model.
pub(super) const fn on_gaussian((_, strategy): Estimator) -> Estimator {
    (ModelKind::Gaussian, strategy)
}

/// Those of some strategies that are not the published sampler, on each model.
fn over_published(of: impl Iterator<Item = Strategy> + Clone) -> Compared {
    let others = on_each_model(of).filter(|(_, strategy)| *strategy != Some(Sampler::Published)).collect();
    Compared { base: published, others }
}

impl Study {
    /// The tables that sum it up: the samplers of each model against `published`, then the models against each other;
    /// variances, then variances in equal time.
    #[must_use]
    pub fn summary(&self, times: &Times) -> Vec<Table> {
        let view = View { study: self, times };
        let (runnable, all) = (over_published(samplers()), over_published(strategies()));
        let on_cauchy = samplers().map(|strategy| (ModelKind::Cauchy, strategy)).collect();
        let models = Compared { base: on_gaussian, others: on_cauchy };
        let (percent, cells) = (100.0 * MAX_RELATIVE_ERROR, self.cells.len());
        let above = |who: &str| {
            format!(
                "Above 1, it needs fewer samples than {who}. {cells} cells. Left out: cells where the standard error of a V \
                 is above {percent}% of it, or nothing was seen of the light. ±: one standard error."
            )
        };
        let timed = "Times of the default hair, eight lanes, one thread, on this machine; ±: one standard error, that of the \
                     times included.";
        let perfect = "In equal time a sample pays until it takes so many times that of the published sampler. perfect: \
                       directions in proportion to S cos θᵢ, drawn without regard to the light, which is what ever better \
                       samplers of the hair come to.";
        let counts = format!(
            "Won and lost: by more than two standard errors, those of the variances and of the times. Of {cells} cells; \
             those left out above are undecided."
        );
        let look_up = "The time of a look-up of the light in its direction is added to that of every sample.";
        let variance = |title, of| variances(view, title, of);
        let median = |title, of, counted| in_time(view, title, of, counted, median);
        let won = |title, of, counted| in_time(view, title, of, counted, won_and_lost);
        let (alone, with) = (Counted::Sample, Counted::LookUp);
        vec![
            variance("V of the published sampler over V of another, over the grid", &all)
                .note(above("the published sampler"))
                .note(perfect),
            median("The same in equal time, set-up included: medians", &runnable, alone).note(timed),
            median("The same with a look-up of the light: medians", &runnable, with).note(look_up),
            won("Cells won / undecided / lost against the published sampler in equal time", &runnable, alone)
                .note(counts),
            won("Cells won / undecided / lost with a look-up of the light", &runnable, with).note(look_up),
            variance("V on the Gaussian model over V on the Cauchy model, over the grid", &models)
                .note(above("on the Gaussian model")),
            median("The same in equal time, set-up included: medians", &models, alone).note(timed),
        ]
    }
}

/// Gains in V.
fn variances(view: View<'_>, title: &str, of: &Compared) -> Table {
    let headers = ["median", "cells above 1 / below 1", "geometric mean", "least", "most", "left out"];
    view.table(title, headers, of.others.iter().copied(), |other, light| {
        let base = (of.base)(other);
        match view.gain(base, other, light) {
            Some(gain) => {
                let [mean, least, most] = [gain.geometric_mean, gain.least, gain.most].map(shown);
                let shares = gain.shares.map(number::percent).join(" / ");
                vec![shown(gain.median), shares, mean, least, most, gain.unsure.to_string()]
            }
            // Perfect sampling under constant light.
            None if view.rows_of(other, light).all(|row| row.v().value == 0.0) => vec!["no limit".to_owned()],
            None => ["", "", "", "", "", "all"].map(str::to_owned).into(),
        }
    })
}

/// A table of equal time, a column for each number of samples per point: what `entry` makes of the pairs of V and the ratio of
/// the times.
fn in_time(
    view: View<'_>,
    title: &str,
    of: &Compared,
    counted: Counted,
    entry: fn(&mut dyn Iterator<Item = [Estimate; 2]>, Estimate) -> String,
) -> Table {
    let headers = PER_POINT.map(|n| format!("{n} a point"));
    view.table(title, headers, of.others.iter().copied(), |other, light| {
        let base = (of.base)(other);
        let cell = |per_point| {
            let time = view.time_ratio([base, other], light, per_point, counted);
            if time.value.is_nan() { "not timed".to_owned() } else { entry(&mut view.pairs(base, other, light), time) }
        };
        PER_POINT.map(cell).into()
    })
}

/// The median gain in equal time.
fn median(pairs: &mut dyn Iterator<Item = [Estimate; 2]>, time: Estimate) -> String {
    gain(pairs).map_or_else(String::new, |gain| shown(in_equal_time(gain.median, time)))
}

/// Cells by what becomes of them in equal time.
fn won_and_lost(pairs: &mut dyn Iterator<Item = [Estimate; 2]>, time: Estimate) -> String {
    count_cells(pairs.map(sure_ratio), time).map(|cells| cells.to_string()).join(" / ")
}

pub(super) fn shown(of: Estimate) -> String {
    number::estimate(&of)
}
