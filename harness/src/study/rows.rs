//! The rows of a study, as columns.

use super::cell::Measured;
use super::grid::{Cell, columns_of};
use super::output::Study;
use super::rays;
use crate::sampler::{Sampler, weight_bound};
use crate::subject::ModelKind;
use hairis_instruments::columns::Columns;
use hairis_instruments::stats::Estimate;

/// The sampler of a row; `None`: perfect sampling of the hair, see [`perfect`](super::perfect).
pub(super) type Strategy = Option<Sampler>;

/// A model, and how its directions are drawn.
pub(super) type Estimator = (ModelKind, Strategy);

/// Every strategy, in the order of reports.
pub(super) fn strategies() -> impl Iterator<Item = Strategy> + Clone {
    samplers().chain([None])
}

/// Samplers that can be run.
pub(super) fn samplers() -> impl Iterator<Item = Strategy> + Clone {
    Sampler::ALL.into_iter().map(Some)
}

/// Each of some strategies on each model.
pub(super) fn on_each_model(
    of: impl Iterator<Item = Strategy> + Clone,
) -> impl Iterator<Item = Estimator> + Clone {
    ModelKind::ALL
        .into_iter()
        .flat_map(move |model| of.clone().map(move |strategy| (model, strategy)))
}

/// Name in reports and in rows.
pub(super) fn name(strategy: Strategy) -> &'static str {
    strategy.map_or("perfect", Sampler::name)
}

/// The published sampler of the same model, which gains are measured against.
pub(super) const fn published((model, _): Estimator) -> Estimator {
    (model, Some(Sampler::Published))
}

/// A row: its identity and its figures.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) cell: Cell,
    pub(super) of: Estimator,
    /// Place of the light.
    pub(super) light: usize,
    pub(super) measured: &'a Measured,
}

impl Row<'_> {
    pub(super) fn v(&self) -> Estimate {
        self.measured.figures.v
    }
}

/// Place of a row within its cell: perfect sampling comes after all samplers of all models.
const fn place((model, strategy): Estimator, light: usize, lights: usize) -> usize {
    let line = match strategy {
        Some(sampler) => model as usize * Sampler::ALL.len() + sampler as usize,
        None => ModelKind::ALL.len() * Sampler::ALL.len() + model as usize,
    };
    line * lights + light
}

/// Sets the proven bounds on the weights in a cell: they depend on no light.
pub(super) fn set_bounds(cell: &Cell, measured: &mut [Measured], lights: usize) {
    let (params, theta_o) = (cell.params().ok(), f64::from(cell.theta_o_deg).to_radians());
    for (model, strategy) in on_each_model(samplers()) {
        let bound = strategy
            .zip(params.as_ref())
            .and_then(|(of, params)| weight_bound(model, of, params, theta_o));
        let first = place((model, strategy), 0, lights);
        measured[first..first + lights]
            .iter_mut()
            .for_each(|row| row.weight_bound = bound);
    }
}

impl Study {
    /// Names of the lights.
    pub(super) fn lights(&self) -> &[String] {
        &self.header.lights
    }

    /// The row of one estimator under one light in a cell.
    pub(super) fn row(&self, cell: Cell, of: Estimator, light: usize) -> Row<'_> {
        Row {
            cell,
            of,
            light,
            measured: &self.cells[cell.index][place(of, light, self.lights().len())],
        }
    }

    /// The rows of one estimator under one light, one per cell.
    pub(super) fn rows_of(&self, of: Estimator, light: usize) -> impl Iterator<Item = Row<'_>> {
        self.grid()
            .cells()
            .take(self.cells.len())
            .map(move |cell| self.row(cell, of, light))
    }

    /// Every row, in order: cells outermost, then models, strategies and lights.
    pub(super) fn rows(&self) -> Vec<Row<'_>> {
        let mut rows = Vec::new();
        for cell in self.grid().cells().take(self.cells.len()) {
            for of in on_each_model(strategies()) {
                rows.extend((0..self.lights().len()).map(|light| self.row(cell, of, light)));
            }
        }
        rows
    }

    /// The columns that identify a row.
    pub(super) fn keys(&self, rows: &[Row<'_>]) -> Columns {
        columns_of(rows.iter().map(|row| &row.cell))
            .text("model", rows.iter().map(|row| row.of.0.name()))
            .text("sampler", rows.iter().map(|row| name(row.of.1)))
            .text(
                "light",
                rows.iter().map(|row| self.lights()[row.light].clone()),
            )
    }

    /// The rows: what depends on the plan and the build alone.
    ///
    /// The sampler `perfect` would draw with a density proportional to the mean of RGB of `S cos theta_i`: all of its
    /// weights are the albedo.
    ///
    /// | column | what it is |
    /// |---|---|
    /// | `cell` .. `light` | what the row is of; widths, `phi_g` and `theta_o` in degrees |
    /// | `mean`, `mean_se` | integral of `L S cos theta_i`, mean of RGB, with its standard error |
    /// | `v`, `v_se` | relative variance of one sample |
    /// | `ess_per_1000` | effective sample size of 1000 samples, `1000 / (1 + v)` |
    /// | `samples_for_1_percent` | samples to a relative error of 1%, `v / 1e-4` |
    /// | `max_weight`, `weight_bound` | largest mean of RGB of a weight, whatever the light, and its proven bound where there is one; of `perfect` the estimate of the albedo |
    /// | `max_contribution` | largest contribution, in means; under constant light the largest weight in means |
    /// | `kl`, `kl_se` | Kullback-Leibler divergence of the density from the normalised integrand, nats; under constant light that from `S cos theta_i` |
    /// | `v_mis`, `v_mis_se` | V of one ray of direct light by one-sample MIS, without occlusion |
    /// | `v_4_4`, `v_8_8` and their `_se` | the same of a ray chosen from 4 + 4 and from 8 + 8 candidates |
    /// | `v_mis_visible_25` .. `v_8_8_visible_75` | the same with 25, 50 and 75% of the directions visible: `(V + 1)/v - 1` |
    /// | `pool_bias` | bias of the mean of the estimates from 8 + 8 candidates against `mean`, in standard errors; empty where too few pools decide it |
    #[must_use]
    pub fn columns(&self) -> Columns {
        let rows = self.rows();
        let figures = |of: fn(&Measured) -> f64| rows.iter().map(move |row| of(row.measured));
        let columns = self
            .keys(&rows)
            .estimate("mean", rows.iter().map(|row| row.measured.figures.mean))
            .estimate("v", rows.iter().map(Row::v))
            .number(
                "ess_per_1000",
                figures(|m| 1_000.0 / (1.0 + m.figures.v.value)),
            )
            .number(
                "samples_for_1_percent",
                figures(|m| m.figures.v.value * 1e4),
            )
            .number("max_weight", figures(|m| m.max_weight))
            .number(
                "weight_bound",
                figures(|m| m.weight_bound.unwrap_or(f64::NAN)),
            )
            .number("max_contribution", figures(|m| m.max_contribution))
            .estimate("kl", rows.iter().map(|row| row.measured.figures.kl));
        rays::columns(columns, &rows)
    }
}
