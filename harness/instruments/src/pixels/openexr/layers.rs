//! Layers with colour: the list of those in a file, and the choice of the one that holds the map.

use super::super::{LayerFlag, line};
use exr::meta::header::Header;
use std::collections::BTreeMap;

/// Largest number of layers or channels that a message names.
const MOST_NAMES: usize = 24;

/// Meaning of the three channels of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colour {
    Rgb,
    Xyz,
    /// Y, RY and BY.
    Chroma,
    /// Y alone.
    Luminance,
}

/// Layer with colour: channels of one part whose names are equal up to the last dot.
#[derive(Debug)]
pub(super) struct Layer {
    pub(super) part: usize,
    pub(super) name: String,
    is_unnamed: bool,
    pub(super) colour: Colour,
    /// Indices in the part's list of channels.
    pub(super) channels: [usize; 3],
}

/// Returns the layers with colour, part by part.
pub(super) fn find_layers(headers: &[Header]) -> Vec<Layer> {
    let mut layers = Vec::new();
    for (part, header) in headers.iter().enumerate() {
        let names = channel_names(header);
        let mut groups: BTreeMap<&str, Vec<(&str, usize)>> = BTreeMap::new();
        for (place, name) in names.iter().enumerate() {
            let (prefix, last) = name.rsplit_once('.').unwrap_or(("", name));
            groups.entry(prefix).or_default().push((last, place));
        }
        for (prefix, group) in groups {
            let place = |names: [&str; 2]| {
                let is_it = |name: &str| names.iter().any(|one| name.eq_ignore_ascii_case(one));
                let mut meant = group.iter().filter(|(name, _)| is_it(name));
                meant.next().map(|(_, place)| *place)
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

/// Returns the kind of colour that a layer has, with the indices of its channels.
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

/// Returns the layer with this name, or without a name the only layer that may be meant.
pub(super) fn choose<'a>(
    headers: &[Header],
    layers: &'a [Layer],
    flag: LayerFlag<'_>,
) -> Result<&'a Layer, String> {
    let only = |is_meant: &dyn Fn(&Layer) -> bool| {
        let mut meant = layers.iter().filter(|layer| is_meant(layer));
        meant.next().filter(|_| meant.next().is_none())
    };
    let is_rgb = |layer: &Layer| layer.colour == Colour::Rgb;
    let found = match flag.name {
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
    let channels: Vec<Vec<String>> = headers.iter().map(channel_names).collect();
    if layers.is_empty() {
        let names = listed(channels.into_iter().flatten());
        return Err(format!(
            "unsupported: a picture needs channels R, G and B, or X, Y and Z, or Y, got {names}"
        ));
    }
    let names = listed(layers.iter().map(|layer| {
        let mut its = layer
            .channels
            .map(|k| channels[layer.part][k].as_str())
            .to_vec();
        its.dedup();
        let name = match layer.name.as_str() {
            "" => "one without a name",
            name => name,
        };
        format!("{name} ({})", its.join(" "))
    }));
    let LayerFlag { flag, name } = flag;
    Err(match name {
        Some(name) => {
            format!("{flag} must be a layer with colour of the file, got {name}; it has {names}")
        }
        None => format!("several layers have colour, choose one by {flag} NAME: {names}"),
    })
}

/// Joins names to a list that is not too long.
pub(super) fn listed(names: impl Iterator<Item = String>) -> String {
    let mut names: Vec<String> = names.collect();
    let more = names.len().saturating_sub(MOST_NAMES);
    names.truncate(MOST_NAMES);
    let mut list = names.join(", ");
    if more > 0 {
        list.push_str(&format!(" and {more} more"));
    }
    line(&list)
}
