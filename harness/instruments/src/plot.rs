//! Charts as self-contained SVG text: plain numbers in, a `String` out.
//!
//! Charts take any number: NaN and infinities, and values of 0 and below on a logarithmic axis, are left out. Colours
//! are those of Okabe and Ito; lines differ in their dashes and markers too, so that a chart survives grey printing.
//! Each SVG has a white sheet, a name and a description for screen readers, and no ids, so that many can stand in one
//! page. All are of one width, so that letters have one size on a page, and can be read on a phone.

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

pub use axis::Axis;
pub use bar::bars;
pub use frame::Bar;
pub use line::{Series, lines};
#[cfg(feature = "png")]
pub use png::png;
pub use polar::{PolarPanel, polar};
pub use sphere::{ScatterPanel, SphereGrid, heat_map, scatter_maps};

#[cfg(test)]
mod tests;
