//! Tests of `layers`.

use glam::Vec3;
use hairis_render::film::{Crop, Film};
use hairis_render::layers::Beside;

#[test]
fn variance_is_that_of_the_mean() {
    let mut film = Film::new(Crop {
        x: 3,
        y: 1,
        width: 2,
        height: 2,
    });
    let tile = &mut film.tiles[0];
    tile.samples = 4;
    for grey in [1.0, 3.0, 1.0, 3.0] {
        tile.sums[2].add(Vec3::splat(grey));
    }
    let beside = Beside::film(&film, "a run");
    let [variance, samples] = &beside.channels[..] else {
        panic!("two layers")
    };
    assert!(
        (variance.pixels[2] - 0.25).abs() < 1e-6 && variance.pixels[0] == 0.0,
        "{variance:?}"
    );
    assert_eq!(samples.pixels, [4.0; 4]);
    assert!(
        beside.attributes.contains(&("run", "a run".to_owned())),
        "{beside:?}"
    );
}
