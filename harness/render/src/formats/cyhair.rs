//! cyHair (`.hair`), after Cem Yuksel's `cyHairFile.h`.
//!
//! A header of 128 bytes holds `HAIR`, then strands, points, flags and default segments as u32, default
//! thickness, transparency and colour as f32, and 88 bytes of text. Arrays follow where flagged:
//! segments per strand as u16, three f32 per point, and per point a thickness, a transparency, and
//! three f32 of colour. The format's page has up to 65,536 segments per strand; u16 holds 65,535.
//! Thickness is a diameter. `LuxCore` adds a flag for two f32 of texture coordinates per point, behind
//! all else.

use super::bytes::Bytes;
use super::raw::{Raw, RawStrand};
use super::{Problem, Wrong};

const HEADER: u64 = 128;
/// Offset of the default thickness in the header.
const THICKNESS_AT: u64 = 20;
const SEGMENTS: u32 = 1;
const POINTS: u32 = 2;
const THICKNESS: u32 = 4;
const TRANSPARENCY: u32 = 8;
const COLOURS: u32 = 16;
const UVS: u32 = 32;

/// Checks the file and returns its strands, with thickness only if it is wanted.
pub(super) fn parse(bytes: Bytes<'_>, wants_thickness: bool) -> Result<Raw<'_>, Wrong> {
    bytes.header(HEADER)?;
    let signature = bytes.u32(0).to_le_bytes();
    if &signature != b"HAIR" {
        return Err((
            0,
            Problem::Signature {
                expected: "\"HAIR\" (cyHair), or with counts that agree (MonoHair)",
                got: signature,
            },
        ));
    }
    let [strands, points, flags, default_segments] = [4, 8, 12, 16].map(|offset| bytes.u32(offset));
    if strands == 0 {
        return Err((
            4,
            Problem::Count {
                expected: "there must be a strand",
                got: strands,
            },
        ));
    }
    if flags & POINTS == 0 {
        return Err((
            12,
            Problem::Flags {
                expected: "have points (2)",
                got: flags,
            },
        ));
    }
    if flags & SEGMENTS == 0 && default_segments == 0 {
        let expected = "there must be segments per strand, or a default of at least 1";
        return Err((
            16,
            Problem::Count {
                expected,
                got: default_segments,
            },
        ));
    }

    // Offsets at which arrays begin, and the file's length.
    let mut end = HEADER;
    let mut array = |flag: u32, bytes: u64, count: u32| {
        let start = end;
        if flags & flag != 0 {
            // At most 2^37 in all.
            end += bytes * u64::from(count);
        }
        start
    };
    let [segments_at, points_at, thickness_at, ..] = [
        array(SEGMENTS, 2, strands),
        array(POINTS, 12, points),
        array(THICKNESS, 4, points),
        array(TRANSPARENCY, 4, points),
        array(COLOURS, 12, points),
        array(UVS, 8, points),
    ];
    let points_end = points_at + 12 * u64::from(points);
    let thickness_end = thickness_at + 4 * u64::from(points);
    bytes.length(if wants_thickness && flags & THICKNESS != 0 {
        thickness_end
    } else {
        points_end
    })?;

    let has = move |flag: u32| flags & flag != 0;
    let segments_of = move |strand: u32| {
        let own = || u64::from(bytes.u16(segments_at + 2 * u64::from(strand)));
        if has(SEGMENTS) {
            own()
        } else {
            u64::from(default_segments)
        }
    };
    let needed = if has(SEGMENTS) {
        (0..strands).map(|strand| segments_of(strand) + 1).sum()
    } else {
        u64::from(strands) * (u64::from(default_segments) + 1)
    };
    if needed != u64::from(points) {
        return Err((
            8,
            Problem::Points {
                needed,
                got: u64::from(points),
            },
        ));
    }
    for point in 0..u64::from(points) {
        bytes.position(points_at + 12 * point)?;
    }
    let thickness_of = move |point: u64| {
        let offset = if has(THICKNESS) {
            thickness_at + 4 * point
        } else {
            THICKNESS_AT
        };
        (offset, bytes.f32(offset))
    };
    let thicknesses = if has(THICKNESS) { u64::from(points) } else { 1 };
    for (offset, value) in (0..thicknesses).map(thickness_of) {
        if wants_thickness && !(0.0..=1e6).contains(&value) {
            return Err((offset, Problem::Thickness { value }));
        }
    }

    let mut first = 0;
    let strands_of_file = (0..strands).map(move |strand| {
        let range = first..first + segments_of(strand) + 1;
        first = range.end;
        let node = move |point: u64| {
            let position = bytes.position(points_at + 12 * point).unwrap_or_default();
            (position, 0.5 * thickness_of(point).1)
        };
        RawStrand {
            number: strand as usize,
            offset: points_at + 12 * range.start,
            nodes: Box::new(range.map(node)),
        }
    });
    let unused: Vec<&str> = [
        (TRANSPARENCY, "transparency"),
        (COLOURS, "colours"),
        (UVS, "texture coordinates"),
    ]
    .into_iter()
    .filter(|&(flag, _)| has(flag))
    .map(|(_, name)| name)
    .collect();
    let mut remarks = Vec::new();
    if !unused.is_empty() {
        remarks.push(format!("not used: {}", unused.join(", ")));
    }
    if flags >= 2 * UVS {
        remarks.push(format!(
            "warning: flags {} are unknown, and what they stand for is not used",
            flags & !(2 * UVS - 1)
        ));
    }
    remarks.extend(bytes.remark_behind(end));
    Ok(Raw {
        scale: 1.0,
        strands: Box::new(strands_of_file),
        count: strands as usize,
        nodes: u64::from(points),
        radii: wants_thickness.then_some(thickness_of(0).0),
        remarks,
    })
}
