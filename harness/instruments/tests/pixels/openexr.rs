//! Tests of `OpenEXR` files as pictures: windows, text, and the compressions that are not read.

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, ImageAttributes,
    IntegerBounds, Layer, LayerAttributes, Text, WritableImage as _,
};
use hairis_instruments::pixels::{LayerFlag, Pixels};
use std::fs;

const HEAD: &[u8] = b"compression\0compression\0\x01\0\0\0";

/// Returns a file of parts of 4 x 2 pixels with this corner in a display window of 6 x 5 pixels. Red is the place of a pixel, from 0.
fn file(names: &[&str], corner: (i32, i32)) -> Vec<u8> {
    let part = |name: &&str| {
        let channel = |(name, value): (&str, f32)| {
            let samples = (0..8_u8).map(|k| value + f32::from(k)).collect();
            AnyChannel::new(name, FlatSamples::F32(samples))
        };
        let channels = [("R", 0.0), ("G", 10.0), ("B", 20.0)].map(channel);
        let mut attributes = LayerAttributes::named(*name);
        attributes.layer_position = corner.into();
        let text = AttributeValue::Text(Text::from("compression\\0 depth=2"));
        attributes.other.insert("run".into(), text);
        let channels = AnyChannels::sort(channels.into_iter().collect());
        Layer::new((4, 2), attributes, Encoding::SMALL_LOSSLESS, channels)
    };
    let attributes = ImageAttributes::new(IntegerBounds::new((0, 0), (6, 5)));
    let parts: Vec<_> = names.iter().map(part).collect();
    let image = Image::from_layers(attributes, parts);
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).expect("written");
    bytes.into_inner()
}

/// Changes the number of the compression of a part.
fn with_compression(mut file: Vec<u8>, part: usize, number: u8) -> Vec<u8> {
    let heads = file.windows(HEAD.len()).enumerate();
    let mut heads = heads.filter(|(_, bytes)| *bytes == HEAD);
    let (start, _) = heads.nth(part).expect("a part");
    file[start + HEAD.len()] = number;
    file
}

fn read(file: &[u8], name: Option<&str>) -> Result<Pixels, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.exr");
    fs::write(&path, file).expect("written");
    let flag = "--picture-layer";
    Pixels::read(&path, LayerFlag { flag, name }, 1 << 10)
}

#[test]
fn pixels_are_those_of_the_data_within_the_display_window() {
    for (corner, expected, first) in [
        ((1, 2), [[1, 2], [4, 2]], 0.0),
        ((4, 4), [[4, 4], [2, 1]], 0.0),
        ((-3, -1), [[0, 0], [1, 1]], 7.0),
        ((-3, 0), [[0, 0], [1, 2]], 3.0),
    ] {
        let pixels = read(&file(&["a"], corner), None).expect("a picture");
        assert_eq!(
            (pixels.size, [pixels.corner, pixels.extent]),
            ([6, 5], expected)
        );
        assert_eq!(
            pixels.values[0],
            [first, first + 10.0, first + 20.0],
            "{corner:?}"
        );
        assert_eq!(pixels.values.len(), pixels.extent[0] * pixels.extent[1]);
    }
    let run = read(&file(&["a"], (0, 0)), None)
        .expect("a picture")
        .texts
        .remove("run");
    assert_eq!(run.as_deref(), Some("compression\\0 depth=2"));
    for corner in [(6, 0), (0, 5), (-4, 0), (0, -2)] {
        let error = read(&file(&["a"], corner), None).expect_err("nothing shows");
        assert!(
            error.contains("must overlap the display window, 6 x 5"),
            "{error}"
        );
    }
}

#[test]
fn the_flag_of_the_layer_is_named() {
    let two = file(&["a", "b"], (0, 0));
    let error = read(&two, None).expect_err("two layers");
    assert_eq!(
        error,
        "several layers have colour, choose one by --picture-layer NAME: a (R G B), b (R G B)"
    );
    let error = read(&two, Some("c")).expect_err("no such layer");
    assert!(
        error.starts_with("--picture-layer must be a layer with colour"),
        "{error}"
    );
    let pixels = read(&two, Some("b")).expect("a layer");
    assert_eq!(pixels.remarks, ["layer b"]);
}

#[test]
fn compressions_that_are_not_read_are_named() {
    for (number, name) in [
        (10, "the compression htj2k256"),
        (11, "the compression htj2k32"),
        (12, "the compression lj2k"),
        (13, "the compression zstd"),
        (14, "an unknown compression, number 14"),
        (255, "an unknown compression, number 255"),
    ] {
        let expected = format!("unsupported: {name}; write the file with zip");
        let one = with_compression(file(&["a"], (0, 0)), 0, number);
        assert_eq!(read(&one, None).expect_err(name), expected);
        for part in [0, 1] {
            let two = with_compression(file(&["a", "b"], (0, 0)), part, number);
            let layer = ["a", "b"][part];
            assert_eq!(read(&two, Some(layer)).expect_err(name), expected);
            // Of another part, the decoder knows the names, but not the numbers beyond.
            let other = read(&two, Some(["b", "a"][part]));
            assert_eq!(other.is_ok(), number < 12, "{name}: {other:?}");
        }
    }
    let cut = with_compression(file(&["a"], (0, 0)), 0, 10);
    for length in 0..cut.len() {
        let error = read(&cut[..length], None).expect_err("cut short");
        assert!(!error.contains('\n'), "{error}");
    }
}
