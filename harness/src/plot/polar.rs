//! Values around a point.

use super::axis::Axis;
use super::canvas::{Canvas, Hang, Pen, Place, Type, sheet};
use super::frame::{self, Key};
use super::palette::{Dash, FAINT_INK, GRID, INK, series_color};

/// A named closed or open line of a [`PolarPanel`].
#[derive(Clone, Debug, PartialEq)]
pub struct PolarSeries {
    name: String,
    points: Vec<(f64, f64)>,
}

impl PolarSeries {
    /// Points as (angle in radians, value); series of the same place in different panels share their style, and the
    /// legend names those of the first panel.
    #[must_use]
    pub fn new(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { name: name.into(), points: points.into_iter().collect() }
    }
}

/// One circle of a [`PolarChart`].
#[derive(Clone, Debug, PartialEq)]
pub struct PolarPanel {
    title: String,
    angle: String,
    series: Vec<PolarSeries>,
    arrow: Option<(String, f64)>,
}

impl PolarPanel {
    /// A circle whose angle, counted anticlockwise from the right, is named `angle`.
    #[must_use]
    pub fn new(title: impl Into<String>, angle: impl Into<String>) -> Self {
        Self { title: title.into(), angle: angle.into(), series: Vec::new(), arrow: None }
    }

    /// Adds a series.
    #[must_use]
    pub fn series(mut self, series: PolarSeries) -> Self {
        self.series.push(series);
        self
    }

    /// Points out one angle (radians), such as that of the viewer.
    #[must_use]
    pub fn arrow(mut self, name: impl Into<String>, angle: f64) -> Self {
        self.arrow = Some((name.into(), angle));
        self
    }
}

/// Values as distances from a centre, in circles side by side with their own scales.
///
/// ```
/// use hairis_harness::plot::{PolarChart, PolarPanel, PolarSeries};
/// let turn = (0..=90).map(|i| f64::from(i) * core::f64::consts::TAU / 90.0);
/// let lobe = PolarSeries::new("cosine", turn.map(|t| (t, t.cos().max(0.0))));
/// let svg = PolarChart::new("A lobe", "radius: S (1/sr)").panel(PolarPanel::new("plane", "φ").series(lobe)).svg();
/// assert!(svg.contains("cosine"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PolarChart {
    title: String,
    radius: String,
    panels: Vec<PolarPanel>,
}

impl PolarChart {
    /// A chart without circles; `radius` names the distance from the centre, with its unit.
    #[must_use]
    pub fn new(title: impl Into<String>, radius: impl Into<String>) -> Self {
        Self { title: title.into(), radius: radius.into(), panels: Vec::new() }
    }

    /// Adds a circle.
    #[must_use]
    pub fn panel(mut self, panel: PolarPanel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The chart as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let names: Vec<&str> =
            self.panels.first().into_iter().flat_map(|p| &p.series).map(|s| s.name.as_str()).collect();
        let top = frame::title_height(&self.title, frame::WIDTH);
        let count = u32::try_from(self.panels.len().max(1)).unwrap_or(1);
        let width = frame::WIDTH / f64::from(count);
        let radius = (0.5 * width - 46.0).clamp(20.0, 190.0);
        let center_y = top + 50.0 + radius;
        let legend_top = center_y + radius + 78.0;
        let height = legend_top + frame::legend_height(&names, frame::WIDTH - 40.0) + 8.0;
        let panels: Vec<&str> = self.panels.iter().map(|p| p.title.as_str()).collect();
        let description = format!("Polar plots, {}: {}; {}.", self.radius, panels.join(", "), names.join(", "));
        sheet((frame::WIDTH, height), &self.title, &description, |canvas| {
            frame::title(canvas, &self.title, frame::WIDTH);
            let mut x = 0.5 * width;
            for panel in &self.panels {
                panel.draw(canvas, (x, center_y), radius);
                x += width;
            }
            let set = Type { color: FAINT_INK, ..Type::new(frame::TICK, Hang::Center) };
            canvas.text(&self.radius, (0.5 * frame::WIDTH, legend_top - 16.0), set);
            let key = |i| Key { color: series_color(i), line: Some(Dash::of(i)), marker: None, swatch: None };
            let keys: Vec<Key> = (0..names.len()).map(key).collect();
            frame::legend(canvas, &names, &keys, (20.0, legend_top), frame::WIDTH - 40.0);
        })
    }
}

impl PolarPanel {
    fn draw(&self, canvas: &mut Canvas, center: Place, radius: f64) {
        let usable = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
        let values = self.series.iter().flat_map(|s| &s.points).filter(|p| usable(p)).map(|p| p.1.max(0.0));
        let most = values.fold(0.0, f64::max);
        let most = if most > 0.0 { most.min(1e300) * 1.02 } else { 1.0 };
        let axis = Axis::linear("").range(0.0, most).step(super::axis::nice_step(most / 4.0));
        let scale = axis.fit(core::iter::empty(), 0.0, radius);
        let at = |angle: f64, r: f64| (center.0 + r * angle.cos(), center.1 - r * angle.sin());
        for spoke in 0..12 {
            let angle = f64::from(spoke) * 30.0;
            canvas.line(&[center, at(angle.to_radians(), radius)], Pen::new(GRID, 1.0), Dash::Solid);
            let signed = if angle > 180.0 { format!("−{}°", 360.0 - angle) } else { format!("{angle}°") };
            let set = Type { color: FAINT_INK, ..Type::new(12.0, Hang::Center) };
            canvas.text(&signed, at(angle.to_radians(), radius + 18.0), set);
        }
        let ticks = scale.ticks();
        for tick in ticks.iter().filter(|t| t.value > 0.0) {
            canvas.ring(center, scale.pixel(tick.value), Pen::new(GRID, 1.0));
        }
        canvas.ring(center, radius, Pen::new(INK, 1.0));
        for (i, series) in self.series.iter().enumerate() {
            let pen = Pen::new(series_color(i), 2.0);
            for run in series.points.split(|p| !usable(p)) {
                let path: Vec<Place> = run.iter().map(|(a, r)| at(*a, scale.within(r.max(0.0)))).collect();
                canvas.line(&path, pen, Dash::of(i));
            }
        }
        for tick in ticks.iter().filter(|t| t.value > 0.0) {
            let place = at(75.0_f64.to_radians(), scale.pixel(tick.value));
            if let Some(label) = &tick.label {
                let set = Type { color: INK, ..Type::new(11.5, Hang::Center) };
                canvas.block(
                    (place.0 - 13.0, place.1 - 7.0),
                    (place.0 + 13.0, place.1 + 7.0),
                    super::palette::PAPER,
                    0.8,
                );
                canvas.text(label, place, set);
            }
        }
        if let Some((name, angle)) = self.arrow.as_ref().filter(|(_, a)| a.is_finite()) {
            let pen = Pen::new(INK, 1.6);
            canvas.line(&[at(*angle, 0.82 * radius), at(*angle, radius)], pen, Dash::Solid);
            for side in [-0.045, 0.045] {
                canvas.line(&[at(angle + side, 0.94 * radius), at(*angle, radius)], pen, Dash::Solid);
            }
            canvas.text(name, at(angle + 0.11, 0.88 * radius), Type::new(frame::TICK, Hang::Center));
        }
        let title = Type { bold: true, ..Type::new(frame::TICK, Hang::Center) };
        canvas.text(&self.title, (center.0, center.1 - radius - 38.0), title);
        let set = Type::new(frame::TICK, Hang::Center);
        canvas.text(&self.angle, (center.0, center.1 + radius + 34.0), set);
    }
}
