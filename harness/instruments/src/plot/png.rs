//! Charts as PNG, for hosts that do not accept SVG.
//!
//! Text is set in a font that is part of the program (`DejaVu Sans`, reduced to the characters that charts use; see `font/LICENSE`), so
//! that a machine without fonts draws the same picture, byte by byte.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::io;
use std::sync::Arc;

/// Pixels of the picture per pixel of the chart.
const SCALE: f32 = 2.0;

const FONTS: [&[u8]; 2] = [
    include_bytes!("font/DejaVuSans.ttf"),
    include_bytes!("font/DejaVuSans-Bold.ttf"),
];

/// Renders a chart as a PNG with twice its width and height in pixels.
///
/// # Errors
///
/// Returns an error if `svg` is not a drawing, or a drawing without extent. The charts of this module never are.
///
/// ```
/// use hairis_instruments::plot::{Axis, Series, lines, png};
/// let svg = lines("t", Axis::linear("x"), Axis::linear("y"), &[Series::curve("s", [(0.0, 1.0)])]);
/// assert!(png(&svg)?.starts_with(b"\x89PNG"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn png(svg: &str) -> io::Result<Vec<u8>> {
    draw(svg)?.encode_png().map_err(io::Error::other)
}

fn draw(svg: &str) -> io::Result<Pixmap> {
    let mut options = Options {
        font_family: "DejaVu Sans".to_owned(),
        ..Options::default()
    };
    let fonts = options.fontdb_mut();
    for font in FONTS {
        fonts.load_font_source(resvg::usvg::fontdb::Source::Binary(Arc::new(font)));
    }
    fonts.set_sans_serif_family("DejaVu Sans");
    let tree = Tree::from_str(svg, &options).map_err(io::Error::other)?;
    let size = tree
        .size()
        .to_int_size()
        .scale_by(SCALE)
        .ok_or_else(|| io::Error::other("a drawing without extent"))?;
    let mut pixels = Pixmap::new(size.width(), size.height())
        .ok_or_else(|| io::Error::other("a drawing too large"))?;
    resvg::render(
        &tree,
        Transform::from_scale(SCALE, SCALE),
        &mut pixels.as_mut(),
    );
    Ok(pixels)
}
