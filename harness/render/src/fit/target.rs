//! Target of a fit: a picture with the weights of its pixels.

use crate::film::{Crop, Picture};
use hairis_instruments::pixels::{LayerFlag, Pixels};
use std::path::Path;

/// Reach, in pixels to each side, of the mean from which the weight of a pixel follows. It is small enough to follow the light, and
/// large enough that the noise of the pixel itself matters little. Weights by the pixel alone would favour pixels that are dark by chance.
const REACH: u32 = 3;
/// Radiance that is added to the mean around a pixel, relative to the mean of the picture.
const FLOOR: f64 = 0.1;
/// Longest side of a picture in pixels.
const LONGEST: usize = 16384;

/// Picture that a fit is to match, with the weights of its pixels.
#[derive(Clone, Debug)]
pub struct Target {
    crop: Crop,
    size: [u32; 2],
    radiance: Vec<[f64; 3]>,
    weights: Vec<[f64; 3]>,
    run: Option<String>,
    remarks: Vec<String>,
}

impl Target {
    /// Creates a target from the part `crop` of a picture of `size` pixels. Weights per channel are `1 / (mean^2 + floor^2)` over the count
    /// of pixels, where `mean` is that of the pixels around, and `floor` is a tenth of the mean of the picture.
    ///
    /// # Errors
    ///
    /// Returns an error if a pixel is not finite, or if the mean of a channel is not above zero.
    pub fn new(picture: &Picture, crop: Crop, size: [u32; 2]) -> Result<Self, String> {
        for (pixel, radiance) in crop.pixels().zip(&picture.pixels) {
            if let Some(c) = (0..3).find(|c| !radiance[*c].is_finite()) {
                let ([x, y], channel) = (pixel, ["R", "G", "B"][c]);
                return Err(format!(
                    "{channel} of the pixel {x},{y} must be finite, got {}",
                    radiance[c]
                ));
            }
        }
        let mean = picture.mean();
        if let Some(c) = (0..3).find(|c| mean[*c] <= 0.0) {
            let channel = ["R", "G", "B"][c];
            return Err(format!(
                "the mean of {channel} must be above 0, got {}",
                mean[c]
            ));
        }
        let share = 1.0 / picture.pixels.len() as f64;
        let weights = smooth(picture)
            .iter()
            .map(|around| {
                core::array::from_fn(|c| share / (around[c].powi(2) + (FLOOR * mean[c]).powi(2)))
            })
            .collect();
        Ok(Self {
            crop,
            size,
            radiance: picture.pixels.clone(),
            weights,
            run: None,
            remarks: Vec::new(),
        })
    }

    /// Reads a picture from a file, as environment maps are read. If the file has pixels of a part of its picture alone, the target is that
    /// part.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be read, if it has no colour or has pixels that are not finite, or if its picture is larger than
    /// any that is rendered.
    pub fn read(path: &Path, layer: LayerFlag<'_>) -> Result<Self, String> {
        let Pixels {
            size,
            corner,
            extent,
            values,
            remarks,
            mut texts,
        } = Pixels::read(path, layer, LONGEST * LONGEST)?;
        if let Some(side) = size.iter().find(|side| **side > LONGEST) {
            return Err(format!(
                "the sides of the display window must have at most {LONGEST} pixels, got {side}"
            ));
        }
        // No side is longer.
        let short = |sides: [usize; 2]| sides.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        let ([x, y], [width, height]) = (short(corner), short(extent));
        let crop = Crop {
            x,
            y,
            width,
            height,
        };
        let picture = Picture {
            size: [width, height],
            pixels: values
                .into_iter()
                .map(|pixel| pixel.map(f64::from))
                .collect(),
        };
        Ok(Self {
            run: texts.remove("run"),
            remarks,
            ..Self::new(&picture, crop, short(size))?
        })
    }

    /// Returns remarks on how the values of the file were changed, one line each.
    #[must_use]
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// Returns the part of the whole picture that the target covers.
    #[must_use]
    pub fn crop(&self) -> Crop {
        self.crop
    }

    /// Returns the width and height of the whole picture in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the part of the picture that the target covers.
    #[must_use]
    pub fn picture(&self) -> Picture {
        Picture {
            size: [self.crop.width, self.crop.height],
            pixels: self.radiance.clone(),
        }
    }

    /// Returns the radiance and the weights of a pixel of the whole picture, channel by channel.
    #[must_use]
    pub fn pixel(&self, pixel: [u32; 2]) -> ([f64; 3], [f64; 3]) {
        let place = self.crop.index(pixel);
        (self.radiance[place], self.weights[place])
    }

    /// Describes each setting `name=value` of the run that rendered the target, if the file states it, that differs from `expected`.
    #[must_use]
    pub fn differences(&self, expected: &[String]) -> Vec<String> {
        let words: Vec<&str> = self.run.as_deref().unwrap_or_default().split(' ').collect();
        let differs = |setting: &String| {
            let (name, _) = setting.split_once('=')?;
            let found = words
                .iter()
                .find(|word| word.split_once('=').is_some_and(|(other, _)| other == name))?;
            (*found != setting).then(|| format!("{found} in place of {setting}"))
        };
        expected.iter().filter_map(differs).collect()
    }
}

/// Returns the mean over the pixels around each pixel.
fn smooth(picture: &Picture) -> Vec<[f64; 3]> {
    let [width, height] = picture.size;
    let around = |at: u32, count: u32| at.saturating_sub(REACH)..(at + REACH + 1).min(count);
    let pixels = Crop::whole(picture.size).pixels();
    let mean = |[x, y]: [u32; 2]| {
        let (columns, rows) = (around(x, width), around(y, height));
        let by = 1.0 / (columns.len() * rows.len()) as f64;
        let mut sum = [0.0; 3];
        for pixel in rows.flat_map(|y| columns.clone().map(move |x| picture.at(x, y))) {
            for (sum, channel) in sum.iter_mut().zip(pixel) {
                *sum += by * channel;
            }
        }
        sum
    };
    pixels.map(mean).collect()
}
