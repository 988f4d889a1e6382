//! The rows of a study, as columns.

use super::cell::Measured;
use super::columns::Columns;
use super::grid::{Cell, Grid, columns_of};
use super::rays;
use crate::sampler::{Sampler, weight_bound};
use crate::subject::ModelKind;
use rayon::prelude::*;

/// Sampling strategy of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Strategy {
    /// By a sampler.
    By(Sampler),
    /// Perfect sampling of the hair: see [`perfect`](super::perfect).
    Perfect,
}

impl Strategy {
    /// Every one, in the order of reports.
    pub(super) const ALL: [Self; Sampler::ALL.len() + 1] = {
        let mut all = [Self::Perfect; Sampler::ALL.len() + 1];
        let mut i = 0;
        while i < Sampler::ALL.len() {
            all[i] = Self::By(Sampler::ALL[i]);
            i += 1;
        }
        all
    };

    /// Name in reports and in rows.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::By(sampler) => sampler.name(),
            Self::Perfect => "perfect",
        }
    }

    /// The sampler, if one draws them.
    pub(super) const fn sampler(self) -> Option<Sampler> {
        match self {
            Self::By(sampler) => Some(sampler),
            Self::Perfect => None,
        }
    }
}

impl From<Sampler> for Strategy {
    fn from(sampler: Sampler) -> Self {
        Self::By(sampler)
    }
}

/// A row: its identity and its figures.
pub(super) struct Row<'a> {
    pub(super) cell: Cell,
    pub(super) model: ModelKind,
    pub(super) strategy: Strategy,
    /// Place of the light.
    pub(super) light: usize,
    pub(super) measured: &'a Measured,
    /// The proven bound on the weights; not a number where there is none.
    pub(super) weight_bound: f64,
}

/// The proven bounds on the weights, computed once: they depend on no light.
#[derive(Clone, Debug)]
pub(super) struct Bounds(Vec<f64>);

impl Bounds {
    /// The bounds of a grid.
    pub(super) fn over(grid: Grid) -> Self {
        let of_cell = |index: usize| {
            let cell = grid.cell(index);
            let (params, theta_o) = (cell.params().ok(), f64::from(cell.theta_o_deg).to_radians());
            let all = ModelKind::ALL.into_iter().flat_map(|model| Sampler::ALL.map(|sampler| (model, sampler)));
            let bound = move |(model, sampler)| weight_bound(model, sampler, params.as_ref()?, theta_o);
            all.map(move |of| bound(of).unwrap_or(f64::NAN))
        };
        Self((0..grid.len()).into_par_iter().flat_map_iter(of_cell).collect())
    }

    /// The bound of a sampler in a cell; NaN where there is none.
    pub(super) fn of(&self, cell: usize, model: ModelKind, sampler: Sampler) -> f64 {
        self.0[cell * ModelKind::ALL.len() * Sampler::ALL.len() + place(model, sampler, 0, 1)]
    }
}

/// Place of a row within its cell: perfect sampling comes after all samplers of all models.
pub(super) fn place(model: ModelKind, strategy: impl Into<Strategy>, light: usize, lights: usize) -> usize {
    let at = |found: Option<usize>| found.unwrap_or_default();
    let model = at(ModelKind::ALL.iter().position(|of| *of == model));
    let samplers = Sampler::ALL.len();
    let line = match strategy.into() {
        Strategy::By(sampler) => model * samplers + at(Sampler::ALL.iter().position(|of| *of == sampler)),
        Strategy::Perfect => ModelKind::ALL.len() * samplers + model,
    };
    line * lights + light
}

/// Every row, in order: cells outermost, then models, samplers (perfect sampling last) and lights.
pub(super) fn rows<'a>(grid: Grid, cells: &'a [Vec<Measured>], bounds: &Bounds, lights: usize) -> Vec<Row<'a>> {
    let mut rows = Vec::new();
    for (index, measured) in cells.iter().enumerate() {
        let cell = grid.cell(index);
        for model in ModelKind::ALL {
            for strategy in Strategy::ALL {
                let weight_bound = strategy.sampler().map_or(f64::NAN, |sampler| bounds.of(index, model, sampler));
                for light in 0..lights {
                    let measured = &measured[place(model, strategy, light, lights)];
                    rows.push(Row { cell, model, strategy, light, measured, weight_bound });
                }
            }
        }
    }
    rows
}

/// The columns that identify a row.
pub(super) fn keys(rows: &[Row<'_>], lights: &[String]) -> Columns {
    columns_of(rows.iter().map(|row| &row.cell))
        .text("model", rows.iter().map(|row| row.model.name()))
        .text("sampler", rows.iter().map(|row| row.strategy.name()))
        .text("light", rows.iter().map(|row| lights[row.light].clone()))
}

/// The columns of the study.
pub(super) fn columns(rows: &[Row<'_>], lights: &[String]) -> Columns {
    let figures = |of: fn(&Measured) -> f64| rows.iter().map(move |row| of(row.measured));
    let columns = keys(rows, lights)
        .estimate("mean", rows.iter().map(|row| row.measured.figures.mean))
        .estimate("v", rows.iter().map(|row| row.measured.figures.v))
        .number("ess_per_1000", figures(|m| 1_000.0 / (1.0 + m.figures.v.value)))
        .number("samples_for_1_percent", figures(|m| m.figures.v.value * 1e4))
        .number("max_weight", figures(|m| m.max_weight))
        .number("weight_bound", rows.iter().map(|row| row.weight_bound))
        .number("max_contribution", figures(|m| m.max_contribution))
        .estimate("kl", rows.iter().map(|row| row.measured.figures.kl));
    rays::columns(columns, rows)
}
