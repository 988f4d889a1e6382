//! Radiance HDR as the lights read it, against the decoder of the crate that writes pictures.

use hairis_instruments::light::Environment;
use hairis_instruments::sequence::Independent;
use image::DynamicImage;
use image::codecs::hdr::HdrDecoder;

/// Writes a scan line as encoders may, or with a fault: components in runs, or whole pixels with runs of the first format.
fn line(xi: &mut Independent, length: usize) -> Vec<u8> {
    let mut draw = |below: u8| to_byte(xi.next_f64() * f64::from(below));
    let mut line = Vec::new();
    if draw(2) == 0 {
        line.extend([2, 2, draw(127), draw(255)]);
        for _ in 0..4 {
            let mut left = length;
            while left > 0 {
                // A few runs are longer than what is left.
                let most = if draw(250) == 0 { 128 } else { left.min(127) };
                let count = 1 + draw(u8::try_from(most).expect("below 129"));
                left = left.saturating_sub(usize::from(count));
                if draw(2) == 0 && count < 128 {
                    line.extend([128 + count, draw(255)]);
                } else {
                    line.push(count);
                    line.extend((0..count).map(|_| draw(255)));
                }
            }
        }
    } else {
        let mut left = length;
        while left > 0 {
            let kind = draw(8);
            if kind < 2 && (left < length || draw(50) == 0) {
                let most = if draw(100) == 0 { 80 } else { left.min(40) };
                let count = draw(1 + u8::try_from(most).expect("below 81"));
                line.extend([1, 1, 1, count]);
                left = left.saturating_sub(usize::from(count).max(1));
            } else {
                line.extend([3 + draw(250), draw(255), draw(255), draw(255)]);
                left -= 1;
            }
        }
    }
    line
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a number from 0 to 255"
)]
fn to_byte(x: f64) -> u8 {
    x as u8
}

#[test]
fn pixels_are_those_of_another_decoder() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let path = folder.path().join("map.hdr");
    let mut xi = Independent::new(31, 0);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..3_000 {
        let length = 1 + usize::from(to_byte(80.0 * xi.next_f64()));
        let lines = 1 + usize::from(to_byte(3.0 * xi.next_f64()));
        let mut pixels: Vec<u8> = (0..lines).flat_map(|_| line(&mut xi, length)).collect();
        if xi.next_f64() < 0.1 {
            pixels.pop();
        }
        let header = format!("#?RADIANCE\n\n-Y {lines} +X {length}\n");
        let bytes = [header.as_bytes(), &pixels].concat();
        let expected = HdrDecoder::new(&bytes[..]).and_then(DynamicImage::from_decoder);
        std::fs::write(&path, &bytes).expect("written");
        match (Environment::load(&path), expected) {
            (Ok(map), Ok(image)) => {
                let pixels = image.to_rgb32f().pixels().map(|pixel| pixel.0).collect();
                let expected = Environment::from_pixels("map", length, lines, pixels);
                assert_eq!(map.digest(), expected.expect("a map").digest(), "{bytes:?}");
                read += 1;
            }
            (Err(error), Err(_)) => {
                let error = error.to_string();
                assert!(error.contains("damaged or cut short"), "{error}");
                refused += 1;
            }
            (ours, theirs) => panic!("{ours:?}, {theirs:?}: {bytes:?}"),
        }
    }
    assert!(
        read > 1_000 && refused > 300,
        "{read} read, {refused} refused"
    );
}
