//! Tests of Radiance HDR as programs write it: signatures, exposures, orders of pixels, runs.

use super::files::directory;
use super::*;

/// Returns a pixel of a map of 4 x 2 texels: three mantissas, and an exponent that doubles them.
fn bytes(x: u8, y: u8) -> [u8; 4] {
    [200, 10 * x, 100 + 10 * y, 137]
}

/// Returns the radiance of the pixel whose [`bytes`] are written.
fn radiance(x: u8, y: u8) -> [f64; 3] {
    let [r, g, b, _] = bytes(x, y);
    [r, g, b].map(|mantissa| 2.0 * f64::from(mantissa))
}

/// Returns the bytes of all pixels, row by row from the upper left corner.
fn rows() -> Vec<u8> {
    (0..2)
        .flat_map(|y| (0..4).flat_map(move |x| bytes(x, y)))
        .collect()
}

fn load(header: &str, pixels: &[u8]) -> Result<(Environment, Vec<String>), String> {
    let folder = directory();
    let path = folder.path().join("map.hdr");
    std::fs::write(&path, [header.as_bytes(), pixels].concat()).expect("written");
    let map = Environment::load(&path).map_err(|error| error.to_string())?;
    let notes = map.notes();
    Ok((map, notes))
}

fn texel(map: &Environment, x: u8, y: u8) -> [f64; 3] {
    let turn = 2.0 * PI * ((f64::from(x) + 0.5) / 4.0 - 0.5);
    let polar = PI * (f64::from(y) + 0.5) / 2.0;
    let across = DVec3::new(turn.sin(), 0.0, -turn.cos());
    map.radiance(polar.sin() * across + polar.cos() * DVec3::Y)
}

/// Loads a map whose header has these `lines` before the resolution.
fn with(lines: &str) -> Result<(Environment, Vec<String>), String> {
    load(&format!("{lines}\n\n-Y 2 +X 4\n"), &rows())
}

fn assert_near(got: [f64; 3], want: [f64; 3]) {
    let is_near = |(got, want): (&f64, f64)| (got - want).abs() <= 1e-5 * want.abs() + 1e-9;
    assert!(
        got.iter().zip(want).all(is_near),
        "{got:?}, expected {want:?}"
    );
}

#[test]
fn every_program_has_a_signature() {
    for lines in [
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe",
        "#?RGBE\nFORMAT=32-bit_rle_rgbe",
        "#?AUTOPANO",
        "#?RADIANCE # signature\n # EXPOSURE=2\nEXPOSURE=1 # none\nCOLORCORR=1 1 1# none\nFORMAT=32-bit_rle_rgbe # FORMAT=x",
        "#?RADIANCE\r\n# a comment\r\nFORMAT=32-bit_rle_rgbe\r\nGAMMA=1.0\r\n\r",
    ] {
        let (map, notes) = load(
            &format!("{}\n\n-Y 2 +X 4\n", lines.trim_end_matches("\n\r")),
            &rows(),
        )
        .unwrap_or_else(|error| panic!("{lines:?}: {error}"));
        for (x, y) in (0..4).flat_map(|x| (0..2).map(move |y| (x, y))) {
            assert_eq!(texel(&map, x, y), radiance(x, y), "{lines:?}");
        }
        assert!(notes.is_empty(), "{notes:?}");
    }
}

#[test]
fn exposures_are_divided_out() {
    let (map, notes) =
        with("#?RADIANCE\nEXPOSURE=4\nEXPOSURE= 0.5\n\tEXPOSURE=7\nVIEW= -vf x").expect("valid");
    assert_near(texel(&map, 3, 1), radiance(3, 1).map(|x| x / 2.0));
    assert!(
        notes[0].contains("EXPOSURE and COLORCORR of the file, 2 2 2"),
        "{notes:?}"
    );
    let (map, _) = with("#?RADIANCE\nCOLORCORR=1 2 4\nEXPOSURE=2\nCOLORCORR=1 2 1").expect("valid");
    let [r, g, b] = radiance(3, 1);
    assert_near(texel(&map, 3, 1), [r / 2.0, g / 8.0, b / 8.0]);
}

#[test]
fn colours_are_converted() {
    let xyz = DVec3::from(radiance(2, 1));
    let (map, notes) = with("#?RADIANCE\nFORMAT=32-bit_rle_xyze").expect("XYZ");
    // IEC 61966-2-1.
    let rgb = [
        DVec3::new(3.240_970, -1.537_383, -0.498_611).dot(xyz),
        DVec3::new(-0.969_244, 1.875_968, 0.041_555).dot(xyz),
        DVec3::new(0.055_630, -0.203_977, 1.056_972).dot(xyz),
    ];
    assert!(
        rgb.iter().all(|channel| *channel > 0.0 || *channel < -1.0),
        "{rgb:?}"
    );
    assert_near(texel(&map, 2, 1), rgb.map(|channel| channel.max(0.0)));
    assert!(notes[0].contains("from XYZ to Rec. 709"), "{notes:?}");
    // Rec. 2020 keeps the white of Rec. 709, and its luminance.
    let (map, _) =
        with("#?RADIANCE\nPRIMARIES=.708 .292 .17 .797 .131 .046 .3127 .329").expect("Rec. 2020");
    let [r, g, b] = radiance(2, 1);
    let [red, ..] = texel(&map, 2, 1);
    assert_near([red; 3], [1.660_491 * r - 0.587_641 * g - 0.072_850 * b; 3]);
    let same = with("#?RADIANCE\nPRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290")
        .expect("Rec. 709");
    assert_eq!((texel(&same.0, 2, 1), same.1), (radiance(2, 1), Vec::new()));
}

#[test]
fn all_orders_of_pixels_are_turned() {
    for (order, place) in [
        (
            "-Y 2 +X 4",
            (|line, along| (along, line)) as fn(u8, u8) -> (u8, u8),
        ),
        ("-Y 2 -X 4", |line, along| (3 - along, line)),
        ("+Y 2 +X 4", |line, along| (along, 1 - line)),
        ("+Y 2 -X 4", |line, along| (3 - along, 1 - line)),
        ("+X 4 -Y 2", |line, along| (line, along)),
        ("-X 4 -Y 2", |line, along| (3 - line, along)),
        ("+X 4 +Y 2", |line, along| (line, 1 - along)),
        ("-X 4 +Y 2", |line, along| (3 - line, 1 - along)),
    ] {
        let (lines, along) = if order.as_bytes()[1] == b'Y' {
            (2, 4)
        } else {
            (4, 2)
        };
        let mut pixels = Vec::new();
        for (line, k) in (0..lines).flat_map(|line| (0..along).map(move |k| (line, k))) {
            let (x, y) = place(line, k);
            pixels.extend(bytes(x, y));
        }
        let (map, _) = load(&format!("#?RADIANCE\n\n{order}\n"), &pixels).expect(order);
        assert_eq!(map.size(), [4, 2]);
        for (x, y) in (0..4).flat_map(|x| (0..2).map(move |y| (x, y))) {
            assert_eq!(texel(&map, x, y), radiance(x, y), "{order}: {x} {y}");
        }
    }
}

#[test]
fn runs_of_both_kinds_are_read() {
    // A row of one colour, written as a pixel with its number of repetitions, and by component.
    let [r, g, b, e] = bytes(1, 1);
    let old = [r, g, b, e, 1, 1, 1, 3].repeat(2);
    let component = |byte| [128 + 4, byte];
    let new = [
        vec![2, 2, 0, 4],
        bytes(1, 1).into_iter().flat_map(component).collect(),
    ]
    .concat()
    .repeat(2);
    for pixels in [old, new] {
        let (map, _) = load("#?RADIANCE\n\n-Y 2 +X 4\n", &pixels).expect("runs");
        assert!((0..4).all(|x| texel(&map, x, 1) == radiance(1, 1)));
    }
}

#[test]
fn headers_that_cannot_be_used_are_refused() {
    for (lines, words) in [
        (
            "#?RADIANCE\nFORMAT=32-bit_rle_cmyk",
            "unsupported: FORMAT=32-bit_rle_cmyk",
        ),
        ("#?RADIANCE\nGAMMA=2.2", "unsupported: GAMMA=2.2"),
        (
            "#?RADIANCE\nEXPOSURE=0",
            "EXPOSURE must be a number above 0, got 0",
        ),
        (
            "#?RADIANCE\nEXPOSURE=bright",
            "EXPOSURE must be a number above 0, got bright",
        ),
        (
            "#?RADIANCE\nCOLORCORR=1 1",
            "COLORCORR must be 3 numbers above 0, got 1 1",
        ),
        (
            "#?RADIANCE\nPRIMARIES=0 0 0 0 0 0 0 0",
            "chromaticities must span a triangle",
        ),
    ] {
        let error = with(lines).expect_err(lines);
        assert!(error.contains(words) && !error.contains('\n'), "{error}");
    }
    for resolution in ["-Y 2", "-Y 2 +Y 4", "-Y two +X 4", "-Z 2 +X 4"] {
        let error = load(&format!("#?RADIANCE\n\n{resolution}\n"), &rows()).expect_err(resolution);
        assert!(error.contains("must be like -Y 512 +X 1024"), "{error}");
    }
    let folder = directory();
    let path = folder.path().join("map.hdr");
    std::fs::write(&path, [b"#?RADIANCE\n\n-Y 2 +X 4\n", &rows()[..]].concat()).expect("written");
    let error = Environment::load_layer(&path, Some("beauty"))
        .expect_err("no layers")
        .to_string();
    assert!(error.contains("leave out --layer beauty"), "{error}");
}
