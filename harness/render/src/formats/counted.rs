//! Formats that store a count before each strand: USC-HairSalon (`.data`) and `CT2Hair` (`.bin`).
//!
//! Both are little endian and begin with the number of strands as i32. Each strand is the number of
//! its vertices as i32, followed by the vertices. A vertex is three f32 in USC-HairSalon, whose unit
//! is the metre. In `CT2Hair`, in millimetres, four f32 follow them: a normal or a colour, and a
//! label. Strands of one vertex are roots without hair. Some published strands have NaN coordinates;
//! this reader drops such strands, as the authors' readers do.

use super::bytes::Bytes;
use super::raw::{Raw, RawStrand};
use super::{Problem, Wrong};

/// Differences between the formats: bytes of a vertex, and centimetres per unit.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    stride: u64,
    scale: f32,
}

pub(super) const HAIR_SALON: Layout = Layout {
    stride: 12,
    scale: 100.0,
};
pub(super) const CT2HAIR: Layout = Layout {
    stride: 28,
    scale: 0.1,
};

/// Returns true if the counts lead to the end of the file.
pub(super) fn fits(bytes: Bytes<'_>, layout: Layout) -> bool {
    let strands = u64::from(bytes.u32(0));
    let possible = strands > 0 && strands <= bytes.len() / 4;
    possible && walk(bytes, layout, |_, _, _| ()).is_ok_and(|end| end == bytes.len())
}

/// Visits every strand, by its number, the offset of its first vertex and its count of vertices, and
/// returns where the last strand ends.
fn walk(
    bytes: Bytes<'_>,
    layout: Layout,
    mut visit: impl FnMut(u32, u64, u64),
) -> Result<u64, Wrong> {
    bytes.header(4)?;
    let mut offset = 4;
    for strand in 0..bytes.u32(0) {
        let vertices = u64::from(bytes.u32(offset));
        let end = offset + 4 + layout.stride * vertices;
        if end > bytes.len() {
            let got = bytes.len();
            return Err((offset, Problem::Strand { strand, end, got }));
        }
        visit(strand, offset + 4, vertices);
        offset = end;
    }
    Ok(offset)
}

/// Checks the file, and returns its strands.
pub(super) fn parse(bytes: Bytes<'_>, layout: Layout) -> Result<Raw<'_>, Wrong> {
    bytes.header(4)?;
    let count = bytes.u32(0);
    if count == 0 {
        let expected = "there must be a strand";
        return Err((0, Problem::Count { expected, got: 0 }));
    }
    let (mut strands, mut empty) = (Vec::new(), 0_usize);
    let end = walk(bytes, layout, |strand, offset, vertices| match vertices {
        0 | 1 => empty += 1,
        _ => strands.push((strand as usize, offset, vertices)),
    })?;
    let hairy = strands.len();
    let vertex = move |(_, offset, vertices): (usize, u64, u64)| {
        (0..vertices).map(move |k| offset + layout.stride * k)
    };
    strands.retain(|&strand| {
        vertex(strand).all(|offset| {
            [0, 4, 8]
                .map(|at| bytes.f32(offset + at))
                .iter()
                .all(|x| x.is_finite())
        })
    });
    for offset in strands.iter().copied().flat_map(vertex) {
        bytes.position(offset)?;
    }
    let mut remarks = Vec::new();
    if empty > 0 {
        remarks.push(format!("{empty} of {count} roots have no hair"));
    }
    if strands.len() < hairy {
        remarks.push(format!(
            "warning: dropped {} of {count} strands, which have coordinates that are not finite",
            hairy - strands.len()
        ));
    }
    remarks.extend(bytes.remark_behind(end));
    Ok(Raw {
        scale: layout.scale,
        count: strands.len(),
        nodes: strands.iter().map(|strand| strand.2).sum(),
        radii: None,
        remarks,
        strands: Box::new(strands.into_iter().map(move |strand| RawStrand {
            number: strand.0,
            offset: strand.1,
            nodes: Box::new(
                vertex(strand).map(move |offset| (bytes.position(offset).unwrap_or_default(), 0.0)),
            ),
        })),
    })
}
