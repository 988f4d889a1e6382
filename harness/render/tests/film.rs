//! Tests of `film`.

use glam::Vec3;
use hairis_render::film::{Crop, Film, TILE, side};

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
