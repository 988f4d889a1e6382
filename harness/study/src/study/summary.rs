//! Summary of a study: gains over the published sampler and of the Cauchy model, as medians and geometric means over the grid, with the
//! shares of cells that gain and lose.

use super::equal_time::count_cells;
use super::estimator::{Estimator, Strategy, on_each_model, published, samplers, strategies};
use super::finished::Study;
use super::view::{Counted, sure_ratio};
use hairis_harness::materials;
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_harness::times::PER_POINT;
use hairis_harness::variance::MAX_RELATIVE_ERROR;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::{Table, number};

/// Function that maps an estimator to the one it is compared with, and the estimators to compare.
type Compared = (fn(Estimator) -> Estimator, Vec<Estimator>);

/// Maps an estimator to the Gaussian model.
pub(super) const fn on_gaussian((_, strategy): Estimator) -> Estimator {
    (ModelKind::Gaussian, strategy)
}

/// Pairs strategies with the published sampler, on each model.
fn over_published(of: impl Iterator<Item = Strategy> + Clone) -> Compared {
    (
        published,
        on_each_model(of)
            .filter(|(_, strategy)| *strategy != Some(Sampler::Published))
            .collect(),
    )
}

impl Study {
    /// Returns the tables that summarise the study: the samplers of each model against `published`, then the models against each other;
    /// variances, then variances in equal time.
    #[must_use]
    pub fn summary(&self) -> Vec<Table> {
        let (runnable, all) = (over_published(samplers()), over_published(strategies()));
        let models: Compared = (
            on_gaussian,
            samplers()
                .map(|strategy| (ModelKind::Cauchy, strategy))
                .collect(),
        );
        let (percent, cells) = (100.0 * MAX_RELATIVE_ERROR, self.cells.len());
        let above = |who: &str| {
            format!(
                "Above 1, it needs fewer samples than {who}. {cells} cells. Left out: cells where the standard error of a V \
                 is above {percent}% of it, or nothing was seen of the light. ±: one standard error."
            )
        };
        let perfect = "In equal time a sample pays until it takes so many times that of the published sampler. perfect: \
                       directions in proportion to S cos θᵢ, drawn without regard to the light, which is what ever better \
                       samplers of the hair come to.";
        let timed = format!(
            "Times of the default hair, eight lanes, one thread, on this machine. ±: one standard error, that of the times \
             included. Won and lost: by more than two standard errors, of {cells} cells; those left out above are undecided."
        );
        let look_up =
            "The time of a look-up of the light in its direction is added to that of every sample.";
        let in_time =
            "The same in equal time, set-up included: median (cells won / undecided / lost)";
        let with_look_up =
            "The same with a look-up of the light: median (cells won / undecided / lost)";
        let mut tables = vec![
            self.gains(
                "V of the published sampler over V of another, over the grid",
                &all,
            )
            .note(above("the published sampler"))
            .note(perfect),
            self.gains_in_time(in_time, &runnable, Counted::Sample)
                .note(&*timed),
            self.gains_in_time(with_look_up, &runnable, Counted::LookUp)
                .note(look_up),
            self.gains(
                "V on the Gaussian model over V on the Cauchy model, over the grid",
                &models,
            )
            .note(above("on the Gaussian model")),
            self.gains_in_time(in_time, &models, Counted::Sample)
                .note(&*timed),
        ];
        tables.extend(self.refit_table());
        tables
    }

    /// Returns the table of the materials beside the hair of the grid, if there are any.
    #[must_use]
    pub fn materials(&self) -> Option<Table> {
        let rows = self.material_rows();
        (!rows.is_empty()).then(|| materials::table(&rows))
    }

    /// Returns the table of gains in V.
    fn gains(&self, title: &str, (base, others): &Compared) -> Table {
        let headers = [
            "median",
            "cells above 1 / below 1",
            "geometric mean",
            "least",
            "most",
            "left out",
        ];
        self.table(
            title,
            headers,
            others.iter().copied(),
            &|other, light| match self.gain([base(other), other], light) {
                Some(gain) => {
                    let [mean, least, most] =
                        [gain.geometric_mean, gain.least, gain.most].map(shown);
                    let shares = gain.shares.map(number::percent).join(" / ");
                    vec![
                        shown(gain.median),
                        shares,
                        mean,
                        least,
                        most,
                        gain.unsure.to_string(),
                    ]
                }
                // Perfect sampling under constant light has a V of 0.
                None if self.rows_of(other, light).all(|row| row.v().value == 0.0) => {
                    vec!["no limit".to_owned()]
                }
                None => ["", "", "", "", "", "all"].map(str::to_owned).into(),
            },
        )
    }

    /// Returns the table of gains in equal time, with a column for each number of samples per point.
    fn gains_in_time(&self, title: &str, (base, others): &Compared, counted: Counted) -> Table {
        let headers = PER_POINT.map(|n| format!("{n} a point"));
        self.table(title, headers, others.iter().copied(), &|other, light| {
            let pair = [base(other), other];
            let entry = |per_point| {
                let time = self.time_ratio(pair, light, per_point, counted);
                if time.value.is_nan() {
                    return "not timed".to_owned();
                }
                let cells = count_cells(self.pairs(pair, light).map(sure_ratio), time)
                    .map(|cells| cells.to_string());
                let median = self
                    .gain(pair, light)
                    .map_or_else(String::new, |gain| shown(gain.median.times(&time)));
                format!("{median} ({})", cells.join(" / "))
            };
            PER_POINT.map(entry).into()
        })
    }
}

/// Returns an estimate as tables show it.
#[must_use]
pub fn shown(of: Estimate) -> String {
    number::estimate(&of)
}
