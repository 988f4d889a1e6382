//! Hair of Mitsuba: text for `linearcurve` and `bsplinecurve`, and the binary form that its earlier versions
//! had for `hair`.
//!
//! Text has a line `x y z radius` per node, and an empty line between strands. Mitsuba 0.6 and 2 also
//! have lines of `x y z`, lines of `#` between strands, and comments behind data. The binary form is little endian:
//! `BINARY_HAIR`, the number of nodes as u32, then three f32 per node, after an infinity for each node
//! that begins a strand.

use super::bytes::{Bytes, position};
use super::raw::{Raw, RawStrand};
use super::text::{Lines, data, excerpt};
use super::{Problem, Wrong};
use crate::geometry::Strands;
use core::ops::Range;
use glam::Vec3;
use std::borrow::Cow;
use std::io::{self, Write};

const SIGNATURE: &[u8] = b"BINARY_HAIR";
/// Offset of the first node.
const HEADER: u64 = 15;

pub(super) fn is_binary(bytes: Bytes<'_>) -> bool {
    bytes.0.starts_with(SIGNATURE)
}

/// Returns true if the first line with data has three or four numbers.
pub(super) fn is_text(bytes: Bytes<'_>) -> bool {
    let mut nodes = lines(bytes).filter(|(_, line)| !line.is_empty());
    let numbers = nodes.next().and_then(|(_, line)| numbers(&line));
    numbers.is_some_and(|numbers| matches!(numbers.len(), 3 | 4))
}

/// Iterates over the data of lines, which are empty between strands, and the offsets where the lines begin.
fn lines(bytes: Bytes<'_>) -> impl Iterator<Item = (u64, Cow<'_, str>)> {
    Lines::new(bytes).map(|(offset, line)| (offset, data(line.trim_ascii())))
}

fn numbers(line: &str) -> Option<Vec<f32>> {
    let words = line.split_ascii_whitespace();
    words.map(|word| word.parse().ok()).collect()
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
    for (start, line) in lines(bytes) {
        if line.is_empty() {
            goes_on = false;
            continue;
        }
        let wrong = |what: &str| {
            let problem = format!("{what}, got {}", excerpt(&line));
            (start, Problem::Text(problem))
        };
        let values =
            numbers(&line).ok_or_else(|| wrong("a line must have numbers: x y z radius"))?;
        if !matches!(values.len(), 3 | 4) {
            return Err(wrong("a line must have three or four numbers"));
        }
        let columns = *columns.get_or_insert(values.len());
        if values.len() != columns {
            let rule = format!("every line must have {columns} numbers, as the first has");
            return Err(wrong(&rule));
        }
        let place = position(Vec3::from_slice(&values), start)?;
        let radius = values.get(3).filter(|_| wants_radii).copied();
        if let Some(value) = radius.filter(|radius| !(0.0..=1e6).contains(radius)) {
            return Err((start, Problem::Thickness { value }));
        }
        radii = radii.or(radius.map(|_| start));
        if !goes_on {
            strands.push((start, nodes.len()..nodes.len()));
        }
        goes_on = true;
        nodes.push((place, radius.unwrap_or(0.0)));
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
