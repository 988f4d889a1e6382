//! Pictures side by side as one SVG drawing that needs no other file.

use super::map::Map;
use crate::film::{Crop, Picture};
use crate::picture::{png, preview};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hairis_instruments::markup::escape;
use image::RgbImage;
use image::imageops::{FilterType, crop_imm, resize};
use std::io;

/// Width of a picture on the page.
const WIDTH: u32 = 210;
const GAP: u32 = 10;
const LABEL: u32 = 18;
/// Magnification of crops.
const ZOOM: u32 = 4;

/// Column of a panel: a title, a remark, a picture, and one error per pixel for each map. If the first column has no errors, it holds
/// the legends.
#[derive(Clone, Debug)]
pub struct Column<'a> {
    /// Title, such as the name of the sampler.
    pub title: String,
    /// Line below the title.
    pub remark: String,
    /// Picture in the first row.
    pub picture: &'a Picture,
    /// Errors of the pixels, row by row, for each map.
    pub errors: Vec<Vec<f64>>,
}

/// Draws rows of pictures, of crops and of error maps as SVG.
///
/// # Errors
///
/// Returns an error only if the encoder of PNG reports one.
pub fn panel(
    columns: &[Column],
    crops: &[Crop; 2],
    maps: &[Map],
    exposure: f64,
) -> io::Result<String> {
    let Some(first) = columns.first() else {
        return Ok(String::new());
    };
    let [width, height] = first.picture.size;
    let shown = WIDTH * height / width.max(1);
    let total: u32 = columns.iter().map(|_| WIDTH + GAP).sum();
    let step = LABEL + shown + GAP;
    let parts = [
        "the brightest part",
        "the part of the largest squared error",
    ];
    let parts = ["A", "B"]
        .into_iter()
        .zip(parts)
        .map(|(name, part)| format!("{name}: {part}, {ZOOM} times as large"));
    let names: Vec<String> = [String::new()]
        .into_iter()
        .chain(parts)
        .chain(maps.iter().map(|map| map.name.to_owned()))
        .collect();
    let rows = LABEL + step * u32::try_from(names.len()).unwrap_or(0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{total}\" height=\"{rows}\" viewBox=\"0 0 {total} {rows}\" \
         role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n<title>Pictures side by side</title>\n\
         <rect width=\"{total}\" height=\"{rows}\" fill=\"#fff\"/>\n"
    );
    for (row, name) in (0..).zip(&names) {
        text(
            &mut svg,
            [0, LABEL + row * step + 12],
            "fill=\"#444\"",
            name,
        );
    }
    let place = |row: u32| 2 * LABEL + row * step;
    for (x, column) in (0..).step_by((WIDTH + GAP) as usize).zip(columns) {
        text(&mut svg, [x, 13], "font-weight=\"bold\"", &column.title);
        text(&mut svg, [x, LABEL + 12], "fill=\"#444\"", &column.remark);
        let image = preview(column.picture, exposure);
        let part =
            |crop: &Crop| crop_imm(&image, crop.x, crop.y, crop.width, crop.height).to_image();
        let maps = maps
            .iter()
            .zip(&column.errors)
            .map(|(map, errors)| map.image(errors, column.picture.size));
        let images = [image.clone()]
            .into_iter()
            .chain(crops.iter().map(part))
            .chain(maps);
        for (row, image) in (0..).zip(images) {
            let size = [WIDTH, shown];
            picture(&mut svg, [x, place(row)], size, &enlarge(&image))?;
        }
    }
    let scale = f64::from(WIDTH) / f64::from(width.max(1));
    for (crop, name) in crops.iter().zip(["A", "B"]) {
        let [x, y, w, h] =
            [crop.x, crop.y, crop.width, crop.height].map(|side| f64::from(side) * scale);
        let y = y + f64::from(place(0));
        svg.push_str(&format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" fill=\"none\" stroke=\"#ffd500\" \
             stroke-width=\"1.5\"/>\n<text x=\"{:.1}\" y=\"{:.1}\" fill=\"#ffd500\" font-weight=\"bold\">{name}</text>\n",
            x + 4.0,
            y + 13.0
        ));
    }
    if first.errors.is_empty() {
        for (row, map) in (3..).zip(maps) {
            let y = place(row);
            picture(&mut svg, [0, y], [WIDTH, 16], &map.legend(WIDTH))?;
            for (share, anchor, label) in map.ticks() {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a share of a width"
                )]
                let x = (share * f64::from(WIDTH)) as u32;
                text(
                    &mut svg,
                    [x, y + 30],
                    &format!("text-anchor=\"{anchor}\""),
                    &label,
                );
            }
            for (line, remark) in (0..).zip(map.remarks) {
                text(&mut svg, [0, y + 52 + 16 * line], "fill=\"#444\"", remark);
            }
        }
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

fn text(svg: &mut String, [x, y]: [u32; 2], style: &str, text: &str) {
    if !text.is_empty() {
        svg.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\" {style}>{}</text>\n",
            escape(text)
        ));
    }
}

fn picture(
    svg: &mut String,
    [x, y]: [u32; 2],
    [width, height]: [u32; 2],
    image: &RgbImage,
) -> io::Result<()> {
    svg.push_str(&format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
         style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
        STANDARD.encode(png(image)?)
    ));
    Ok(())
}

/// Enlarges an image to at least as many pixels as are shown, so that viewers that smooth what they enlarge keep each pixel square.
fn enlarge(image: &RgbImage) -> RgbImage {
    let by = (2 * WIDTH).div_ceil(image.width().max(1)).max(1);
    resize(
        image,
        image.width() * by,
        image.height() * by,
        FilterType::Nearest,
    )
}

/// Returns two parts of `1 / ZOOM` the size that do not overlap: the brightest part, and the part of the largest squared error.
#[must_use]
pub fn crops(picture: &Picture, squares: &[f64]) -> [Crop; 2] {
    let [width, height] = picture.size.map(|side| (side / ZOOM).max(1));
    let starts =
        |side: u32, part: u32| (0..=side.saturating_sub(part)).step_by((part / 2).max(1) as usize);
    let places: Vec<Crop> = starts(picture.size[1], height)
        .flat_map(|y| {
            starts(picture.size[0], width).map(move |x| Crop {
                x,
                y,
                width,
                height,
            })
        })
        .collect();
    let most = |values: &[f64], taken: Option<Crop>| {
        let sum = |part: &Crop| {
            part.pixels()
                .map(|at| values[Crop::whole(picture.size).index(at)])
                .sum::<f64>()
        };
        let apart = |part: &&Crop| {
            taken.is_none_or(|taken| {
                part.x.abs_diff(taken.x) >= width || part.y.abs_diff(taken.y) >= height
            })
        };
        let free = places.iter().filter(apart);
        free.max_by(|a, b| sum(a).total_cmp(&sum(b)))
            .copied()
            .unwrap_or(Crop::whole([width, height]))
    };
    let brightest = most(&picture.luminances(), None);
    [brightest, most(squares, Some(brightest))]
}
