//! Parts common to charts: the axes with their grid, bars of errors, and the legend.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, GRID, LABEL, Pen, Place, THIN, TICK, Type, WIDTH};
use super::palette::{Color, series_color};
use crate::stats::Estimate;
use core::iter;

/// Distance of the entries of a legend.
const LEGEND_LINE: f64 = 23.0;

/// A value, as the height of a bar or of a point, with whiskers if they differ from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    pub(super) value: f64,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Bar {
    /// A bar without whiskers.
    #[must_use]
    pub const fn new(value: f64) -> Self {
        Self { value, low: value, high: value }
    }

    /// The same bar with a standard error.
    #[must_use]
    pub const fn with_error(self, error: f64) -> Self {
        self.with_interval(self.value - error, self.value + error)
    }

    /// The same bar with an interval, such as that of the quartiles.
    #[must_use]
    pub const fn with_interval(self, low: f64, high: f64) -> Self {
        Self { low, high, ..self }
    }

    /// Draws its whiskers, cut to the plot, at the pixel `x`.
    pub(super) fn whiskers(&self, canvas: &mut Canvas, x: f64, y: &Fitted, color: Color) {
        if self.high > self.low {
            let (pen, low, high) = (Pen::new(color, 1.5), y.within(self.low), y.within(self.high));
            canvas.line(&[(x, low), (x, high)], pen);
            for end in [low, high] {
                canvas.line(&[(x - 4.0, end), (x + 4.0, end)], pen);
            }
        }
    }
}

impl From<f64> for Bar {
    fn from(value: f64) -> Self {
        Self::new(value)
    }
}

impl From<Estimate> for Bar {
    fn from(estimate: Estimate) -> Self {
        Self::new(estimate.value).with_error(estimate.standard_error)
    }
}

/// A sheet with its title, and the axes of a plot of `height` below it, wide enough for their values.
pub(super) fn plot<'a>(
    title: &str,
    height: f64,
    (x, xs): (&'a Axis, impl Iterator<Item = f64>),
    (y, ys): (&'a Axis, impl Iterator<Item = f64>),
) -> (Canvas, Fitted<'a>, Fitted<'a>) {
    let (mut canvas, top) = Canvas::new(title);
    let y = y.fit(ys, top + height, top);
    let x = x.fit(xs, 42.0 + widest_label(&y), WIDTH - 16.0);
    draw_axis(&mut canvas, &y, &x, true);
    (canvas, x, y)
}

fn widest_label(axis: &Fitted) -> f64 {
    axis.ticks().iter().filter_map(|tick| tick.label.as_deref()).map(|label| TICK.width(label)).fold(20.0, f64::max)
}

/// Draws an axis at the start of another one, with its grid lines across to the end of that.
pub(super) fn draw_axis(canvas: &mut Canvas, axis: &Fitted, across: &Fitted, upright: bool) {
    let place = |along: f64, across: f64| if upright { (across, along) } else { (along, across) };
    let base = across.start;
    let (outwards, anchor) = if upright { (-1.0, "end") } else { (1.0, "middle") };
    let ticks = axis.ticks();
    for tick in &ticks {
        let pen = if tick.label.is_some() { GRID } else { Pen { alpha: 0.5 * GRID.alpha, ..GRID } };
        canvas.line(&[place(tick.at, base), place(tick.at, across.end)], pen);
    }
    for (at, label) in ticks.iter().filter_map(|tick| Some((tick.at, tick.label.as_deref()?))) {
        canvas.line(&[place(at, base), place(at, base + 5.0 * outwards)], THIN);
        let gap = if upright { -9.0 } else { 15.0 };
        canvas.text(label, place(at, base + gap), Type { anchor, ..TICK });
    }
    let gap = if upright { -22.0 - widest_label(axis) } else { 36.0 };
    canvas.text(&axis.axis.label, place(axis.middle(), base + gap), Type { upright, ..LABEL });
}

/// Draws a legend below `top`, each entry with its mark, and returns where it ends.
pub(super) fn legend(canvas: &mut Canvas, names: &[&str], top: f64, mark: impl Fn(&mut Canvas, usize, Place)) -> f64 {
    const LEFT: f64 = 12.0;
    let widest = names.iter().map(|name| 58.0 + LABEL.width(name)).fold(1.0, f64::max);
    let fit = (1..=names.len()).rev().find(|n| LEFT + *n as f64 * widest <= WIDTH).unwrap_or(1);
    // As few rows as fit, evenly filled.
    let rows = names.len().div_ceil(fit);
    let columns = names.len().div_ceil(rows.max(1)).max(1);
    for (i, name) in names.iter().enumerate() {
        let x = LEFT + (i % columns) as f64 * widest;
        let y = top + ((i / columns) as f64 + 0.5) * LEGEND_LINE;
        mark(canvas, i, (x, y));
        canvas.text(name, (x + 42.0, y), Type { anchor: "start", ..LABEL });
    }
    top + rows as f64 * LEGEND_LINE
}

/// A bar of the series number `index`: filled, framed, and hatched differently for each so that it survives grey printing.
pub(super) fn swatch(canvas: &mut Canvas, (x0, y0): Place, (x1, y1): Place, index: usize) {
    let color = series_color(index);
    let (low, high) = ((x0, y0.min(y1)), (x1, y0.max(y1)));
    canvas.block(low, high, color, if index == 0 { 1.0 } else { 0.55 });
    if let Some(slope) = [None, Some(1.0), Some(-1.0), Some(0.0)][index % 4] {
        let width = x1 - x0;
        let starts = iter::successors(Some(low.1 - width), |y| Some(y + 7.0)).take_while(|y| *y < high.1 + width);
        for stroke in starts.filter_map(|y| clip([(x0, y), (x1, y + slope * width)], low, high)) {
            canvas.line(&stroke, Pen::new(color, 1.4));
        }
    }
    canvas.frame(low, high, Pen::new(color, 1.2));
}

/// The part of a segment inside of the rectangle from `low` to `high`.
pub(super) fn clip([a, b]: [Place; 2], low: Place, high: Place) -> Option<[Place; 2]> {
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    for (from, step, low, high) in [(a.0, dx, low.0, high.0), (a.1, dy, low.1, high.1)] {
        if step == 0.0 && (low..=high).contains(&from) {
            continue;
        }
        let (enter, leave) = ((low - from) / step, (high - from) / step);
        (t0, t1) = (t0.max(enter.min(leave)), t1.min(enter.max(leave)));
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    (t0 <= t1).then(|| [at(t0), at(t1)])
}
