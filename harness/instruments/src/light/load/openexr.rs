//! `OpenEXR`: which layer is the map, and its pixels.

use super::primaries::{Primaries, xyz_to_rec_709};
use super::{Map, checked, damaged, line};
use crate::light::rounded;
use exr::block;
use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader as _;
use exr::error::{Error, UnitResult};
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::attribute::{Chromaticities, EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::f16;
use std::io::{BufRead, Seek};

/// Layers and channels that a message names at most.
const MOST_NAMES: usize = 24;

/// Reads a map.
pub(super) fn read(mut file: impl BufRead + Seek, layer: Option<&str>) -> Result<Map, String> {
    let mut start = [0; 8];
    file.read_exact(&mut start)
        .and_then(|()| file.rewind())
        .map_err(|e| refusal(e.into()))?;
    if start[5] & 8 != 0 {
        return Err(DEEP.to_owned());
    }
    let meta = MetaData::read_from_buffered(&mut file, true).map_err(refusal)?;
    let layers = find_layers(&meta.headers);
    let chosen = choose(&meta.headers, &layers, layer)?;
    check_support(&meta.headers, chosen.part)?;
    file.rewind().map_err(|e| refusal(e.into()))?;
    let mut map = pixels(file, &meta.headers[chosen.part], chosen)?;
    if !chosen.name.is_empty() {
        map.remarks.push(format!("layer {}", chosen.name));
    }
    convert(&mut map, &meta.headers, chosen)?;
    Ok(map)
}

const DEEP: &str = "unsupported: deep data; flatten the file first";

/// The message of an error.
fn refusal(error: Error) -> String {
    match error {
        Error::NotSupported(problem) => format!("unsupported: {}", line(&problem)),
        Error::Io(problem) => format!("cannot read: {}", line(&problem)),
        Error::Invalid(_) | Error::Aborted => damaged(error),
    }
}

/// What the three channels of a layer are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Colour {
    Rgb,
    Xyz,
    /// Y, RY and BY.
    Chroma,
    /// Y alone.
    Luminance,
}

/// A layer with colour: channels of one part that share what stands before the last dot of their names.
#[derive(Debug)]
struct Layer {
    part: usize,
    name: String,
    is_unnamed: bool,
    colour: Colour,
    /// Places in the part's list of channels.
    channels: [usize; 3],
}

/// The layers with colour.
fn find_layers(headers: &[Header]) -> Vec<Layer> {
    let mut layers = Vec::new();
    for (part, header) in headers.iter().enumerate() {
        let names = channel_names(header);
        let split: Vec<(&str, &str)> = names
            .iter()
            .map(|name| name.rsplit_once('.').unwrap_or(("", name)))
            .collect();
        let mut prefixes: Vec<&str> = split.iter().map(|(prefix, _)| *prefix).collect();
        prefixes.sort_unstable();
        prefixes.dedup();
        for prefix in prefixes {
            let place = |names: [&str; 2]| {
                let is_it = |(a, b): &(&str, &str)| {
                    *a == prefix && names.iter().any(|name| b.eq_ignore_ascii_case(name))
                };
                split.iter().position(is_it)
            };
            let Some((colour, channels)) = colour(place) else {
                continue;
            };
            let own = header.own_attributes.layer_name.as_ref();
            let own = own.filter(|_| headers.len() > 1);
            let name = match own.map(|name| String::from_utf8_lossy(name.as_slice())) {
                Some(own) if prefix.is_empty() => own.into_owned(),
                Some(own) if own != prefix => format!("{own}.{prefix}"),
                _ => prefix.to_owned(),
            };
            layers.push(Layer {
                part,
                name,
                is_unnamed: prefix.is_empty(),
                colour,
                channels,
            });
        }
    }
    layers
}

/// The colour that a layer has, by the places of its channels.
fn colour(place: impl Fn([&str; 2]) -> Option<usize>) -> Option<(Colour, [usize; 3])> {
    if let (Some(r), Some(g), Some(b)) = (
        place(["R", "red"]),
        place(["G", "green"]),
        place(["B", "blue"]),
    ) {
        return Some((Colour::Rgb, [r, g, b]));
    }
    let one = |name| place([name, name]);
    let y = one("Y")?;
    match (one("X"), one("Z"), one("W"), one("RY"), one("BY")) {
        (Some(x), Some(z), None, ..) => Some((Colour::Xyz, [x, y, z])),
        // A vector of two or four numbers.
        (Some(_), ..) => None,
        (None, .., Some(ry), Some(by)) => Some((Colour::Chroma, [ry, y, by])),
        (None, .., None, None) => Some((Colour::Luminance, [y; 3])),
        (None, ..) => None,
    }
}

fn channel_names(header: &Header) -> Vec<String> {
    let names = header.channels.list.iter();
    names
        .map(|channel| String::from_utf8_lossy(channel.name.as_slice()).into_owned())
        .collect()
}

/// The layer of this name; without a name, the only layer that may be meant.
fn choose<'a>(
    headers: &[Header],
    layers: &'a [Layer],
    name: Option<&str>,
) -> Result<&'a Layer, String> {
    let only = |is_meant: &dyn Fn(&Layer) -> bool| {
        let mut meant = layers.iter().filter(|layer| is_meant(layer));
        meant.next().filter(|_| meant.next().is_none())
    };
    let is_rgb = |layer: &Layer| layer.colour == Colour::Rgb;
    let found = match name {
        Some(name) => only(&|layer| layer.name == name),
        None => only(&|layer| is_rgb(layer) && layer.is_unnamed).or_else(|| {
            if !layers.iter().any(is_rgb) {
                only(&|layer| layer.is_unnamed).or_else(|| only(&|_| true))
            } else if !layers.iter().any(|layer| layer.is_unnamed) {
                only(&is_rgb)
            } else {
                None
            }
        }),
    };
    if let Some(layer) = found {
        return Ok(layer);
    }
    if layers.is_empty() {
        let names = listed(headers.iter().flat_map(channel_names));
        return Err(format!(
            "unsupported: a map needs channels R, G and B, or X, Y and Z, or Y, got {names}"
        ));
    }
    let names = listed(layers.iter().map(|layer| {
        let names = channel_names(&headers[layer.part]);
        let mut channels: Vec<&str> = layer.channels.map(|k| names[k].as_str()).into();
        channels.dedup();
        match layer.name.as_str() {
            "" => format!("one without a name ({})", channels.join(" ")),
            name => format!("{name} ({})", channels.join(" ")),
        }
    }));
    Err(match name {
        Some(name) => {
            format!("--layer must be a layer with colour of the file, got {name}; it has {names}")
        }
        None => format!("several layers have colour, choose one by --layer NAME: {names}"),
    })
}

/// Names as a list that is not too long.
fn listed(names: impl Iterator<Item = String>) -> String {
    let mut names: Vec<String> = names.collect();
    let more = names.len().saturating_sub(MOST_NAMES);
    names.truncate(MOST_NAMES);
    let mut list = names.join(", ");
    if more > 0 {
        list.push_str(&format!(" and {more} more"));
    }
    line(&list)
}

/// Refuses by name what is valid in a file, and not read here.
fn check_support(headers: &[Header], part: usize) -> Result<(), String> {
    // The decoder refuses the whole file for one part or channel.
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
    Ok(())
}

/// The pixels of the display window: black where the data window ends.
fn pixels(file: impl BufRead + Seek, header: &Header, layer: &Layer) -> Result<Map, String> {
    let display = header.shared_attributes.display_window;
    let data = header.data_window();
    let size = checked([display.size.width(), display.size.height()])?;
    checked([data.size.width(), data.size.height()])?;
    // Of the data window's upper left corner in the display window.
    let offset = [
        i64::from(data.position.x()) - i64::from(display.position.x()),
        i64::from(data.position.y()) - i64::from(display.position.y()),
    ];
    let spans = [
        (offset[0], data.size.width(), size[0]),
        (offset[1], data.size.height(), size[1]),
    ];
    let place = format!(
        "the data window, {} x {} pixels from {} {},",
        data.size.width(),
        data.size.height(),
        offset[0],
        offset[1]
    );
    let display = format!("the display window, {} x {}", size[0], size[1]);
    if spans
        .iter()
        .any(|(from, count, all)| *from >= *all as i64 || from + *count as i64 <= 0)
    {
        return Err(format!("{place} must overlap {display}"));
    }
    let mut map = Map {
        size,
        pixels: vec![[0.0; 3]; size[0] * size[1]],
        remarks: Vec::new(),
    };
    if spans
        .iter()
        .any(|(from, count, all)| *from > 0 || from + (*count as i64) < *all as i64)
    {
        map.remarks
            .push(format!("{place} does not cover {display}: black elsewhere"));
    }
    let is_whole =
        |block: &block::BlockIndex| block.layer == layer.part && block.level == Vec2(0, 0);
    let result: UnitResult = block::read(file, false)
        .and_then(|reader| reader.filter_chunks(false, |_, _, block| is_whole(&block)))
        .and_then(|chunks| {
            chunks.decompress_sequential(false, |_, block| {
                if !is_whole(&block.index) {
                    return Err(Error::Invalid("a chunk of another layer".into()));
                }
                let lines = block.lines(&header.channels);
                lines
                    .map(|line| take(&mut map, offset, header, layer, line))
                    .collect()
            })
        });
    result.map_err(refusal)?;
    Ok(map)
}

/// Takes the samples of a line, if they are of the layer and within the display window.
fn take(
    map: &mut Map,
    offset: [i64; 2],
    header: &Header,
    layer: &Layer,
    line: LineRef<'_>,
) -> UnitResult {
    let channel = line.location.channel;
    let [width, height] = map.size;
    let Vec2(x, y) = line.location.position;
    let row = usize::try_from(y as i64 + offset[1])
        .ok()
        .filter(|row| *row < height);
    let (Some(row), true) = (row, layer.channels.contains(&channel)) else {
        return Ok(());
    };
    let row = &mut map.pixels[row * width..][..width];
    let mut put = |k: usize, sample: f32| {
        let column = usize::try_from((x + k) as i64 + offset[0]).ok();
        if let Some(pixel) = column.and_then(|column| row.get_mut(column)) {
            for (number, _) in pixel
                .iter_mut()
                .zip(layer.channels)
                .filter(|(_, of)| *of == channel)
            {
                *number = sample;
            }
        }
    };
    match header.channels.list[channel].sample_type {
        SampleType::F16 => (0..)
            .zip(line.read_samples::<f16>())
            .try_for_each(|(k, sample)| {
                put(k, sample?.to_f32());
                Ok(())
            }),
        SampleType::F32 => (0..)
            .zip(line.read_samples::<f32>())
            .try_for_each(|(k, sample)| {
                put(k, sample?);
                Ok(())
            }),
        SampleType::U32 => (0..)
            .zip(line.read_samples::<u32>())
            .try_for_each(|(k, sample)| {
                put(k, sample? as f32);
                Ok(())
            }),
    }
}

/// Makes Rec. 709 of the channels.
fn convert(map: &mut Map, headers: &[Header], layer: &Layer) -> Result<(), String> {
    // Files may have attributes of all parts in the first alone.
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
            for pixel in &mut map.pixels {
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

/// Chromaticities of the attribute.
fn primaries(attribute: Chromaticities) -> Primaries {
    let Chromaticities {
        red,
        green,
        blue,
        white,
    } = attribute;
    Primaries([red, green, blue, white].map(|Vec2(x, y)| [f64::from(x), f64::from(y)]))
}
