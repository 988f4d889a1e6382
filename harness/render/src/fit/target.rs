//! Target of a fit: a picture with the weights of its pixels.

use crate::film::{Crop, Picture};
use exr::block;
use exr::meta::header::Header;
use exr::prelude::{AttributeValue, FlatSamples, ReadChannels as _, ReadLayers as _, Text, read};
use std::fs::File;
use std::io::BufReader;
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
        })
    }

    /// Reads a picture from the channels R, G and B of the first layer of an EXR file. If the data window is smaller than the display
    /// window, the target is a part of the picture.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be read, if it has no such channels or has pixels that are not finite, or if its data window
    /// reaches beyond its display window.
    pub fn read(path: &Path) -> Result<Self, String> {
        let unreadable = |problem: exr::error::Error| {
            let line = problem.to_string().replace(['\n', '\r'], " ");
            format!("cannot read: {line}")
        };
        let file = File::open(path).map_err(|problem| unreadable(problem.into()))?;
        let chunks = block::read(BufReader::new(file), false).map_err(unreadable)?;
        // Check the windows first: decoding takes memory for every pixel of the data window, which the header alone states.
        let (crop, size) = windows(&chunks.headers()[0])?;
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_chunks(chunks)
            .map_err(unreadable)?;
        let layer = &image.layer_data;
        let channels = &layer.channel_data.list;
        let channel = |name: &str| {
            let found = channels.iter().find(|one| one.name == *name);
            found.map(|one| &one.sample_data).ok_or_else(|| {
                let names: Vec<String> = channels.iter().map(|one| one.name.to_string()).collect();
                format!("the channels must be R, G and B, got {}", names.join(", "))
            })
        };
        let rgb = [channel("R")?, channel("G")?, channel("B")?];
        let picture = Picture {
            size: [crop.width, crop.height],
            pixels: (0..crop.len())
                .map(|place| rgb.map(|samples| number(samples, place)))
                .collect(),
        };
        let run = match layer.attributes.other.get(&Text::from("run")) {
            Some(AttributeValue::Text(text)) => Some(text.to_string()),
            _ => None,
        };
        Ok(Self {
            run,
            ..Self::new(&picture, crop, size)?
        })
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

/// Returns the part of the picture in the data window, and the size of the display window, which is the whole picture.
fn windows(header: &Header) -> Result<(Crop, [u32; 2]), String> {
    let display = header.shared_attributes.display_window;
    let side = |pixels: usize| {
        u32::try_from(pixels).ok().filter(|_| pixels <= LONGEST).ok_or_else(|| {
            format!("the sides of the display window must have at most {LONGEST} pixels, got {pixels}")
        })
    };
    let size = [side(display.size.width())?, side(display.size.height())?];
    let data = header.data_window();
    let corner = data.position - display.position;
    let (width, height) = (data.size.width(), data.size.height());
    let within = |from: i32, count: usize, all: u32| {
        let from = u32::try_from(from).ok()?;
        let count = u32::try_from(count).ok()?;
        from.checked_add(count).filter(|end| *end <= all)?;
        Some((from, count))
    };
    let (Some((x, width)), Some((y, height))) = (
        within(corner.x(), width, size[0]),
        within(corner.y(), height, size[1]),
    ) else {
        return Err(format!(
            "the data window must lie within the display window of {} x {} pixels, got {width} x {height} from {} {}",
            size[0],
            size[1],
            corner.x(),
            corner.y()
        ));
    };
    let crop = Crop {
        x,
        y,
        width,
        height,
    };
    Ok((crop, size))
}

fn number(samples: &FlatSamples, place: usize) -> f64 {
    match samples {
        FlatSamples::F16(numbers) => f64::from(numbers[place].to_f32()),
        FlatSamples::F32(numbers) => f64::from(numbers[place]),
        FlatSamples::U32(numbers) => f64::from(numbers[place]),
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
