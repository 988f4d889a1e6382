//! Charts of lines through points, with error bars.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, LABEL, Pen, THIN};
use super::frame::{Bar, draw_axis, legend, plot};
use super::palette::{DOTS, INK, series_color};

/// Named line through points `(x, y)` of a chart of [`lines`].
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Series {
    name: String,
    points: Vec<(f64, Bar)>,
    markers: bool,
    /// Pen in place of the one that belongs to the number of the series.
    pen: Option<Pen>,
}

impl Series {
    /// Makes a line for measured values, with a marker at each point and errors drawn as bars.
    pub fn new<B: Into<Bar>>(
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, B)>,
    ) -> Self {
        let points = points.into_iter().map(|(x, y)| (x, y.into())).collect();
        Self {
            name: name.into(),
            points,
            markers: true,
            pen: None,
        }
    }

    /// Makes a line without markers, for the values of functions.
    pub fn curve(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            markers: false,
            ..Self::new(name, points)
        }
    }

    /// Makes a dotted line without markers, for other lines to be compared with.
    pub fn guide(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            pen: Some(Pen {
                dash: DOTS,
                ..Pen::new(INK, 1.8)
            }),
            ..Self::curve(name, points)
        }
    }

    /// Sets the numbers of the colour and of the dash, in place of the next ones: for series that belong together.
    pub fn styled(self, color: usize, dash: usize) -> Self {
        Self {
            pen: Some(pen(color, dash)),
            ..self
        }
    }

    fn draw(&self, canvas: &mut Canvas, index: usize, x: &Fitted, y: &Fitted) {
        let pen = self.pen.unwrap_or(pen(index, index));
        let place = |(at, bar): &(f64, Bar)| (x.pixel(*at), y.pixel(bar.value));
        // Points that cannot be shown break the line.
        for run in self
            .points
            .split(|(at, bar)| !x.spans(*at) || !y.spans(bar.value))
        {
            canvas.line(&run.iter().map(place).collect::<Vec<_>>(), pen);
            for point in run {
                point.1.whiskers(canvas, x.pixel(point.0), y, pen.color);
                if self.markers || run.len() == 1 {
                    canvas.marker(
                        place(point),
                        if self.markers { index } else { 0 },
                        pen.color,
                    );
                }
            }
        }
    }
}

/// Returns the pen of a colour and a dash, by their numbers.
pub(super) const fn pen(color: usize, dash: usize) -> Pen {
    Pen {
        dash,
        ..Pen::new(series_color(color), 2.2)
    }
}

/// Draws series of points over two axes, with a legend, as SVG.
///
/// ```
/// use hairis_instruments::plot::{Axis, Series, lines};
/// let errors = Series::new("published", [(16.0, 0.25), (64.0, 0.12), (256.0, 0.063)]);
/// let slope = Series::guide("slope −1/2", [(16.0, 0.25), (256.0, 0.0625)]);
/// let svg = lines("Convergence", Axis::log("samples N"), Axis::log("relative RMS error"), &[errors, slope]);
/// assert!(svg.starts_with("<svg"));
/// ```
#[must_use]
pub fn lines(title: &str, x: Axis, y: Axis, series: &[Series]) -> String {
    let mut values = [Vec::new(), Vec::new()];
    for (at, bar) in series.iter().flat_map(|series| &series.points) {
        if x.shows(*at) && y.shows(bar.value) {
            values[0].push(*at);
            values[1].extend([bar.value, bar.low, bar.high]);
        }
    }
    let [xs, ys] = &values;
    let (mut canvas, x, y) = plot(title, 360.0, (x, xs), (y, ys));
    draw_axis(&mut canvas, &x, &y, false);
    canvas.frame((x.start, y.end), (x.end, y.start), THIN);
    for (i, series) in series.iter().enumerate() {
        series.draw(&mut canvas, i, &x, &y);
    }
    if xs.is_empty() {
        canvas.text("no data", (x.along(0.5), y.along(0.5)), LABEL);
    }
    let names: Vec<&str> = series.iter().map(|series| series.name.as_str()).collect();
    let bottom = legend(&mut canvas, &names, y.start + 52.0, &|canvas, i, (x, y)| {
        let pen = series[i].pen.unwrap_or(pen(i, i));
        canvas.line(&[(x, y), (x + 36.0, y)], pen);
        if series[i].markers {
            canvas.marker((x + 18.0, y), i, pen.color);
        }
    });
    let description = format!(
        "{} against {}: {}.",
        y.axis.label,
        x.axis.label,
        names.join(", ")
    );
    canvas.finish(&description, bottom + 8.0)
}
