//! Unfinished pictures as files: what a run that was stopped goes on from, and what shards leave for `merge`.

mod sealed;

pub use sealed::seal;
pub(crate) use sealed::{Reader, digest, unseal};

use crate::film::{Crop, Film, Sums, Tile};
use hairis::simd::Level;
use hairis_instruments::error::Error;
use hairis_instruments::files::whole;
use hairis_instruments::machine;
use hairis_instruments::program::say;
use std::collections::HashMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// First line of a file.
const MAGIC: &str = "hairis-render part 3";

/// Sums of tiles, and of which run they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Everything that the sums depend on, in one line: parts of equal runs may be joined, and no others.
    pub run: String,
    /// The sums.
    pub film: Film,
    /// Whether the picture has been written: a run with other settings may begin anew, then.
    pub finished: bool,
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
        let bytes = self.to_bytes();
        whole(path, |out| out.write_all(&bytes))
    }

    /// The bytes of the file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let Crop {
            x,
            y,
            width,
            height,
        } = self.film.crop();
        let mut bytes = format!("{MAGIC}\n{}\n", self.run).into_bytes();
        bytes.extend(
            [x, y, width, height, u32::from(self.finished)]
                .into_iter()
                .flat_map(u32::to_le_bytes),
        );
        for Tile {
            place,
            sums,
            samples,
            seconds,
            first,
        } in &self.film.tiles
        {
            let Crop {
                x,
                y,
                width,
                height,
            } = *place;
            bytes.extend(
                [x, y, width, height, *samples]
                    .into_iter()
                    .flat_map(u32::to_le_bytes),
            );
            bytes.extend(seconds.to_le_bytes());
            for Sums {
                radiance: [r, g, b],
                luminance_sq,
            } in sums
            {
                bytes.extend(
                    [r, g, b, luminance_sq]
                        .into_iter()
                        .flat_map(|sum| sum.to_le_bytes()),
                );
            }
            bytes.extend(u32::from(!first.is_empty()).to_le_bytes());
            bytes.extend(
                first
                    .iter()
                    .flatten()
                    .flat_map(|number| number.to_le_bytes()),
            );
        }
        seal(&mut bytes);
        bytes
    }

    /// Reads a file.
    ///
    /// # Errors
    ///
    /// If it cannot be read, or is no such file.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let refuse = |problem: String| Error::Part {
            path: path.to_owned(),
            problem,
        };
        let bytes = fs::read(path).map_err(|source| refuse(format!("cannot read: {source}")))?;
        Self::from_bytes(&bytes)
            .ok_or_else(|| refuse("damaged, or not a part of a picture: remove it".to_owned()))
    }

    /// Reads the bytes of a file; `None` if they are damaged, or not those of a part.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        parse(unseal(bytes)?)
    }

    /// Goes on from a file, if there is one and it belongs to the same run and tiles as `fresh`; otherwise `fresh`. A finished
    /// picture that the run cannot continue is no obstacle: the run begins anew, as a remark says.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read), and if the file belongs to an unfinished picture of another run, of another shard, or with more
    /// than `samples` samples.
    pub fn resume(path: &Path, fresh: Self, samples: Option<u32>) -> Result<Self, Error> {
        if !path.exists() {
            return Ok(fresh);
        }
        let part = Self::read(path)?;
        let got = part.film.samples();
        let other = if part.run != fresh.run {
            let words = difference(&part.run, &fresh.run).unwrap_or_default();
            format!("belongs to another run ({words})")
        } else if !part.film.has_tiles_of(&fresh.film) {
            "belongs to another shard".to_owned()
        } else if let Some(samples) = samples.filter(|samples| *samples < got) {
            format!("has {got} samples, more than --spp {samples}")
        } else {
            return Ok(part);
        };
        if part.finished {
            say(&format!(
                "{}: {other}; the picture is begun anew",
                path.display()
            ));
            return Ok(fresh);
        }
        let problem = format!("{other}: remove it, or choose another --out");
        Err(Error::Part {
            path: path.to_owned(),
            problem,
        })
    }

    /// Joins parts of one run into a whole picture. A tile that is in several is taken from the first.
    ///
    /// # Errors
    ///
    /// If parts belong to different runs, or tiles are missing.
    pub fn merge(parts: Vec<(PathBuf, Self)>) -> Result<Self, Error> {
        // A small picture may have shards without a tile, whose count of samples says nothing.
        let is_counted = |part: &Self| !part.film.tiles.is_empty();
        let (counted, empty): (Vec<_>, Vec<_>) =
            parts.into_iter().partition(|(_, part)| is_counted(part));
        let mut parts = counted.into_iter().chain(empty);
        let Some((first_path, first)) = parts.next() else {
            return Err(Error::Missing("no parts".to_owned()));
        };
        let (run, crop, samples) = (first.run, first.film.crop(), first.film.samples());
        let mut tiles: HashMap<[u32; 2], Tile> = HashMap::new();
        let mut add = |film: Film| {
            for tile in film.tiles {
                tiles.entry([tile.place.x, tile.place.y]).or_insert(tile);
            }
        };
        add(first.film);
        for (path, part) in parts {
            let problem = if part.run != run || part.film.crop() != crop {
                let words = difference(&part.run, &run).unwrap_or_default();
                format!(
                    "belongs to another run than {} ({words})",
                    first_path.display()
                )
            } else if is_counted(&part) && part.film.samples() != samples {
                let got = part.film.samples();
                format!(
                    "has {got} samples, expected {samples} as in {}: render it to the same --spp",
                    first_path.display()
                )
            } else {
                add(part.film);
                continue;
            };
            return Err(Error::Part { path, problem });
        }
        let all = crop.tiles().count();
        let tiles: Vec<Tile> = crop
            .tiles()
            .filter_map(|place| tiles.remove(&[place.x, place.y]))
            .collect();
        if tiles.len() < all {
            return Err(Error::Missing(format!(
                "{} of {all} tiles are in no part",
                all - tiles.len()
            )));
        }
        Ok(Self {
            run,
            film: Film::of(crop, tiles),
            finished: false,
        })
    }
}

/// What the sums of a picture depend on beside flags: the build, and whether the CPU fuses multiply and add.
pub(crate) fn build() -> String {
    let machine = machine!();
    // A commit does not tell builds with changes apart: their program does.
    let changes = if machine.dirty == Some(false) {
        String::new()
    } else {
        let program = env::current_exe().and_then(fs::read).unwrap_or_default();
        format!("+{:016x}", digest(&program))
    };
    format!(
        "commit={}{changes} fuses={}",
        machine.commit,
        Level::detect().fuses()
    )
}

/// The first word in which two runs differ.
fn difference(found: &str, expected: &str) -> Option<String> {
    let mut pairs = found.split_whitespace().zip(expected.split_whitespace());
    let (found, expected) = pairs.find(|(a, b)| a != b)?;
    Some(format!("{found}, expected {expected}"))
}

/// A part of a picture, if it lies within the largest.
fn crop(reader: &mut Reader<'_>) -> Option<Crop> {
    let [x, y, width, height] = [
        reader.number()?,
        reader.number()?,
        reader.number()?,
        reader.number()?,
    ];
    let fits = |from: u32, count: u32| from.checked_add(count).is_some_and(|end| end <= 1 << 14);
    (fits(x, width) && fits(y, height)).then_some(Crop {
        x,
        y,
        width,
        height,
    })
}

/// The two lines of text, then the numbers.
fn parse(content: &[u8]) -> Option<Part> {
    let mut lines = content.splitn(3, |byte| *byte == b'\n');
    if lines.next()? != MAGIC.as_bytes() {
        return None;
    }
    let run = core::str::from_utf8(lines.next()?).ok()?.to_owned();
    let mut rest = Reader::new(lines.next()?);
    let whole = crop(&mut rest)?;
    let finished = rest.number()? != 0;
    let mut tiles = Vec::new();
    while !rest.is_empty() {
        let place = crop(&mut rest).filter(|place| place.is_tile_of(whole))?;
        let (samples, seconds) = (rest.number()?, rest.double()?);
        let mut sums = Vec::new();
        for _ in 0..place.len() {
            let radiance = [rest.double()?, rest.double()?, rest.double()?];
            sums.push(Sums {
                radiance,
                luminance_sq: rest.double()?,
            });
        }
        let mut first = Vec::new();
        if rest.number()? != 0 {
            for _ in 0..place.len() {
                let mut numbers = [0.0; 7];
                for number in &mut numbers {
                    *number = f32::from_le_bytes(rest.bytes()?);
                }
                first.push(numbers);
            }
        }
        tiles.push(Tile {
            place,
            sums,
            samples,
            seconds,
            first,
        });
    }
    Some(Part {
        run,
        film: Film::of(whole, tiles),
        finished,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn part() -> Part {
        let mut film = Film::new(Crop {
            x: 3,
            y: 0,
            width: 70,
            height: 20,
        });
        for (k, tile) in (0_u16..).zip(&mut film.tiles) {
            tile.samples = 4;
            tile.seconds = 0.5;
            tile.first = vec![
                [0.1, 0.2, 0.3, 1.0, 0.0, 0.0, f32::from(k)];
                if k == 1 { 0 } else { tile.sums.len() }
            ];
            tile.sums
                .iter_mut()
                .for_each(|sums| sums.add(Vec3::splat(1.0 / f32::from(k + 3))));
        }
        Part {
            run: "scene=head seed=1".to_owned(),
            film,
            finished: false,
        }
    }

    #[test]
    fn files_hold_every_bit() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.part");
        part().write(&path).expect("written");
        assert_eq!(Part::read(&path).expect("read"), part());
        let bytes = fs::read(&path).expect("there");
        // Cuts between tiles among them.
        for length in 0..bytes.len() {
            assert_eq!(Part::from_bytes(&bytes[..length]), None, "cut at {length}");
        }
        for byte in (0..bytes.len()).step_by(97) {
            let mut damaged = bytes.clone();
            damaged[byte] ^= 4;
            assert_eq!(Part::from_bytes(&damaged), None, "byte {byte} changed");
        }
        assert!(Part::read(&folder.path().join("none")).is_err());
    }

    #[test]
    fn runs_go_on_from_their_own_parts() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.part");
        let fresh = |run: &str| Part {
            run: run.to_owned(),
            film: Film::new(part().film.crop()),
            finished: false,
        };
        let (same, other) = ("scene=head seed=1", "scene=head seed=2");
        let resume =
            |fresh, samples| Part::resume(&path, fresh, samples).map_err(|error| error.to_string());
        assert_eq!(
            resume(fresh(same), Some(8)),
            Ok(fresh(same)),
            "there is no file"
        );
        part().write(&path).expect("written");
        assert_eq!(resume(fresh(same), Some(4)), Ok(part()));
        assert_eq!(resume(fresh(same), None), Ok(part()));
        let refused = |fresh, samples| resume(fresh, samples).expect_err("refused");
        assert!(refused(fresh(other), None).contains("seed=1, expected seed=2"));
        assert!(refused(fresh(same), Some(3)).contains("has 4 samples, more than --spp 3"));
        let mut shard = fresh(same);
        shard.film.tiles.remove(1);
        assert!(refused(shard, None).contains("another shard"));
        Part {
            finished: true,
            ..part()
        }
        .write(&path)
        .expect("written");
        assert_eq!(
            resume(fresh(other), Some(4)),
            Ok(fresh(other)),
            "a finished picture"
        );
        assert_eq!(resume(fresh(same), Some(3)), Ok(fresh(same)));
        assert!(resume(fresh(same), Some(8)).expect("its own").finished);
    }

    #[test]
    fn parts_of_one_run_join_and_others_do_not() {
        let (mut a, mut b) = (part(), part());
        a.film.tiles.truncate(1);
        b.film.tiles.remove(0);
        let named = |name: &str, part: &Part| (PathBuf::from(name), part.clone());
        assert_eq!(
            Part::merge(vec![named("b", &b), named("a", &a)]).expect("whole"),
            part()
        );
        let message = |parts| Part::merge(parts).expect_err("refused").to_string();
        assert!(message(vec![named("a", &a)]).contains("2 of 3 tiles"));
        let mut none = b.clone();
        none.film.tiles.clear();
        assert_eq!(
            Part::merge(vec![named("none", &none), named("b", &b), named("a", &a)]).expect("whole"),
            part()
        );
        let mut more = b.clone();
        more.film.tiles.iter_mut().for_each(|tile| tile.samples = 8);
        let refused = message(vec![named("a", &a), named("more", &more)]);
        assert!(
            refused.contains("more: has 8 samples, expected 4 as in a"),
            "{refused}"
        );
        b.run = "scene=box seed=1".to_owned();
        assert!(
            message(vec![named("a", &a), named("b", &b)])
                .contains("scene=box, expected scene=head")
        );
    }
}
