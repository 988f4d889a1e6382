//! Polar charts, which show values as distances from a centre.

use super::axis::{Axis, nice_step};
use super::canvas::{Canvas, GRID, HEADING, LABEL, Pen, Place, THIN, TICK, Type, WIDTH};
use super::frame::legend;
use super::line::pen;
use super::palette::{INK, PAPER};

/// Circle of a polar chart, with a title, lines and a marked angle.
#[derive(Clone, Debug, PartialEq)]
pub struct PolarPanel {
    /// Title above the circle.
    pub title: String,
    /// Name of the angle, counted anticlockwise from the right.
    pub angle: String,
    /// Lines as points of (angle in radians, value).
    pub lines: Vec<Vec<(f64, f64)>>,
    /// Name and angle (radians) of a direction that is pointed out, such as that of the viewer.
    pub arrow: (String, f64),
}

/// Radius of a circle, in pixels.
const RADIUS: f64 = 165.0;

/// Draws values as distances from a centre, as SVG. The circles stand one below the other, each with a scale of its own, and the lines
/// of every circle have the same `names`.
///
/// ```
/// use hairis_instruments::plot::{PolarPanel, polar};
/// let turn = (0..=90).map(|i| f64::from(i) * core::f64::consts::TAU / 90.0);
/// let lines = vec![turn.map(|t| (t, t.cos().max(0.0))).collect()];
/// let panel = PolarPanel { title: "plane".into(), angle: "φ".into(), lines, arrow: ("viewer".into(), 0.0) };
/// assert!(polar("A lobe", "radius: S (1/sr)", &["cosine"], &[panel]).contains("cosine"));
/// ```
#[must_use]
pub fn polar(title: &str, radius: &str, names: &[&str], panels: &[PolarPanel]) -> String {
    let (mut canvas, mut y) = Canvas::new(title);
    for panel in panels {
        panel.draw(&mut canvas, (0.5 * WIDTH, y + 52.0 + RADIUS));
        y += 2.0 * RADIUS + 116.0;
    }
    canvas.text(radius, (0.5 * WIDTH, y + 4.0), LABEL);
    let bottom = legend(&mut canvas, names, y + 18.0, &|canvas, i, (x, y)| {
        canvas.line(&[(x, y), (x + 36.0, y)], pen(i, i));
    });
    let panels: Vec<&str> = panels.iter().map(|panel| panel.title.as_str()).collect();
    let description = format!(
        "Polar plots, {radius}: {}; {}.",
        panels.join(", "),
        names.join(", ")
    );
    canvas.finish(&description, bottom + 8.0)
}

impl PolarPanel {
    fn draw(&self, canvas: &mut Canvas, center: Place) {
        let is_usable = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
        let values = self
            .lines
            .iter()
            .flatten()
            .filter(|p| is_usable(p))
            .map(|p| p.1);
        let most = values.fold(0.0, f64::max);
        let most = if most > 0.0 {
            most.min(1e300) * 1.02
        } else {
            1.0
        };
        let scale = Axis::linear("")
            .range(0.0, most)
            .step(nice_step(most / 4.0))
            .fit(&[], 0.0, RADIUS);
        let at = |angle: f64, r: f64| (center.0 + r * angle.cos(), center.1 - r * angle.sin());
        let ring = |r: f64| {
            (0..=120)
                .map(|i| at(f64::from(3 * i).to_radians(), r))
                .collect::<Vec<Place>>()
        };
        for degrees in (-150..=180).step_by(30).map(f64::from) {
            canvas.line(&[center, at(degrees.to_radians(), RADIUS)], GRID);
            let label = format!("{degrees}°").replace('-', "−");
            canvas.text(&label, at(degrees.to_radians(), RADIUS + 20.0), TICK);
        }
        let ticks: Vec<_> = scale
            .ticks()
            .into_iter()
            .filter(|(r, _)| *r > 0.0)
            .collect();
        for (r, _) in &ticks {
            canvas.line(&ring(*r), GRID);
        }
        canvas.line(&ring(RADIUS), THIN);
        for (i, points) in self.lines.iter().enumerate() {
            for run in points.split(|p| !is_usable(p)) {
                let path: Vec<Place> = run
                    .iter()
                    .map(|(angle, r)| at(*angle, scale.pixel(*r)))
                    .collect();
                canvas.line(&path, pen(i, i));
            }
        }
        for (r, label) in ticks {
            let (x, y) = at(75.0_f64.to_radians(), r);
            canvas.block((x - 15.0, y - 8.0), (x + 15.0, y + 8.0), PAPER, 0.8);
            canvas.text(
                &label.unwrap_or_default(),
                (x, y),
                Type {
                    color: INK,
                    size: 13.0,
                    ..TICK
                },
            );
        }
        let (name, angle) = &self.arrow;
        let tip = at(*angle, RADIUS);
        for (side, start) in [(0.0, 0.82), (-0.045, 0.94), (0.045, 0.94)] {
            canvas.line(&[at(angle + side, start * RADIUS), tip], Pen::new(INK, 1.6));
        }
        canvas.text(name, at(angle + 0.11, 0.88 * RADIUS), LABEL);
        canvas.text(&self.title, (center.0, center.1 - RADIUS - 40.0), HEADING);
        canvas.text(&self.angle, (center.0, center.1 + RADIUS + 40.0), LABEL);
    }
}
