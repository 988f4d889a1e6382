//! A scalar on a map of the sphere.

use super::axis::Axis;
use super::canvas::sheet;
use super::frame;
use super::grid::{Map, SphereGrid, color_bar};
use super::palette::{scale_color, signed_color};

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
        Self { title: title.into(), value, grid, signed: false }
    }

    /// Colours by sign: white is 0, and both ends are as far from it as the values go.
    #[must_use]
    pub fn signed(mut self) -> Self {
        let most = self.grid.range().map_or(0.0, |(low, high)| high.max(-low));
        self.value = self.value.or_range(-most, most);
        self.signed = true;
        self
    }

    /// The map as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let top = frame::title_height(&self.title, frame::WIDTH);
        let (low, high) = ((70.0, top), (frame::WIDTH - 110.0, top + 270.0));
        let map = Map { low, high, projection: self.grid.projection() };
        let values = self.grid.range().into_iter().flat_map(|(a, b)| [a, b]);
        let fitted = match self.grid.range() {
            // The colours end where the values do.
            Some((a, b)) if a < b && self.value.shows(a) => {
                self.value.clone().or_range(a, b).fit(values, high.1, low.1)
            }
            _ => self.value.fit(values, high.1, low.1),
        };
        let number = |v| crate::table::number::plain(v, 3);
        let (least, most) = (number(fitted.low), number(fitted.high));
        let description = format!("{} over the sphere, from {least} to {most}.", self.value.label);
        sheet((frame::WIDTH, high.1 + 48.0), &self.title, &description, |canvas| {
            frame::title(canvas, &self.title, frame::WIDTH);
            let color = if self.signed { signed_color } else { scale_color };
            let share = |v: f64| (fitted.within(v) - fitted.start) / (fitted.end - fitted.start);
            map.fill(canvas, &self.grid, 49, share, color);
            map.axes(canvas, frame::TICK, (Some("azimuth φ"), Some("inclination θ")));
            color_bar(canvas, &self.value, &fitted, high.0 + 16.0, color);
        })
    }
}
