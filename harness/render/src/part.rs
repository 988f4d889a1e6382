//! Unfinished pictures as files: what a run that was stopped goes on from, and what shards leave for `merge`.

use crate::film::{Crop, Film, Sums, Tile};
use hairis::Level;
use hairis_harness::error::Error;
use hairis_harness::files::whole;
use hairis_harness::machine::Machine;
use hairis_harness::sequence::mix;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// First line of a file.
const MAGIC: &str = "hairis-render part 1";

/// Sums of tiles, and of which run they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Everything that the sums depend on, in one line: parts of equal runs may be joined, and no others.
    pub run: String,
    /// The sums.
    pub film: Film,
}

/// Where the part of a picture lies while it is unfinished.
#[must_use]
pub fn path(picture: &Path) -> PathBuf {
    picture.with_extension("part")
}

impl Part {
    /// Writes the file as a whole.
    ///
    /// # Errors
    ///
    /// If it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let Crop { x, y, width, height } = self.film.crop();
        whole(path, |out| {
            out.write_all(format!("{MAGIC}\n{}\n", self.run).as_bytes())?;
            for number in [x, y, width, height] {
                out.write_all(&number.to_le_bytes())?;
            }
            for tile in &self.film.tiles {
                let Crop { x, y, width, height } = tile.place;
                for number in [x, y, width, height, tile.samples] {
                    out.write_all(&number.to_le_bytes())?;
                }
                out.write_all(&tile.seconds.to_le_bytes())?;
                for Sums { radiance: [r, g, b], luminance_sq } in &tile.sums {
                    for sum in [r, g, b, luminance_sq] {
                        out.write_all(&sum.to_le_bytes())?;
                    }
                }
            }
            Ok(())
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    ///
    /// If it cannot be read, or is no such file.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let refuse = |problem: String| Error::Part { path: path.to_owned(), problem };
        let bytes = fs::read(path).map_err(|source| refuse(format!("cannot read: {source}")))?;
        parse(&bytes).ok_or_else(|| refuse("not a part of a picture, or cut short".to_owned()))
    }

    /// Reads a file of the same run, with the same tiles, as `expected`.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read), and if it belongs to another run or to another shard.
    pub fn read_of(path: &Path, expected: &Self) -> Result<Self, Error> {
        let part = Self::read(path)?;
        let other = if part.run != expected.run {
            format!("another run ({})", difference(&part.run, &expected.run).unwrap_or_default())
        } else if !part.film.has_tiles_of(&expected.film) {
            "another shard".to_owned()
        } else {
            return Ok(part);
        };
        let problem = format!("belongs to {other}: remove it, or choose another --out");
        Err(Error::Part { path: path.to_owned(), problem })
    }

    /// Joins parts of one run into a whole picture. A tile that is in several is taken from the first.
    ///
    /// # Errors
    ///
    /// If parts belong to different runs, or tiles are missing.
    pub fn merge(parts: Vec<(PathBuf, Self)>) -> Result<Self, Error> {
        let mut parts = parts.into_iter();
        let Some((_, mut first)) = parts.next() else { return Err(Error::Missing("no parts".to_owned())) };
        for (path, part) in parts {
            if part.run != first.run || part.film.crop() != first.film.crop() {
                let problem = format!(
                    "belongs to another run than the first ({})",
                    difference(&part.run, &first.run).unwrap_or_default()
                );
                return Err(Error::Part { path, problem });
            }
            first.film.tiles.extend(part.film.tiles);
        }
        let crop = first.film.crop();
        let found = |place| first.film.tiles.iter().find(|one| one.place == place && one.samples > 0);
        let tiles: Vec<Tile> = crop.tiles().filter_map(found).cloned().collect();
        let (all, there) = (crop.tiles().count(), tiles.len());
        if there < all {
            return Err(Error::Missing(format!("{} of {all} tiles are in no part", all - there)));
        }
        if tiles.iter().any(|tile| tile.samples != tiles[0].samples) {
            return Err(Error::Missing("parts have different counts of samples".to_owned()));
        }
        Ok(Self { run: first.run, film: Film::of(crop, tiles) })
    }
}

/// A number that differs where bytes do, but by chance.
pub(crate) fn digest(bytes: &[u8]) -> u64 {
    bytes.chunks(8).fold(bytes.len() as u64, |hash, chunk| {
        mix(hash ^ chunk.iter().fold(0, |word, byte| word << 8 | u64::from(*byte)))
    })
}

/// What the sums of a picture depend on beside flags: the build, and whether the CPU fuses multiply and add.
pub(crate) fn build() -> String {
    let machine = Machine::current();
    // A commit does not tell builds with changes apart: their program does.
    let changes = if machine.dirty == Some(false) {
        String::new()
    } else {
        let program = env::current_exe().and_then(fs::read).unwrap_or_default();
        format!("+{:016x}", digest(&program))
    };
    format!("commit={}{changes} fuses={}", machine.commit, Level::detect().fuses())
}

/// The first word in which two runs differ.
fn difference(found: &str, expected: &str) -> Option<String> {
    let mut pairs = found.split_whitespace().zip(expected.split_whitespace());
    let (found, expected) = pairs.find(|(a, b)| a != b)?;
    Some(format!("{found}, expected {expected}"))
}

/// Takes numbers from the front.
pub(crate) struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*first)
    }

    pub(crate) fn number(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    pub(crate) fn double(&mut self) -> Option<f64> {
        self.bytes().map(f64::from_le_bytes)
    }

    fn crop(&mut self) -> Option<Crop> {
        let [x, y, width, height] = [self.number()?, self.number()?, self.number()?, self.number()?];
        let fits = |from: u32, count: u32| from.checked_add(count).is_some_and(|end| end <= 1 << 14);
        (fits(x, width) && fits(y, height)).then_some(Crop { x, y, width, height })
    }
}

fn parse(bytes: &[u8]) -> Option<Part> {
    let mut lines = bytes.splitn(3, |byte| *byte == b'\n');
    if lines.next()? != MAGIC.as_bytes() {
        return None;
    }
    let run = core::str::from_utf8(lines.next()?).ok()?.to_owned();
    let mut rest = Reader::new(lines.next()?);
    let crop = rest.crop()?;
    let mut tiles = Vec::new();
    while !rest.is_empty() {
        let place = rest.crop()?;
        if !crop.tiles().any(|tile| tile == place) {
            return None;
        }
        let (samples, seconds) = (rest.number()?, rest.double()?);
        let mut sums = Vec::new();
        for _ in 0..place.len() {
            let radiance = [rest.double()?, rest.double()?, rest.double()?];
            sums.push(Sums { radiance, luminance_sq: rest.double()? });
        }
        tiles.push(Tile { place, sums, samples, seconds });
    }
    Some(Part { run, film: Film::of(crop, tiles) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn part() -> Part {
        let mut film = Film::new(Crop { x: 3, y: 0, width: 70, height: 20 });
        for (k, tile) in (0_u16..).zip(&mut film.tiles) {
            tile.samples = 4;
            tile.seconds = 0.5;
            tile.sums.iter_mut().for_each(|sums| sums.add(Vec3::splat(1.0 / f32::from(k + 3))));
        }
        Part { run: "scene=head seed=1".to_owned(), film }
    }

    #[test]
    fn files_hold_every_bit() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.part");
        part().write(&path).expect("written");
        assert_eq!(Part::read(&path).expect("read"), part());
        let read_of = |expected: &Part| Part::read_of(&path, expected).map_err(|error| error.to_string());
        assert_eq!(read_of(&part()), Ok(part()));
        let other = read_of(&Part { run: "scene=head seed=2".to_owned(), ..part() }).expect_err("another run");
        assert!(other.contains("seed=1, expected seed=2"), "{other}");
        let mut shard = part();
        shard.film.tiles.remove(1);
        assert!(read_of(&shard).expect_err("another shard").contains("another shard"));
        let bytes = fs::read(&path).expect("there");
        for length in (0..bytes.len()).step_by(97) {
            let cut = parse(&bytes[..length]);
            // A cut between tiles leaves fewer of them, which `merge` finds.
            assert!(cut.is_none_or(|cut| cut.film.tiles.len() < part().film.tiles.len()), "cut at {length}");
        }
        assert!(Part::read(&folder.path().join("none")).is_err());
    }

    #[test]
    fn parts_of_one_run_join_and_others_do_not() {
        let (mut a, mut b) = (part(), part());
        a.film.tiles.truncate(1);
        b.film.tiles.remove(0);
        let named = |name: &str, part: &Part| (PathBuf::from(name), part.clone());
        assert_eq!(Part::merge(vec![named("b", &b), named("a", &a)]).expect("whole"), part());
        let message = |parts| Part::merge(parts).expect_err("refused").to_string();
        assert!(message(vec![named("a", &a)]).contains("2 of 3 tiles"));
        b.run = "scene=box seed=1".to_owned();
        assert!(message(vec![named("a", &a), named("b", &b)]).contains("scene=box, expected scene=head"));
    }
}
