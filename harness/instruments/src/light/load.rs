//! Environment maps from files.

use super::{Environment, PixelRepairs};
use crate::error::Error;
use crate::pixels::{LayerFlag, Pixels};
use core::fmt;
use std::path::{Path, PathBuf};

/// Largest number of texels of a map, 8192 x 4096; the tables of a map beyond would take a gigabyte.
const MAX_TEXELS: usize = 1 << 25;

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

    /// Reads a latitude-longitude map from a Radiance HDR or `OpenEXR` file, as [`Pixels::read`] does. The map is black outside the data
    /// window. `layer` names the layer to read if several layers of the file have colour. [`notes`](Self::notes) reports every conversion.
    ///
    /// # Errors
    /// Returns [`LightError`], which names the file and the reason in one line.
    pub fn load_layer(path: impl AsRef<Path>, layer: Option<&str>) -> Result<Self, LightError> {
        let path = path.as_ref();
        let name = path.file_name().map_or_else(
            || path.display().to_string(),
            |n| n.to_string_lossy().into_owned(),
        );
        let flag = LayerFlag {
            flag: "--layer",
            name: layer,
        };
        Pixels::read(path, flag, MAX_TEXELS)
            .and_then(|pixels| Self::of_pixels(name, pixels))
            .map_err(|reason| LightError {
                path: path.to_owned(),
                reason,
            })
    }

    /// Creates a map of a whole picture, which is black where the file has no data.
    fn of_pixels(name: String, pixels: Pixels) -> Result<Self, String> {
        let Pixels {
            size: [width, height],
            corner: [x, y],
            extent,
            values,
            mut remarks,
            ..
        } = pixels;
        let whole = if extent == [width, height] {
            values
        } else {
            remarks.insert(0, format!(
                "the data window, {} x {} pixels from {x} {y}, covers a part of the display window, {width} x {height}: black elsewhere",
                extent[0], extent[1]
            ));
            let mut whole = vec![[0.0; 3]; width * height];
            for (line, row) in values.chunks_exact(extent[0]).enumerate() {
                whole[(y + line) * width + x..][..extent[0]].copy_from_slice(row);
            }
            whole
        };
        Ok(Self::from_pixels(name, width, height, whole)?.with_remarks(remarks))
    }
}
