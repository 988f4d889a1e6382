//! Tests of `picture`.

use exr::prelude::{AttributeValue, Text};
use hairis_render::film::{Crop, Film, Picture};
use hairis_render::layers::Beside;
use hairis_render::picture::{BRIGHT, exposure, srgb, write};

#[test]
fn files_hold_the_picture() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let mut picture = Picture::black([5, 3]);
    picture.pixels[7] = [0.25, 1.5, 1e-3];
    let path = folder.path().join("a.exr");
    let film = Film::new(Crop::whole(picture.size));
    let beside = Beside::film(&film, "seed=1 commit=abc\nname=日");
    write(&picture, &beside, &path, 1.0).expect("written");
    let file = exr::prelude::read_all_flat_layers_from_file(&path).expect("an EXR file");
    let [layer] = &file.layer_data[..] else {
        panic!("one part")
    };
    let names: Vec<String> = layer
        .channel_data
        .list
        .iter()
        .map(|channel| channel.name.to_string())
        .collect();
    assert_eq!(names, ["B", "G", "R", "samples", "variance"]);
    let run = layer.attributes.other.get(&Text::from("run"));
    assert_eq!(
        run,
        Some(&AttributeValue::Text(
            "seed=1 commit=abc\\x0aname=\\xe6\\x97\\xa5".into()
        ))
    );
    let read = image::open(&path).expect("an image").to_rgb32f();
    assert_eq!(read.get_pixel(2, 1).0, [0.25, 1.5, 1e-3]);
    assert_eq!(read.get_pixel(1, 2).0, [0.0; 3]);
    let seen = image::open(path.with_extension("png"))
        .expect("an image")
        .to_rgb8();
    assert_eq!(seen.get_pixel(0, 0).0, [0; 3]);
    assert!(
        seen.get_pixel(2, 1).0[1] > 200,
        "{:?}",
        seen.get_pixel(2, 1)
    );
}

#[test]
fn exposure_brings_pictures_to_one_level() {
    let mut picture = Picture::black([10, 10]);
    picture
        .pixels
        .iter_mut()
        .take(50)
        .for_each(|pixel| *pixel = [2e-3; 3]);
    assert!(
        (exposure(&picture) * 2e-3 - BRIGHT).abs() < 1e-6,
        "{}",
        exposure(&picture)
    );
    assert_eq!(exposure(&Picture::black([2, 2])), 1.0);
    assert_eq!(
        (srgb(0.0), srgb(1.0), srgb(f64::NAN), srgb(0.214)),
        (0, 255, 0, 127)
    );
}
