//! Pixels of Radiance HDR and `OpenEXR` files, by one set of rules for maps and for pictures.

mod openexr;
mod primaries;
mod radiance;
mod rgbe;

pub use primaries::Primaries;

use crate::light::rounded;
use core::fmt;
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead as _, BufReader};
use std::path::Path;

/// Value that an infinite channel is set to, the largest half float.
pub(crate) const INFINITE_PIXEL: f32 = 65_504.0;

/// First bytes of pictures without high dynamic range, which may be taken for maps, with the names of their formats.
const PICTURES: [(&[u8], &str); 7] = [
    (b"\x89PNG\r\n\x1a\n", "Png"),
    (b"\xff\xd8\xff", "Jpeg"),
    (b"II*\0", "Tiff"),
    (b"MM\0*", "Tiff"),
    (b"DDS ", "Dds"),
    (b"BM", "Bmp"),
    (b"GIF8", "Gif"),
];

/// Name of the layer to read if several layers of a file have colour, and the flag that messages call it by.
#[derive(Clone, Copy, Debug)]
pub struct LayerFlag<'a> {
    /// Flag by which a user chooses the layer.
    pub flag: &'static str,
    /// Name of the layer, if the user gives one.
    pub name: Option<&'a str>,
}

/// Pixels of a file: linear RGB with the Rec. 709 primaries.
#[derive(Clone, Debug)]
pub struct Pixels {
    /// Width and height of the whole picture, which is the display window of `OpenEXR`.
    pub size: [usize; 2],
    /// Column and row of the upper left pixel of the part with data.
    pub corner: [usize; 2],
    /// Width and height of the part with data.
    pub extent: [usize; 2],
    /// Pixels of the part with data, row by row from its upper left corner.
    pub values: Vec<[f32; 3]>,
    /// Remarks on how the values of the file were changed, one line each.
    pub remarks: Vec<String>,
    /// Attributes of the layer that are text.
    pub texts: BTreeMap<String, String>,
}

impl Pixels {
    /// Reads a Radiance HDR or `OpenEXR` file of at most `most` pixels, a power of two. The format is detected from the content, whatever
    /// the file is called.
    ///
    /// Files with other primaries and XYZ files are converted so that tristimulus values are kept: whites are not adapted. Radiance values
    /// are divided by `EXPOSURE` and `COLORCORR`. Pixels outside the display window of `OpenEXR` and alpha are ignored. Remarks report
    /// every conversion.
    ///
    /// # Errors
    /// Returns the reason why the file is rejected, in one line. It names the features of a valid file that are not supported.
    pub fn read(path: &Path, layer: LayerFlag<'_>, most: usize) -> Result<Self, String> {
        let unreadable = |e: io::Error| format!("cannot read: {}", line(&e));
        if std::fs::metadata(path).map_err(unreadable)?.is_dir() {
            return Err("is a directory, not a picture".to_owned());
        }
        let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
        let start = file.fill_buf().map_err(unreadable)?;
        if start.is_empty() {
            return Err("the file is empty".to_owned());
        }
        if start.starts_with(&exr::meta::magic_number::BYTES) {
            return openexr::read(file, layer, most);
        }
        if !start.starts_with(b"#?") {
            let known = PICTURES.iter().find(|(mark, _)| start.starts_with(mark));
            let kind = known.map_or("not a".to_owned(), |(_, name)| format!("{name} is not"));
            return Err(format!("unsupported: {kind} Radiance HDR or OpenEXR file"));
        }
        if let Some(name) = layer.name {
            return Err(format!(
                "has no layers, because it is Radiance HDR: leave out {} {name}",
                layer.flag
            ));
        }
        radiance::read(file, most)
    }

    /// Multiplies every pixel by a matrix. Infinite channels are first set to the largest half float, because a sum with both signs of
    /// infinity is NaN.
    fn convert(&mut self, matrix: &DMat3) {
        let mut infinite = 0;
        for pixel in &mut self.values {
            for channel in pixel
                .iter_mut()
                .filter(|channel| **channel == f32::INFINITY)
            {
                *channel = INFINITE_PIXEL;
                infinite += 1;
            }
            let rgb = *matrix * DVec3::from(pixel.map(f64::from));
            *pixel = rgb.to_array().map(rounded);
        }
        if infinite > 0 {
            self.remarks.push(format!(
                "{infinite} infinite channels set to {INFINITE_PIXEL} before the conversion"
            ));
        }
    }
}

/// Returns the size of a picture or a window if it is neither empty nor too large.
fn checked(what: &str, [width, height]: [usize; 2], most: usize) -> Result<[usize; 2], String> {
    if !(1..=most).contains(&width.saturating_mul(height)) {
        let most = most.ilog2();
        return Err(format!(
            "the {what} must have from 1 to 2^{most} pixels, got {width} x {height}"
        ));
    }
    Ok([width, height])
}

fn damaged(e: impl fmt::Display) -> String {
    format!("damaged or cut short: {}", line(&e))
}

/// Returns the message of a foreign error on one line.
fn line(e: &dyn fmt::Display) -> String {
    e.to_string()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

/// Returns the start of a text from a file, for use in a message.
fn excerpt(text: &str) -> String {
    let text = line(&text);
    let mut start: String = text.chars().take(60).collect();
    if start.len() < text.len() {
        start.push_str("...");
    }
    start
}
