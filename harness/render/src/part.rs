//! Unfinished pictures as files, from which stopped runs continue and which shards leave for `merge`.
//!
//! A file has a header, followed by tiles, each with a digest of its own. A [`Log`] appends tiles as
//! they are rendered, and the last record of a tile counts. A process that is killed leaves at most its
//! last tile torn, which readers leave out.

mod log;
mod read;
mod sealed;

pub use log::Log;
pub(crate) use sealed::{Reader, digest, seal, unseal};

use crate::film::{Crop, Film, Sums, Tile};
use hairis::simd::Level;
use hairis_instruments::error::Error;
use hairis_instruments::files::whole;
use hairis_instruments::machine;
use hairis_instruments::program::say;
use read::{is_damage, parse};
use std::collections::HashMap;
use std::env;
use std::fs::{self, File};
use std::io::{self, BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};

/// Beginning of the first line of a file, without the number of the format.
const FORMAT: &str = "hairis-render part ";
/// First line of a file, with the number of the format.
pub const MAGIC: &str = "hairis-render part 4";

/// Part of a picture: the sums of tiles, and the run to which they belong.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Line of everything that the sums depend on. Only parts of equal runs may be joined.
    pub run: String,
    /// Film with the sums of the tiles.
    pub film: Film,
    /// Whether the picture has been written, so that a run with other settings may begin anew.
    pub finished: bool,
}

/// Returns the path of the part of an unfinished picture, with the ending `part`.
#[must_use]
pub fn path(picture: &Path) -> PathBuf {
    picture.with_extension("part")
}

impl Part {
    /// Writes the file as a whole: the header, and a record of every tile that is begun.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        whole(path, |out| self.write_to(out))
    }

    /// Encodes the part as the bytes of its file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        // Ignore errors, because writing into memory does not fail.
        let _ = self.write_to(&mut bytes);
        bytes
    }

    fn write_to(&self, out: &mut impl io::Write) -> io::Result<()> {
        out.write_all(&self.header())?;
        let mut begun = self.film.tiles.iter().filter(|tile| tile.is_begun());
        begun.try_for_each(|tile| out.write_all(&record(tile)))
    }

    /// Returns the bytes of the file before its tiles.
    #[must_use]
    pub fn header(&self) -> Vec<u8> {
        let Crop {
            x,
            y,
            width,
            height,
        } = self.film.crop();
        let mut bytes = format!("{MAGIC}\n{}\n", self.run).into_bytes();
        bytes.extend(
            [
                x,
                y,
                width,
                height,
                self.film.side(),
                u32::from(self.finished),
            ]
            .into_iter()
            .flat_map(u32::to_le_bytes),
        );
        seal(&mut bytes);
        bytes
    }

    /// Reads a file. Bytes at the end that are no whole record are left out, with a remark.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be read, or is not a part of a picture.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::read_whole(path).map(|(part, _)| part)
    }

    /// Reads a file, and returns how many of its bytes are whole.
    fn read_whole(path: &Path) -> Result<(Self, usize), Error> {
        let refuse = |problem: String| Error::Part {
            path: path.to_owned(),
            problem,
        };
        let unread = |source: io::Error| refuse(format!("cannot read: {source}"));
        let file = File::open(path).map_err(unread)?;
        let length = file.metadata().map_err(unread)?.len();
        let (part, whole) = parse(BufReader::new(file), is_sealed).map_err(|error| {
            if is_damage(&error) {
                refuse(problem(path))
            } else {
                unread(error)
            }
        })?;
        let left = length.saturating_sub(whole as u64);
        if left > 0 {
            say(&format!(
                "{}: the last {left} bytes are not whole, and left out",
                path.display()
            ));
        }
        Ok((part, whole))
    }

    /// Reads a part from the bytes of a file. Returns `None` if they are damaged, or not those of a part.
    /// Bytes at the end that are no whole record are left out.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        parse(bytes, is_sealed).ok().map(|(part, _)| part)
    }

    /// Reads a part without a check of the digests, for tests of the reader.
    #[must_use]
    pub fn from_bytes_unchecked(bytes: &[u8]) -> Option<Self> {
        parse(bytes, |_, _| true).ok().map(|(part, _)| part)
    }

    /// Continues from a file, if there is one and it belongs to the same run and tiles as `fresh`; otherwise returns `fresh`. A finished
    /// picture that the run cannot continue is no obstacle: the run begins anew, as a remark says.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`read`](Self::read). Also returns an error if the file belongs to an
    /// unfinished picture of another run, of another shard, or with more than `samples` samples, or if
    /// another process is writing to the file.
    pub fn resume(
        path: &Path,
        mut fresh: Self,
        samples: Option<u32>,
    ) -> Result<(Self, Log), Error> {
        if !path.exists() {
            let log = Log::new(path);
            return Ok((fresh, log));
        }
        let (
            Self {
                run,
                film,
                finished,
            },
            whole,
        ) = Self::read_whole(path)?;
        let got = film.most_samples();
        let other = if run != fresh.run {
            let words = difference(&run, &fresh.run).unwrap_or_default();
            format!("belongs to another run ({words})")
        } else if let Some(samples) = samples.filter(|samples| *samples < got) {
            format!("has {got} samples, more than --spp {samples}")
        } else if fresh.film.adopt(film).is_err() {
            "belongs to another shard".to_owned()
        } else {
            fresh.finished = finished;
            let log = Log::go_on(path, &fresh, whole)?;
            return Ok((fresh, log));
        };
        if finished {
            say(&format!(
                "{}: {other}; the picture is begun anew",
                path.display()
            ));
            let log = Log::new(path);
            return Ok((fresh, log));
        }
        let problem = format!("{other}: remove it, or choose another --out");
        Err(Error::Part {
            path: path.to_owned(),
            problem,
        })
    }

    /// Joins parts of one run into a whole picture. A tile that is in several parts is taken from the first.
    ///
    /// # Errors
    ///
    /// Returns an error if parts belong to different runs, have different counts of samples, or lack tiles.
    pub fn merge(parts: Vec<(PathBuf, Self)>) -> Result<Self, Error> {
        // A small picture may have shards without a tile, whose count of samples says nothing.
        let is_counted = |part: &Self| !part.film.tiles.is_empty();
        let (counted, empty): (Vec<_>, Vec<_>) =
            parts.into_iter().partition(|(_, part)| is_counted(part));
        let mut parts = counted.into_iter().chain(empty);
        let Some((first_path, first)) = parts.next() else {
            return Err(Error::Missing("no parts".to_owned()));
        };
        let (run, crop, samples) = (first.run.clone(), first.film.crop(), first.film.samples());
        let side = first.film.side();
        let mut tiles: HashMap<[u32; 2], Tile> = HashMap::new();
        let mut add = |film: Film| {
            for tile in film.tiles {
                tiles.entry(tile.key()).or_insert(tile);
            }
        };
        for (path, part) in [(first_path.clone(), first)].into_iter().chain(parts) {
            let most = part.film.most_samples();
            let problem = if part.run != run || (part.film.crop(), part.film.side()) != (crop, side)
            {
                let words = difference(&part.run, &run).unwrap_or_default();
                format!(
                    "belongs to another run than {} ({words})",
                    first_path.display()
                )
            } else if part.film.samples() < most {
                let got = part.film.samples();
                format!("has tiles of {got} to {most} samples: start its run again to finish it")
            } else if is_counted(&part) && most != samples {
                let got = most;
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
        let all = crop.tiles(side).count();
        let tiles: Vec<Tile> = crop
            .tiles(side)
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
            film: Film::of(crop, side, tiles),
            finished: false,
        })
    }
}

/// Returns the identity of the build that the sums depend on: the build, and whether the CPU fuses multiply and add.
#[must_use]
pub fn build() -> String {
    let machine = machine!();
    // A commit does not distinguish builds with changes, but a digest of the program does.
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

/// Returns the first word in which two runs differ.
fn difference(found: &str, expected: &str) -> Option<String> {
    let mut pairs = found.split_whitespace().zip(expected.split_whitespace());
    let (found, expected) = pairs.find(|(a, b)| a != b)?;
    Some(format!("{found}, expected {expected}"))
}

/// Describes the fault of a file without a whole header.
fn problem(path: &Path) -> String {
    let mut first = String::new();
    // A file that is not text is no part of any format.
    let read = File::open(path).map(|file| BufReader::new(file.take(80)).read_line(&mut first));
    let got = first.trim_end();
    if read.is_ok() && got.starts_with(FORMAT) && got != MAGIC {
        format!("expected \"{MAGIC}\", got \"{got}\": remove it")
    } else {
        "damaged, or not a part of a picture: remove it".to_owned()
    }
}

/// Encodes a tile as a record of the file.
#[must_use]
pub fn record(tile: &Tile) -> Vec<u8> {
    let Tile {
        place,
        sums,
        samples,
        seconds,
        first,
    } = tile;
    let Crop {
        x,
        y,
        width,
        height,
    } = *place;
    let mut bytes = Vec::with_capacity(64 * (1 + sums.len()));
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
    seal(&mut bytes);
    bytes
}

/// Returns true if `check` is the digest of the bytes before it.
fn is_sealed(bytes: &[u8], check: u64) -> bool {
    digest(bytes) == check
}
