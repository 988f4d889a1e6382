//! Grouped bars.

use super::axis::Axis;
use super::canvas::{THIN, TICK, Type};
use super::frame::{Bar, legend, plot, swatch};
use super::palette::INK;
use crate::table::number;

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
}

impl BarChart {
    /// A chart of the named groups, without bars. A linear axis spans 0 whether or not it is asked to.
    #[must_use]
    pub fn new<S: Into<String>>(title: impl Into<String>, y: Axis, groups: impl IntoIterator<Item = S>) -> Self {
        let groups = groups.into_iter().map(Into::into).collect();
        Self { title: title.into(), y: y.from_zero(), groups, series: vec![], level: None }
    }

    /// Adds a bar to each group, in order.
    #[must_use]
    pub fn series(mut self, name: impl Into<String>, bars: impl IntoIterator<Item = Bar>) -> Self {
        self.series.push((name.into(), bars.into_iter().collect()));
        self
    }

    /// Starts the bars at `y`, such as at a ratio of 1.
    #[must_use]
    pub fn level(self, y: f64) -> Self {
        Self { level: Some(y), ..self }
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
        let bars = self.series.iter().flat_map(|(_, bars)| bars);
        let ends = bars.flat_map(|b| [b.value, b.low, b.high]).chain(self.level);
        let x = Axis::linear("").range(0.0, self.groups.len().max(1) as f64);
        let (mut canvas, x, y) = plot(&self.title, 320.0, (&x, [].into_iter()), (&self.y, ends));
        let group_width = x.pixel(1.0) - x.pixel(0.0);
        let bar_width = (0.8 * group_width / self.series.len().max(1) as f64).min(90.0);
        let level = self.level.filter(|level| self.y.shows(*level));
        // 0 is the lower end of a logarithmic axis.
        let base = y.within(level.unwrap_or(0.0));
        let mut below = y.start + 16.0;
        for (g, group) in self.groups.iter().enumerate() {
            let middle = x.pixel(g as f64 + 0.5);
            below = below.max(canvas.lines(group, (middle, y.start + 16.0), group_width - 4.0, TICK));
            for (s, (_, bars)) in self.series.iter().enumerate() {
                let Some(bar) = bars.get(g).filter(|b| self.y.shows(b.value)) else { continue };
                let center = middle + (s as f64 + 0.5 - 0.5 * self.series.len() as f64) * bar_width;
                let (half, end) = (0.44 * bar_width, y.within(bar.value));
                swatch(&mut canvas, (center - half, end), (center + half, base), s);
                bar.whiskers(&mut canvas, center, &y, INK);
                if bar_width > 26.0 {
                    // A bar that hangs from its level has its number below.
                    let ends = [end, y.within(bar.low), y.within(bar.high)].into_iter();
                    let at = if end > base { ends.fold(end, f64::max) + 9.0 } else { ends.fold(end, f64::min) - 9.0 };
                    canvas.text(&number::plain(bar.value, 3), (center, at), Type { color: INK, ..TICK });
                }
            }
        }
        canvas.line(&[(x.start, base), (x.end, base)], THIN);
        canvas.line(&[(x.start, y.start), (x.start, y.end)], THIN);
        let names: Vec<&str> = self.series.iter().map(|(name, _)| name.as_str()).collect();
        let bottom = legend(&mut canvas, &names, below, |canvas, s, (x, y)| {
            swatch(canvas, (x + 6.0, y - 7.0), (x + 30.0, y + 7.0), s);
        });
        canvas.finish(&self.values_in_words(), bottom + 10.0)
    }
}
