//! Environment maps from Radiance HDR and `OpenEXR` files.

mod openexr;
mod primaries;
mod radiance;
mod rgbe;

pub use primaries::Primaries;

use super::environment::INFINITE_PIXEL;
use super::{Environment, PixelRepairs, rounded};
use crate::error::Error;
use core::fmt;
use glam::{DMat3, DVec3};
use std::fs::File;
use std::io::{self, BufRead as _, BufReader};
use std::path::{Path, PathBuf};

/// Largest number of texels of a map, 8192 x 4096; the tables of a map beyond would take a gigabyte.
const MAX_TEXELS: usize = 1 << 25;

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

/// Error of an environment map that cannot be used: the file and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightError {
    path: PathBuf,
    reason: String,
}

impl LightError {
    /// Returns the error of a map that emits no light, because no figure can be relative to such a map.
    #[must_use]
    pub fn black(path: &Path, PixelRepairs { nan, negative, .. }: PixelRepairs) -> Self {
        let repairs = match nan + negative {
            0 => String::new(),
            _ => format!(": {nan} NaN and {negative} negative channels count as 0"),
        };
        Self {
            path: path.to_owned(),
            reason: format!("the map gives no light{repairs}; pass another file"),
        }
    }
}

impl fmt::Display for LightError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.reason)
    }
}

impl core::error::Error for LightError {}

impl From<LightError> for Error {
    fn from(source: LightError) -> Self {
        Self::Environment(source.to_string())
    }
}

impl Environment {
    /// Reads an environment map as [`load_layer`](Self::load_layer) does, without naming a layer.
    ///
    /// # Errors
    /// Returns [`LightError`], which names the file and the reason in one line.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, LightError> {
        Self::load_layer(path, None)
    }

    /// Reads a latitude-longitude map from a Radiance HDR or `OpenEXR` file. The format is detected from the content, whatever the file
    /// is called.
    ///
    /// The map is linear RGB with the Rec. 709 primaries. Files with other primaries and XYZ files are converted so that tristimulus
    /// values are kept: whites are not adapted. Radiance values are divided by `EXPOSURE` and `COLORCORR`. An `OpenEXR` map covers the
    /// display window and is black outside the data window; alpha is ignored. `layer` names the layer to read if several layers of the
    /// file have colour. [`notes`](Self::notes) reports every conversion.
    ///
    /// # Errors
    /// Returns [`LightError`], which names the file and the reason in one line.
    pub fn load_layer(path: impl AsRef<Path>, layer: Option<&str>) -> Result<Self, LightError> {
        let path = path.as_ref();
        let name = path.file_name().map_or_else(
            || path.display().to_string(),
            |n| n.to_string_lossy().into_owned(),
        );
        read_map(path, layer)
            .and_then(|map| {
                let [width, height] = map.size;
                Ok(Self::from_pixels(name, width, height, map.pixels)?.with_remarks(map.remarks))
            })
            .map_err(|reason| LightError {
                path: path.to_owned(),
                reason,
            })
    }
}

/// Content of a file: linear Rec. 709 pixels, row by row from the zenith.
struct Map {
    size: [usize; 2],
    pixels: Vec<[f32; 3]>,
    /// Remarks on how the values of the file were changed, one line each.
    remarks: Vec<String>,
}

impl Map {
    /// Multiplies every pixel by a matrix. Infinite channels are first set to the largest half float, because a sum with both signs of
    /// infinity is NaN.
    fn convert(&mut self, matrix: &DMat3) {
        let mut infinite = 0;
        for pixel in &mut self.pixels {
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

/// Reads the map of a file, or returns the reason why the file is rejected.
fn read_map(path: &Path, layer: Option<&str>) -> Result<Map, String> {
    let unreadable = |e: io::Error| format!("cannot read: {}", line(&e));
    if std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        return Err("is a directory, not an environment map".to_owned());
    }
    let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
    let start = file.fill_buf().map_err(unreadable)?;
    if start.is_empty() {
        return Err("the file is empty".to_owned());
    }
    if start.starts_with(&exr::meta::magic_number::BYTES) {
        return openexr::read(file, layer);
    }
    if !start.starts_with(b"#?") {
        let known = PICTURES.iter().find(|(mark, _)| start.starts_with(mark));
        let kind = known.map_or("not a".to_owned(), |(_, name)| format!("{name} is not"));
        return Err(format!("unsupported: {kind} Radiance HDR or OpenEXR file"));
    }
    if let Some(layer) = layer {
        return Err(format!(
            "has no layers, because it is Radiance HDR: leave out --layer {layer}"
        ));
    }
    radiance::read(file)
}

/// Returns the size of a map if the map is neither empty nor too large.
fn checked([width, height]: [usize; 2]) -> Result<[usize; 2], String> {
    if width == 0 || height == 0 {
        return Err(format!("the image has no pixels: {width} x {height}"));
    }
    if width.saturating_mul(height) > MAX_TEXELS {
        return Err(format!("{width} x {height} is more than 2^25 pixels"));
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
