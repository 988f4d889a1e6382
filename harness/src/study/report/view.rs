//! Queries of a report to a study: variances, gains and times by model, sampler and light.

use super::super::cell::Measured;
use super::super::equal_time::{NOTHING, in_equal_time, time_ratio};
use super::super::rows::{Bounds, Strategy, place};
use super::super::summary::{Gain, gain};
use super::super::{Cell, Grid};
use crate::difference::Difference;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::study::output::Times;
use crate::subject::ModelKind;

/// A sampler of a model.
pub(super) type Estimator = (ModelKind, Sampler);

/// A finished study with what it is told together with.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) grid: Grid,
    pub(super) cells: &'a [Vec<Measured>],
    pub(super) bounds: &'a Bounds,
    /// Names of the lights.
    pub(super) lights: &'a [String],
    pub(super) times: &'a Times,
    pub(super) difference: &'a Difference,
}

/// Samples per shading point of figures and sentences that give one number of them: direct lighting.
pub(super) const MANY: usize = 16;

/// Parts of a sample whose time is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counted {
    /// The sampler's alone.
    Sample,
    /// That and the look-up of the light.
    LookUp,
}

/// The samplers that are told apart in sentences: the published one, and the matched one that a renderer takes unless it
/// knows better.
pub(super) const TOLD: [Sampler; 2] = [Sampler::Published, Sampler::Matched];

impl<'a> View<'a> {
    /// Names of the lights, to be set under bars: a file's in words.
    pub(super) fn light_labels(&self) -> impl Iterator<Item = String> + use<'_, 'a> {
        self.lights.iter().map(|name| name.replace(['-', '_'], " "))
    }

    pub(super) fn measured(
        &self,
        index: usize,
        (model, strategy): (ModelKind, impl Into<Strategy>),
        light: usize,
    ) -> &'a Measured {
        &self.cells[index][place(model, strategy, light, self.lights.len())]
    }

    pub(super) fn v(&self, index: usize, of: (ModelKind, impl Into<Strategy>), light: usize) -> Estimate {
        self.measured(index, of, light).figures.v
    }

    /// The cells, with their places.
    pub(super) fn each_cell(&self) -> impl Iterator<Item = Cell> + '_ {
        (0..self.cells.len()).map(|index| self.grid.cell(index))
    }

    /// V of `base` and of `other` in every cell.
    fn pairs<S: Into<Strategy> + Copy>(
        &self,
        base: Estimator,
        other: (ModelKind, S),
        light: usize,
    ) -> impl Iterator<Item = [Estimate; 2]> {
        (0..self.cells.len()).map(move |index| [self.v(index, base, light), self.v(index, other, light)])
    }

    /// V of `base` over V of `other`; `None` if no cell is sure.
    pub(super) fn gain<S: Into<Strategy> + Copy>(
        &self,
        base: Estimator,
        other: (ModelKind, S),
        light: usize,
    ) -> Option<Gain> {
        gain(self.pairs(base, other, light))
    }

    /// Geometric mean of V over the cells that are kept.
    pub(super) fn mean_v<S: Into<Strategy> + Copy>(
        &self,
        of: (ModelKind, S),
        light: usize,
        keep: impl Fn(&Cell) -> bool,
    ) -> Option<Estimate> {
        let one = Estimate::exact(1.0);
        let cells = self.each_cell().filter(|cell| keep(cell));
        gain(cells.map(|cell| [self.v(cell.index, of, light), one])).map(|gain| gain.geometric_mean)
    }

    /// Time of a sample in ns, its shading point's set-up shared by `per_point`.
    pub(super) fn ns(&self, (model, sampler): Estimator, per_point: usize) -> Estimate {
        self.times.ns(model, sampler, per_point)
    }

    /// Time of a look-up of the light in ns; `None` if it was not timed.
    pub(super) fn look_up(&self, light: usize) -> Option<Estimate> {
        Some(self.times.look_up(light)).filter(|of| of.value.is_finite())
    }

    /// How many times the variance `base` has of `other` in equal time, [`MANY`] samples per shading point: median over
    /// the cells.
    pub(super) fn equal_time(
        &self,
        base: Estimator,
        other: Estimator,
        light: usize,
        counted: Counted,
    ) -> Option<Estimate> {
        let time = self.time_ratio(base, other, light, counted)?;
        self.gain(base, other, light).map(|gain| in_equal_time(gain.median, time))
    }

    /// Time of a sample of `base` over that of one of `other`, at [`MANY`] samples per shading point.
    pub(super) fn time_ratio(
        &self,
        base: Estimator,
        other: Estimator,
        light: usize,
        counted: Counted,
    ) -> Option<Estimate> {
        let more = match counted {
            Counted::Sample => NOTHING,
            Counted::LookUp => self.look_up(light)?,
        };
        Some(time_ratio(self.ns(base, MANY), self.ns(other, MANY), more))
    }

    /// Geometric mean over the cells of `1 / (V µs)`.
    pub(super) fn efficiency(&self, of: Estimator, light: usize, per_point: usize) -> Option<Estimate> {
        let v = self.mean_v(of, light, |_| true)?;
        let ns = self.ns(of, per_point);
        let value = 1e3 / (v.value * ns.value);
        let relative = (v.standard_error / v.value).hypot(ns.standard_error / ns.value);
        Some(Estimate { value, standard_error: value * relative })
    }

    /// Mean over the cells of a figure; cells where it is no number are left out.
    pub(super) fn mean_of<S: Into<Strategy> + Copy>(
        &self,
        of: (ModelKind, S),
        light: usize,
        figure: impl Fn(&Measured) -> Estimate,
    ) -> Estimate {
        let figures = (0..self.cells.len()).map(|index| figure(self.measured(index, of, light)));
        let (mut n, mut sum, mut square) = (0.0, 0.0, 0.0);
        for figure in figures.filter(|figure| figure.value.is_finite() && figure.standard_error.is_finite()) {
            (n, sum, square) = (n + 1.0, sum + figure.value, square + figure.standard_error.powi(2));
        }
        Estimate { value: sum / n, standard_error: f64::sqrt(square) / n }
    }
}

/// Effective samples in 1000.
pub(super) fn ess(of: &Measured) -> Estimate {
    let v = of.figures.v;
    let value = 1e3 / (1.0 + v.value);
    Estimate { value, standard_error: value * v.standard_error / (1.0 + v.value) }
}
