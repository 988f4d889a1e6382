//! Parts that charts share: the axes with their grid, error bars, and the legend.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, GRID, LABEL, Pen, Place, THIN, TICK, Type, WIDTH};
use super::palette::{Color, series_color};
use crate::stats::Estimate;

/// Distance between the lines of a legend, in pixels.
const LEGEND_LINE: f64 = 23.0;

/// Value that a bar or a point shows, with whiskers if their ends differ from each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Value, which is drawn only if it is finite.
    pub value: f64,
    /// Lower end of the whiskers.
    pub low: f64,
    /// Upper end of the whiskers.
    pub high: f64,
}

impl From<f64> for Bar {
    fn from(value: f64) -> Self {
        Self {
            value,
            low: value,
            high: value,
        }
    }
}

/// Makes whiskers of one standard error to either side.
impl From<Estimate> for Bar {
    fn from(
        Estimate {
            value,
            standard_error,
        }: Estimate,
    ) -> Self {
        Self {
            value,
            low: value - standard_error,
            high: value + standard_error,
        }
    }
}

impl Bar {
    /// Draws the whiskers at the pixel `x`, cut to the plot.
    pub(super) fn whiskers(&self, canvas: &mut Canvas, x: f64, y: &Fitted, color: Color) {
        if self.high > self.low {
            let (pen, low, high) = (Pen::new(color, 1.5), y.pixel(self.low), y.pixel(self.high));
            canvas.line(&[(x, low), (x, high)], pen);
            for end in [low, high] {
                canvas.line(&[(x - 4.0, end), (x + 4.0, end)], pen);
            }
        }
    }
}

/// Makes a sheet with its title, and below it the axes of a plot of `height`, wide enough for their values.
pub(super) fn plot(
    title: &str,
    height: f64,
    (x, xs): (Axis, &[f64]),
    (y, ys): (Axis, &[f64]),
) -> (Canvas, Fitted, Fitted) {
    let (mut canvas, top) = Canvas::new(title);
    let y = y.fit(ys, top + height, top);
    let x = x.fit(xs, 42.0 + widest_label(&y), WIDTH - 16.0);
    draw_axis(&mut canvas, &y, &x, true);
    (canvas, x, y)
}

fn widest_label(axis: &Fitted) -> f64 {
    axis.ticks()
        .iter()
        .filter_map(|(_, label)| label.as_deref())
        .map(|label| TICK.width(label))
        .fold(20.0, f64::max)
}

/// Draws an axis at the start of the axis `across`, with grid lines to the end of `across`.
pub(super) fn draw_axis(canvas: &mut Canvas, axis: &Fitted, across: &Fitted, upright: bool) {
    let place = |along: f64, across: f64| {
        if upright {
            (across, along)
        } else {
            (along, across)
        }
    };
    let base = across.start;
    let (outwards, anchor) = if upright {
        (-1.0, "end")
    } else {
        (1.0, "middle")
    };
    let [text_gap, title_gap] = if upright {
        [-9.0, -22.0 - widest_label(axis)]
    } else {
        [15.0, 36.0]
    };
    let ticks = axis.ticks();
    for (at, label) in &ticks {
        let alpha = if label.is_some() {
            GRID.alpha
        } else {
            0.5 * GRID.alpha
        };
        canvas.line(
            &[place(*at, base), place(*at, across.end)],
            Pen { alpha, ..GRID },
        );
    }
    for (at, label) in &ticks {
        let Some(label) = label else { continue };
        canvas.line(&[place(*at, base), place(*at, base + 5.0 * outwards)], THIN);
        canvas.text(label, place(*at, base + text_gap), Type { anchor, ..TICK });
    }
    canvas.text(
        &axis.axis.label,
        place(axis.along(0.5), base + title_gap),
        Type { upright, ..LABEL },
    );
}

/// Draws a legend below `top`, each entry with its mark, and returns the height at which the legend ends.
pub(super) fn legend(
    canvas: &mut Canvas,
    names: &[&str],
    top: f64,
    mark: &dyn Fn(&mut Canvas, usize, Place),
) -> f64 {
    const LEFT: f64 = 12.0;
    let widest = names
        .iter()
        .map(|name| 58.0 + LABEL.width(name))
        .fold(1.0, f64::max);
    let fit = (1..=names.len())
        .rev()
        .find(|n| LEFT + *n as f64 * widest <= WIDTH)
        .unwrap_or(1);
    // As few rows as fit, evenly filled.
    let rows = names.len().div_ceil(fit);
    let columns = names.len().div_ceil(rows.max(1)).max(1);
    for (i, name) in names.iter().enumerate() {
        let x = LEFT + (i % columns) as f64 * widest;
        let y = top + ((i / columns) as f64 + 0.5) * LEGEND_LINE;
        mark(canvas, i, (x, y));
        canvas.text(
            name,
            (x + 42.0, y),
            Type {
                anchor: "start",
                ..LABEL
            },
        );
    }
    top + rows as f64 * LEGEND_LINE
}

/// Draws a bar of the series with number `index`. The bar is framed, and its strength depends on the series so that it survives grey
/// printing.
pub(super) fn swatch(canvas: &mut Canvas, low: Place, high: Place, index: usize) {
    let color = series_color(index);
    canvas.block(low, high, color, [1.0, 0.5, 0.2, 0.75][index % 4]);
    canvas.frame(low, high, Pen::new(color, 1.2));
}
