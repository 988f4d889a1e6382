//! Rows of a study, and their columns in its files.

use super::estimator::{Estimator, name, on_each_model, place, strategies};
use super::finished::Study;
use super::grid::{Cell, columns_of};
use hairis_harness::materials::{self, MaterialRow};
use hairis_harness::variance::{Measured, figures_of};
use hairis_instruments::columns::Columns;
use hairis_instruments::light::Constant;
use hairis_instruments::stats::Estimate;

/// Row of a study: its identity and its figures.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) cell: Cell,
    pub(super) of: Estimator,
    /// Index of the light.
    pub(super) light: usize,
    pub(super) measured: &'a Measured,
}

impl Row<'_> {
    pub(super) fn v(&self) -> Estimate {
        self.measured.figures.v
    }
}

impl Study {
    /// Returns the names of the lights.
    pub(super) fn lights(&self) -> &[String] {
        &self.header.lights
    }

    /// Returns the index of the constant light, or 0 if the parts have none.
    pub(super) fn constant(&self) -> usize {
        let mut names = self.lights().iter();
        names.position(|name| name == Constant::NAME).unwrap_or(0)
    }

    /// Returns the row of one estimator under one light in a cell.
    pub(super) fn row(&self, cell: Cell, of: Estimator, light: usize) -> Row<'_> {
        Row {
            cell,
            of,
            light,
            measured: &self.cells[cell.index][place(of, light, self.lights().len())],
        }
    }

    /// Returns the rows of one estimator under one light, one per cell.
    pub(super) fn rows_of(&self, of: Estimator, light: usize) -> impl Iterator<Item = Row<'_>> {
        self.grid()
            .cells()
            .take(self.cells.len())
            .map(move |cell| self.row(cell, of, light))
    }

    /// Returns every row, in order: cells outermost, then models, strategies and lights.
    pub(super) fn rows(&self) -> Vec<Row<'_>> {
        let mut rows = Vec::new();
        for cell in self.grid().cells().take(self.cells.len()) {
            for of in on_each_model(strategies()) {
                rows.extend((0..self.lights().len()).map(|light| self.row(cell, of, light)));
            }
        }
        rows
    }

    /// Returns the columns that identify a row.
    pub(super) fn keys(&self, rows: &[Row<'_>]) -> Columns {
        columns_of(rows.iter().map(|row| &row.cell))
            .text("model", rows.iter().map(|row| row.of.0.name()))
            .text("sampler", rows.iter().map(|row| name(row.of.1)))
            .text(
                "light",
                rows.iter().map(|row| self.lights()[row.light].clone()),
            )
    }

    /// Returns the rows as columns of a file. They depend only on the plan and the build.
    ///
    /// The sampler `perfect` would draw with a density proportional to the mean of RGB of `S cos theta_i`, so that all of its weights are
    /// the albedo.
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
        let measured: Vec<&Measured> = rows.iter().map(|row| row.measured).collect();
        figures_of(self.keys(&rows), &measured)
    }

    /// Returns every row of the materials: materials outermost, then inclinations, samplers and lights.
    pub(super) fn material_rows(&self) -> Vec<MaterialRow<'_>> {
        let inclinations = self.grid().theta_o_deg;
        let keys = self.header.materials.iter().flat_map(|key| {
            let pose = move |theta_o: &f32| (key, f64::from(*theta_o));
            inclinations.iter().map(pose)
        });
        let rows = keys.zip(&self.materials);
        rows.flat_map(|((key, theta_o), measured)| {
            materials::rows(key, self.lights(), theta_o, measured)
        })
        .collect()
    }

    /// Returns the rows of the materials as columns: `material`, `model`, `theta_o_deg` in degrees, `sampler` and `light`, then the figures
    /// of [`columns`](Self::columns).
    #[must_use]
    pub fn material_columns(&self) -> Columns {
        materials::columns(&self.material_rows())
    }
}
