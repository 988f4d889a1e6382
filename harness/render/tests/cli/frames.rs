//! Frames: the place of a file's pixels in the picture.

use super::{channels, render, succeed};
use exr::math::Vec2;
use exr::prelude::{IntegerBounds, read_all_flat_layers_from_file};
use std::path::Path;
use tempfile::TempDir;

/// Returns the display window and the data window of a file.
fn windows(folder: &TempDir, file: impl AsRef<Path>) -> [IntegerBounds; 2] {
    let file = read_all_flat_layers_from_file(folder.path().join(file)).expect("a picture");
    let layer = &file.layer_data[0];
    let data = IntegerBounds::new(layer.attributes.layer_position, layer.size);
    [file.attributes.display_window, data]
}

#[test]
fn crops_lie_in_the_window_of_the_whole() {
    let folder = TempDir::new().expect("a folder");
    let flags = ["head", "--spp", "1", "--crop", "5,3,20,33"];
    render(&folder, &flags);
    let whole = IntegerBounds::from_dimensions(Vec2(40, 40));
    let crop = IntegerBounds::new((5, 3), (20, 33));
    assert_eq!(windows(&folder, "out/render/head.exr"), [whole, crop]);
    for shard in ["1/2", "2/2"] {
        render(
            &folder,
            &[&flags[..], &["--shard", shard, "--out", "a.exr"]].concat(),
        );
    }
    succeed(
        &folder,
        &["merge", "a.exr", "a.1-of-2.part", "a.2-of-2.part"],
    );
    assert_eq!(windows(&folder, "a.exr"), [whole, crop]);
    assert_eq!(
        channels(&folder, "a.exr"),
        channels(&folder, "out/render/head.exr")
    );
    render(&folder, &["head", "--spp", "1"]);
    assert_eq!(windows(&folder, "out/render/head.exr"), [whole, whole]);
}
