//! Maps of the sphere: where a direction lies, and values on a grid of cells.

use super::axis::{Axis, Fitted};
use super::canvas::Pen;
use super::canvas::{Canvas, Hang, Place, Type};
use super::frame;
use super::palette::{Color, Dash, FAINT_INK, INK};
use core::f64::consts::{FRAC_PI_2, PI};

/// How the sphere is laid out: the azimuth to the right, the inclination upwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Equal angles are equal lengths.
    EqualAngle,
    /// Equal solid angles are equal areas (the height is `sin theta`): uniform directions look uniform.
    EqualArea,
}

impl Projection {
    /// Height of an inclination, from -1 to 1.
    fn height(self, theta: f64) -> f64 {
        match self {
            Self::EqualAngle => theta / FRAC_PI_2,
            Self::EqualArea => theta.sin(),
        }
    }

    fn theta(self, height: f64) -> f64 {
        match self {
            Self::EqualAngle => height * FRAC_PI_2,
            Self::EqualArea => height.clamp(-1.0, 1.0).asin(),
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
        let middle = |i: u16, n: u16| (f64::from(i) + 0.5) / f64::from(n);
        let mut values = Vec::new();
        for row in 0..rows {
            let theta = projection.theta(1.0 - 2.0 * middle(row, rows));
            values.extend((0..columns).map(|column| value(theta, PI * (2.0 * middle(column, columns) - 1.0))));
        }
        Self { projection, columns: usize::from(columns), values }
    }

    /// The same cells with their values changed.
    #[must_use]
    pub fn map(mut self, change: impl FnMut(f64) -> f64) -> Self {
        self.values = self.values.into_iter().map(change).collect();
        self
    }

    /// The least and the greatest finite value.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        let finite = || self.values.iter().copied().filter(|v| v.is_finite());
        let low = finite().reduce(f64::min)?;
        Some((low, finite().fold(low, f64::max)))
    }

    pub(super) fn projection(&self) -> Projection {
        self.projection
    }
}

/// A map's place on the sheet.
#[derive(Clone, Copy)]
pub(super) struct Map {
    pub(super) low: Place,
    pub(super) high: Place,
    pub(super) projection: Projection,
}

impl Map {
    pub(super) fn place(&self, theta: f64, phi: f64) -> Place {
        let turns = phi / (2.0 * PI) + 0.5;
        let across = turns - turns.floor();
        let up = 0.5 * (1.0 + self.projection.height(theta.clamp(-FRAC_PI_2, FRAC_PI_2)));
        let (width, height) = (self.high.0 - self.low.0, self.high.1 - self.low.1);
        (self.low.0 + across * width, self.high.1 - up * height)
    }

    /// Fills the cells of `grid` with the colours of `color`, which maps 0 .. 1, drawn in `levels` steps.
    pub(super) fn fill(
        &self,
        canvas: &mut Canvas,
        grid: &SphereGrid,
        levels: u16,
        share: impl Fn(f64) -> f64,
        color: impl Fn(f64) -> Color,
    ) {
        let rows = grid.values.len() / grid.columns.max(1);
        let real = |n: usize| f64::from(u32::try_from(n).unwrap_or(u32::MAX));
        let (width, height) = (self.high.0 - self.low.0, self.high.1 - self.low.1);
        let (cell_width, cell_height) = (width / real(grid.columns), height / real(rows));
        let last = f64::from(levels - 1);
        // One pass a colour, each over all cells of that colour and of later ones: a colour becomes one path, and no
        // paper shines through the seams between colours.
        for level in 0..levels {
            let level = f64::from(level);
            let is = |v: f64| v.is_finite() && (share(v).clamp(0.0, 1.0) * last).round() >= level;
            for (row, values) in grid.values.chunks_exact(grid.columns.max(1)).enumerate() {
                let mut start = 0;
                for run in values.chunk_by(|a, b| is(*a) == is(*b)) {
                    let end = start + run.len();
                    if is(run[0]) {
                        let x = |column: usize| self.low.0 + real(column) * cell_width;
                        let y = |row: usize| self.low.1 + real(row) * cell_height;
                        canvas.block((x(start), y(row)), (x(end), y(row + 1)), color(level / last), 1.0);
                    }
                    start = end;
                }
            }
        }
    }

    /// The frame, the labels in degrees, and the names of the axes where asked for.
    pub(super) fn axes(&self, canvas: &mut Canvas, size: f64, names: (Option<&str>, Option<&str>)) {
        let set = |hang| Type { color: FAINT_INK, ..Type::new(size, hang) };
        let tick = Pen::new(INK, 1.0);
        let grid = Pen::new(FAINT_INK, 0.6).faded(0.35);
        for phi in [-180, -90, 0, 90, 180] {
            let x = self.low.0 + (f64::from(phi) / 360.0 + 0.5) * (self.high.0 - self.low.0);
            canvas.line(&[(x, self.low.1), (x, self.high.1)], grid, Dash::Solid);
            canvas.line(&[(x, self.high.1), (x, self.high.1 + 4.0)], tick, Dash::Solid);
            canvas.text(&degrees(phi), (x, self.high.1 + 12.0), set(Hang::Center));
        }
        for theta in [-90_i32, -60, -30, 0, 30, 60, 90] {
            let (_, y) = self.place(f64::from(theta).to_radians(), 0.0);
            canvas.line(&[(self.low.0, y), (self.high.0, y)], grid, Dash::Solid);
            canvas.line(&[(self.low.0 - 4.0, y), (self.low.0, y)], tick, Dash::Solid);
            // In equal areas the poles' neighbours crowd them.
            if theta.abs() != 60 || self.high.1 - self.low.1 > 200.0 || self.projection == Projection::EqualAngle {
                canvas.text(&degrees(theta), (self.low.0 - 7.0, y), set(Hang::Right));
            }
        }
        canvas.frame(self.low, self.high, tick);
        if let Some(name) = names.0 {
            let middle = (0.5 * (self.low.0 + self.high.0), self.high.1 + 30.0);
            canvas.text(name, middle, Type::new(frame::TICK, Hang::Center));
        }
        if let Some(name) = names.1 {
            let middle = (self.low.0 - 46.0, 0.5 * (self.low.1 + self.high.1));
            canvas.text(name, middle, Type { upright: true, ..Type::new(frame::TICK, Hang::Center) });
        }
    }
}

fn degrees(angle: i32) -> String {
    if angle < 0 { format!("−{}°", -angle) } else { format!("{angle}°") }
}

/// A vertical bar of colours with its labels, to the right of a map.
pub(super) fn color_bar(canvas: &mut Canvas, axis: &Axis, fitted: &Fitted, x: f64, color: impl Fn(f64) -> Color) {
    let steps = 64;
    let height = (fitted.start - fitted.end) / f64::from(steps);
    for i in 0..steps {
        let low = fitted.start - height * f64::from(i);
        let color = color((f64::from(i) + 0.5) / f64::from(steps));
        canvas.block((x, fitted.end), (x + 18.0, low), color, 1.0);
    }
    canvas.frame((x, fitted.end), (x + 18.0, fitted.start), Pen::new(INK, 1.0));
    let mut widest = 0.0_f64;
    for (value, label) in fitted.ticks().into_iter().filter_map(|t| t.label.map(|l| (t.value, l))) {
        let y = fitted.pixel(value);
        canvas.line(&[(x + 18.0, y), (x + 22.0, y)], Pen::new(INK, 1.0), Dash::Solid);
        canvas.text(&label, (x + 26.0, y), Type { color: FAINT_INK, ..Type::new(frame::TICK, Hang::Left) });
        widest = widest.max(super::canvas::text_width(&label, frame::TICK));
    }
    let middle = (x + 36.0 + widest, 0.5 * (fitted.start + fitted.end));
    canvas.text(&axis.label, middle, Type { upright: true, ..Type::new(frame::TICK, Hang::Center) });
}
