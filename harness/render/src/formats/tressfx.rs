//! Format of `TressFX` (`.tfx`), version 4, after AMD's `TressFXFileFormat.h`.
//!
//! A header of 160 bytes holds the version as f32, the strands, the nodes per strand, and then the offsets of sections, or 0:
//! positions (four f32 per node, the fourth a mass), texture coordinates per strand and per node (two f32), thickness per
//! strand (f32) and colours per node (four f32). Reserved numbers follow, 32 of them. The unit is the metre.

use super::bytes::Bytes;
use super::raw::{Raw, RawStrand};
use super::{Problem, Wrong};

const HEADER: u64 = 160;
const VERSION: f32 = 4.0;

/// Returns true if the file begins with the version, whose bits no number of strands of another format has.
pub(super) fn fits(bytes: Bytes<'_>) -> bool {
    bytes.f32(0) == VERSION && bytes.len() >= HEADER
}

/// Checks the file and returns its strands.
pub(super) fn parse(bytes: Bytes<'_>) -> Result<Raw<'_>, Wrong> {
    bytes.header(HEADER)?;
    if bytes.f32(0) != VERSION {
        let got = bytes.u32(0).to_le_bytes();
        return Err((
            0,
            Problem::Signature {
                expected: "version 4 as a float, \"\\x00\\x00\\x80@\"",
                got,
            },
        ));
    }
    let (strands, nodes) = (bytes.u32(4), bytes.u32(8));
    if strands == 0 {
        return Err((
            4,
            Problem::Count {
                expected: "there must be a strand",
                got: strands,
            },
        ));
    }
    if !(4..=64).contains(&nodes) || !nodes.is_power_of_two() {
        return Err((
            8,
            Problem::Count {
                expected: "nodes per strand must be a power of two from 4 to 64",
                got: nodes,
            },
        ));
    }
    // The product is at most 2^38, so that no section ends beyond 2^42.
    let of_nodes = u64::from(strands) * u64::from(nodes);
    let of_strands = u64::from(strands);
    // Offset of the field that holds the beginning of a section, and the section's bytes.
    let sections = [
        (12, 16 * of_nodes),
        (16, 8 * of_strands),
        (20, 8 * of_nodes),
        (24, 4 * of_strands),
        (28, 16 * of_nodes),
    ];
    let (mut end, mut positions_end) = (HEADER, HEADER);
    for (offset, size) in sections {
        let start = u64::from(bytes.u32(offset));
        if start == 0 && offset != 12 {
            continue;
        }
        if start < HEADER {
            let header = HEADER;
            return Err((offset, Problem::Section { header, got: start }));
        }
        end = end.max(start + size);
        if offset == 12 {
            positions_end = end;
        }
    }
    bytes.length(positions_end)?;
    let start = u64::from(bytes.u32(12));
    let (strands, nodes) = (u64::from(strands), u64::from(nodes));
    for node in 0..strands * nodes {
        bytes.position(start + 16 * node)?;
    }
    let strand = move |strand: u64| {
        let offset = start + 16 * strand * nodes;
        let node = move |k: u64| (bytes.position(offset + 16 * k).unwrap_or_default(), 0.0);
        RawStrand {
            number: usize::try_from(strand).unwrap_or(usize::MAX),
            offset,
            nodes: Box::new((0..nodes).map(node)),
        }
    };
    let unused: Vec<&str> = [
        (16, "texture coordinates of strands"),
        (20, "texture coordinates of nodes"),
        (24, "thickness"),
        (28, "colours"),
    ]
    .into_iter()
    .filter(|&(offset, _)| bytes.u32(offset) != 0)
    .map(|(_, name)| name)
    .collect();
    let mut remarks = Vec::new();
    if !unused.is_empty() {
        remarks.push(format!("not used: {}", unused.join(", ")));
    }
    remarks.extend(bytes.remark_behind(end));
    Ok(Raw {
        scale: 100.0,
        strands: Box::new((0..strands).map(strand)),
        count: usize::try_from(strands).unwrap_or(usize::MAX),
        nodes: of_nodes,
        radii: None,
        remarks,
    })
}
