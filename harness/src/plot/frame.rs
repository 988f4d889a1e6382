//! Parts common to all charts: the title, the axes with their grid, and the legend.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, Hang, Pen, Place, Type, text_width, wrap};
use super::palette::{Color, Dash, FAINT_GRID, FAINT_INK, GRID, INK, Marker};

/// Width of a chart, pixels.
pub(super) const WIDTH: f64 = 640.0;
/// Size of titles, axis labels and legends; tick labels.
const TITLE: f64 = 17.0;
pub(super) const LABEL: f64 = 15.0;
pub(super) const TICK: f64 = 13.5;
const LEGEND_LINE: f64 = 23.0;

/// Mark that a legend shows beside a name.
#[derive(Clone, Copy)]
pub(super) struct Key {
    pub(super) color: Color,
    /// A line in this dash.
    pub(super) line: Option<Dash>,
    pub(super) marker: Option<Marker>,
    /// A filled swatch, as of a bar.
    pub(super) swatch: Option<usize>,
}

/// Draws the title and returns the height it takes.
pub(super) fn title(canvas: &mut Canvas, text: &str, width: f64) -> f64 {
    let lines = wrap(text, width - 24.0, TITLE * 1.05);
    let mut y = 8.0;
    for line in &lines {
        let set = Type { bold: true, ..Type::new(TITLE, Hang::Center) };
        canvas.text(line, (width / 2.0, y + 12.0), set);
        y += 22.0;
    }
    y + 4.0
}

/// The height of a title.
pub(super) fn title_height(text: &str, width: f64) -> f64 {
    let mut y = 12.0;
    wrap(text, width - 24.0, TITLE * 1.05).iter().for_each(|_| y += 22.0);
    y
}

/// The places of a legend's entries in columns of one width, as few rows as fit, evenly filled.
fn legend_places(names: &[&str], width: f64) -> Vec<Place> {
    let widest = names.iter().map(|name| 44.0 + text_width(name, LABEL) + 18.0).fold(1.0, f64::max);
    let fit = (1..names.len()).take_while(|n| f64::from(u32::try_from(n + 1).unwrap_or(u32::MAX)) * widest <= width);
    let columns = names.len().div_ceil(names.len().div_ceil(fit.count() + 1).max(1)).max(1);
    let mut place = (0.0, 0.0);
    let mut places = Vec::new();
    for i in 0..names.len() {
        if i > 0 && i.is_multiple_of(columns) {
            place = (0.0, place.1 + LEGEND_LINE);
        }
        places.push(place);
        place.0 += widest;
    }
    places
}

/// The height of a legend.
pub(super) fn legend_height(names: &[&str], width: f64) -> f64 {
    legend_places(names, width).last().map_or(0.0, |place| place.1 + LEGEND_LINE)
}

/// Draws a legend from `place` (its top left) in rows no wider than `width`.
pub(super) fn legend(canvas: &mut Canvas, names: &[&str], keys: &[Key], place: Place, width: f64) {
    let places = legend_places(names, width);
    for ((name, key), (x, y)) in names.iter().zip(keys).zip(places) {
        let (x, y) = (place.0 + x, place.1 + y + LEGEND_LINE / 2.0);
        if let Some(dash) = key.line {
            canvas.line(&[(x, y), (x + 36.0, y)], Pen::new(key.color, 2.2), dash);
        }
        if let Some(marker) = key.marker {
            canvas.marker((x + 18.0, y), marker, 4.2, key.color);
        }
        if let Some(index) = key.swatch {
            swatch(canvas, (x + 8.0, y - 7.0), (x + 34.0, y + 7.0), key.color, index);
        }
        canvas.text(name, (x + 42.0, y), Type::new(LABEL, Hang::Left));
    }
}

/// A bar: filled, framed, and hatched differently for each series so that it survives grey printing.
pub(super) fn swatch(canvas: &mut Canvas, (x0, y0): Place, (x1, y1): Place, color: Color, index: usize) {
    let (top, bottom) = (y0.min(y1), y0.max(y1));
    canvas.block((x0, top), (x1, bottom), color, if index == 0 { 1.0 } else { 0.55 });
    let hatch = Pen::new(color, 1.4);
    let slope = match index % 4 {
        1 => 1.0,
        2 => -1.0,
        3 => 0.0,
        _ => f64::NAN,
    };
    let width = x1 - x0;
    let mut y = bottom + width;
    while slope.is_finite() && y > top - width {
        // The line from (x0, y) to (x1, y - slope * width), cut to the bar.
        let (from, to) = (y, y - slope * width);
        let x_at = |level: f64| if slope == 0.0 { x0 } else { x0 + (from - level) / slope };
        let cut = |x: f64, level: f64| match level {
            l if l < top => (x_at(top), top),
            l if l > bottom => (x_at(bottom), bottom),
            l => (x, l),
        };
        if from.max(to) > top && from.min(to) < bottom {
            canvas.line(&[cut(x0, from), cut(x1, to)], hatch, Dash::Solid);
        }
        y -= 7.0;
    }
    canvas.frame((x0, top), (x1, bottom), Pen::new(color, 1.2));
}

/// The axes of a plot whose corners are the ends of `x` and `y`.
pub(super) fn axes(canvas: &mut Canvas, labels: (&Axis, &Axis), x: &Fitted, y: &Fitted) {
    vertical(canvas, labels.1, x, y);
    for tick in x.ticks() {
        let at = x.pixel(tick.value);
        let color = if tick.label.is_some() { GRID } else { FAINT_GRID };
        canvas.line(&[(at, y.start), (at, y.end)], Pen::new(color, 1.0), Dash::Solid);
    }
    for tick in x.ticks() {
        let at = x.pixel(tick.value);
        if let Some(label) = tick.label {
            canvas.line(&[(at, y.start), (at, y.start + 5.0)], Pen::new(INK, 1.0), Dash::Solid);
            canvas.text(&label, (at, y.start + 15.0), Type { color: FAINT_INK, ..Type::new(TICK, Hang::Center) });
        }
    }
    canvas.frame((x.start, y.end), (x.end, y.start), Pen::new(INK, 1.0));
    let middle = (0.5 * (x.start + x.end), y.start + 38.0);
    canvas.text(&labels.0.label, middle, Type::new(LABEL, Hang::Center));
}

/// The vertical axis alone, with its grid lines across the plot.
pub(super) fn vertical(canvas: &mut Canvas, axis: &Axis, x: &Fitted, y: &Fitted) {
    for tick in y.ticks() {
        let at = y.pixel(tick.value);
        let color = if tick.label.is_some() { GRID } else { FAINT_GRID };
        canvas.line(&[(x.start, at), (x.end, at)], Pen::new(color, 1.0), Dash::Solid);
        if let Some(label) = tick.label {
            canvas.line(&[(x.start - 5.0, at), (x.start, at)], Pen::new(INK, 1.0), Dash::Solid);
            canvas.text(&label, (x.start - 9.0, at), Type { color: FAINT_INK, ..Type::new(TICK, Hang::Right) });
        }
    }
    let middle = (18.0, 0.5 * (y.start + y.end));
    canvas.text(&axis.label, middle, Type { upright: true, ..Type::new(LABEL, Hang::Center) });
}

/// Room that the labels of a vertical axis need, with its own label.
pub(super) fn left_margin(y: &Fitted) -> f64 {
    let widest = y.ticks().iter().filter_map(|t| t.label.as_deref().map(|l| text_width(l, TICK))).fold(0.0, f64::max);
    38.0 + widest.max(20.0)
}

/// The part of the segment from `a` to `b` inside of the rectangle of `low` and `high`.
pub(super) fn clip(a: Place, b: Place, low: Place, high: Place) -> Option<(Place, Place)> {
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    for (from, step, low, high) in [(a.0, dx, low.0, high.0), (a.1, dy, low.1, high.1)] {
        if step == 0.0 {
            if from < low || from > high {
                return None;
            }
            continue;
        }
        let (enter, leave) = ((low - from) / step, (high - from) / step);
        (t0, t1) = (t0.max(enter.min(leave)), t1.min(enter.max(leave)));
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    (t0 <= t1).then(|| (at(t0), at(t1)))
}
