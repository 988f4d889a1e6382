//! Pictures as files: `OpenEXR` for measurements, and PNG for previews.

use crate::film::Picture;
use crate::layers::Beside;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, IntegerBounds, Layer,
    LayerAttributes, Text, Vec2, WritableImage as _,
};
use hairis_instruments::error::Error;
use hairis_instruments::files::whole;
use hairis_instruments::light::luminance;
use hairis_instruments::stats::percentile;
use image::{ExtendedColorType, ImageEncoder as _, RgbImage};
use std::io::{self, Cursor, Write as _};
use std::path::Path;

/// Share of the pixels that are not black whose luminance a preview shows below [`BRIGHT`].
const MOST: f64 = 0.95;
/// Display luminance, of 1, of the pixel at that share.
pub const BRIGHT: f64 = 0.7;

/// Returns the factor on radiance that makes a preview neither dark nor white.
#[must_use]
pub fn exposure(picture: &Picture) -> f64 {
    let mut luminances: Vec<f64> = picture
        .luminances()
        .into_iter()
        .filter(|l| *l > 1e-6)
        .collect();
    luminances.sort_by(f64::total_cmp);
    if luminances.is_empty() {
        1.0
    } else {
        BRIGHT / percentile(&luminances, MOST).max(1e-12)
    }
}

/// Converts a picture, with radiance times `exposure`, to sRGB: linear in the shadows, with lights rolled off towards white.
#[must_use]
pub fn preview(picture: &Picture, exposure: f64) -> RgbImage {
    RgbImage::from_fn(picture.size[0], picture.size[1], |x, y| {
        let rgb = picture
            .at(x, y)
            .map(|channel| (channel * exposure).max(0.0));
        // Beyond 0.6 the curve bends, and it is close to 1 at 4.
        let l = luminance(rgb).max(1e-12);
        let rolled = if l < 0.6 {
            l
        } else {
            0.6 + 0.4 * (1.0 - (-(l - 0.6) / 0.6).exp())
        };
        image::Rgb(rgb.map(|channel| srgb(channel * rolled / l)))
    })
}

/// Encodes a linear value in `[0, 1]` as the sRGB byte that a screen shows.
#[must_use]
pub fn srgb(linear: f64) -> u8 {
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to a byte"
    )]
    let byte = (255.0 * encoded.clamp(0.0, 1.0)).round() as u8;
    byte
}

/// Encodes an image as a PNG file in memory.
///
/// # Errors
///
/// Returns an error only if the encoder reports one.
pub fn png(image: &RgbImage) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    image::codecs::png::PngEncoder::new(&mut bytes)
        .write_image(
            image.as_raw(),
            image.width(),
            image.height(),
            ExtendedColorType::Rgb8,
        )
        .map_err(io::Error::other)?;
    Ok(bytes)
}

/// Writes a picture as `OpenEXR` in single precision, with layers and attributes, and beside it a PNG preview, each as a whole.
///
/// # Errors
///
/// Returns an error if a file cannot be written.
pub fn write(picture: &Picture, beside: &Beside, path: &Path, exposure: f64) -> Result<(), Error> {
    let encoded = exr(picture, beside).map_err(io::Error::other);
    whole(path, |out| encoded.and_then(|bytes| out.write_all(&bytes)))?;
    write_preview(picture, &path.with_extension("png"), exposure)
}

/// Encodes a picture as an `OpenEXR` file in memory.
fn exr(picture: &Picture, beside: &Beside) -> exr::error::Result<Vec<u8>> {
    let channel = |name: &str, pixels| AnyChannel::new(name, FlatSamples::F32(pixels));
    #[expect(
        clippy::cast_possible_truncation,
        reason = "files hold single precision"
    )]
    let radiance = ["R", "G", "B"].into_iter().enumerate().map(|(c, name)| {
        channel(
            name,
            picture.pixels.iter().map(|pixel| pixel[c] as f32).collect(),
        )
    });
    let layers = beside
        .channels
        .iter()
        .map(|layer| channel(layer.name, layer.pixels.clone()));
    let channels = AnyChannels::sort(radiance.chain(layers).collect());
    let ([x, y], whole) = beside.frame.unwrap_or(([0, 0], picture.size));
    let pixels = |[width, height]: [u32; 2]| Vec2(width as usize, height as usize);
    let attributes =
        LayerAttributes::default().with_position(Vec2(i32::try_from(x)?, i32::try_from(y)?));
    let mut image = Image::from_layer(Layer::new(
        pixels(picture.size),
        attributes,
        Encoding::SMALL_LOSSLESS,
        channels,
    ));
    image.attributes.display_window = IntegerBounds::from_dimensions(pixels(whole));
    for (name, value) in &beside.attributes {
        image
            .layer_data
            .attributes
            .other
            .insert((*name).into(), AttributeValue::Text(text(value)));
    }
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// Converts the value of an attribute to ASCII text, in which other bytes become `\xNN`.
fn text(value: &str) -> Text {
    let mut ascii = String::new();
    for byte in value.bytes() {
        if matches!(byte, b' '..=b'~') {
            ascii.push(char::from(byte));
        } else {
            ascii.push_str(&format!("\\x{byte:02x}"));
        }
    }
    Text::from_slice_unchecked(ascii.as_bytes())
}

/// Writes a PNG preview of a picture as a whole file.
///
/// # Errors
///
/// Returns an error if the file cannot be written.
pub fn write_preview(picture: &Picture, path: &Path, exposure: f64) -> Result<(), Error> {
    whole(path, |out| {
        out.write_all(&png(&preview(picture, exposure))?)
    })
}
