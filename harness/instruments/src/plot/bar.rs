//! Charts of bars in groups, such as speeds by operation and instruction set.

use super::axis::Axis;
use super::canvas::{THIN, TICK, Type};
use super::frame::{Bar, legend, plot, swatch};
use super::palette::INK;
use crate::table::number;

/// Draws bars in groups as SVG, one bar per series in each group, with their values at their ends. The bars start at `level`, such as a
/// ratio of 1; on a logarithmic axis, a level of 0 is the lower end. A linear axis includes 0.
///
/// ```
/// use hairis_instruments::plot::{Axis, bars};
/// let series = [("AVX2".to_owned(), vec![7.1.into(), 5.9.into()])];
/// let groups = ["eval", "sample"].map(str::to_owned);
/// let svg = bars("Speed", Axis::linear("speed relative to scalar (×)"), &groups, &series, 1.0);
/// assert!(svg.contains("7.10"));
/// ```
#[must_use]
pub fn bars(
    title: &str,
    y: Axis,
    groups: &[String],
    series: &[(String, Vec<Bar>)],
    level: f64,
) -> String {
    let all = series.iter().flat_map(|(_, bars)| bars);
    let ends: Vec<f64> = all
        .flat_map(|bar| [bar.value, bar.low, bar.high])
        .chain([0.0, level])
        .collect();
    let x = Axis::linear("").range(0.0, groups.len().max(1) as f64);
    let (mut canvas, x, y) = plot(title, 320.0, (x, &[]), (y, &ends));
    let group_width = x.pixel(1.0) - x.pixel(0.0);
    let bar_width = (0.8 * group_width / series.len().max(1) as f64).min(90.0);
    let base = y.pixel(if y.axis.shows(level) { level } else { 0.0 });
    let mut below = y.start + 16.0;
    let mut description = format!("{}.", y.axis.label);
    for (g, group) in groups.iter().enumerate() {
        let middle = x.pixel(g as f64 + 0.5);
        below = below.max(canvas.lines(group, (middle, y.start + 16.0), group_width - 12.0, TICK));
        for (s, (name, bars)) in series.iter().enumerate() {
            let Some(bar) = bars.get(g).filter(|b| y.axis.shows(b.value)) else {
                continue;
            };
            let number = number::plain(bar.value, 3);
            description += &format!(" {group}, {name}: {number}.");
            let center = middle + (s as f64 + 0.5 - 0.5 * series.len() as f64) * bar_width;
            let (half, end) = (0.44 * bar_width, y.pixel(bar.value));
            swatch(&mut canvas, (center - half, end), (center + half, base), s);
            bar.whiskers(&mut canvas, center, &y, INK);
            if bar_width > 26.0 {
                // The number of a bar that hangs below its level stands below the bar.
                let ends = [end, y.pixel(bar.low), y.pixel(bar.high)].into_iter();
                let at = if end > base {
                    ends.fold(end, f64::max) + 9.0
                } else {
                    ends.fold(end, f64::min) - 9.0
                };
                canvas.text(&number, (center, at), Type { color: INK, ..TICK });
            }
        }
    }
    canvas.line(&[(x.start, base), (x.end, base)], THIN);
    canvas.line(&[(x.start, y.start), (x.start, y.end)], THIN);
    let names: Vec<&str> = series.iter().map(|(name, _)| name.as_str()).collect();
    let bottom = legend(&mut canvas, &names, below, &|canvas, s, (x, y)| {
        swatch(canvas, (x + 6.0, y - 7.0), (x + 30.0, y + 7.0), s);
    });
    canvas.finish(&description, bottom + 10.0)
}
