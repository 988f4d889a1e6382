//! Tests of files that are written here, read back, cut short, renamed and missing.

use super::*;
use exr::prelude::{
    Image, SpecificChannels, Vec2, WritableImage as _, write_rgb_file, write_rgba_file,
};
use std::path::{Path, PathBuf};

pub(super) fn directory() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary directory")
}

fn texel(x: usize, y: usize) -> [f32; 3] {
    [(1 + x) as f32, 0.5 * (1 + y) as f32, 0.25]
}

/// Writes a map of 16 x 8 texels, as Radiance HDR or `OpenEXR` by the ending of `name`.
fn write(dir: &Path, name: &str) -> PathBuf {
    let path = dir.join(name);
    if name.ends_with("hdr") {
        let rows = (0..8).flat_map(|y| scan_line(core::array::from_fn(|x| texel(x, y))));
        let bytes = b"#?RADIANCE\n\n-Y 8 +X 16\n".iter().copied().chain(rows);
        std::fs::write(&path, bytes.collect::<Vec<u8>>()).expect("written");
    } else {
        write_rgb_file(&path, 16, 8, |x, y| texel(x, y).into()).expect("written");
    }
    path
}

/// Returns a scan line of Radiance HDR, each of whose components is one stretch of literal bytes.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "mantissas and exponents are bytes"
)]
fn scan_line(pixels: [[f32; 3]; 16]) -> Vec<u8> {
    // The largest channel has a mantissa from 128 to 255.
    let rgbe = pixels.map(|rgb| {
        let exponent = rgb.into_iter().fold(0.0, f32::max).log2().floor() + 1.0;
        let [r, g, b] = rgb.map(|x| (x * (8.0 - exponent).exp2()) as u8);
        [r, g, b, (exponent + 128.0) as u8]
    });
    let component = |channel| {
        let bytes = rgbe.iter().map(move |pixel: &[u8; 4]| pixel[channel]);
        core::iter::once(16).chain(bytes)
    };
    [2, 2, 0, 16]
        .into_iter()
        .chain((0..4).flat_map(component))
        .collect()
}

#[test]
fn both_formats_read_back() {
    let dir = directory();
    for name in ["map.hdr", "map.exr"] {
        let map = Environment::load(write(dir.path(), name)).expect(name);
        assert_eq!((map.size(), map.name()), ([16, 8], name));
        assert!(map.notes().is_empty());
        for (x, y) in [(0_u8, 0_u8), (15, 7), (5, 2)] {
            let (theta, phi) = (
                PI * (f64::from(y) + 0.5) / 8.0,
                2.0 * PI * ((f64::from(x) + 0.5) / 16.0 - 0.5),
            );
            let got = map.radiance(DVec3::new(
                theta.sin() * phi.sin(),
                theta.cos(),
                -theta.sin() * phi.cos(),
            ));
            // The channels share an exponent and have eight bits of mantissa each: the error is half a step of the largest.
            let bound = if name.ends_with("hdr") {
                16.0 / 128.0
            } else {
                0.0
            };
            for (got, want) in got.iter().zip(texel(x.into(), y.into())) {
                assert!(
                    (got - f64::from(want)).abs() <= bound,
                    "{name} ({x}, {y}): {got} {want}"
                );
            }
        }
    }
}

#[test]
fn content_decides_and_alpha_is_ignored() {
    let dir = directory();
    let exr = write(dir.path(), "real.exr");
    let renamed = dir.path().join("renamed.hdr");
    std::fs::rename(exr, &renamed).expect("renamed");
    assert_eq!(
        Environment::load(&renamed)
            .expect("an EXR under another name")
            .size(),
        [16, 8]
    );
    let path = dir.path().join("alpha.exr");
    write_rgba_file(&path, 4, 2, |_, _| (1.0, 2.0, 3.0, 0.25)).expect("written");
    assert_eq!(
        Environment::load(&path).expect("alpha").radiance(DVec3::X),
        [1.0, 2.0, 3.0]
    );
}

#[test]
fn luminance_alone_is_a_grey_map() {
    let dir = directory();
    let path = dir.path().join("grey.exr");
    let luminance = |at: Vec2<usize>| (1.0 + at.x() as f32 + 10.0 * at.y() as f32,);
    let channels = SpecificChannels::build()
        .with_channel("Y")
        .with_pixel_fn(luminance);
    Image::from_channels((4, 2), channels)
        .write()
        .to_file(&path)
        .expect("written");
    let map = Environment::load(&path).expect("luminance");
    assert_eq!((map.size(), map.name()), ([4, 2], "grey.exr"));
    // The lower row, and the column to the right of the middle.
    assert_eq!(map.radiance(DVec3::new(0.1, -1.0, -0.2)), [13.0; 3]);
    let cut = dir.path().join("cut.exr");
    let bytes = std::fs::read(&path).expect("read");
    std::fs::write(&cut, &bytes[..bytes.len() - 5]).expect("written");
    one_line(&Environment::load(&cut).expect_err("cut"), &cut);
}

#[test]
fn bad_pixels_of_a_file_are_counted() {
    let dir = directory();
    let path = dir.path().join("bad.exr");
    let pixel = |x, _| match x {
        0 => (f32::NAN, -1.0, f32::INFINITY),
        _ => (1.0, 1.0, 1.0),
    };
    write_rgb_file(&path, 4, 2, pixel).expect("written");
    assert_eq!(
        Environment::load(&path).expect("repaired").repairs(),
        PixelRepairs {
            nan: 2,
            negative: 2,
            infinite: 2
        }
    );
}

#[test]
fn every_cut_is_an_error_and_no_panic() {
    let dir = directory();
    for name in ["map.hdr", "map.exr"] {
        let bytes = std::fs::read(write(dir.path(), name)).expect("read");
        let cut = dir.path().join(format!("cut-{name}"));
        for length in 0..bytes.len() {
            std::fs::write(&cut, &bytes[..length]).expect("written");
            let error = Environment::load(&cut)
                .expect_err(&format!("{name} cut to {length} of {}", bytes.len()));
            one_line(&error, &cut);
        }
    }
}

#[test]
fn damaged_bytes_never_panic() {
    // One byte at a time is set to 0, to 255 and to its complement: whatever loads must still be a valid light.
    let dir = directory();
    for name in ["map.hdr", "map.exr"] {
        let bytes = std::fs::read(write(dir.path(), name)).expect("read");
        let bad = dir.path().join(format!("bad-{name}"));
        for at in 0..bytes.len().min(600) {
            for value in [0, 255, !bytes[at]] {
                let mut copy = bytes.clone();
                copy[at] = value;
                std::fs::write(&bad, &copy).expect("written");
                match Environment::load(&bad) {
                    Ok(map) => assert!(
                        map.sample([0.5, 0.5]).pdf.is_finite(),
                        "{name} byte {at} = {value}"
                    ),
                    Err(error) => one_line(&error, &bad),
                }
            }
        }
    }
}

fn one_line(error: &LightError, path: &Path) {
    let text = error.to_string();
    assert!(
        !text.contains('\n')
            && text.starts_with(&path.display().to_string())
            && text.len() > path.display().to_string().len() + 10,
        "{text}"
    );
}

#[test]
fn each_refusal_says_why() {
    let dir = directory();
    let missing = dir.path().join("missing.hdr");
    let error = Environment::load(&missing).expect_err("missing");
    assert!(error.to_string().contains("cannot read"), "{error}");
    one_line(&error, &missing);
    let error = Environment::load(dir.path()).expect_err("directory");
    assert!(
        error.to_string().ends_with("is a directory, not a picture"),
        "{error}"
    );
    one_line(&error, dir.path());
    let cases: [(&str, &[u8], &str); 7] = [
        (
            "zero.hdr",
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 16\n",
            "from 1 to 2^25 pixels, got 16 x 0",
        ),
        (
            "huge.hdr",
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65536 +X 65536\n",
            "2^25",
        ),
        ("text.hdr", b"hello, this is no picture", "unsupported"),
        ("empty.exr", b"", "empty"),
        ("notes.txt", b"hello, this is no picture", "unsupported"),
        (
            "picture.png",
            b"\x89PNG\r\n\x1a\n0000000000000000",
            "unsupported",
        ),
        (
            "picture.hdr",
            b"\x89PNG\r\n\x1a\n0000000000000000",
            "unsupported",
        ),
    ];
    for (name, bytes, want) in cases {
        let path = dir.path().join(name);
        std::fs::write(&path, bytes).expect("written");
        let error = Environment::load(&path).expect_err(name);
        assert!(error.to_string().contains(want), "{name}: {error}");
        one_line(&error, &path);
    }
}
