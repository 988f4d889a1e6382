//! Queries to a finished study: variances, gains and times by model, sampler and light.

use super::equal_time::{NOTHING, Sign, time_ratio};
use super::estimator::{Estimator, name};
use super::finished::Study;
use super::rows::Row;
use hairis_harness::rays::RayTimes;
use hairis_harness::variance::{MAX_RELATIVE_ERROR, Measured, RAYS};
use hairis_instruments::plot::{Axis, Bar, bars};
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::Table;

/// Ratios of V over the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// Geometric mean of the ratios.
    pub geometric_mean: Estimate,
    /// Median cell, with its own standard error, which is larger than that of the median.
    pub median: Estimate,
    /// First and third quartile of the ratios.
    pub quartiles: [f64; 2],
    /// Shares of the cells that are above 1 and below it by more than two standard errors.
    pub shares: [f64; 2],
    /// Least ratio.
    pub least: Estimate,
    /// Largest ratio.
    pub most: Estimate,
    /// Number of cells that are left out.
    pub unsure: usize,
}

/// Returns the first V over the second; `None` if one of them is too uncertain.
pub(super) fn sure_ratio([base, other]: [Estimate; 2]) -> Option<Estimate> {
    let sure = |v: &Estimate| v.value > 0.0 && v.standard_error <= MAX_RELATIVE_ERROR * v.value;
    (sure(&base) && sure(&other)).then(|| base.ratio(&other))
}

/// Summarises the ratios of the first V to the second, cell by cell; `None` if no cell is sure.
///
/// The standard error of the geometric mean is that of its figures, for this grid. Both samplers use the same directions of the light, so
/// errors of the ratios are, if anything, overestimated.
pub fn gain(pairs: impl Iterator<Item = [Estimate; 2]>) -> Option<Gain> {
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
    let share = |sign| {
        ratios
            .iter()
            .filter(|ratio| Sign::of(**ratio) == sign)
            .count() as f64
            / (n + unsure as f64)
    };
    Some(Gain {
        geometric_mean: Estimate::geometric_mean(&ratios),
        median: at(2),
        quartiles: [at(1), at(3)].map(|ratio| ratio.value),
        shares: [Sign::Above, Sign::Below].map(share),
        least,
        most,
        unsure,
    })
}

/// Parts of a sample whose time is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counted {
    /// Time of the sampler alone.
    Sample,
    /// Time of the sampler and of the look-up of the light.
    LookUp,
}

/// Samples per shading point in figures and sentences that state one number only: that of direct lighting.
pub(super) const MANY: usize = 16;

impl Study {
    /// Returns V of `base` and of `other` in every cell.
    pub(super) fn pairs(
        &self,
        [base, other]: [Estimator; 2],
        light: usize,
    ) -> impl Iterator<Item = [Estimate; 2]> {
        self.rows_of(base, light)
            .zip(self.rows_of(other, light))
            .map(|(base, other)| [base.v(), other.v()])
    }

    /// Returns V of `base` over V of `other`; `None` if no cell is sure.
    #[must_use]
    pub fn gain(&self, pair: [Estimator; 2], light: usize) -> Option<Gain> {
        gain(self.pairs(pair, light))
    }

    /// Returns the time of a sample in ns, with its shading point's set-up shared by `per_point`; NaN for perfect sampling.
    pub(super) fn ns(&self, (model, strategy): Estimator, per_point: usize) -> Estimate {
        strategy.map_or(Estimate::UNKNOWN, |sampler| {
            self.times.ns(model, sampler, per_point)
        })
    }

    /// Returns the time of a look-up of the light in ns, or NaN if it was not measured.
    pub(super) fn look_up(&self, light: usize) -> Estimate {
        self.times.look_up(&self.lights()[light])
    }

    /// Returns the time that is counted beside that of a sample, in ns.
    pub(super) fn more(&self, light: usize, counted: Counted) -> Estimate {
        if counted == Counted::LookUp {
            self.look_up(light)
        } else {
            NOTHING
        }
    }

    /// Returns the time of a ray without its tracing, in ns, by its index in [`RAYS`]; NaN if it was not measured.
    pub(super) fn ray_ns(&self, (model, strategy): Estimator, light: usize, by: usize) -> Estimate {
        let key = (model.name(), name(strategy), &*self.lights()[light]);
        let is = |of: &&RayTimes| (of.model, of.sampler, &*of.light) == key;
        self.times
            .of_rays
            .iter()
            .find(is)
            .map_or(Estimate::UNKNOWN, |of| of.ray(RAYS[by].candidates_each))
    }

    /// Returns the time of a sample of `base` over that of one of `other`.
    pub(super) fn time_ratio(
        &self,
        pair: [Estimator; 2],
        light: usize,
        per_point: usize,
        counted: Counted,
    ) -> Estimate {
        time_ratio(
            pair.map(|one| self.ns(one, per_point)),
            self.more(light, counted),
        )
    }

    /// Returns the ratio of the variance of `base` to that of `other` in equal time, with [`MANY`] samples per shading point, as the median
    /// over the cells. `None` if no cell is sure, or a time is unknown.
    pub(super) fn equal_time(
        &self,
        pair: [Estimator; 2],
        light: usize,
        counted: Counted,
    ) -> Option<Estimate> {
        let median = self.gain(pair, light)?.median;
        let gain = median.times(&self.time_ratio(pair, light, MANY, counted));
        gain.value.is_finite().then_some(gain)
    }

    /// Returns the geometric mean over the cells of `1 / (V µs)`.
    pub(super) fn efficiency(
        &self,
        of: Estimator,
        light: usize,
        per_point: usize,
    ) -> Option<Estimate> {
        let one = Estimate::exact(1e3).ratio(&mean_v(self.rows_of(of, light))?);
        Some(one.ratio(&self.ns(of, per_point)))
    }

    /// Returns a table with a row for each of these estimators under each light, whose numbers `cells` returns.
    pub(super) fn table(
        &self,
        title: &str,
        headers: impl IntoIterator<Item = impl Into<String>>,
        of: impl Iterator<Item = Estimator>,
        cells: &dyn Fn(Estimator, usize) -> Vec<String>,
    ) -> Table {
        let mut table = Table::new(title)
            .texts(["model", "sampler", "light"])
            .numbers(headers);
        for (model, strategy) in of {
            for (light, title) in self.lights().iter().enumerate() {
                let keys = [model.name(), name(strategy), title].map(str::to_owned);
                table.push(keys.into_iter().chain(cells((model, strategy), light)));
            }
        }
        table
    }

    /// Draws a chart with a bar for each light of each of these estimators, from `level` on.
    pub(super) fn by_light(
        &self,
        title: &str,
        axis: Axis,
        level: f64,
        of: &mut dyn Iterator<Item = Estimator>,
        bar: &dyn Fn(Estimator, usize) -> Bar,
    ) -> String {
        // The words of a file's name.
        let labels: Vec<String> = self
            .lights()
            .iter()
            .map(|name| name.replace(['-', '_'], " "))
            .collect();
        let lights = 0..labels.len();
        let series: Vec<_> = of
            .map(|one| {
                (
                    name(one.1).to_owned(),
                    lights.clone().map(|light| bar(one, light)).collect(),
                )
            })
            .collect();
        bars(title, axis, &labels, &series, level)
    }
}

/// Returns the geometric mean of V over some cells.
pub(super) fn mean_v<'a>(rows: impl Iterator<Item = Row<'a>>) -> Option<Estimate> {
    gain(rows.map(|row| [row.v(), Estimate::exact(1.0)])).map(|gain| gain.geometric_mean)
}

/// Returns the mean of a figure over some cells. Cells with NaN are left out.
pub(super) fn mean_of<'a>(
    rows: impl Iterator<Item = Row<'a>>,
    figure: &dyn Fn(&Measured) -> Estimate,
) -> Estimate {
    let figures = rows.map(|row| figure(row.measured));
    let (mut n, mut sum, mut square) = (0.0, 0.0, 0.0);
    for figure in
        figures.filter(|figure| figure.value.is_finite() && figure.standard_error.is_finite())
    {
        (n, sum, square) = (
            n + 1.0,
            sum + figure.value,
            square + figure.standard_error.powi(2),
        );
    }
    Estimate {
        value: sum / n,
        standard_error: f64::sqrt(square) / n,
    }
}
