//! Film: sums over samples, tile by tile.

use crate::transport::Profile;
use glam::Vec3;
use hairis_instruments::light::luminance;
use hairis_instruments::sequence::mix;
use hairis_instruments::shard::Shard;
use std::collections::HashMap;

/// Side of a tile in pixels, at most.
pub const TILE: u32 = 32;

/// Side of the tiles of a picture of which each sample is so many camera rays: smaller for many,
/// because a run saves whole tiles.
#[must_use]
pub fn side(rays: u32) -> u32 {
    const MOST: u32 = 16 * TILE * TILE;
    let mut side = TILE;
    while side > 1 && side * side * rays > MOST {
        side /= 2;
    }
    side
}

/// Part of a picture in pixels: columns `x` to `x + width`, rows `y` to `y + height`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Count of columns.
    pub width: u32,
    /// Count of rows.
    pub height: u32,
}

impl Crop {
    /// The whole of a picture.
    #[must_use]
    pub fn whole([width, height]: [u32; 2]) -> Self {
        Self {
            x: 0,
            y: 0,
            width,
            height,
        }
    }

    /// Pixels, row by row.
    pub fn pixels(self) -> impl Iterator<Item = [u32; 2]> {
        (self.y..self.y + self.height)
            .flat_map(move |y| (self.x..self.x + self.width).map(move |x| [x, y]))
    }

    /// Place of one of its pixels among them.
    #[must_use]
    pub fn index(self, [x, y]: [u32; 2]) -> usize {
        (y - self.y) as usize * self.width as usize + (x - self.x) as usize
    }

    /// Count of pixels.
    #[must_use]
    pub fn len(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Whether there are no pixels.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Tiles of at most `side` pixels a side, row by row.
    pub fn tiles(self, side: u32) -> impl Iterator<Item = Self> {
        let step = side as usize;
        (self.y..self.y + self.height)
            .step_by(step)
            .flat_map(move |y| {
                (self.x..self.x + self.width)
                    .step_by(step)
                    .map(move |x| Self {
                        x,
                        y,
                        width: side.min(self.x + self.width - x),
                        height: side.min(self.y + self.height - y),
                    })
            })
    }

    /// Whether it is one of the [`tiles`](Self::tiles) of `whole`.
    #[must_use]
    pub fn is_tile_of(self, whole: Self, side: u32) -> bool {
        let one_axis = |from: u32, count: u32, start: u32, all: u32| {
            let Some(offset) = from.checked_sub(start) else {
                return false;
            };
            offset < all && offset.is_multiple_of(side) && count == side.min(all - offset)
        };
        one_axis(self.x, self.width, whole.x, whole.width)
            && one_axis(self.y, self.height, whole.y, whole.height)
    }
}

/// Sums over the samples of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Radiance, linear RGB.
    pub radiance: [f64; 3],
    /// Square of the luminance.
    pub luminance_sq: f64,
}

impl Sums {
    /// Adds a sample.
    #[inline]
    pub fn add(&mut self, radiance: Vec3) {
        let rgb = radiance.to_array().map(f64::from);
        for (sum, channel) in self.radiance.iter_mut().zip(rgb) {
            *sum += channel;
        }
        self.luminance_sq += luminance(rgb).powi(2);
    }
}

/// A tile: its place, and the sums of its pixels row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Which pixels.
    pub place: Crop,
    /// Their sums.
    pub sums: Vec<Sums>,
    /// Count of samples of each pixel.
    pub samples: u32,
    /// Time that a thread worked on it, in seconds.
    pub seconds: f64,
    /// Albedo (3), tangent (3) and distance of what the ray through each pixel's centre meets first: see
    /// [`layers::look`](crate::layers::look). Empty where nobody has looked.
    pub first: Vec<[f32; 7]>,
}

impl Tile {
    /// Its first pixel, which tells it from the other tiles of a film.
    #[must_use]
    pub fn key(&self) -> [u32; 2] {
        [self.place.x, self.place.y]
    }

    /// Whether there is anything in it.
    #[must_use]
    pub fn is_begun(&self) -> bool {
        self.samples > 0 || !self.first.is_empty()
    }
}

/// The sums of a picture. Tiles share nothing, so that threads may work on them in any order.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    crop: Crop,
    side: u32,
    /// The tiles, row by row.
    pub tiles: Vec<Tile>,
    /// Time by part of the work, if it was measured.
    pub profile: Profile,
}

impl Film {
    /// No samples yet, in tiles of [`TILE`] pixels a side.
    #[must_use]
    pub fn new(crop: Crop) -> Self {
        Self::with_tiles(crop, TILE)
    }

    /// No samples yet, in tiles of `side` pixels a side.
    #[must_use]
    pub fn with_tiles(crop: Crop, side: u32) -> Self {
        let tile = |place: Crop| Tile {
            place,
            sums: vec![Sums::default(); place.len()],
            samples: 0,
            seconds: 0.0,
            first: Vec::new(),
        };
        Self::of(crop, side, crop.tiles(side).map(tile).collect())
    }

    /// Makes a film of tiles of `side` pixels a side that exist already.
    #[must_use]
    pub fn of(crop: Crop, side: u32, tiles: Vec<Tile>) -> Self {
        Self {
            crop,
            side,
            tiles,
            profile: Profile::default(),
        }
    }

    /// Keeps the tiles of one shard. They are scattered over the picture, so that shards take about as long.
    #[must_use]
    pub fn shard(mut self, shard: Shard) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "any bits do")]
        let hash = |place: Crop| mix(u64::from(place.y) << 32 | u64::from(place.x)) as usize;
        self.tiles.retain(|tile| shard.owns(hash(tile.place)));
        self
    }

    /// Takes the tiles of another film of the same part of the picture in place of its own. Gives
    /// the other back, and takes none, if one of them is not among its own.
    ///
    /// # Errors
    ///
    /// The other film.
    pub fn adopt(&mut self, other: Self) -> Result<(), Self> {
        let places: HashMap<[u32; 2], usize> = self.tiles.iter().map(Tile::key).zip(0..).collect();
        if (self.crop, self.side) != (other.crop, other.side)
            || !other
                .tiles
                .iter()
                .all(|tile| places.contains_key(&tile.key()))
        {
            return Err(other);
        }
        for tile in other.tiles {
            let place = places[&tile.key()];
            self.tiles[place] = tile;
        }
        Ok(())
    }

    /// Samples of a pixel, mean over the pixels.
    #[must_use]
    pub fn mean_samples(&self) -> f64 {
        let sum = |of: fn(&Tile) -> f64| self.tiles.iter().map(of).sum::<f64>();
        let pixels = sum(|tile| tile.place.len() as f64);
        sum(|tile| tile.place.len() as f64 * f64::from(tile.samples)) / pixels.max(1.0)
    }

    /// Samples of the pixels that have most.
    #[must_use]
    pub fn most_samples(&self) -> u32 {
        self.tiles
            .iter()
            .map(|tile| tile.samples)
            .max()
            .unwrap_or(0)
    }

    /// Samples that every pixel has.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.tiles
            .iter()
            .map(|tile| tile.samples)
            .min()
            .unwrap_or(0)
    }

    /// Side of its tiles in pixels.
    #[must_use]
    pub fn side(&self) -> u32 {
        self.side
    }

    /// The part of the picture that it covers.
    #[must_use]
    pub fn crop(&self) -> Crop {
        self.crop
    }

    /// Time that threads worked on it, in seconds.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.tiles.iter().map(|tile| tile.seconds).sum()
    }

    /// Means over the samples.
    #[must_use]
    pub fn picture(&self) -> Picture {
        let mut picture = Picture::black([self.crop.width, self.crop.height]);
        for tile in &self.tiles {
            let by = 1.0 / f64::from(tile.samples.max(1));
            for (pixel, sums) in tile.place.pixels().zip(&tile.sums) {
                picture.pixels[self.crop.index(pixel)] = sums.radiance.map(|sum| sum * by);
            }
        }
        picture
    }
}

/// A picture: linear RGB, row by row from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Radiance.
    pub pixels: Vec<[f64; 3]>,
}

impl Picture {
    /// A black picture.
    #[must_use]
    pub fn black(size: [u32; 2]) -> Self {
        Self {
            size,
            pixels: vec![[0.0; 3]; Crop::whole(size).len()],
        }
    }

    /// Mean radiance.
    #[must_use]
    pub fn mean(&self) -> [f64; 3] {
        let by = 1.0 / self.pixels.len().max(1) as f64;
        core::array::from_fn(|c| self.pixels.iter().map(|pixel| pixel[c]).sum::<f64>() * by)
    }

    /// The radiance of a pixel.
    ///
    /// # Panics
    ///
    /// If it lies outside.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> [f64; 3] {
        assert!(
            x < self.size[0] && y < self.size[1],
            "the pixel lies outside"
        );
        self.pixels[y as usize * self.size[0] as usize + x as usize]
    }

    /// Luminance of every pixel.
    #[must_use]
    pub fn luminances(&self) -> Vec<f64> {
        self.pixels.iter().map(|pixel| luminance(*pixel)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_crop_once() {
        let crop = Crop {
            x: 5,
            y: 3,
            width: 70,
            height: 33,
        };
        let film = Film::new(crop);
        assert_eq!(film.tiles.len(), 6);
        let is_tile = |x, y, width, height| {
            Crop {
                x,
                y,
                width,
                height,
            }
            .is_tile_of(crop, TILE)
        };
        assert!(
            film.tiles
                .iter()
                .all(|tile| tile.place.is_tile_of(crop, TILE))
        );
        assert!(
            !is_tile(6, 3, 32, 32)
                && !is_tile(5, 3, 32, 31)
                && !is_tile(5, 67, 32, 1)
                && !is_tile(0, 3, 32, 32)
        );
        let mut pixels: Vec<[u32; 2]> = film
            .tiles
            .iter()
            .flat_map(|tile| tile.place.pixels())
            .collect();
        pixels.sort_unstable();
        let mut expected: Vec<[u32; 2]> = crop.pixels().collect();
        expected.sort_unstable();
        assert_eq!(pixels, expected);
    }

    #[test]
    fn tiles_are_smaller_where_samples_are_many_rays() {
        assert_eq!([1, 16, 17, 64, 4096].map(side), [32, 32, 16, 16, 2]);
        let crop = Crop::whole([40, 33]);
        assert_eq!(crop.tiles(16).count(), 9);
        assert!(crop.tiles(16).all(|tile| tile.is_tile_of(crop, 16)));
    }

    #[test]
    fn a_picture_is_the_mean_of_samples() {
        let mut film = Film::new(Crop::whole([40, 2]));
        let tile = &mut film.tiles[1];
        tile.samples = 2;
        tile.sums[9].add(Vec3::new(1.0, 2.0, 3.0));
        tile.sums[9].add(Vec3::new(3.0, 2.0, 1.0));
        assert_eq!(film.picture().at(33, 1), [2.0; 3]);
        assert_eq!(film.picture().mean(), [2.0 / 80.0; 3]);
    }
}
