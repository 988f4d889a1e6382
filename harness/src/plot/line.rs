//! Lines through points with errors.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, LABEL, Pen, Place, THIN};
use super::frame::{Bar, clip, draw_axis, legend, plot};
use super::palette::{Dash, FAINT_INK, series_color};

/// A named line of a [`LineChart`].
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    name: String,
    points: Vec<(f64, Bar)>,
    markers: bool,
    group: Option<(usize, Dash)>,
}

impl Series {
    /// A line with a marker at each point `(x, y)`, for measured values; their errors are drawn as bars.
    #[must_use]
    pub fn new<B: Into<Bar>>(name: impl Into<String>, points: impl IntoIterator<Item = (f64, B)>) -> Self {
        let points = points.into_iter().map(|(x, y)| (x, y.into())).collect();
        Self { name: name.into(), points, markers: true, group: None }
    }

    /// A line without markers, for functions.
    #[must_use]
    pub fn curve(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { markers: false, ..Self::new(name, points) }
    }

    /// The colour number and the dash, in place of the next ones: for series that belong together.
    #[must_use]
    pub fn styled(self, color: usize, dash: Dash) -> Self {
        Self { group: Some((color, dash)), ..self }
    }

    /// The pen of the series number `index`.
    fn pen(&self, index: usize) -> Pen {
        let (color, dash) = self.group.unwrap_or((index, Dash::of(index)));
        Pen { dash, ..Pen::new(series_color(color), 2.2) }
    }

    fn draw(&self, canvas: &mut Canvas, index: usize, x: &Fitted, y: &Fitted) {
        let pen = self.pen(index);
        let place = |(at, bar): &(f64, Bar)| (x.pixel(*at), y.pixel(bar.value));
        // What cannot be shown breaks the line.
        for run in self.points.split(|(at, bar)| !x.axis.shows(*at) || !y.axis.shows(bar.value)) {
            clipped(canvas, &run.iter().map(place).collect::<Vec<_>>(), pen, x, y);
            for point in run.iter().filter(|(at, _)| x.spans(*at)) {
                point.1.whiskers(canvas, x.pixel(point.0), y, pen.color);
                if y.spans(point.1.value) && (self.markers || run.len() == 1) {
                    canvas.marker(place(point), if self.markers { index } else { 0 }, pen.color);
                }
            }
        }
    }
}

/// A line that data are compared with: `y = y0 (x / x0)^slope`.
#[derive(Clone, Debug, PartialEq)]
struct Reference {
    name: String,
    slope: f64,
    through: (f64, f64),
}

impl Reference {
    const PEN: Pen = Pen { dash: Dash::Dotted, ..Pen::new(FAINT_INK, 1.8) };

    fn at(&self, x: f64) -> f64 {
        self.through.1 * (x / self.through.0).powf(self.slope)
    }
}

/// Series of points over two axes.
///
/// ```
/// use hairis_harness::plot::{Axis, Bar, LineChart, Series};
/// let errors = [(16.0, 0.25), (64.0, 0.12), (256.0, 0.063)].map(|(n, e)| (n, Bar::new(e).with_error(0.1 * e)));
/// let svg = LineChart::new("Convergence", Axis::log("samples N"), Axis::log("relative RMS error"))
///     .series(Series::new("published", errors))
///     .reference("slope −1/2", -0.5, (16.0, 0.25))
///     .svg();
/// assert!(svg.starts_with("<svg"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LineChart {
    title: String,
    x: Axis,
    y: Axis,
    series: Vec<Series>,
    references: Vec<Reference>,
}

impl LineChart {
    /// A chart without series.
    #[must_use]
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, series: Vec::new(), references: Vec::new() }
    }

    /// Adds a series.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds the line `y = y0 (x / x0)^slope` through `(x0, y0)` to compare with: straight when both axes are logarithmic, such as
    /// the -1/2 of Monte Carlo; a level if `slope` is 0.
    #[must_use]
    pub fn reference(mut self, name: impl Into<String>, slope: f64, through: (f64, f64)) -> Self {
        self.references.push(Reference { name: name.into(), slope, through });
        self
    }

    /// The chart as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let all = self.series.iter().flat_map(|series| &series.points);
        let shown: Vec<&(f64, Bar)> = all.filter(|(x, y)| self.x.shows(*x) && self.y.shows(y.value)).collect();
        let levels = self.references.iter().filter(|line| line.slope == 0.0).map(|line| line.through.1);
        let ys = shown.iter().flat_map(|(_, y)| [y.value, y.low, y.high]).chain(levels);
        let (mut canvas, x, y) = plot(&self.title, 360.0, (&self.x, shown.iter().map(|(x, _)| *x)), (&self.y, ys));
        draw_axis(&mut canvas, &x, &y, false);
        canvas.frame((x.start, y.end), (x.end, y.start), THIN);
        for reference in &self.references {
            let values = (0..=64).map(|i| x.value(f64::from(i) / 64.0)).map(|at| (at, reference.at(at)));
            let path: Vec<Place> = values
                .filter(|(_, level)| self.y.shows(*level))
                .map(|(at, level)| (x.pixel(at), y.pixel(level)))
                .collect();
            clipped(&mut canvas, &path, Reference::PEN, &x, &y);
        }
        for (i, series) in self.series.iter().enumerate() {
            series.draw(&mut canvas, i, &x, &y);
        }
        if shown.is_empty() {
            canvas.text("no data", (x.middle(), y.middle()), LABEL);
        }
        let mut names: Vec<&str> = self.series.iter().map(|s| s.name.as_str()).collect();
        names.extend(self.references.iter().map(|line| line.name.as_str()));
        let bottom = legend(&mut canvas, &names, y.start + 52.0, |canvas, i, (x, y)| {
            let series = self.series.get(i);
            let pen = series.map_or(Reference::PEN, |series| series.pen(i));
            canvas.line(&[(x, y), (x + 36.0, y)], pen);
            if series.is_some_and(|series| series.markers) {
                canvas.marker((x + 18.0, y), i, pen.color);
            }
        });
        let description = format!("{} against {}: {}.", self.y.label, self.x.label, names.join(", "));
        canvas.finish(&description, bottom + 8.0)
    }
}

/// Draws the part of a path that lies in the plot.
fn clipped(canvas: &mut Canvas, path: &[Place], pen: Pen, x: &Fitted, y: &Fitted) {
    let mut part: Vec<Place> = Vec::new();
    for pair in path.windows(2) {
        let Some([a, b]) = clip([pair[0], pair[1]], (x.start, y.end), (x.end, y.start)) else { continue };
        if part.last() != Some(&a) {
            canvas.line(&part, pen);
            part = vec![a];
        }
        part.push(b);
    }
    canvas.line(&part, pen);
}
