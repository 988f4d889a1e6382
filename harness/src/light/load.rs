//! Environment maps from files.

use super::{Environment, PixelRepairs};
use core::fmt;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels as _, ReadLayers as _, ReadSpecificChannel as _, read};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::path::{Path, PathBuf};

/// Texels beyond which a map is refused, 8192 x 4096: its tables would take a gigabyte.
const MAX_TEXELS: u64 = 1 << 25;

/// Refusal of an environment map: the file and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LightError {
    /// The file could not be opened or read.
    Io(PathBuf, String),
    /// The path names a directory.
    Directory(PathBuf),
    /// The file is neither Radiance HDR nor `OpenEXR`, or a variant of them that is not supported.
    Unsupported(PathBuf, String),
    /// The image has no pixels: its width and height.
    ZeroSize(PathBuf, u32, u32),
    /// The image is larger than 2^25 pixels: its width and height.
    TooLarge(PathBuf, u32, u32),
    /// The file is damaged or cut short.
    Decode(PathBuf, String),
    /// The map gives no light, and no figure can be relative to it.
    Black(PathBuf, PixelRepairs),
}

impl fmt::Display for LightError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, reason) => write!(f, "{}: cannot read: {reason}", path.display()),
            Self::Directory(path) => write!(f, "{}: is a directory, not an environment map", path.display()),
            Self::Unsupported(path, reason) => {
                write!(f, "{}: unsupported: {reason}", path.display())
            }
            Self::ZeroSize(path, width, height) => {
                write!(f, "{}: the image has no pixels: {width} x {height}", path.display())
            }
            Self::TooLarge(path, width, height) => {
                write!(f, "{}: {width} x {height} is more than 2^25 pixels", path.display())
            }
            Self::Decode(path, reason) => {
                write!(f, "{}: damaged or cut short: {reason}", path.display())
            }
            Self::Black(path, PixelRepairs { nan, negative, .. }) => {
                write!(f, "{}: the map gives no light", path.display())?;
                if nan + negative > 0 {
                    write!(f, ": {nan} NaN and {negative} negative channels count as 0")?;
                }
                f.write_str("; pass another file")
            }
        }
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
        let file = || path.to_path_buf();
        let metadata = std::fs::metadata(path).map_err(|e| LightError::Io(file(), line(&e)))?;
        if metadata.is_dir() {
            return Err(LightError::Directory(file()));
        }
        let reader = ImageReader::open(path)
            .and_then(ImageReader::with_guessed_format)
            .map_err(|e| LightError::Io(file(), line(&e)))?;
        match reader.format() {
            Some(ImageFormat::Hdr | ImageFormat::OpenExr) => {}
            Some(other) => {
                return Err(LightError::Unsupported(file(), format!("{other:?} is not Radiance HDR or OpenEXR")));
            }
            None => {
                return Err(LightError::Unsupported(file(), "not a Radiance HDR or OpenEXR file".into()));
            }
        }
        let refuse = |e: image::ImageError| match e {
            image::ImageError::IoError(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => {
                LightError::Io(file(), line(&e))
            }
            image::ImageError::Unsupported(e) => LightError::Unsupported(file(), line(&e)),
            e => LightError::Decode(file(), line(&e)),
        };
        let is_exr = reader.format() == Some(ImageFormat::OpenExr);
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
            return Err(LightError::ZeroSize(file(), width, height));
        }
        if u64::from(width) * u64::from(height) > MAX_TEXELS {
            return Err(LightError::TooLarge(file(), width, height));
        }
        let mut limits = Limits::default();
        limits.max_alloc = Some(64 * MAX_TEXELS);
        decoder.set_limits(limits).map_err(refuse)?;
        let pixels = match DynamicImage::from_decoder(decoder).map_err(refuse)? {
            DynamicImage::ImageRgb32F(map) => map.pixels().map(|p| p.0).collect(),
            DynamicImage::ImageRgba32F(map) => map.pixels().map(|p| [p.0[0], p.0[1], p.0[2]]).collect(),
            other => {
                return Err(LightError::Unsupported(file(), format!("pixels of type {:?}", other.color())));
            }
        };
        Self::from_pixels(name(path), width as usize, height as usize, pixels)
            .map_err(|reason| LightError::Decode(file(), reason))
    }
}

fn name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned())
}

/// The map of an `OpenEXR` file that has luminance (channel Y) and no colour; `None` for any other file.
fn luminance_map(path: &Path) -> Result<Option<Environment>, LightError> {
    let file = || path.to_path_buf();
    let Ok(meta) = MetaData::read_from_file(path, false) else { return Ok(None) };
    let names =
        |header: &Header| header.channels.list.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>();
    let Some(header) = meta.headers.iter().find(|header| names(header).iter().any(|name| name == "Y")) else {
        return Ok(None);
    };
    if names(header).iter().any(|name| name == "RY" || name == "BY") {
        let reason = "luminance with chroma; convert it to RGB";
        return Err(LightError::Unsupported(file(), reason.to_owned()));
    }
    let size = header.layer_size;
    let [width, height] = [size.width(), size.height()];
    #[expect(clippy::cast_possible_truncation, reason = "sizes of the format have 32 bits")]
    if width as u64 * height as u64 > MAX_TEXELS {
        return Err(LightError::TooLarge(file(), width as u32, height as u32));
    }
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
        .map_err(|e| LightError::Decode(file(), line(&e)))?;
    let (width, pixels) = image.layer_data.channel_data.pixels;
    let height = pixels.len() / width.max(1);
    Environment::from_pixels(name(path), width, height, pixels)
        .map(Some)
        .map_err(|reason| LightError::Decode(file(), reason))
}

/// A foreign error's message on one line.
fn line(e: &dyn fmt::Display) -> String {
    e.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
