//! Little-endian numbers read from the bytes of a file.

use super::{LONGEST_FILE, Problem, Wrong};
use glam::Vec3;

/// Bytes of a file, from which numbers are read by offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl<'a> Bytes<'a> {
    /// Returns the length of the file in bytes.
    pub(super) fn len(self) -> u64 {
        self.0.len() as u64
    }

    /// Rejects a file that is shorter than its header.
    pub(super) fn header(self, needed: u64) -> Result<(), Wrong> {
        let got = self.len();
        if got < needed {
            Err((got, Problem::Header { needed, got }))
        } else {
            Ok(())
        }
    }

    /// Rejects a file that ends before `end`, and an `end` beyond the largest length that is read.
    pub(super) fn length(self, end: u64) -> Result<(), Wrong> {
        let got = self.len();
        if end > LONGEST_FILE {
            let most = LONGEST_FILE;
            Err((4, Problem::TooLarge { bytes: end, most }))
        } else if got < end {
            let expected = end;
            Err((got, Problem::Length { expected, got }))
        } else {
            Ok(())
        }
    }

    /// Returns a remark if the file goes on behind the end of everything that its header describes, or
    /// ends before it.
    pub(super) fn remark_behind(self, end: u64) -> Option<String> {
        let got = self.len();
        if got < end {
            let missing = end - got;
            return Some(format!(
                "warning: the last {missing} bytes are missing, which are not used"
            ));
        }
        let more = got - end;
        (more > 0).then(|| format!("warning: {more} bytes follow the end, byte {end}: not used"))
    }

    /// Returns the bytes at `offset`, or zeros beyond the end, which callers have checked.
    fn some<const N: usize>(self, offset: u64) -> [u8; N] {
        let start = usize::try_from(offset).unwrap_or(usize::MAX);
        self.0
            .get(start..)
            .and_then(|bytes| bytes.first_chunk())
            .copied()
            .unwrap_or([0; N])
    }

    pub(super) fn u16(self, offset: u64) -> u16 {
        u16::from_le_bytes(self.some(offset))
    }

    pub(super) fn u32(self, offset: u64) -> u32 {
        u32::from_le_bytes(self.some(offset))
    }

    pub(super) fn f32(self, offset: u64) -> f32 {
        f32::from_le_bytes(self.some(offset))
    }

    /// Reads a position, and rejects one that is not finite or farther than 1e6 units along an axis.
    pub(super) fn position(self, offset: u64) -> Result<Vec3, Wrong> {
        let component = |axis: u64| {
            let value = self.f32(offset + 4 * axis);
            if is_near(value) {
                Ok(value)
            } else {
                Err((offset + 4 * axis, Problem::Coordinate { value }))
            }
        };
        Ok(Vec3::new(component(0)?, component(1)?, component(2)?))
    }
}

/// Rejects a position that is not finite or farther than 1e6 units along an axis.
pub(super) fn position(place: Vec3, offset: u64) -> Result<Vec3, Wrong> {
    let components = place.to_array();
    match components.into_iter().find(|value| !is_near(*value)) {
        Some(value) => Err((offset, Problem::Coordinate { value })),
        None => Ok(place),
    }
}

fn is_near(component: f32) -> bool {
    component.abs() <= 1e6
}
