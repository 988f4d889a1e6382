//! Reader of `OpenEXR` files: the pixels of one layer, converted to Rec. 709.
//!
//! Compressions that are read: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab.

mod layers;

use super::primaries::{Primaries, xyz_to_rec_709};
use super::{LayerFlag, Pixels, checked, damaged, line};
use crate::light::rounded;
use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader as _;
use exr::block::{self, BlockIndex, UncompressedBlock};
use exr::error::{Error, Result as ExrResult, UnitResult};
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Chromaticities, EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::f16;
use layers::{Colour, Layer, choose, find_layers, listed};
use std::collections::BTreeMap;
use std::io::{self, BufRead, Read as _, Seek};

/// Names of the compressions that are not read, by the numbers that files have for them: those that `OpenEXR` 3.4 and 3.5 added.
const UNREAD: [(u8, &str); 4] = [
    (10, "htj2k256"),
    (11, "htj2k32"),
    (12, "lj2k"),
    (13, "zstd"),
];

/// Reads the pixels of the chosen layer.
pub(super) fn read(
    mut file: impl BufRead + Seek,
    layer: LayerFlag<'_>,
    most: usize,
) -> Result<Pixels, String> {
    let mut start = [0; 8];
    file.read_exact(&mut start).map_err(|e| refusal(e.into()))?;
    if start[5] & 8 != 0 {
        return Err(DEEP.to_owned());
    }
    let compressions = compressions(&mut file, start[5] & 16 != 0);
    file.rewind().map_err(|e| refusal(e.into()))?;
    let meta = MetaData::read_from_buffered(&mut file, true);
    // The decoder takes no file with a number that it does not know, in whatever part.
    if meta.is_err() {
        compressions
            .iter()
            .try_for_each(|number| check_compression(*number))?;
    }
    let meta = meta.map_err(refusal)?;
    let layers = find_layers(&meta.headers);
    let chosen = choose(&meta.headers, &layers, layer)?;
    check_support(&meta.headers, chosen.part)?;
    if let Some(number) = compressions.get(chosen.part) {
        check_compression(*number)?;
    }
    file.rewind().map_err(|e| refusal(e.into()))?;
    let mut map = pixels(file, &meta.headers[chosen.part], chosen, most)?;
    if !chosen.name.is_empty() {
        map.remarks.push(format!("layer {}", chosen.name));
    }
    convert(&mut map, &meta.headers, chosen)?;
    Ok(map)
}

/// Returns the numbers of the parts' compressions, read from behind the first 8 bytes of a file, as far as its headers can be read.
fn compressions(file: &mut impl BufRead, has_parts: bool) -> Vec<u8> {
    let mut numbers = Vec::new();
    let mut attribute = || -> io::Result<bool> {
        let mut name = Vec::new();
        file.by_ref().take(256).read_until(0, &mut name)?;
        if name == b"\0" {
            return Ok(false);
        }
        let (mut kind, mut size) = (Vec::new(), [0; 4]);
        file.by_ref().take(256).read_until(0, &mut kind)?;
        file.read_exact(&mut size)?;
        let mut value = file.by_ref().take(u32::from_le_bytes(size).into());
        if name == b"compression\0" {
            let mut number = [0];
            value.read_exact(&mut number)?;
            numbers.extend(number);
        }
        io::copy(&mut value, &mut io::sink())?;
        Ok(true)
    };
    // An empty name ends a header, and another one behind it the headers of several parts.
    let mut header = || -> io::Result<bool> {
        let mut is_empty = true;
        while attribute()? {
            is_empty = false;
        }
        Ok(!is_empty && has_parts)
    };
    while header().unwrap_or(false) {}
    numbers
}

/// Rejects, by name, a compression that is not read.
fn check_compression(number: u8) -> Result<(), String> {
    let name = UNREAD.iter().find(|(one, _)| *one == number);
    match name {
        Some((_, name)) => Err(format!(
            "unsupported: the compression {name}; write the file with zip"
        )),
        None if number > UNREAD[3].0 => Err(format!(
            "unsupported: an unknown compression, number {number}; write the file with zip"
        )),
        None => Ok(()),
    }
}

const DEEP: &str = "unsupported: deep data; flatten the file first";

/// Returns the message of an error of the decoder.
fn refusal(error: Error) -> String {
    match error {
        Error::NotSupported(problem) => format!("unsupported: {}", line(&problem)),
        Error::Io(problem) => format!("cannot read: {}", line(&problem)),
        Error::Invalid(_) | Error::Aborted => damaged(error),
    }
}

/// Rejects, by name, features that are valid in a file but not supported here.
fn check_support(headers: &[Header], part: usize) -> Result<(), String> {
    // The decoder rejects the whole file because of one part or channel.
    if headers.iter().any(|header| header.deep) {
        return Err(DEEP.to_owned());
    }
    let channels = || headers.iter().flat_map(|header| &header.channels.list);
    if channels().any(|channel| channel.sampling != Vec2(1, 1)) {
        let subsampled = channels().filter(|channel| channel.sampling != Vec2(1, 1));
        let names = subsampled.map(|one| {
            format!(
                "{} of {} x {} pixels",
                one.name,
                one.sampling.x(),
                one.sampling.y()
            )
        });
        return Err(format!(
            "unsupported: subsampled channels, {}; write every channel in full",
            listed(names)
        ));
    }
    if headers[part].own_attributes.environment_map == Some(EnvironmentMap::Cube) {
        return Err("unsupported: a cube map; convert it to latitude-longitude".to_owned());
    }
    // The crate files an attribute of another type under the attributes of the program that wrote the file.
    let mut others = headers
        .iter()
        .flat_map(|header| header.own_attributes.other.keys());
    if others.any(|name| name == "chromaticities") {
        return Err("unsupported: the attribute chromaticities is of another type".to_owned());
    }
    Ok(())
}

/// Reads the pixels of the data window that lie within the display window.
fn pixels(
    file: impl BufRead + Seek,
    header: &Header,
    layer: &Layer,
    most: usize,
) -> Result<Pixels, String> {
    let (display, data) = (
        header.shared_attributes.display_window,
        header.data_window(),
    );
    let size = [display.size.width(), display.size.height()];
    let size = checked("display window", size, most)?;
    let data_size = [data.size.width(), data.size.height()];
    let data_size = checked("data window", data_size, most)?;
    // Position of the data window's upper left corner in the display window.
    let offset = [
        i64::from(data.position.x()) - i64::from(display.position.x()),
        i64::from(data.position.y()) - i64::from(display.position.y()),
    ];
    let within = |axis: usize, at: i64| usize::try_from(at).unwrap_or(0).min(size[axis]);
    let corner = [0, 1].map(|axis| within(axis, offset[axis]));
    let end = [0, 1].map(|axis| within(axis, offset[axis] + data_size[axis] as i64));
    let extent = [0, 1].map(|axis| end[axis] - corner[axis]);
    if extent.contains(&0) {
        return Err(format!(
            "the data window, {} x {} pixels from {} {}, must overlap the display window, {} x {}",
            data_size[0], data_size[1], offset[0], offset[1], size[0], size[1]
        ));
    }
    let mut map = Pixels {
        size,
        corner,
        extent,
        values: vec![[0.0; 3]; extent[0] * extent[1]],
        remarks: Vec::new(),
        texts: texts(header),
    };
    // Position of the data window in the part that is read, 0 or less.
    let offset = [0, 1].map(|axis| offset[axis] - corner[axis] as i64);
    let is_wanted = |block: &BlockIndex| block.layer == layer.part && block.level == Vec2(0, 0);
    let take_block = |_: &MetaData, block: UncompressedBlock| {
        if !is_wanted(&block.index) {
            return Err(Error::Invalid("a chunk of another layer".into()));
        }
        let mut lines = block.lines(&header.channels);
        lines.try_for_each(|line| take(&mut map, offset, header, layer, line))
    };
    block::read(file, false)
        .and_then(|reader| reader.filter_chunks(false, |_, _, block| is_wanted(&block)))
        .and_then(|chunks| chunks.decompress_sequential(false, take_block))
        .map_err(refusal)?;
    Ok(map)
}

/// Returns the attributes of a part that are text.
fn texts(header: &Header) -> BTreeMap<String, String> {
    let own = header.own_attributes.other.iter();
    own.filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
        _ => None,
    })
    .collect()
}

/// Stores the samples of a line, if they belong to the layer and lie within the part that is read.
fn take(
    map: &mut Pixels,
    offset: [i64; 2],
    header: &Header,
    layer: &Layer,
    line: LineRef<'_>,
) -> UnitResult {
    let channel = line.location.channel;
    let [width, height] = map.extent;
    let Vec2(x, y) = line.location.position;
    let row = usize::try_from(y as i64 + offset[1]).unwrap_or(usize::MAX);
    if row >= height || !layer.channels.contains(&channel) {
        return Ok(());
    }
    let row = &mut map.values[row * width..][..width];
    let samples: Box<dyn Iterator<Item = ExrResult<f32>>> =
        match header.channels.list[channel].sample_type {
            SampleType::F16 => Box::new(line.read_samples().map(|one| one.map(f16::to_f32))),
            SampleType::F32 => Box::new(line.read_samples()),
            SampleType::U32 => Box::new(
                line.read_samples()
                    .map(|one| one.map(|one: u32| one as f32)),
            ),
        };
    for (k, sample) in samples.enumerate() {
        let sample = sample?;
        let column = usize::try_from((x + k) as i64 + offset[0]).unwrap_or(usize::MAX);
        if let Some(pixel) = row.get_mut(column) {
            // A luminance channel is stored in all three channels of the pixel.
            for (number, its_channel) in pixel.iter_mut().zip(layer.channels) {
                if its_channel == channel {
                    *number = sample;
                }
            }
        }
    }
    Ok(())
}

/// Converts the channels of the layer to RGB with the Rec. 709 primaries.
fn convert(map: &mut Pixels, headers: &[Header], layer: &Layer) -> Result<(), String> {
    // Files may store the attributes of all parts in the first part alone.
    let chromaticities = [layer.part, 0]
        .iter()
        .find_map(|part| headers[*part].shared_attributes.chromaticities);
    let primaries = chromaticities.map_or(Primaries::REC_709, primaries);
    match layer.colour {
        Colour::Luminance => return Ok(()),
        Colour::Xyz => {
            map.convert(&xyz_to_rec_709());
            map.remarks
                .push("converted from XYZ to Rec. 709".to_owned());
            return Ok(());
        }
        Colour::Chroma => {
            // RY and BY are (R - Y) / Y and (B - Y) / Y.
            let [yr, yg, yb] = primaries.to_xyz()?.row(1).to_array();
            for pixel in &mut map.values {
                let [ry, y, by] = pixel.map(f64::from);
                let (r, b) = ((ry + 1.0) * y, (by + 1.0) * y);
                *pixel = [r, (y - yr * r - yb * b) / yg, b].map(rounded);
            }
            map.remarks
                .push("converted from luminance and chroma to RGB".to_owned());
        }
        Colour::Rgb => {}
    }
    if let Some(matrix) = primaries.to_rec_709()? {
        map.convert(&matrix);
        map.remarks.push(format!(
            "converted to Rec. 709 from the primaries of the file, {primaries}"
        ));
    }
    Ok(())
}

/// Converts the attribute to primaries in double precision.
fn primaries(attribute: Chromaticities) -> Primaries {
    let Chromaticities {
        red,
        green,
        blue,
        white,
    } = attribute;
    Primaries([red, green, blue, white].map(|Vec2(x, y)| [f64::from(x), f64::from(y)]))
}
