//! Log of a part, whose file grows as its picture does.

use super::{Part, record};
use crate::film::Tile;
use hairis_instruments::appended::Appended;
use hairis_instruments::error::Error;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Number of bytes that are written at once.
const BLOCK: usize = 1 << 23;
/// Largest ratio of a file's length to the length it needs, before the file is written anew.
const MOST: usize = 3;

/// File of a part, to which tiles are appended. The file is written as a whole when the first tiles
/// are saved, and again once most of it is out of date.
#[derive(Debug)]
pub struct Log {
    path: PathBuf,
    file: Option<Appended>,
    /// Samples of each tile in the file, and whether the tile has what its pixels meet first.
    saved: HashMap<[u32; 2], (u32, bool)>,
    /// Length of the file in bytes.
    length: usize,
}

fn state(tile: &Tile) -> (u32, bool) {
    (tile.samples, !tile.first.is_empty())
}

impl Log {
    /// Creates a log whose file is written when the first tiles are saved, in place of any file there.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            file: None,
            saved: HashMap::new(),
            length: 0,
        }
    }

    /// Opens a file that has the tiles of a part in its first bytes.
    pub(super) fn go_on(path: &Path, part: &Part, whole: usize) -> Result<Self, Error> {
        let file = Appended::open(path)?;
        file.cut(whole)?;
        Ok(Self {
            file: Some(file),
            saved: begun(part).collect(),
            length: whole,
            ..Self::new(path)
        })
    }

    /// Returns the path of the file to which tiles are appended.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Saves the tiles whose state differs from that in the file.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be written, or if another process is writing to it.
    pub fn save(&mut self, part: &Part) -> Result<(), Error> {
        let Some(file) = &self.file else {
            return self.write(part);
        };
        let mut block = Vec::new();
        let (mut added, mut whole) = (0, 0);
        for tile in part.film.tiles.iter().filter(|tile| tile.is_begun()) {
            let size = || record_size(tile);
            whole += size();
            if self.saved.get(&tile.key()) == Some(&state(tile)) {
                continue;
            }
            block.extend(record(tile));
            added += size();
            if block.len() >= BLOCK {
                file.append(&block)?;
                block.clear();
            }
        }
        file.append(&block)?;
        self.saved.extend(begun(part));
        self.length += added;
        if self.length > MOST * whole + BLOCK {
            self.write(part)?;
        }
        Ok(())
    }

    /// Writes the file as a whole, with the current state of every tile.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`save`](Self::save).
    pub fn write(&mut self, part: &Part) -> Result<(), Error> {
        if self.file.take().is_none() && self.path.exists() {
            // Fail if another process holds the file.
            Appended::open(&self.path)?;
        }
        part.write(&self.path)?;
        self.saved = begun(part).collect();
        self.length = part.film.tiles.iter().map(record_size).sum();
        self.file = Some(Appended::open(&self.path)?);
        Ok(())
    }
}

/// Iterates over the tiles that a file has, with their states.
fn begun(part: &Part) -> impl Iterator<Item = ([u32; 2], (u32, bool))> {
    let begun = part.film.tiles.iter().filter(|tile| tile.is_begun());
    begun.map(|tile| (tile.key(), state(tile)))
}

/// Returns the bytes of a tile in a file, or a few more.
fn record_size(tile: &Tile) -> usize {
    64 + 32 * tile.sums.len() + 28 * tile.first.len()
}
