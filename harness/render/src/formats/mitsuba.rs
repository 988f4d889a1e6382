//! Hair of Mitsuba: text for `linearcurve` and `bsplinecurve`, and the binary form that its earlier versions
//! had for `hair`.
//!
//! Text has a line `x y z radius` per node, and an empty line between strands. Mitsuba 0.6 and 2 also
//! have lines of `x y z`, and lines of `#` between strands. The binary form is little endian:
//! `BINARY_HAIR`, the number of nodes as u32, then three f32 per node, after an infinity for each node
//! that begins a strand.

use super::bytes::Bytes;
use super::raw::{Raw, RawStrand};
use super::{Problem, Wrong};
use crate::geometry::Strands;
use core::ops::Range;
use glam::Vec3;
use std::io::{self, Write};

const SIGNATURE: &[u8] = b"BINARY_HAIR";
/// Offset of the first node.
const HEADER: u64 = 15;

pub(super) fn is_binary(bytes: Bytes<'_>) -> bool {
    bytes.0.starts_with(SIGNATURE)
}

/// Returns true if the first line that is neither empty nor a comment has three or four numbers.
pub(super) fn is_text(bytes: Bytes<'_>) -> bool {
    let mut nodes = lines(bytes).filter(|(_, line)| !is_between(line));
    nodes.next().is_some_and(|(_, line)| {
        let numbers: Option<Vec<f32>> = numbers(line).collect();
        numbers.is_some_and(|numbers| matches!(numbers.len(), 3 | 4))
    })
}

/// Iterates over lines and the offsets where they begin. Lines that are not text have no numbers.
fn lines(bytes: Bytes<'_>) -> impl Iterator<Item = (u64, &str)> {
    let mut start = 0;
    let pieces = bytes
        .0
        .split_inclusive(|byte| matches!(byte, b'\n' | b'\r'));
    pieces.map(move |piece| {
        let offset = start;
        start += piece.len() as u64;
        (
            offset,
            core::str::from_utf8(piece)
                .unwrap_or("\u{fffd}")
                .trim()
                .trim_start_matches('\u{feff}'),
        )
    })
}

/// Returns true if a line stands between strands.
fn is_between(line: &str) -> bool {
    line.is_empty() || line.starts_with('#')
}

fn numbers(line: &str) -> impl Iterator<Item = Option<f32>> {
    line.split_ascii_whitespace().map(|word| word.parse().ok())
}

/// Makes strands from collected nodes.
fn collected<'a>(
    nodes: Vec<(Vec3, f32)>,
    strands: Vec<(u64, Range<usize>)>,
    radii: Option<u64>,
    remarks: Vec<String>,
) -> Raw<'a> {
    let (count, all) = (strands.len(), nodes.len() as u64);
    let strand = move |(number, (offset, range)): (usize, (u64, Range<usize>))| RawStrand {
        number,
        offset,
        nodes: Box::new(Vec::from(&nodes[range]).into_iter()),
    };
    Raw {
        scale: 1.0,
        strands: Box::new(strands.into_iter().enumerate().map(strand)),
        count,
        nodes: all,
        radii,
        remarks,
    }
}

/// Checks the text and returns its strands, with radii only if they are wanted.
pub(super) fn parse_text(bytes: Bytes<'_>, wants_radii: bool) -> Result<Raw<'_>, Wrong> {
    let mut nodes: Vec<(Vec3, f32)> = Vec::new();
    let mut strands: Vec<(u64, Range<usize>)> = Vec::new();
    let (mut columns, mut radii) = (None, None);
    let mut goes_on = false;
    // Skip the empty line that appears between the two bytes of a line end on some systems.
    let lines = lines(bytes).filter(|&(start, line)| {
        let at = usize::try_from(start).unwrap_or(usize::MAX);
        !(line.is_empty() && at > 0 && bytes.0[at - 1..].starts_with(b"\r\n"))
    });
    for (start, line) in lines {
        if is_between(line) {
            goes_on = false;
            continue;
        }
        let wrong = |what: &str| (start, Problem::Text(format!("{what}, got {line:.60?}")));
        let values: Option<Vec<f32>> = numbers(line).collect();
        let values = values.ok_or_else(|| wrong("a line must have numbers: x y z radius"))?;
        if *columns.get_or_insert(values.len()) != values.len() || !matches!(values.len(), 3 | 4) {
            return Err(wrong(
                "every line must have four numbers, or every line three",
            ));
        }
        if let Some(value) = values[..3]
            .iter()
            .find(|value| value.is_nan() || value.abs() > 1e6)
        {
            return Err((start, Problem::Coordinate { value: *value }));
        }
        let radius = values.get(3).filter(|_| wants_radii).copied();
        if let Some(value) = radius.filter(|radius| !(0.0..=1e6).contains(radius)) {
            return Err((start, Problem::Thickness { value }));
        }
        radii = radii.or(radius.map(|_| start));
        if !goes_on {
            strands.push((start, nodes.len()..nodes.len()));
        }
        goes_on = true;
        nodes.push((Vec3::from_slice(&values), radius.unwrap_or(0.0)));
        if let Some((_, range)) = strands.last_mut() {
            range.end = nodes.len();
        }
    }
    if strands.is_empty() {
        let problem = "there must be a line of numbers: x y z radius";
        return Err((0, Problem::Text(problem.to_owned())));
    }
    Ok(collected(nodes, strands, radii, Vec::new()))
}

/// Checks the binary form and returns its strands.
pub(super) fn parse_binary(bytes: Bytes<'_>) -> Result<Raw<'_>, Wrong> {
    bytes.header(HEADER)?;
    let count = bytes.u32(HEADER - 4);
    if count == 0 {
        let expected = "there must be a node";
        return Err((HEADER - 4, Problem::Count { expected, got: 0 }));
    }
    let mut nodes: Vec<(Vec3, f32)> = Vec::new();
    let mut strands: Vec<(u64, Range<usize>)> = Vec::new();
    let mut offset = HEADER;
    for node in 0..count as usize {
        let begins = bytes.f32(offset).is_infinite();
        offset += if begins { 4 } else { 0 };
        // The nodes that follow take at least this much.
        bytes.length(offset + 12 * u64::from(count).saturating_sub(node as u64))?;
        if begins || strands.is_empty() {
            strands.push((offset, node..node));
        }
        nodes.push((bytes.position(offset)?, 0.0));
        offset += 12;
        if let Some((_, range)) = strands.last_mut() {
            range.end = node + 1;
        }
    }
    let remarks = bytes.remark_behind(offset).into_iter().collect();
    Ok(collected(nodes, strands, None, remarks))
}

/// Writes strands as Mitsuba reads them: a line `x y z radius` per node, and an empty line after each strand. Numbers have
/// as many digits as are needed to read back the same values.
///
/// # Errors
///
/// Returns an error if the text cannot be written.
pub fn write_mitsuba(strands: &Strands, mut to: impl Write) -> io::Result<()> {
    for strand in (0..).take(strands.strands()) {
        for node in strands.nodes_of(strand) {
            let p = strands.node_position(node);
            writeln!(to, "{} {} {} {}", p.x, p.y, p.z, strands.node_radius(node))?;
        }
        writeln!(to)?;
    }
    Ok(())
}
