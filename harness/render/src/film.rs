//! Film of a picture, which holds the sums over samples, tile by tile.

use crate::transport::profile::Profile;
use glam::Vec3;
use hairis_instruments::light::luminance;
use hairis_instruments::sequence::mix;
use hairis_instruments::shard::Shard;
use std::collections::HashMap;

/// Largest side of a tile in pixels.
pub const TILE: u32 = 32;

/// Returns the side of the tiles of a picture with `rays` camera rays per sample. Tiles are smaller
/// for many rays, because a run saves whole tiles.
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
    /// Returns the part that is the whole of a picture of this width and height.
    #[must_use]
    pub fn whole([width, height]: [u32; 2]) -> Self {
        Self {
            x: 0,
            y: 0,
            width,
            height,
        }
    }

    /// Iterates over the pixels of the part, row by row.
    pub fn pixels(self) -> impl Iterator<Item = [u32; 2]> {
        (self.y..self.y + self.height)
            .flat_map(move |y| (self.x..self.x + self.width).map(move |x| [x, y]))
    }

    /// Returns the index of a pixel of the part in the order of [`pixels`](Self::pixels).
    #[must_use]
    pub fn index(self, [x, y]: [u32; 2]) -> usize {
        (y - self.y) as usize * self.width as usize + (x - self.x) as usize
    }

    /// Returns the count of pixels in the part.
    #[must_use]
    pub fn len(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Returns true if the part has no pixels.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Iterates over tiles of at most `side` pixels a side that cover the part, row by row.
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

    /// Returns true if this part is one of the [`tiles`](Self::tiles) of `whole` with this side.
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

/// Sums over the samples of a pixel, of radiance and of squared luminance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Sum of the radiance, linear RGB.
    pub radiance: [f64; 3],
    /// Sum of the squares of the luminance.
    pub luminance_sq: f64,
}

impl Sums {
    /// Adds the radiance of a sample, linear RGB, and the square of its luminance.
    #[inline]
    pub fn add(&mut self, radiance: Vec3) {
        let rgb = radiance.to_array().map(f64::from);
        for (sum, channel) in self.radiance.iter_mut().zip(rgb) {
            *sum += channel;
        }
        self.luminance_sq += luminance(rgb).powi(2);
    }
}

/// Tile of a film: its place, and the sums of its pixels row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Pixels of the tile, as a part of the picture.
    pub place: Crop,
    /// Sums of the pixels, row by row.
    pub sums: Vec<Sums>,
    /// Count of samples of each pixel.
    pub samples: u32,
    /// Time that a thread worked on the tile, in seconds.
    pub seconds: f64,
    /// Albedo (3), tangent (3) and distance of what the ray through each pixel's centre meets first: see
    /// [`layers::look`](crate::layers::look). Empty until that function has looked.
    pub first: Vec<[f32; 7]>,
}

impl Tile {
    /// Returns the first pixel of the tile, which distinguishes the tile from the others of a film.
    #[must_use]
    pub fn key(&self) -> [u32; 2] {
        [self.place.x, self.place.y]
    }

    /// Returns true if the tile has samples, or has found what its rays meet first.
    #[must_use]
    pub fn is_begun(&self) -> bool {
        self.samples > 0 || !self.first.is_empty()
    }
}

/// Sums of a picture, tile by tile. Tiles share nothing, so that threads may work on them in any order.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    crop: Crop,
    side: u32,
    /// Tiles of the film, row by row.
    pub tiles: Vec<Tile>,
    /// Time by part of the work, if it was measured.
    pub profile: Profile,
}

impl Film {
    /// Creates a film without samples, in tiles of [`TILE`] pixels a side.
    #[must_use]
    pub fn new(crop: Crop) -> Self {
        Self::with_tiles(crop, TILE)
    }

    /// Creates a film without samples, in tiles of `side` pixels a side.
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

    /// Creates a film from tiles of `side` pixels a side that exist already.
    #[must_use]
    pub fn of(crop: Crop, side: u32, tiles: Vec<Tile>) -> Self {
        Self {
            crop,
            side,
            tiles,
            profile: Profile::default(),
        }
    }

    /// Keeps the tiles of one shard. They are scattered over the picture, so that all shards take about as long.
    #[must_use]
    pub fn shard(mut self, shard: Shard) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "any bits do")]
        let hash = |place: Crop| mix(u64::from(place.y) << 32 | u64::from(place.x)) as usize;
        self.tiles.retain(|tile| shard.owns(hash(tile.place)));
        self
    }

    /// Replaces tiles of this film by the tiles of another film of the same part of the picture.
    ///
    /// # Errors
    ///
    /// Returns the other film, and takes no tile of it, if the parts or the sides of the tiles differ, or if
    /// one of its tiles is not among those of this film.
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

    /// Returns the samples per pixel, averaged over the pixels.
    #[must_use]
    pub fn mean_samples(&self) -> f64 {
        let sum = |of: fn(&Tile) -> f64| self.tiles.iter().map(of).sum::<f64>();
        let pixels = sum(|tile| tile.place.len() as f64);
        sum(|tile| tile.place.len() as f64 * f64::from(tile.samples)) / pixels.max(1.0)
    }

    /// Returns the samples of the pixels that have most.
    #[must_use]
    pub fn most_samples(&self) -> u32 {
        self.tiles
            .iter()
            .map(|tile| tile.samples)
            .max()
            .unwrap_or(0)
    }

    /// Returns the count of samples that every pixel has at least.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.tiles
            .iter()
            .map(|tile| tile.samples)
            .min()
            .unwrap_or(0)
    }

    /// Returns the side of the tiles in pixels.
    #[must_use]
    pub fn side(&self) -> u32 {
        self.side
    }

    /// Returns the part of the picture that the film covers.
    #[must_use]
    pub fn crop(&self) -> Crop {
        self.crop
    }

    /// Returns the time that threads worked on the film, in seconds.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.tiles.iter().map(|tile| tile.seconds).sum()
    }

    /// Returns the picture of the means over the samples, which is black where there are none.
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

/// Picture in linear RGB, row by row from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Radiance of each pixel.
    pub pixels: Vec<[f64; 3]>,
}

impl Picture {
    /// Creates a picture of this width and height in which every pixel is black.
    #[must_use]
    pub fn black(size: [u32; 2]) -> Self {
        Self {
            size,
            pixels: vec![[0.0; 3]; Crop::whole(size).len()],
        }
    }

    /// Returns the mean radiance over the pixels, channel by channel.
    #[must_use]
    pub fn mean(&self) -> [f64; 3] {
        let by = 1.0 / self.pixels.len().max(1) as f64;
        core::array::from_fn(|c| self.pixels.iter().map(|pixel| pixel[c]).sum::<f64>() * by)
    }

    /// Returns the radiance of the pixel in column `x` and row `y`.
    ///
    /// # Panics
    ///
    /// Panics if the pixel lies outside the picture.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> [f64; 3] {
        assert!(
            x < self.size[0] && y < self.size[1],
            "the pixel lies outside"
        );
        self.pixels[y as usize * self.size[0] as usize + x as usize]
    }

    /// Returns the luminance of every pixel, row by row from the upper left corner.
    #[must_use]
    pub fn luminances(&self) -> Vec<f64> {
        self.pixels.iter().map(|pixel| luminance(*pixel)).collect()
    }
}
