//! Charts as self-contained SVG text: plain numbers in, a `String` out.
//!
//! Charts take any number: NaN and infinities, and values of 0 and below on a logarithmic axis, are left out. Colours
//! are those of Okabe and Ito; lines differ in their dashes and markers too, so that a chart survives grey printing.
//! Each SVG has a white sheet, a name and a description for screen readers, and no ids, so that many can stand in one
//! page.

mod axis;
mod bar;
mod canvas;
mod frame;
mod grid;
mod heat;
mod line;
mod palette;
#[cfg(feature = "png")]
mod png;
mod polar;
mod scatter;

pub use axis::{Axis, Scale};
pub use bar::{Bar, BarChart};
pub use grid::{Projection, SphereGrid};
pub use heat::HeatMap;
pub use line::{LineChart, Point, ReferenceLine, Series};
pub use palette::Dash;
#[cfg(feature = "png")]
pub use png::png;
pub use polar::{PolarChart, PolarPanel, PolarSeries};
pub use scatter::{ScatterMap, ScatterPanel};

#[cfg(test)]
mod tests;
