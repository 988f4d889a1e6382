//! Charts as self-contained SVG text, made from plain numbers and returned as a `String`.
//!
//! Charts accept any number: NaN and infinities are left out, and so are values of 0 and below on a logarithmic axis. Colours are those
//! of Okabe and Ito; lines also differ in their dashes and markers, so that a chart survives grey printing. Each SVG has a white sheet,
//! and a name and a description for screen readers. None has ids, so that many charts can stand in one page. All have the same width,
//! so that letters have one size on a page and can be read on a phone.

mod axis;
mod bar;
mod canvas;
mod frame;
mod line;
mod palette;
#[cfg(feature = "png")]
mod png;
mod polar;
mod sphere;

pub use axis::{Axis, Fitted, Tick};
pub use bar::bars;
pub use frame::Bar;
pub use line::{Series, lines};
#[cfg(feature = "png")]
pub use png::png;
pub use polar::{PolarPanel, polar};
pub use sphere::{ScatterPanel, SphereGrid, heat_map, scatter_maps};
