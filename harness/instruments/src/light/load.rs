//! Environment maps from files.

use super::{Environment, PixelRepairs};
use core::fmt;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels as _, ReadLayers as _, ReadSpecificChannel as _, read};
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Texels beyond which a map is refused, 8192 x 4096: its tables would take a gigabyte.
const MAX_TEXELS: usize = 1 << 25;

/// Refusal of an environment map: the file and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightError {
    path: PathBuf,
    reason: String,
}

impl LightError {
    /// Refusal of a map that gives no light, so that no figure can be relative to it.
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

impl Environment {
    /// Reads a latitude-longitude map, Radiance HDR or `OpenEXR` by content, whatever the file is called. An alpha channel is ignored.
    ///
    /// Pixel values are taken as linear RGB with the Rec. 709 primaries; the exposure of a Radiance header is not applied, so the scale is the file's own.
    ///
    /// # Errors
    /// [`LightError`], one line that names the file and the reason.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, LightError> {
        let path = path.as_ref();
        let name = path.file_name().map_or_else(
            || path.display().to_string(),
            |n| n.to_string_lossy().into_owned(),
        );
        read_map(path)
            .and_then(|([width, height], pixels)| {
                Self::from_pixels(name, width, height, pixels).map_err(damaged)
            })
            .map_err(|reason| LightError {
                path: path.to_owned(),
                reason,
            })
    }
}

/// Width and height, and the pixels.
type Map = ([usize; 2], Vec<[f32; 3]>);

/// The map of a file, or the reason to refuse it.
fn read_map(path: &Path) -> Result<Map, String> {
    let unreadable = |e| format!("cannot read: {}", line(&e));
    if std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        return Err("is a directory, not an environment map".to_owned());
    }
    let reader = ImageReader::open(path)
        .and_then(ImageReader::with_guessed_format)
        .map_err(unreadable)?;
    let is_exr = match reader.format() {
        Some(ImageFormat::Hdr) => false,
        Some(ImageFormat::OpenExr) => true,
        Some(other) => {
            return Err(format!(
                "unsupported: {other:?} is not Radiance HDR or OpenEXR"
            ));
        }
        None => return Err("unsupported: not a Radiance HDR or OpenEXR file".to_owned()),
    };
    let refuse = |e: ImageError| match e {
        ImageError::IoError(e) if e.kind() != ErrorKind::UnexpectedEof => unreadable(e),
        ImageError::Unsupported(e) => format!("unsupported: {}", line(&e)),
        e => damaged(e),
    };
    let decoder = reader.into_decoder();
    // The decoder knows colour alone.
    if is_exr
        && decoder.is_err()
        && let Some(map) = luminance_map(path)?
    {
        return Ok(map);
    }
    let mut decoder = decoder.map_err(refuse)?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 {
        return Err(format!("the image has no pixels: {width} x {height}"));
    }
    let size = checked([width as usize, height as usize])?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(64 * MAX_TEXELS as u64);
    decoder.set_limits(limits).map_err(refuse)?;
    match DynamicImage::from_decoder(decoder).map_err(refuse)? {
        DynamicImage::ImageRgb32F(map) => Ok((size, map.pixels().map(|p| p.0).collect())),
        DynamicImage::ImageRgba32F(map) => Ok((
            size,
            map.pixels().map(|p| [p.0[0], p.0[1], p.0[2]]).collect(),
        )),
        other => Err(format!("unsupported: pixels of type {:?}", other.color())),
    }
}

/// The map of an `OpenEXR` file that has luminance (channel Y) and no colour; `None` for any other file.
fn luminance_map(path: &Path) -> Result<Option<Map>, String> {
    let Ok(meta) = MetaData::read_from_file(path, false) else {
        return Ok(None);
    };
    let has = |header: &Header, name: &str| {
        header
            .channels
            .list
            .iter()
            .any(|channel| channel.name == *name)
    };
    let Some(header) = meta.headers.iter().find(|header| has(header, "Y")) else {
        return Ok(None);
    };
    if has(header, "RY") || has(header, "BY") {
        return Err("unsupported: luminance with chroma; convert it to RGB".to_owned());
    }
    checked([header.layer_size.width(), header.layer_size.height()])?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("Y")
        .collect_pixels(
            |size, _| (size.width(), vec![[0.0; 3]; size.area()]),
            |(width, pixels), at, (y,): (f32,)| pixels[at.y() * *width + at.x()] = [y; 3],
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(damaged)?;
    let (width, pixels) = image.layer_data.channel_data.pixels;
    Ok(Some(([width, pixels.len() / width.max(1)], pixels)))
}

/// The size of a map that is not too large.
fn checked([width, height]: [usize; 2]) -> Result<[usize; 2], String> {
    if width.saturating_mul(height) > MAX_TEXELS {
        return Err(format!("{width} x {height} is more than 2^25 pixels"));
    }
    Ok([width, height])
}

fn damaged(e: impl fmt::Display) -> String {
    format!("damaged or cut short: {}", line(&e))
}

/// A foreign error's message on one line.
fn line(e: &dyn fmt::Display) -> String {
    e.to_string()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}
