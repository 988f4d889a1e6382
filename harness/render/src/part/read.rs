//! Reader of the file of a part, which does not hold the file in memory.

use super::{MAGIC, Part};
use crate::film::{Crop, Film, Sums, TILE, Tile};
use std::collections::BTreeMap;
use std::io::{self, BufRead, ErrorKind, Read};

/// Largest number of bytes of the first two lines.
const LINES: u64 = 1 << 16;

/// Source of numbers from the front of a file, which keeps their bytes for the digest behind them.
struct Source<R> {
    input: R,
    /// Bytes taken since the last digest.
    bytes: Vec<u8>,
    /// Count of the bytes up to the last digest.
    whole: usize,
    is_sealed: fn(&[u8], u64) -> bool,
}

/// Returns the error for a file that is not as a part is.
fn damaged() -> io::Error {
    ErrorKind::InvalidData.into()
}

impl<R: Read> Source<R> {
    fn take<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.input.read_exact(&mut bytes)?;
        self.bytes.extend(bytes);
        Ok(bytes)
    }

    fn number(&mut self) -> io::Result<u32> {
        self.take().map(u32::from_le_bytes)
    }

    fn double(&mut self) -> io::Result<f64> {
        self.take().map(f64::from_le_bytes)
    }

    /// Compares the bytes that were taken with the digest that follows.
    fn check(&mut self) -> io::Result<()> {
        let content = self.bytes.len();
        let check = self.take().map(u64::from_le_bytes)?;
        if !(self.is_sealed)(&self.bytes[..content], check) {
            return Err(damaged());
        }
        self.whole += self.bytes.len();
        self.bytes.clear();
        Ok(())
    }

    /// Reads a part of a picture, if it lies within the largest picture.
    fn crop(&mut self) -> io::Result<Crop> {
        let [x, y, width, height] = [
            self.number()?,
            self.number()?,
            self.number()?,
            self.number()?,
        ];
        let fits =
            |from: u32, count: u32| from.checked_add(count).is_some_and(|end| end <= 1 << 14);
        if fits(x, width) && fits(y, height) {
            Ok(Crop {
                x,
                y,
                width,
                height,
            })
        } else {
            Err(damaged())
        }
    }

    /// Reads a tile of a picture, and checks its digest.
    fn tile(&mut self, whole: Crop, side: u32) -> io::Result<Tile> {
        let place = self.crop()?;
        if !place.is_tile_of(whole, side) {
            return Err(damaged());
        }
        let (samples, seconds) = (self.number()?, self.double()?);
        let mut sums = Vec::with_capacity(place.len());
        for _ in 0..place.len() {
            let radiance = [self.double()?, self.double()?, self.double()?];
            sums.push(Sums {
                radiance,
                luminance_sq: self.double()?,
            });
        }
        let mut first = Vec::new();
        if self.number()? != 0 {
            for _ in 0..place.len() {
                let mut numbers = [0.0; 7];
                for number in &mut numbers {
                    *number = f32::from_le_bytes(self.take()?);
                }
                first.push(numbers);
            }
        }
        self.check()?;
        Ok(Tile {
            place,
            sums,
            samples,
            seconds,
            first,
        })
    }
}

/// Reads the header, then whole tiles, and returns the part with the count of their bytes. `is_sealed`
/// compares bytes with their digest.
///
/// # Errors
///
/// Returns [`ErrorKind::InvalidData`] or [`ErrorKind::UnexpectedEof`] without a whole header, and the
/// errors of the input.
pub(super) fn parse(
    mut input: impl BufRead,
    is_sealed: fn(&[u8], u64) -> bool,
) -> io::Result<(Part, usize)> {
    let mut bytes = Vec::new();
    let mut lines = input.by_ref().take(LINES);
    lines.read_until(b'\n', &mut bytes)?;
    if bytes.strip_suffix(b"\n") != Some(MAGIC.as_bytes()) {
        return Err(damaged());
    }
    lines.read_until(b'\n', &mut bytes)?;
    let run = bytes[MAGIC.len() + 1..]
        .strip_suffix(b"\n")
        .and_then(|run| core::str::from_utf8(run).ok());
    let run = run.ok_or_else(damaged)?.to_owned();
    let mut source = Source {
        input,
        bytes,
        whole: 0,
        is_sealed,
    };
    let whole = source.crop()?;
    let side = source.number()?;
    if !(1..=TILE).contains(&side) {
        return Err(damaged());
    }
    let finished = source.number()? != 0;
    source.check()?;
    let mut tiles: BTreeMap<[u32; 2], Tile> = BTreeMap::new();
    loop {
        match source.tile(whole, side) {
            Ok(tile) if tile.is_begun() => {
                // Keep tiles row by row, as in a film.
                let [x, y] = tile.key();
                tiles.insert([y, x], tile);
            }
            Ok(_) => {}
            Err(error) if is_damage(&error) => break,
            Err(error) => return Err(error),
        }
    }
    let film = Film::of(whole, side, tiles.into_values().collect());
    let part = Part {
        run,
        film,
        finished,
    };
    Ok((part, source.whole))
}

/// Returns true if a file is at fault, and not the system that reads it.
pub(super) fn is_damage(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::InvalidData | ErrorKind::UnexpectedEof
    )
}
