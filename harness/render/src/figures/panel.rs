//! Pictures side by side as one drawing that needs no other file.

use crate::film::{Crop, Picture};
use crate::picture::{png, preview};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hairis_harness::markup::escape;
use image::RgbImage;
use image::imageops::{FilterType, crop_imm, resize};
use std::io;

/// Width of a picture on the page.
const WIDTH: u32 = 210;
const GAP: u32 = 10;
const LABEL: u32 = 18;
/// Magnification of crops.
const ZOOM: u32 = 4;

/// A column: a title, a remark, a picture, and the signed relative error of every pixel.
pub(super) struct Column<'a> {
    pub(super) title: String,
    pub(super) remark: String,
    pub(super) picture: &'a Picture,
    pub(super) errors: Option<Vec<f64>>,
}

/// Columns of picture, crop and error map, as SVG. The crop is the brightest part of the first picture.
pub(super) fn panel(columns: &[Column], exposure: f64) -> io::Result<String> {
    let Some(first) = columns.first() else { return Ok(String::new()) };
    let [width, height] = first.picture.size;
    let place = brightest(first.picture);
    let shown = WIDTH * height / width.max(1);
    let total: u32 = columns.iter().map(|_| WIDTH + GAP).sum();
    let rows = 3 * (shown + GAP) + 3 * LABEL;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{total}\" height=\"{rows}\" viewBox=\"0 0 {total} {rows}\" \
         role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n<title>Pictures side by side</title>\n\
         <rect width=\"{total}\" height=\"{rows}\" fill=\"#fff\"/>\n"
    );
    for (x, column) in (0..).step_by((WIDTH + GAP) as usize).zip(columns) {
        svg.push_str(&format!(
            "<text x=\"{x}\" y=\"13\" font-weight=\"bold\">{}</text>\n<text x=\"{x}\" y=\"{}\" fill=\"#444\">{}</text>\n",
            escape(&column.title),
            LABEL + 12,
            escape(&column.remark)
        ));
        let image = preview(column.picture, exposure);
        let crop = crop_imm(&image, place[0], place[1], width / ZOOM, height / ZOOM).to_image();
        let mut images = vec![enlarge(&image), enlarge(&crop)];
        images.extend(column.errors.as_ref().map(|errors| enlarge(&map(errors, column.picture.size))));
        for (y, image) in (2 * LABEL..).step_by((shown + GAP) as usize).zip(&images) {
            svg.push_str(&format!(
                "<image x=\"{x}\" y=\"{y}\" width=\"{WIDTH}\" height=\"{shown}\" style=\"image-rendering:pixelated\" \
                 href=\"data:image/png;base64,{}\"/>\n",
                STANDARD.encode(png(image)?)
            ));
        }
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

/// At least as many pixels as are shown, each a square: viewers that smooth what they enlarge then keep the pixels.
fn enlarge(image: &RgbImage) -> RgbImage {
    let by = (2 * WIDTH).div_ceil(image.width().max(1)).max(1);
    resize(image, image.width() * by, image.height() * by, FilterType::Nearest)
}

/// Upper left corner of the brightest part of `1 / ZOOM` the size.
fn brightest(picture: &Picture) -> [u32; 2] {
    let [width, height] = picture.size.map(|side| (side / ZOOM).max(1));
    let luminances = picture.luminances();
    let sum = |[x0, y0]: [u32; 2]| -> f64 {
        let part = Crop { x: x0, y: y0, width, height };
        part.pixels().map(|[x, y]| luminances[(y * picture.size[0] + x) as usize]).sum()
    };
    let starts = |side: u32, part: u32| (0..=side.saturating_sub(part)).step_by((part / 2).max(1) as usize);
    let places = starts(picture.size[1], height).flat_map(|y| starts(picture.size[0], width).map(move |x| [x, y]));
    places.max_by(|a, b| sum(*a).total_cmp(&sum(*b))).unwrap_or_default()
}

/// Signed errors as colours: blue for too dark, red for too bright, white for none; full at 1.
fn map(errors: &[f64], [width, height]: [u32; 2]) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let error = errors[(y * width + x) as usize].clamp(-1.0, 1.0);
        let full = if error < 0.0 { [0.02, 0.19, 0.38] } else { [0.40, 0.0, 0.12] };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a byte")]
        let byte = |end: f64| (255.0 * (1.0 + (end - 1.0) * error.abs().sqrt())) as u8;
        image::Rgb(full.map(byte))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_needs_no_other_file() {
        let mut picture = Picture::black([16, 16]);
        picture.pixels[16 * 9 + 13] = [1.0; 3];
        let column = Column { title: "<b>".to_owned(), remark: String::new(), picture: &picture, errors: None };
        let svg = panel(&[column], 1.0).expect("a drawing");
        assert!(svg.contains("&lt;b&gt;") && svg.matches("data:image/png;base64,").count() == 2);
        assert!(!svg.replace("http://www.w3.org/2000/svg", "").contains("http"));
        let [x, y] = brightest(&picture);
        assert!((x..x + 4).contains(&13) && (y..y + 4).contains(&9), "{x} {y}");
    }

    #[test]
    fn errors_have_a_sign() {
        let image = map(&[-1.0, 0.0, 1.0], [3, 1]);
        assert_eq!(image.get_pixel(1, 0).0, [255; 3]);
        assert!(image.get_pixel(0, 0).0[2] > image.get_pixel(0, 0).0[0]);
        assert!(image.get_pixel(2, 0).0[0] > image.get_pixel(2, 0).0[2]);
    }
}
