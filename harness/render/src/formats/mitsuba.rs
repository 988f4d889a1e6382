//! Text for Mitsuba's `linearcurve` and `bsplinecurve`.

use crate::geometry::Strands;
use std::io::{self, Write};

/// Writes strands as Mitsuba reads them: a line `x y z radius` per node, and an empty line after each strand. Numbers have
/// as many digits as it takes to read back the same.
///
/// # Errors
///
/// If it cannot be written.
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
