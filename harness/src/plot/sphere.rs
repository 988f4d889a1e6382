//! Maps of the sphere: directions as dots, and values on a grid of cells.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, HEADING, Place, THIN, TICK, Type, WIDTH};
use super::frame::draw_axis;
use super::palette::{CROSS, Color, MARK, scale_color, series_color, signed_color, soft_color};
use crate::table::number;
use core::f64::consts::PI;

/// How the sphere is laid out: the azimuth to the right, the inclination upwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Equal angles are equal lengths.
    EqualAngle,
    /// Equal solid angles are equal areas (the height is `sin theta`): uniform directions look uniform.
    EqualArea,
}

impl Projection {
    /// The inclination at a height from -1 to 1.
    fn theta(self, height: f64) -> f64 {
        match self {
            Self::EqualAngle => 0.5 * PI * height,
            Self::EqualArea => height.asin(),
        }
    }

    /// The axis of the inclination.
    fn axis(self, label: &str) -> Axis {
        match self {
            Self::EqualAngle => Axis::linear(label).range(-90.0, 90.0).step(30.0),
            Self::EqualArea => Axis::sine(label).range(-90.0, 90.0).step(45.0),
        }
    }
}

/// Values on a map of the sphere, in cells of equal size on it.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereGrid {
    projection: Projection,
    columns: usize,
    values: Vec<f64>,
}

impl SphereGrid {
    /// `value(theta, phi)` in the middle of each of `rows` by `columns` cells; angles in radians.
    #[must_use]
    pub fn sample(projection: Projection, (rows, columns): (u16, u16), mut value: impl FnMut(f64, f64) -> f64) -> Self {
        let middle = |i: u16, n: u16| 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
        let mut values = Vec::new();
        for row in 0..rows {
            let theta = -projection.theta(middle(row, rows));
            values.extend((0..columns).map(|column| value(theta, PI * middle(column, columns))));
        }
        Self { projection, columns: usize::from(columns.max(1)), values }
    }

    /// The least and the greatest finite value.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        let finite = || self.values.iter().copied().filter(|v| v.is_finite());
        Some((finite().reduce(f64::min)?, finite().reduce(f64::max)?))
    }

    /// Fills the map of `x` and `y` with the colours of `color`, which maps 0 .. 1, drawn in `levels` steps.
    fn fill(
        &self,
        canvas: &mut Canvas,
        (x, y): (&Fitted, &Fitted),
        levels: u16,
        share: impl Fn(f64) -> f64,
        color: impl Fn(f64) -> Color,
    ) {
        let last = f64::from(levels - 1);
        let rows = self.values.len() / self.columns;
        let corner = |row: usize, column: usize| {
            let along = |axis: &Fitted, t: f64| axis.start + t * (axis.end - axis.start);
            (along(x, column as f64 / self.columns as f64), along(y, 1.0 - row as f64 / rows as f64))
        };
        // One pass a colour, each over all cells of that colour and of later ones: a colour becomes one path, and no
        // paper shines through the seams between colours.
        for level in (0..levels).map(f64::from) {
            let is = |v: f64| v.is_finite() && (share(v).clamp(0.0, 1.0) * last).round() >= level;
            for (row, values) in self.values.chunks_exact(self.columns).enumerate() {
                let mut start = 0;
                for run in values.chunk_by(|a, b| is(*a) == is(*b)) {
                    let end = start + run.len();
                    if is(run[0]) {
                        canvas.block(corner(row, start), corner(row + 1, end), color(level / last), 1.0);
                    }
                    start = end;
                }
            }
        }
    }
}

/// A map from `low` to `high`: draws what `paint` does, then the axes over it.
fn map(
    canvas: &mut Canvas,
    (projection, theta): (Projection, &str),
    (low, high): (Place, Place),
    paint: impl FnOnce(&mut Canvas, &Fitted, &Fitted),
) {
    let (azimuth, inclination) =
        (Axis::linear("azimuth φ (°)").range(-180.0, 180.0).step(90.0), projection.axis(theta));
    let x = azimuth.fit([].into_iter(), low.0, high.0);
    let y = inclination.fit([].into_iter(), high.1, low.1);
    paint(canvas, &x, &y);
    draw_axis(canvas, &x, &y, false);
    draw_axis(canvas, &y, &x, true);
    canvas.frame(low, high, THIN);
}

/// The place of a direction (radians) on a map.
fn place(x: &Fitted, y: &Fitted, [theta, phi]: [f64; 2]) -> Place {
    let turns = phi / (2.0 * PI) + 0.5;
    (x.pixel(360.0 * (turns - turns.floor()) - 180.0), y.within(theta.to_degrees().clamp(-90.0, 90.0)))
}

/// A map of the sphere coloured by a scalar, in viridis, with a bar of its colours; by a difference, in blue and
/// vermilion either side of white.
///
/// ```
/// use hairis_harness::plot::{Axis, SphereGrid, HeatMap, Projection};
/// let grid = SphereGrid::sample(Projection::EqualArea, (36, 72), |theta, phi| theta.cos() * (1.0 + phi.cos()));
/// let svg = HeatMap::new("Radiance", Axis::linear("L (W/m²/sr)"), grid).svg();
/// assert!(svg.ends_with("</svg>\n"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    title: String,
    value: Axis,
    grid: SphereGrid,
    signed: bool,
}

impl HeatMap {
    /// A map of `grid`; `value` says what its numbers are and how colours spread over them.
    #[must_use]
    pub fn new(title: impl Into<String>, value: Axis, grid: SphereGrid) -> Self {
        // The colours end where the values do.
        let value = match grid.range() {
            Some((low, high)) => value.or_range(low, high),
            None => value,
        };
        Self { title: title.into(), value, grid, signed: false }
    }

    /// A map of differences: white is 0, and both ends are as far from it as the values go.
    #[must_use]
    pub fn signed(title: impl Into<String>, value: Axis, grid: SphereGrid) -> Self {
        let most = grid.range().map_or(0.0, |(low, high)| high.max(-low));
        Self { signed: true, ..Self::new(title, value.or_range(-most, most), grid) }
    }

    /// The map as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        const STEPS: u16 = 64;
        let color = if self.signed { signed_color } else { scale_color };
        let (mut canvas, top) = Canvas::new(&self.title);
        let (low, high) = ((70.0, top), (WIDTH - 20.0, top + 240.0));
        let (values, width) = (self.grid.range().into_iter().flat_map(|(a, b)| [a, b]), high.0 - low.0);
        let bar = self.value.fit(values, low.0, high.0);
        map(&mut canvas, (self.grid.projection, "inclination θ (°)"), (low, high), |canvas, x, y| {
            self.grid.fill(canvas, (x, y), 49, |v| bar.share(v), color);
        });
        let (bar_top, bar_bottom) = (high.1 + 62.0, high.1 + 80.0);
        for i in (0..STEPS).map(f64::from) {
            let left = (low.0 + width * i / f64::from(STEPS), bar_top);
            canvas.block(left, (high.0, bar_bottom), color((i + 0.5) / f64::from(STEPS)), 1.0);
        }
        canvas.frame((low.0, bar_top), (high.0, bar_bottom), THIN);
        let axis = Axis::linear("");
        draw_axis(&mut canvas, &bar, &axis.fit([].into_iter(), bar_bottom, bar_top), false);
        let ends = [0.0, 1.0].map(|t| number::plain(bar.value(t), 3));
        let description = format!("{} over the sphere, from {} to {}.", self.value.label, ends[0], ends[1]);
        canvas.finish(&description, bar_bottom + 52.0)
    }
}

/// One map of a [`ScatterMap`].
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterPanel {
    /// Title of the map.
    pub title: String,
    /// Directions as `theta` and `phi` in radians.
    pub points: Vec<[f64; 2]>,
    /// A density shown behind the points, from white at 0 to a pale colour at its greatest value.
    pub density: SphereGrid,
}

/// Directions as dots on maps of the sphere, one map a data set, two in a row.
///
/// ```
/// use hairis_harness::plot::{Projection, ScatterMap, ScatterPanel, SphereGrid};
/// let points = (0..100).map(|i| f64::from(i) / 100.0).map(|t| [2.0 * t - 1.0, 30.0 * t]).collect();
/// let density = SphereGrid::sample(Projection::EqualArea, (18, 36), |theta, _| theta.cos());
/// let panels = vec![ScatterPanel { title: "a spiral".into(), points, density }];
/// let svg = ScatterMap { title: "Directions".into(), panels, mark: ("viewer".into(), [0.3, 0.0]) }.svg();
/// assert!(svg.contains("a spiral"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterMap {
    /// The title.
    pub title: String,
    /// The maps.
    pub panels: Vec<ScatterPanel>,
    /// A direction (radians) that is marked on every map, such as that to the viewer, by name.
    pub mark: (String, [f64; 2]),
}

impl ScatterMap {
    /// The figure as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        const LEFT: [f64; 2] = [64.0, 316.0];
        const SIZE: Place = (182.0, 120.0);
        let (mut canvas, mut top) = Canvas::new(&self.title);
        for row in self.panels.chunks(LEFT.len()) {
            for ((panel, left), name) in row.iter().zip(LEFT).zip(["inclination θ (°)", ""]) {
                let low = (left, top + 22.0);
                canvas.text(&panel.title, (left + 0.5 * SIZE.0, top + 8.0), HEADING);
                let corners = (low, (low.0 + SIZE.0, low.1 + SIZE.1));
                map(&mut canvas, (panel.density.projection, name), corners, |canvas, x, y| {
                    let most = panel.density.range().map_or(0.0, |(_, high)| high);
                    // The square root lets the tails show.
                    let share = |v: f64| if most > 0.0 { (v / most).max(0.0).sqrt() } else { 0.0 };
                    panel.density.fill(canvas, (x, y), 24, share, soft_color);
                    for at in panel.points.iter().filter(|at| at.iter().all(|angle| angle.is_finite())) {
                        canvas.dot(place(x, y, *at), 0.8, series_color(0), 0.85);
                    }
                    canvas.marker(place(x, y, self.mark.1), CROSS, MARK);
                });
            }
            top += SIZE.1 + 82.0;
        }
        canvas.marker((LEFT[0] + 6.0, top + 8.0), CROSS, MARK);
        canvas.text(&self.mark.0, (LEFT[0] + 18.0, top + 8.0), Type { anchor: "start", ..TICK });
        let names: Vec<&str> = self.panels.iter().map(|p| p.title.as_str()).collect();
        canvas.finish(&format!("Directions on maps of the sphere: {}.", names.join("; ")), top + 24.0)
    }
}
