//! Lines through points with errors.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, Hang, Pen, Place, Type, sheet};
use super::frame::{self, Key};
use super::palette::{Dash, FAINT_INK, Marker, series_color};

/// One point of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    x: f64,
    y: f64,
    low: f64,
    high: f64,
}

impl Point {
    /// A point without error.
    #[must_use]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y, low: y, high: y }
    }

    /// The same point with a standard error of `y`, drawn as a bar of one error to either side.
    #[must_use]
    pub const fn with_error(self, error: f64) -> Self {
        Self { low: self.y - error, high: self.y + error, ..self }
    }

    /// The same point with an interval of `y`.
    #[must_use]
    pub const fn with_interval(self, low: f64, high: f64) -> Self {
        Self { low, high, ..self }
    }
}

impl From<(f64, f64)> for Point {
    fn from((x, y): (f64, f64)) -> Self {
        Self::new(x, y)
    }
}

/// A named line of a [`LineChart`].
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    name: String,
    points: Vec<Point>,
    markers: bool,
    group: Option<(usize, Dash)>,
}

impl Series {
    /// A line with a marker at each point, for measured values.
    #[must_use]
    pub fn new<P: Into<Point>>(name: impl Into<String>, points: impl IntoIterator<Item = P>) -> Self {
        let points = points.into_iter().map(Into::into).collect();
        Self { name: name.into(), points, markers: true, group: None }
    }

    /// A line without markers, for functions.
    #[must_use]
    pub fn curve<P: Into<Point>>(name: impl Into<String>, points: impl IntoIterator<Item = P>) -> Self {
        Self { markers: false, ..Self::new(name, points) }
    }

    /// The colour number and the dash, in place of the next ones: for series that belong together.
    #[must_use]
    pub fn styled(mut self, color: usize, dash: Dash) -> Self {
        self.group = Some((color, dash));
        self
    }
}

/// A line that data are compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferenceLine {
    /// `y = y0 (x / x0)^slope`: a straight line when both axes are logarithmic, such as the -1/2 of Monte Carlo.
    Power {
        /// Meaning of the line.
        label: String,
        /// The exponent.
        slope: f64,
        /// A point `(x0, y0)` of the line.
        through: (f64, f64),
    },
    /// `y` is the same everywhere.
    Level {
        /// Meaning of the line.
        label: String,
        /// The value.
        y: f64,
    },
}

impl ReferenceLine {
    fn label(&self) -> &str {
        match self {
            Self::Power { label, .. } | Self::Level { label, .. } => label,
        }
    }

    fn at(&self, x: f64) -> f64 {
        match self {
            Self::Power { slope, through: (x0, y0), .. } => y0 * (x / x0).powf(*slope),
            Self::Level { y, .. } => *y,
        }
    }
}

/// Series of points over two axes.
///
/// ```
/// use hairis_harness::plot::{Axis, LineChart, Point, ReferenceLine, Series};
/// let errors = [(16.0, 0.25), (64.0, 0.12), (256.0, 0.063)].map(|(n, e)| Point::new(n, e).with_error(0.1 * e));
/// let svg = LineChart::new("Convergence", Axis::log("samples N"), Axis::log("relative RMS error"))
///     .series(Series::new("published", errors))
///     .reference(ReferenceLine::Power { label: "slope −1/2".into(), slope: -0.5, through: (16.0, 0.25) })
///     .svg();
/// assert!(svg.starts_with("<svg"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LineChart {
    title: String,
    x: Axis,
    y: Axis,
    series: Vec<Series>,
    references: Vec<ReferenceLine>,
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

    /// Adds a line to compare with.
    #[must_use]
    pub fn reference(mut self, reference: ReferenceLine) -> Self {
        self.references.push(reference);
        self
    }

    /// The chart as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let mut names: Vec<&str> = self.series.iter().map(|s| s.name.as_str()).collect();
        names.extend(self.references.iter().map(ReferenceLine::label));
        let description = format!("{} against {}: {}.", self.y.label, self.x.label, names.join(", "));
        let top = frame::title_height(&self.title, frame::WIDTH);
        let bottom = top + 400.0;
        let shown = |p: &&Point| self.x.shows(p.x) && self.y.shows(p.y);
        let points = || self.series.iter().flat_map(|s| &s.points).filter(shown);
        let levels = self.references.iter().filter_map(|r| match r {
            ReferenceLine::Level { y, .. } => Some(*y),
            ReferenceLine::Power { .. } => None,
        });
        let y = self.y.fit(points().flat_map(|p| [p.y, p.low, p.high]).chain(levels), bottom, top);
        let left = frame::left_margin(&y);
        let x = self.x.fit(points().map(|p| p.x), left, frame::WIDTH - 22.0);
        let legend_width = frame::WIDTH - left - 10.0;
        let height = bottom + 56.0 + frame::legend_height(&names, legend_width) + 8.0;
        sheet((frame::WIDTH, height), &self.title, &description, |canvas| {
            frame::title(canvas, &self.title, frame::WIDTH);
            frame::axes(canvas, (&self.x, &self.y), &x, &y);
            let grey = Pen::new(FAINT_INK, 1.5);
            for reference in &self.references {
                let ends: Vec<Place> = (0..=64)
                    .map(|i| value_at(&x, f64::from(i) / 64.0, self.x.scale))
                    .map(|at| (at, reference.at(at)))
                    .filter(|(_, level)| self.y.shows(*level))
                    .map(|(at, level)| (x.pixel(at), y.pixel(level)))
                    .collect();
                clipped(canvas, &ends, grey, Dash::Dotted, &x, &y);
            }
            for (i, series) in self.series.iter().enumerate() {
                self.draw(canvas, series, i, &x, &y);
            }
            let mut keys: Vec<Key> = self.series.iter().enumerate().map(|(i, s)| key(s, i)).collect();
            let key = Key { color: FAINT_INK, line: Some(Dash::Dotted), marker: None, swatch: None };
            keys.resize(names.len(), key);
            frame::legend(canvas, &names, &keys, (left, bottom + 54.0), legend_width);
            if points().next().is_none() {
                let middle = (0.5 * (x.start + x.end), 0.5 * (y.start + y.end));
                canvas.text("no data", middle, Type { color: FAINT_INK, ..Type::new(frame::LABEL, Hang::Center) });
            }
        })
    }

    fn draw(&self, canvas: &mut Canvas, series: &Series, index: usize, x: &Fitted, y: &Fitted) {
        let Key { color, line, marker, .. } = key(series, index);
        let place = |p: &Point| (x.pixel(p.x), y.pixel(p.y));
        let shown = |p: &Point| self.x.shows(p.x) && self.y.shows(p.y);
        // What cannot be shown breaks the line.
        for run in series.points.split(|p| !shown(p)) {
            let spread = |p: &Point| {
                let bound = |v: f64| if self.y.shows(v) { y.within(v) } else { y.start };
                let high = if p.high.is_finite() { bound(p.high) } else { y.within(p.y) };
                (bound(if p.low.is_nan() { p.y } else { p.low }), high)
            };
            let inside = |p: &&Point| (x.low..=x.high).contains(&p.x) && p.high > p.low;
            for p in run.iter().filter(inside) {
                let ((low, high), at, pen) = (spread(p), x.pixel(p.x), Pen::new(color, 1.5));
                canvas.line(&[(at, low), (at, high)], pen, Dash::Solid);
                for end in [low, high] {
                    canvas.line(&[(at - 4.0, end), (at + 4.0, end)], pen, Dash::Solid);
                }
            }
            if let Some(dash) = line {
                clipped(canvas, &run.iter().map(place).collect::<Vec<_>>(), Pen::new(color, 2.2), dash, x, y);
            }
            let inside = |p: &&Point| (x.low..=x.high).contains(&p.x) && (y.low..=y.high).contains(&p.y);
            let lone = run.len() == 1;
            for p in run.iter().filter(inside).filter(|_| lone || marker.is_some()) {
                canvas.marker(place(p), marker.unwrap_or(Marker::Circle), 4.2, color);
            }
        }
    }
}

fn key(series: &Series, index: usize) -> Key {
    let (number, dash) = series.group.unwrap_or((index, Dash::of(index)));
    let marker = series.markers.then(|| Marker::of(index));
    Key { color: series_color(number), line: Some(dash), marker, swatch: None }
}

/// The value a share `t` of the way along the axis.
fn value_at(axis: &Fitted, t: f64, scale: super::Scale) -> f64 {
    match scale {
        super::Scale::Linear => axis.low + t * (axis.high - axis.low),
        super::Scale::Log => axis.low * (axis.high / axis.low).powf(t),
    }
}

/// Draws the part of a path that lies in the plot.
fn clipped(canvas: &mut Canvas, path: &[Place], pen: Pen, dash: Dash, x: &Fitted, y: &Fitted) {
    let (low, high) = ((x.start, y.end), (x.end, y.start));
    let mut part: Vec<Place> = Vec::new();
    for pair in path.windows(2) {
        let Some((a, b)) = frame::clip(pair[0], pair[1], low, high) else { continue };
        if part.last() != Some(&a) {
            canvas.line(&part, pen, dash);
            part = vec![a];
        }
        part.push(b);
    }
    canvas.line(&part, pen, dash);
}
