//! Layers and attributes of the file of a picture.

use crate::args::Size;
use crate::film::Film;
use crate::scene::{Met, Scene};
use crate::transport::{Stop, each_until};
use glam::Vec3;
use hairis::simd::Level;
use hairis_instruments::light::{luminance, rounded};
use hairis_instruments::machine;
use std::ffi::OsStr;

/// Channel of a layer, row by row from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name of the channel, after that of the layer and a dot if the layer has several.
    pub name: &'static str,
    /// One number per pixel.
    pub pixels: Vec<f32>,
}

/// Layers and attributes that are written beside the pixels of a picture's file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Beside {
    /// Channels of the layers.
    pub channels: Vec<Channel>,
    /// Names and values of the attributes.
    pub attributes: Vec<(&'static str, String)>,
    /// Place of the pixels in a larger picture: left column and upper row, then width and height of the whole. Without a value, the
    /// pixels are the whole.
    pub frame: Option<([u32; 2], [u32; 2])>,
}

impl Beside {
    /// Returns the layers of a film, and the attributes of a run. The layer `variance` is that of a pixel's mean luminance, under the
    /// assumption of independent samples, and `samples` is their count. Further layers follow if [`look`] has been called.
    #[must_use]
    pub fn film(film: &Film, run: &str) -> Self {
        let crop = film.crop();
        let [mut variance, mut samples] = [vec![0.0; crop.len()], vec![0.0; crop.len()]];
        for tile in &film.tiles {
            let n = f64::from(tile.samples.max(1));
            for (pixel, sums) in tile.place.pixels().zip(&tile.sums) {
                let place = crop.index(pixel);
                let mean = luminance(sums.radiance) / n;
                variance[place] = rounded((sums.luminance_sq / n - mean * mean).max(0.0) / n);
                samples[place] = rounded(f64::from(tile.samples));
            }
        }
        let mut channels = vec![
            Channel {
                name: "variance",
                pixels: variance,
            },
            Channel {
                name: "samples",
                pixels: samples,
            },
        ];
        if film.tiles.iter().any(|tile| !tile.first.is_empty()) {
            let names = [
                "albedo.R",
                "albedo.G",
                "albedo.B",
                "tangent.X",
                "tangent.Y",
                "tangent.Z",
                "Z",
            ];
            channels.extend(names.into_iter().enumerate().map(|(k, name)| {
                let mut pixels = vec![0.0; crop.len()];
                for tile in &film.tiles {
                    for (pixel, first) in tile.place.pixels().zip(&tile.first) {
                        pixels[crop.index(pixel)] = first[k];
                    }
                }
                Channel { name, pixels }
            }));
        }
        let attributes = vec![
            ("run", run.to_owned()),
            ("command", command()),
            ("level", Level::detect().name().to_owned()),
            ("machine", machine!().summary()),
            ("samplesPerPixel", film.samples().to_string()),
            ("secondsOfCpuTime", format!("{:.1}", film.seconds())),
        ];
        Self {
            channels,
            attributes,
            frame: picture_size(run).map(|size| ([crop.x, crop.y], size)),
        }
    }
}

/// Parses the width and height of the whole picture from the description of a run.
fn picture_size(run: &str) -> Option<[u32; 2]> {
    let size = run
        .split_whitespace()
        .find_map(|word| word.strip_prefix("size="))?;
    size.parse().ok().map(|Size(size)| size)
}

/// Returns the command line of this process, as Bash reads it. Paths are as they were given.
fn command() -> String {
    words(std::env::args_os())
}

/// Returns the words of a command line as Bash reads them.
pub(crate) fn words(words: impl IntoIterator<Item = impl AsRef<OsStr>>) -> String {
    let quoted = words.into_iter().map(|word| quoted(word.as_ref()));
    quoted.collect::<Vec<_>>().join(" ")
}

/// Quotes a word in ASCII. Words with other bytes than letters, digits and a few signs are in `$'...'`, where quotes and backslashes
/// have a backslash before them, and bytes that are not printable ASCII are `\xNN`.
fn quoted(word: &OsStr) -> String {
    let bytes = word.as_encoded_bytes();
    let is_plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"-_./:=,+@%".contains(byte);
    if !bytes.is_empty() && bytes.iter().all(is_plain) {
        bytes.escape_ascii().to_string()
    } else {
        format!("$'{}'", bytes.escape_ascii())
    }
}

/// Finds what the ray through each pixel's centre meets first, for tiles where that is not known yet,
/// until `stop` ends the work. The layer `albedo` is the directional albedo of hair and the albedo of
/// surfaces; `tangent` is the direction of the fibre from root to tip; and `Z` is the distance along
/// the ray in cm. All are 0 elsewhere.
pub fn look(scene: &Scene, film: &mut Film, stop: &Stop<'_>) {
    let unseen = film.tiles.iter_mut().filter(|tile| tile.first.is_empty());
    each_until(unseen.collect(), stop, |tile| {
        tile.first = tile
            .place
            .pixels()
            .map(|pixel| first(scene, pixel))
            .collect();
    });
}

/// Returns albedo, tangent and distance of what the ray through a pixel's centre meets first.
fn first(scene: &Scene, [x, y]: [u32; 2]) -> [f32; 7] {
    let ray = scene.camera.ray(x as f32 + 0.5, y as f32 + 0.5);
    let (albedo, tangent, distance) = match scene.closest(&ray) {
        Met::Hair(hit) => {
            let tangent = scene
                .strands
                .tangent(hit.segment, hit.s)
                .normalize_or_zero();
            let theta_o = (-ray.direction.dot(tangent)).clamp(-1.0, 1.0).asin();
            (
                scene.hair_of(hit.strand).1.albedo(theta_o, hit.h),
                tangent,
                hit.t,
            )
        }
        Met::Surface(point, _, albedo) => {
            (albedo.to_array(), Vec3::ZERO, point.distance(ray.origin))
        }
        Met::Nothing | Met::Light(_) => ([0.0; 3], Vec3::ZERO, 0.0),
    };
    let [r, g, b] = albedo;
    [r, g, b, tangent.x, tangent.y, tangent.z, distance]
}
