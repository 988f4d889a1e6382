//! Files of hair that are written for other programs.

use super::write_mitsuba;
use crate::geometry::Strands;
use glam::Vec3;
use std::io::{self, Write};
use std::path::Path;

/// Writes strands in the format of the name's ending, in its unit: `.hair` (cyHair), `.data`
/// (USC-HairSalon), `.bin` (`CT2Hair`) or `.ply`, and with any other ending Mitsuba's text. Without
/// smoothing, [`import`](super::import) reads the same nodes.
///
/// # Errors
///
/// Returns an error if the strands cannot be written, or are more, or have more nodes, than the format counts.
pub fn write_hair(path: &Path, strands: &Strands, to: impl Write) -> io::Result<()> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    match ending.to_lowercase().as_str() {
        "hair" => cyhair(strands, to),
        "data" => counted(strands, 0.01, 0, to),
        "bin" => counted(strands, 10.0, 4, to),
        "ply" => ply(strands, to),
        _ => write_mitsuba(strands, to),
    }
}

/// Returns the number of nodes of each strand.
fn counts(strands: &Strands) -> impl Iterator<Item = usize> {
    (0..)
        .take(strands.strands())
        .map(|strand| strands.nodes_of(strand).len())
}

fn nodes(strands: &Strands) -> impl Iterator<Item = (Vec3, f32)> {
    let nodes = (0..).take(strands.nodes());
    nodes.map(|node| (strands.node_position(node), strands.node_radius(node)))
}

/// Converts a count to the type that the format has for it.
fn count<T: TryFrom<usize>>(count: usize) -> io::Result<T> {
    let too_many = |_| io::Error::new(io::ErrorKind::InvalidInput, "the format counts no further");
    T::try_from(count).map_err(too_many)
}

fn floats(to: &mut impl Write, numbers: &[f32]) -> io::Result<()> {
    let mut numbers = numbers.iter();
    numbers.try_for_each(|number| to.write_all(&number.to_le_bytes()))
}

fn cyhair(strands: &Strands, mut to: impl Write) -> io::Result<()> {
    to.write_all(b"HAIR")?;
    // Segments, points and thickness.
    for number in [
        count(strands.strands())?,
        count(strands.nodes())?,
        1 | 2 | 4,
        0_u32,
    ] {
        to.write_all(&number.to_le_bytes())?;
    }
    to.write_all(&[0; 108])?;
    for nodes in counts(strands) {
        to.write_all(&count::<u16>(nodes - 1)?.to_le_bytes())?;
    }
    for (place, _) in nodes(strands) {
        floats(&mut to, &place.to_array())?;
    }
    for (_, radius) in nodes(strands) {
        floats(&mut to, &[2.0 * radius])?;
    }
    Ok(())
}

/// Writes the strands behind their counts. Zeros follow each position, `beside` of them.
fn counted(strands: &Strands, scale: f32, beside: usize, mut to: impl Write) -> io::Result<()> {
    to.write_all(&count::<i32>(strands.strands())?.to_le_bytes())?;
    let mut nodes = nodes(strands);
    for of_strand in counts(strands) {
        to.write_all(&count::<i32>(of_strand)?.to_le_bytes())?;
        for (place, _) in nodes.by_ref().take(of_strand) {
            floats(&mut to, &(scale * place).to_array())?;
            floats(&mut to, &[0.0; 4][..beside])?;
        }
    }
    Ok(())
}

fn ply(strands: &Strands, mut to: impl Write) -> io::Result<()> {
    write!(
        to,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         property float radius\nelement strand {}\nproperty uint num_vertices\nend_header\n",
        strands.nodes(),
        strands.strands()
    )?;
    for (place, radius) in nodes(strands) {
        floats(&mut to, &place.extend(radius).to_array())?;
    }
    for nodes in counts(strands) {
        to.write_all(&count::<u32>(nodes)?.to_le_bytes())?;
    }
    Ok(())
}
