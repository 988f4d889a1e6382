//! Format of `MonoHair` (`.hair`), which has no signature.
//!
//! Files are little endian: strands and points as u32, points per strand as u16, and three f32 per
//! point. The unit is the metre.

use super::Wrong;
use super::bytes::Bytes;
use super::raw::{Raw, RawStrand};

/// Returns true if the points of the strands add up to the count in the header. The data that follow
/// may be too short or too long.
pub(super) fn fits(bytes: Bytes<'_>) -> bool {
    let (strands, points) = (u64::from(bytes.u32(0)), u64::from(bytes.u32(4)));
    let counted = 8 + 2 * strands;
    strands > 0
        && points > 0
        && counted < bytes.len()
        && (0..strands)
            .map(|strand| u64::from(bytes.u16(8 + 2 * strand)))
            .sum::<u64>()
            == points
}

/// Checks the file and returns its strands.
pub(super) fn parse(bytes: Bytes<'_>) -> Result<Raw<'_>, Wrong> {
    let (strands, points) = (u64::from(bytes.u32(0)), u64::from(bytes.u32(4)));
    let first = 8 + 2 * strands;
    let end = first + 12 * points;
    bytes.length(end)?;
    for point in 0..points {
        bytes.position(first + 12 * point)?;
    }
    let mut offset = first;
    let strand = move |strand: u64| {
        let start = offset;
        offset += 12 * u64::from(bytes.u16(8 + 2 * strand));
        let nodes = (start..offset).step_by(12);
        RawStrand {
            number: usize::try_from(strand).unwrap_or(usize::MAX),
            offset: start,
            nodes: Box::new(nodes.map(move |at| (bytes.position(at).unwrap_or_default(), 0.0))),
        }
    };
    Ok(Raw {
        scale: 100.0,
        strands: Box::new((0..strands).map(strand)),
        count: usize::try_from(strands).unwrap_or(usize::MAX),
        nodes: points,
        radii: None,
        remarks: bytes.remark_behind(end).into_iter().collect(),
    })
}
