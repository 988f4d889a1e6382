//! Directions on maps of the sphere.

use super::canvas::{Hang, Type, sheet};
use super::frame;
use super::grid::{Map, Projection, SphereGrid};
use super::palette::{INK, MARK, Marker, series_color, soft_color};

/// One map of a [`ScatterMap`].
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterPanel {
    title: String,
    points: Vec<(f64, f64)>,
    density: Option<SphereGrid>,
}

impl ScatterPanel {
    /// Directions as `(theta, phi)` in radians.
    #[must_use]
    pub fn new(title: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { title: title.into(), points: points.into_iter().collect(), density: None }
    }

    /// A density shown behind the points, from white at 0 to a pale colour at its greatest value.
    #[must_use]
    pub fn with_density(mut self, density: SphereGrid) -> Self {
        self.density = Some(density);
        self
    }
}

/// Directions as dots on maps of the sphere, one map a data set, in rows of two or three.
///
/// ```
/// use hairis_harness::plot::{ScatterPanel, Projection, ScatterMap};
/// let spiral = (0..100).map(|i| f64::from(i) / 100.0).map(|t| (2.0 * t - 1.0, 30.0 * t));
/// let svg = ScatterMap::new("Directions", Projection::EqualArea).panel(ScatterPanel::new("a spiral", spiral)).svg();
/// assert!(svg.contains("a spiral"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterMap {
    title: String,
    projection: Projection,
    panels: Vec<ScatterPanel>,
    mark: Option<(String, f64, f64)>,
}

impl ScatterMap {
    /// A figure without maps.
    #[must_use]
    pub fn new(title: impl Into<String>, projection: Projection) -> Self {
        Self { title: title.into(), projection, panels: Vec::new(), mark: None }
    }

    /// Adds a map.
    #[must_use]
    pub fn panel(mut self, panel: ScatterPanel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Marks one direction (radians) on every map, such as that to the viewer.
    #[must_use]
    pub fn mark(mut self, name: impl Into<String>, theta: f64, phi: f64) -> Self {
        self.mark = Some((name.into(), theta, phi));
        self
    }

    /// The figure as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        const WIDTH: f64 = 960.0;
        const LEFT: f64 = 66.0;
        const GAP: f64 = 52.0;
        let columns: u32 = match self.panels.len() {
            0 | 1 => 1,
            2 | 4 => 2,
            _ => 3,
        };
        let across = f64::from(columns);
        let width = (WIDTH - LEFT - 16.0 - GAP * (across - 1.0)) / across;
        let height = (width * 0.62).min(420.0);
        let step = (width + GAP, height + 62.0);
        let rows = self.panels.len().max(1).div_ceil(columns as usize);
        let top = frame::title_height(&self.title, WIDTH);
        let bottom = top + f64::from(u32::try_from(rows).unwrap_or(1)) * step.1 + 18.0;
        let note = if self.mark.is_some() { 22.0 } else { 0.0 };
        let names: Vec<&str> = self.panels.iter().map(|p| p.title.as_str()).collect();
        let description = format!("Directions on maps of the sphere: {}.", names.join("; "));
        sheet((WIDTH, bottom + note), &self.title, &description, |canvas| {
            frame::title(canvas, &self.title, WIDTH);
            let (mut row, mut column) = (0_u32, 0_u32);
            for panel in &self.panels {
                let low = (LEFT + f64::from(column) * step.0, top + 24.0 + f64::from(row) * step.1);
                let map = Map { low, high: (low.0 + width, low.1 + height), projection: self.projection };
                if let Some(grid) = &panel.density {
                    let most = grid.range().map_or(0.0, |(_, high)| high);
                    // The square root lets the tails show.
                    let share = |v: f64| if most > 0.0 { (v / most).max(0.0).sqrt() } else { 0.0 };
                    map.fill(canvas, grid, 24, share, soft_color);
                }
                let last_row = (row + 2) * columns > u32::try_from(self.panels.len()).unwrap_or(0) + columns - 1;
                let names = (last_row.then_some("azimuth φ"), (column == 0).then_some("inclination θ"));
                map.axes(canvas, 12.0, names);
                for (theta, phi) in panel.points.iter().filter(|(a, b)| a.is_finite() && b.is_finite()) {
                    canvas.dot(map.place(*theta, *phi), 0.9, series_color(0), 0.85);
                }
                if let Some((_, theta, phi)) = self.mark.as_ref().filter(|(_, a, b)| a.is_finite() && b.is_finite()) {
                    canvas.marker(map.place(*theta, *phi), Marker::Cross, 5.0, MARK);
                }
                let middle = (low.0 + 0.5 * width, low.1 - 12.0);
                canvas.text(&panel.title, middle, Type { bold: true, ..Type::new(frame::TICK, Hang::Center) });
                column += 1;
                if column == columns {
                    (row, column) = (row + 1, 0);
                }
            }
            if let Some((name, ..)) = &self.mark {
                let y = bottom + 4.0;
                canvas.marker((LEFT + 6.0, y), Marker::Cross, 5.0, MARK);
                canvas.text(name, (LEFT + 18.0, y), Type { color: INK, ..Type::new(frame::TICK, Hang::Left) });
            }
        })
    }
}
