//! Grouped bars.

use super::axis::{Axis, Scale};
use super::canvas::{Hang, Pen, Type, sheet, wrap};
use super::frame::{self, Key};
use super::palette::{Dash, INK, series_color};
use crate::table::number;

/// The height of one bar, with whiskers if they differ from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    value: f64,
    low: f64,
    high: f64,
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
}

/// Bars in groups, one bar per series in each, with their values at their ends. They start at the level of the chart if it
/// has one, else at 0 or at the lower end of a logarithmic axis.
///
/// ```
/// use hairis_harness::plot::{Axis, Bar, BarChart};
/// let svg = BarChart::new("Speed", Axis::linear("speed relative to scalar (×)").from_zero(), ["eval", "sample"])
///     .series("AVX2", [Bar::new(7.1).with_error(0.1), Bar::new(5.9).with_error(0.2)])
///     .level(1.0)
///     .svg();
/// assert!(svg.contains("7.10"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BarChart {
    title: String,
    y: Axis,
    groups: Vec<String>,
    series: Vec<(String, Vec<Bar>)>,
    level: Option<f64>,
    width: f64,
}

impl BarChart {
    /// A chart of the named groups, without bars. A linear axis spans 0 whether or not it is asked to.
    #[must_use]
    pub fn new<S: Into<String>>(title: impl Into<String>, y: Axis, groups: impl IntoIterator<Item = S>) -> Self {
        let groups = groups.into_iter().map(Into::into).collect();
        Self { title: title.into(), y: y.from_zero(), groups, series: vec![], level: None, width: frame::WIDTH }
    }

    /// Adds a bar to each group, in order.
    #[must_use]
    pub fn series(mut self, name: impl Into<String>, bars: impl IntoIterator<Item = Bar>) -> Self {
        self.series.push((name.into(), bars.into_iter().collect()));
        self
    }

    /// Starts the bars at `y`, such as at a ratio of 1.
    #[must_use]
    pub fn level(mut self, y: f64) -> Self {
        self.level = Some(y);
        self
    }

    /// Draws the chart narrower: for a column of a page, and for a phone.
    #[must_use]
    pub fn narrow(self) -> Self {
        Self { width: 520.0, ..self }
    }

    fn values_in_words(&self) -> String {
        let mut text = format!("{}.", self.y.label);
        for (name, bars) in &self.series {
            for (group, bar) in self.groups.iter().zip(bars) {
                text.push_str(&format!(" {group}, {name}: {}.", number::plain(bar.value, 3)));
            }
        }
        text
    }

    /// The chart as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let names: Vec<&str> = self.series.iter().map(|(name, _)| name.as_str()).collect();
        let top = frame::title_height(&self.title, self.width);
        let bottom = top + 340.0;
        let bars = self.series.iter().flat_map(|(_, bars)| bars);
        let ends = bars.flat_map(|b| [b.value, b.low, b.high]).chain(self.level);
        let y = self.y.fit(ends.filter(|v| self.y.shows(*v)), bottom, top);
        let left = frame::left_margin(&y);
        let x = Axis::linear("").range(0.0, 1.0).fit(core::iter::empty(), left, self.width - 16.0);
        let lanes = |n: usize| f64::from(u32::try_from(n.max(1)).unwrap_or(u32::MAX));
        let group_width = (x.end - x.start) / lanes(self.groups.len());
        let bar_width = (0.8 * group_width / lanes(self.series.len())).min(90.0);
        let labels: Vec<Vec<String>> = self.groups.iter().map(|g| wrap(g, group_width - 4.0, frame::TICK)).collect();
        let label_height = labels.iter().map(Vec::len).map(lanes).fold(1.0, f64::max) * 17.0;
        let legend_top = bottom + 14.0 + label_height;
        let height = legend_top + frame::legend_height(&names, x.end - left) + 10.0;
        sheet((self.width, height), &self.title, &self.values_in_words(), |canvas| {
            frame::title(canvas, &self.title, self.width);
            frame::vertical(canvas, &self.y, &x, &y);
            let level = self.level.filter(|level| self.y.shows(*level));
            let base = match level {
                Some(level) => y.within(level),
                None if self.y.scale == Scale::Log => y.start,
                None => y.within(0.0),
            };
            for (g, label) in labels.iter().enumerate() {
                let middle = left + (lanes(g + 1) - 0.5) * group_width;
                for (i, line) in label.iter().enumerate() {
                    let below = bottom + 16.0 + 17.0 * (lanes(i + 1) - 1.0);
                    canvas.text(line, (middle, below), Type::new(frame::TICK, Hang::Center));
                }
                for (s, (_, bars)) in self.series.iter().enumerate() {
                    let Some(bar) = bars.get(g).filter(|b| self.y.shows(b.value)) else { continue };
                    let offset = lanes(s + 1) - 0.5 - 0.5 * lanes(self.series.len());
                    let (center, end) = (middle + offset * bar_width, y.within(bar.value));
                    let half = 0.44 * bar_width;
                    let corners = ((center - half, end), (center + half, base));
                    frame::swatch(canvas, corners.0, corners.1, series_color(s), s);
                    let (mut top, mut bottom) = (end.min(base), end.max(base));
                    if bar.high > bar.low && bar.high.is_finite() {
                        let low = if self.y.shows(bar.low) { bar.low } else { y.low };
                        let (low, high) = (y.within(low), y.within(bar.high));
                        let pen = Pen::new(INK, 1.5);
                        canvas.line(&[(center, low), (center, high)], pen, Dash::Solid);
                        for at in [low, high] {
                            canvas.line(&[(center - 4.0, at), (center + 4.0, at)], pen, Dash::Solid);
                        }
                        (top, bottom) = (top.min(high), bottom.max(low));
                    }
                    if bar_width > 30.0 {
                        let text = number::plain(bar.value, 3);
                        // A bar that hangs from its level has its number below.
                        let at = if end > base { bottom + 9.0 } else { top - 9.0 };
                        canvas.text(&text, (center, at), Type::new(12.5, Hang::Center));
                    }
                }
            }
            canvas.line(&[(x.start, base), (x.end, base)], Pen::new(INK, 1.2), Dash::Solid);
            canvas.line(&[(x.start, y.start), (x.start, y.end)], Pen::new(INK, 1.0), Dash::Solid);
            let key = |s| Key { color: series_color(s), line: None, marker: None, swatch: Some(s) };
            let keys: Vec<Key> = (0..names.len()).map(key).collect();
            frame::legend(canvas, &names, &keys, (left, legend_top), x.end - left);
        })
    }
}
