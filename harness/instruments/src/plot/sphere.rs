//! Maps of the sphere, with the azimuth to the right and the inclination upwards by its sine, so that equal solid angles have equal
//! areas.

use super::axis::{Axis, Fitted};
use super::canvas::{Canvas, HEADING, Place, THIN, TICK, Type, WIDTH};
use super::frame::draw_axis;
use super::palette::{CROSS, Color, MARK, scale_color, series_color, signed_color, soft_color};
use crate::table::number;
use core::f64::consts::PI;

/// Grid of values on a map of the sphere, in cells of equal solid angle.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereGrid {
    columns: usize,
    values: Vec<f64>,
}

impl SphereGrid {
    /// Evaluates `value(theta, phi)` in the middle of each of `rows` by `columns` cells; angles are in radians.
    #[must_use]
    pub fn sample((rows, columns): (u16, u16), value: &mut dyn FnMut(f64, f64) -> f64) -> Self {
        let middle = |i: u16, n: u16| 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
        let mut values = Vec::new();
        for row in 0..rows {
            let theta = -middle(row, rows).asin();
            values.extend((0..columns).map(|column| value(theta, PI * middle(column, columns))));
        }
        Self {
            columns: usize::from(columns.max(1)),
            values,
        }
    }

    /// Returns the least and the greatest finite value, or `None` if no value is finite.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        let finite = || self.values.iter().copied().filter(|v| v.is_finite());
        Some((finite().reduce(f64::min)?, finite().reduce(f64::max)?))
    }

    /// Fills the map of `x` and `y` with colours, in `levels` steps. `share` maps a value to 0 .. 1, and `color` maps that to a colour.
    fn fill(
        &self,
        canvas: &mut Canvas,
        (x, y): (&Fitted, &Fitted),
        levels: u16,
        share: &dyn Fn(f64) -> f64,
        color: fn(f64) -> Color,
    ) {
        let last = f64::from(levels - 1);
        let rows = self.values.len() / self.columns;
        let corner = |row: usize, column: usize| {
            (
                x.along(column as f64 / self.columns as f64),
                y.along(1.0 - row as f64 / rows as f64),
            )
        };
        // There is one pass per colour, each over all cells of that colour and of later ones. A colour thus becomes one path, and no
        // paper shows through the seams between colours.
        for level in (0..levels).map(f64::from) {
            let is = |v: f64| v.is_finite() && (share(v).clamp(0.0, 1.0) * last).round() >= level;
            for (row, values) in self.values.chunks_exact(self.columns).enumerate() {
                let mut start = 0;
                for run in values.chunk_by(|a, b| is(*a) == is(*b)) {
                    let end = start + run.len();
                    if is(run[0]) {
                        canvas.block(
                            corner(row, start),
                            corner(row + 1, end),
                            color(level / last),
                            1.0,
                        );
                    }
                    start = end;
                }
            }
        }
    }
}

/// Draws a map between the corners `low` and `high`: first what `paint` draws, then the axes over it.
fn map(
    canvas: &mut Canvas,
    inclination: &str,
    (low, high): (Place, Place),
    paint: &dyn Fn(&mut Canvas, &Fitted, &Fitted),
) {
    let x = Axis::linear("azimuth φ (°)")
        .range(-180.0, 180.0)
        .step(90.0)
        .fit(&[], low.0, high.0);
    let y = Axis::sine(inclination)
        .range(-90.0, 90.0)
        .step(45.0)
        .fit(&[], high.1, low.1);
    paint(canvas, &x, &y);
    draw_axis(canvas, &x, &y, false);
    draw_axis(canvas, &y, &x, true);
    canvas.frame(low, high, THIN);
}

/// Returns the place of a direction (radians) on a map.
fn place(x: &Fitted, y: &Fitted, [theta, phi]: [f64; 2]) -> Place {
    let turns = phi / (2.0 * PI) + 0.5;
    (
        x.along(turns - turns.floor()),
        y.pixel(theta.to_degrees().clamp(-90.0, 90.0)),
    )
}

/// Draws a map of the sphere coloured by a scalar, as SVG, with a bar of its colours. The colours are viridis, or blue and vermilion to
/// either side of white if some values are negative. The axis `value` says what the numbers are and how colours spread over them.
///
/// ```
/// use hairis_instruments::plot::{Axis, SphereGrid, heat_map};
/// let grid = SphereGrid::sample((36, 72), &mut |theta, phi| theta.cos() * (1.0 + phi.cos()));
/// assert!(heat_map("Radiance", Axis::linear("L (W/m²/sr)"), &grid).ends_with("</svg>\n"));
/// ```
#[must_use]
pub fn heat_map(title: &str, value: Axis, grid: &SphereGrid) -> String {
    const STEPS: u16 = 64;
    let (mut canvas, top) = Canvas::new(title);
    let (low, high) = ((70.0, top), (WIDTH - 20.0, top + 240.0));
    // The colours end with the values; if some values are negative, white is in the middle.
    let (least, most) = grid.range().unwrap_or((0.0, 1.0));
    let (start, color): (f64, fn(f64) -> Color) = if least < 0.0 {
        (-most.max(-least), signed_color)
    } else {
        (least, scale_color)
    };
    let bar = value
        .or_range(start, most.max(-least))
        .fit(&[least, most], low.0, high.0);
    map(
        &mut canvas,
        "inclination θ (°)",
        (low, high),
        &|canvas, x, y| {
            grid.fill(canvas, (x, y), 49, &|v| bar.share(v), color);
        },
    );
    let (bar_top, bar_bottom) = (high.1 + 62.0, high.1 + 80.0);
    for i in (0..STEPS).map(f64::from) {
        let left = (bar.along(i / f64::from(STEPS)), bar_top);
        canvas.block(
            left,
            (high.0, bar_bottom),
            color((i + 0.5) / f64::from(STEPS)),
            1.0,
        );
    }
    canvas.frame((low.0, bar_top), (high.0, bar_bottom), THIN);
    draw_axis(
        &mut canvas,
        &bar,
        &Axis::linear("").fit(&[], bar_bottom, bar_top),
        false,
    );
    let [least, most] = bar.ends().map(|end| number::plain(end, 3));
    canvas.finish(
        &format!(
            "{} over the sphere, from {least} to {most}.",
            bar.axis.label
        ),
        bar_bottom + 52.0,
    )
}

/// Map of directions: a title, the directions as dots, and a density behind them.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterPanel {
    /// Title of the map.
    pub title: String,
    /// Directions as `theta` and `phi` in radians.
    pub points: Vec<[f64; 2]>,
    /// Density that is shown behind the points, from white at 0 to a pale colour at its greatest value.
    pub density: SphereGrid,
}

/// Draws directions as dots on maps of the sphere, two in a row, as SVG. A direction `at` (radians), such as that to the viewer, is
/// marked on every map.
///
/// ```
/// use hairis_instruments::plot::{ScatterPanel, SphereGrid, scatter_maps};
/// let points = (0..100).map(|i| f64::from(i) / 100.0).map(|t| [2.0 * t - 1.0, 30.0 * t]).collect();
/// let density = SphereGrid::sample((18, 36), &mut |theta, _| theta.cos());
/// let panel = ScatterPanel { title: "a spiral".into(), points, density };
/// assert!(scatter_maps("Directions", &[panel], "viewer", [0.3, 0.0]).contains("a spiral"));
/// ```
#[must_use]
pub fn scatter_maps(title: &str, panels: &[ScatterPanel], mark: &str, at: [f64; 2]) -> String {
    const LEFT: [f64; 2] = [64.0, 316.0];
    const SIZE: Place = (182.0, 120.0);
    let (mut canvas, mut top) = Canvas::new(title);
    for row in panels.chunks(LEFT.len()) {
        for ((panel, left), name) in row.iter().zip(LEFT).zip(["inclination θ (°)", ""]) {
            let low = (left, top + 22.0);
            canvas.text(&panel.title, (left + 0.5 * SIZE.0, top + 8.0), HEADING);
            map(
                &mut canvas,
                name,
                (low, (low.0 + SIZE.0, low.1 + SIZE.1)),
                &|canvas, x, y| {
                    let most = panel.density.range().map_or(0.0, |(_, high)| high);
                    // The square root keeps the tails visible.
                    let share = |v: f64| {
                        if most > 0.0 {
                            (v / most).max(0.0).sqrt()
                        } else {
                            0.0
                        }
                    };
                    panel.density.fill(canvas, (x, y), 24, &share, soft_color);
                    for at in panel
                        .points
                        .iter()
                        .filter(|at| at.iter().all(|angle| angle.is_finite()))
                    {
                        canvas.dot(place(x, y, *at), 0.8, series_color(0), 0.85);
                    }
                    canvas.marker(place(x, y, at), CROSS, MARK);
                },
            );
        }
        top += SIZE.1 + 82.0;
    }
    canvas.marker((LEFT[0] + 6.0, top + 8.0), CROSS, MARK);
    canvas.text(
        mark,
        (LEFT[0] + 18.0, top + 8.0),
        Type {
            anchor: "start",
            ..TICK
        },
    );
    let names: Vec<&str> = panels.iter().map(|panel| panel.title.as_str()).collect();
    canvas.finish(
        &format!("Directions on maps of the sphere: {}.", names.join("; ")),
        top + 24.0,
    )
}
