//! Tests of `OpenEXR` maps as compositors and renderers write them: layers, windows, primaries.

use super::files::directory;
use super::*;
use exr::meta::attribute::{Chromaticities, EnvironmentMap};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, ImageAttributes,
    IntegerBounds, Layer, LayerAttributes, LineOrder, Text, Vec2, WritableImage as _, f16,
};
use std::path::{Path, PathBuf};

/// Width and height of the data.
const SIZE: [usize; 2] = [4, 2];
/// Chromaticities of red, green, blue and white: ACES AP1, AP0, DCI-P3 with D65, Rec. 2020.
const AP1: [[f32; 2]; 4] = [
    [0.713, 0.293],
    [0.165, 0.83],
    [0.128, 0.044],
    [0.32168, 0.33767],
];
const AP0: [[f32; 2]; 4] = [
    [0.7347, 0.2653],
    [0.0, 1.0],
    [0.0001, -0.077],
    [0.32168, 0.33767],
];
const P3: [[f32; 2]; 4] = [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], [0.3127, 0.329]];
const REC_2020: [[f32; 2]; 4] = [
    [0.708, 0.292],
    [0.17, 0.797],
    [0.131, 0.046],
    [0.3127, 0.329],
];
const REC_709: [[f32; 2]; 4] = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.31271, 0.32902]];

type Channel = AnyChannel<FlatSamples>;
type Part = Layer<AnyChannels<FlatSamples>>;

fn channel(name: &str, samples: FlatSamples) -> Channel {
    // Names are bytes, UTF-8 by custom.
    AnyChannel::new(Text::from_slice_unchecked(name.as_bytes()), samples)
}

/// Returns a channel whose samples are `value` plus 10 times the row plus the column.
fn ramp(name: &str, value: f32) -> Channel {
    let [width, height] = SIZE;
    let sample = |k: usize| value + (10 * (k / width) + k % width) as f32;
    channel(
        name,
        FlatSamples::F32((0..width * height).map(sample).collect()),
    )
}

fn flat(name: &str, value: f32) -> Channel {
    channel(name, FlatSamples::F32(vec![value; SIZE[0] * SIZE[1]]))
}

/// Returns channels R, G and B with a prefix; layers differ by `value`.
fn rgb(prefix: &str, value: f32) -> Vec<Channel> {
    let names = ["R", "G", "B"].into_iter().zip([0.0, 100.0, 200.0]);
    names
        .map(|(name, more)| ramp(&format!("{prefix}{name}"), value + more))
        .collect()
}

/// Returns channels that have one value each.
fn flats<const N: usize>(names: [&str; N], values: [f32; N]) -> Vec<Channel> {
    names
        .into_iter()
        .zip(values)
        .map(|(name, value)| flat(name, value))
        .collect()
}

fn part(name: &str, channels: Vec<Channel>) -> Part {
    let attributes = LayerAttributes {
        layer_name: Some(Text::from(name)).filter(|_| !name.is_empty()),
        ..LayerAttributes::default()
    };
    let channels = AnyChannels::sort(channels.into_iter().collect());
    Layer::new(
        (SIZE[0], SIZE[1]),
        attributes,
        Encoding::SMALL_LOSSLESS,
        channels,
    )
}

struct Files(tempfile::TempDir);

impl Files {
    fn new() -> Self {
        Self(directory())
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("map.exr")
    }

    fn write(&self, parts: Vec<Part>, edit: impl FnOnce(&mut ImageAttributes)) -> PathBuf {
        let mut attributes = ImageAttributes::with_size((SIZE[0], SIZE[1]));
        edit(&mut attributes);
        let image = Image::from_layers(attributes, parts);
        image.write().to_file(self.path()).expect("written");
        self.path()
    }

    fn one(&self, channels: Vec<Channel>) -> PathBuf {
        self.write(vec![part("", channels)], |_| {})
    }

    fn with_primaries(&self, channels: Vec<Channel>, primaries: [[f32; 2]; 4]) -> PathBuf {
        let [red, green, blue, white] = primaries.map(|[x, y]| Vec2(x, y));
        let chromaticities = Chromaticities {
            red,
            green,
            blue,
            white,
        };
        let edit =
            |attributes: &mut ImageAttributes| attributes.chromaticities = Some(chromaticities);
        self.write(vec![part("", channels)], edit)
    }

    /// Replaces the first `old` among the bytes of the file.
    fn replace(&self, old: &[u8], new: &[u8]) {
        let bytes = std::fs::read(self.path()).expect("read");
        let at = bytes
            .windows(old.len())
            .position(|window| window == old)
            .expect("there");
        let bytes = [&bytes[..at], new, &bytes[at + old.len()..]].concat();
        std::fs::write(self.path(), bytes).expect("written");
    }
}

/// Loads the map of a file, with its notes.
fn load(path: &Path, layer: Option<&str>) -> Result<(Environment, Vec<String>), String> {
    let map = Environment::load_layer(path, layer).map_err(|error| error.to_string())?;
    let notes = map.notes();
    Ok((map, notes))
}

fn digest(path: &Path, layer: Option<&str>) -> u64 {
    load(path, layer).expect("a map").0.digest()
}

fn refused(path: &Path, layer: Option<&str>) -> String {
    let error = load(path, layer).expect_err("refused");
    assert!(
        !error.contains('\n') && !error.contains("damaged"),
        "{error}"
    );
    error
}

fn near(got: [f64; 3], want: [f64; 3], bound: f64) {
    let is_near = got
        .iter()
        .zip(want)
        .all(|(got, want)| (got - want).abs() <= bound);
    assert!(is_near, "{got:?}, expected {want:?}");
}

/// Returns the colour of a map that has one colour.
fn colour(map: &Environment) -> [f64; 3] {
    map.radiance(DVec3::new(0.3, -0.5, 0.7))
}

#[test]
fn the_only_layer_with_colour_is_read() {
    let files = Files::new();
    let plain = digest(&files.one(rgb("", 1.0)), None);
    for prefix in ["", ".", "rgba.", "ViewLayer.Combined.", "日本."] {
        let mut channels = rgb(prefix, 1.0);
        channels.extend([flat(&format!("{prefix}A"), 0.5), flat("Depth.Z", 9.0)]);
        channels.extend(flats(
            ["Vector.X", "Vector.Y", "Vector.Z", "Vector.W"],
            [9.0; 4],
        ));
        channels.extend(flats(["Normal.X", "Normal.Y", "Normal.Z"], [9.0; 3]));
        let (map, notes) = load(&files.one(channels), None).expect(prefix);
        assert_eq!(map.digest(), plain, "{prefix}");
        let wanted: Vec<String> = match prefix.trim_end_matches('.') {
            "" => Vec::new(),
            name => vec![format!("map.exr: layer {name}")],
        };
        assert_eq!(notes, wanted);
    }
    let long = ["red", "green", "blue"]
        .into_iter()
        .zip([1.0, 101.0, 201.0]);
    let channels = long.map(|(name, value)| ramp(&format!("beauty.{name}"), value));
    assert_eq!(digest(&files.one(channels.collect()), None), plain);
}

#[test]
fn several_layers_need_a_name() {
    let files = Files::new();
    let [direct, indirect] = [1.0, 2.0].map(|value| digest(&files.one(rgb("", value)), None));
    let both = || [rgb("direct.", 1.0), rgb("indirect.", 2.0)].concat();
    let parts = || ["direct", "indirect"].into_iter().zip([1.0, 2.0]);
    for parts in [
        vec![part("", both())],
        parts()
            .map(|(name, value)| part(name, rgb("", value)))
            .collect(),
        parts()
            .map(|(name, value)| part(name, rgb(&format!("{name}."), value)))
            .collect(),
    ] {
        let path = files.write(parts, |_| {});
        assert_eq!(digest(&path, Some("direct")), direct);
        assert_eq!(digest(&path, Some("indirect")), indirect);
        let error = refused(&path, None);
        for words in ["--layer NAME", "direct (", "indirect ("] {
            assert!(error.contains(words), "{error}");
        }
        let error = refused(&path, Some("diffuse"));
        assert!(error.contains("got diffuse; it has direct ("), "{error}");
    }
    // The picture itself has no name, beside its layers.
    let path = files.one([rgb("", 1.0), rgb("albedo.", 2.0)].concat());
    assert_eq!(
        [digest(&path, None), digest(&path, Some("albedo"))],
        [direct, indirect]
    );
    let error = refused(&files.one(flats(["depth.Z", "A", "RY"], [1.0; 3])), None);
    assert!(
        error.contains("unsupported") && error.ends_with("got A, RY, depth.Z"),
        "{error}"
    );
}

#[test]
fn xyz_is_converted_and_no_grey() {
    let files = Files::new();
    for (xyz, want) in [
        ([0.950_456, 1.0, 1.089_058], [1.0; 3]),
        ([0.412_391, 0.212_639, 0.019_331], [1.0, 0.0, 0.0]),
    ] {
        let (map, notes) = load(&files.one(flats(["X", "Y", "Z"], xyz)), None).expect("XYZ");
        near(colour(&map), want, 2e-5);
        assert!(
            notes[0].ends_with("converted from XYZ to Rec. 709"),
            "{notes:?}"
        );
    }
    // Depth beside luminance.
    let path = files.one(flats(["Y", "Z"], [0.5, 9.0]));
    assert_eq!(colour(&load(&path, None).expect("grey").0), [0.5; 3]);
}

#[test]
fn luminance_and_chroma_are_converted() {
    let files = Files::new();
    let rgb = [0.2_f32, 0.6, 0.3];
    let y = 0.212_639 * rgb[0] + 0.715_169 * rgb[1] + 0.072_192 * rgb[2];
    let channels = flats(["RY", "Y", "BY"], [rgb[0] / y - 1.0, y, rgb[2] / y - 1.0]);
    let (map, _) = load(&files.one(channels), None).expect("chroma");
    near(colour(&map), rgb.map(f64::from), 1e-6);
    // Each block of two by two pixels shares a number of the chroma channels.
    let mut channel = b"BY\0\x02\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\0\0".to_vec();
    let full = channel.clone();
    (channel[11], channel[15]) = (2, 2);
    files.replace(&full, &channel);
    let error = refused(&files.path(), None);
    assert!(
        error.contains("unsupported: subsampled channels, BY of 2 x 2"),
        "{error}"
    );
}

#[test]
fn the_display_window_is_the_map() {
    let files = Files::new();
    let [width, height] = SIZE;
    let display = |x: i32, y: i32, width: usize, height: usize| {
        move |attributes: &mut ImageAttributes| {
            attributes.display_window = IntegerBounds::new((x, y), (width, height));
        }
    };
    let at = |x: i32, y: i32, channels: Vec<Channel>| {
        let mut part = part("", channels);
        part.attributes.layer_position = Vec2(x, y);
        vec![part]
    };
    for channels in [rgb("", 1.0), vec![ramp("Y", 1.0)]] {
        let whole = load(&files.one(channels.clone()), None).expect("whole").0;
        let texel = |map: &Environment, x: usize, y: usize| {
            let [width, height] = map.size();
            let turn = 2.0 * PI * ((x as f64 + 0.5) / width as f64 - 0.5);
            let polar = PI * (y as f64 + 0.5) / height as f64;
            let across = DVec3::new(turn.sin(), 0.0, -turn.cos());
            map.radiance(polar.sin() * across + polar.cos() * DVec3::Y)
        };
        // Within: the data covers columns 3 to 6 and rows 1 to 2 of 8 x 4, wherever the origin is.
        for (x, y) in [(0, 0), (-5, 7)] {
            let parts = at(x + 3, y + 1, channels.clone());
            let (map, notes) =
                load(&files.write(parts, display(x, y, 8, 4)), None).expect("within");
            assert_eq!(map.size(), [8, 4]);
            for (column, row) in (0..8).flat_map(|x| (0..4).map(move |y| (x, y))) {
                let is_data = (3..3 + width).contains(&column) && (1..1 + height).contains(&row);
                let want = if is_data {
                    texel(&whole, column - 3, row - 1)
                } else {
                    [0.0; 3]
                };
                assert_eq!(texel(&map, column, row), want, "{column} {row}");
            }
            assert!(
                notes[0].contains(
                    "4 x 2 pixels from 3 1, covers a part of the display window, 8 x 4: black"
                ),
                "{notes:?}"
            );
        }
        // Overscan: two columns of the lower row.
        let parts = at(-1, -1, channels.clone());
        let (map, notes) = load(&files.write(parts, display(0, 0, 2, 1)), None).expect("overscan");
        assert_eq!(
            [texel(&map, 0, 0), texel(&map, 1, 0)],
            [1, 2].map(|x| texel(&whole, x, 1))
        );
        assert!(notes.is_empty(), "{notes:?}");
        let error = refused(&files.write(at(8, 0, channels), display(0, 0, 8, 4)), None);
        assert!(
            error.contains("must overlap the display window, 8 x 4"),
            "{error}"
        );
    }
}

#[test]
fn primaries_are_converted_to_rec_709() {
    let files = Files::new();
    let names = ["R", "G", "B"];
    // A white of D60 keeps its chromaticity, and so does the white of other primaries with D65.
    for (primaries, rgb, want) in [
        (AP1, [0.299, 0.467, 0.345], [0.207, 0.488, 0.302]),
        (AP1, [1.0; 3], [1.047, 0.994, 0.915]),
        (AP0, [1.0; 3], [1.047, 0.994, 0.915]),
        (P3, [1.0; 3], [1.0; 3]),
        (P3, [0.822_462, 0.033_194, 0.017_083], [1.0, 0.0, 0.0]),
        (REC_2020, [1.0; 3], [1.0; 3]),
        (REC_2020, [0.627_404, 0.069_097, 0.016_391], [1.0, 0.0, 0.0]),
    ] {
        let (map, notes) =
            load(&files.with_primaries(flats(names, rgb), primaries), None).expect("RGB");
        near(colour(&map), want, 1e-3);
        assert!(
            notes[0].contains("converted to Rec. 709 from the primaries"),
            "{notes:?}"
        );
    }
    let bits = digest(&files.one(rgb("", 1.0)), None);
    let (map, notes) = load(&files.with_primaries(rgb("", 1.0), REC_709), None).expect("Rec. 709");
    assert_eq!(
        (map.digest(), notes),
        (bits, Vec::new()),
        "rounded chromaticities"
    );
    // The sun of a half float, and no NaN out of a difference of infinities.
    let path = files.with_primaries(flats(names, [f32::INFINITY; 3]), AP1);
    let (map, notes) = load(&path, None).expect("infinite");
    assert!(colour(&map)[1] > 6e4 && map.repairs().nan == 0, "{map:?}");
    assert!(
        notes[0].contains("24 infinite channels set to 65504"),
        "{notes:?}"
    );
    for primaries in [
        [[0.0; 2]; 4],
        [AP1[0], AP1[1], AP1[1], AP1[3]],
        [[f32::NAN; 2]; 4],
    ] {
        let error = refused(&files.with_primaries(rgb("", 1.0), primaries), None);
        assert!(
            error.contains("chromaticities must span a triangle"),
            "{error}"
        );
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "ramps hold whole numbers, from 0"
)]
fn whole_numbers(samples: &[f32]) -> FlatSamples {
    FlatSamples::U32(samples.iter().map(|sample| *sample as u32).collect())
}

#[test]
fn every_type_of_sample_and_block_is_read() {
    let files = Files::new();
    let bits = digest(&files.one(rgb("", 1.0)), None);
    let [half, whole]: [fn(&[f32]) -> FlatSamples; 2] = [
        |samples| FlatSamples::F16(samples.iter().copied().map(f16::from_f32).collect()),
        whole_numbers,
    ];
    for convert in [[half; 3], [whole; 3], [half, whole, half]] {
        let mut channels = rgb("", 1.0);
        for (channel, convert) in channels.iter_mut().zip(convert) {
            if let FlatSamples::F32(samples) = &channel.sample_data {
                channel.sample_data = convert(samples);
            }
        }
        assert_eq!(digest(&files.one(channels), None), bits);
    }
    let tiles = Encoding {
        compression: Compression::PIZ,
        blocks: Blocks::Tiles(Vec2(3, 1)),
        line_order: LineOrder::Unspecified,
    };
    for encoding in [Encoding::UNCOMPRESSED, Encoding::FAST_LOSSLESS, tiles] {
        let mut tiled = part("", rgb("", 1.0));
        tiled.encoding = encoding;
        assert_eq!(digest(&files.write(vec![tiled], |_| {}), None), bits);
    }
}

#[test]
fn what_is_not_supported_is_named() {
    let files = Files::new();
    let path = files.one(rgb("", 1.0));
    // The flag of files with one part, and the type of a part among several.
    files.replace(b"\x76\x2f\x31\x01\x02\0", b"\x76\x2f\x31\x01\x02\x08");
    assert!(refused(&path, None).contains("unsupported: deep data"));
    files.one(rgb("", 1.0));
    files.replace(b"\x0d\0\0\0scanlineimage", b"\x0c\0\0\0deepscanline");
    assert!(refused(&path, None).contains("unsupported: deep data"));
    let mut cube = part("", rgb("", 1.0));
    cube.attributes.environment_map = Some(EnvironmentMap::Cube);
    let error = refused(&files.write(vec![cube], |_| {}), None);
    assert!(error.contains("unsupported: a cube map"), "{error}");
    files.with_primaries(rgb("", 1.0), AP1);
    files.replace(b"\0chromaticities\0\x20\0\0\0", b"\0floats\0\x20\0\0\0");
    let error = refused(&path, None);
    assert!(
        error.contains("chromaticities is of another type"),
        "{error}"
    );
}
