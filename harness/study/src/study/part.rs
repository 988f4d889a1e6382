//! Part files: finished cells, one per line, after a header line.
//!
//! Part files are only ever appended to, a whole line at a time. A process that is killed leaves at most its last line torn; the next run
//! drops that line and computes its cell again. Each line ends in a checksum of the rest of the line.

pub use hairis_harness::sealed::line;

use super::grid::Size;
use hairis_harness::materials::MaterialKey;
use hairis_harness::sealed::unseal;
use hairis_harness::variance::{Figures, Measured};
use hairis_instruments::appended::Appended;
use hairis_instruments::error::Error;
use hairis_instruments::light::Environment;
use hairis_instruments::shard::Shard;
use hairis_instruments::stats::Estimate;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// First word of every part file, which stands for the layout of its lines.
pub const FORMAT: &str = "hairis-study-4";

/// Header of a part file. Parts of one study agree in every field except the shard.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Layout of the lines, which is [`FORMAT`] in this version.
    pub format: String,
    /// Version of the program.
    pub version: String,
    /// Commit of the program, with "+changes" if the files differed from the commit.
    pub commit: String,
    /// Instruction set of the eight lanes, and those the rest was compiled for. Last digits depend on both.
    pub level: String,
    /// Whether this is the short run.
    pub quick: bool,
    /// Seed of every stream.
    pub seed: u64,
    /// Number of samples of each sampler of each model in a cell.
    pub samples: usize,
    /// Number of samples of each light in a cell.
    pub light_samples: usize,
    /// Number of pools of 32 + 32 candidates of each sampler and light in a cell; none in parts of earlier formats.
    #[serde(default)]
    pub pools: usize,
    /// Digest of the environment's pixels.
    pub environment: String,
    /// Names of the models, in the order of the rows.
    pub models: Vec<String>,
    /// Names of the samplers, in the order of the rows.
    pub samplers: Vec<String>,
    /// Names of the lights, in the order of the rows.
    pub lights: Vec<String>,
    /// Number of cells of the grid.
    pub cells: usize,
    /// Materials beside the hair of the grid, whose cells follow those of the grid; none in earlier versions.
    #[serde(default)]
    pub materials: Vec<MaterialKey>,
    /// Shard that the part holds, as `I/N`.
    pub shard: String,
}

/// Returns the digest of an environment, as headers have it.
pub(super) fn digest(environment: &Environment) -> String {
    format!("{:016x}", environment.digest())
}

impl Header {
    /// Returns the number of rows of a cell, which are those of the samplers and of perfect sampling.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.models.len() * (self.samplers.len() + 1) * self.lights.len()
    }

    /// Returns the size of the run, which the number of its cells tells.
    #[must_use]
    pub fn size(&self) -> Size {
        let mut all = Size::ALL.into_iter();
        let size = all.find(|size| size.grid().len() == self.cells);
        size.unwrap_or(Size::of_flags(self.quick, false))
    }

    /// Returns the number of cells of the grid and of the materials together.
    #[must_use]
    pub fn work(&self) -> usize {
        let poses = self.size().grid().theta_o_deg.len();
        self.cells.saturating_add(poses * self.materials.len())
    }

    /// Returns the number of rows of the cell with this index.
    fn rows_of(&self, cell: usize) -> usize {
        let Some(place) = cell.checked_sub(self.cells) else {
            return self.rows();
        };
        let poses = self.size().grid().theta_o_deg.len();
        let material = self.materials.get(place / poses);
        material.map_or(0, |key| (key.samplers.len() + 1) * self.lights.len())
    }

    /// Returns the first field in which `other` differs, with its value here and there, or `None` if no field but the shard differs.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<[String; 3]> {
        let fields = |of: &Self| {
            let mut fields = serde_json::to_value(of).unwrap_or_default();
            // In an error message the names suffice, unless they are the same.
            if self
                .materials
                .iter()
                .map(|key| &key.name)
                .ne(other.materials.iter().map(|key| &key.name))
            {
                fields["materials"] = of.materials.iter().map(|key| &*key.name).collect();
            }
            fields
        };
        let [ours, theirs] = [self, other].map(fields);
        ours.as_object()?
            .iter()
            .filter(|(name, _)| *name != "shard")
            .find_map(|(name, here)| {
                let there = &theirs[name];
                (here != there)
                    .then(|| [name.replace('_', " "), here.to_string(), there.to_string()])
            })
    }

    /// Parses the shard of the part.
    ///
    /// # Errors
    ///
    /// Returns the reason, in words, if the header's shard is invalid.
    pub fn shard(&self) -> Result<Shard, String> {
        self.shard
            .parse()
            .map_err(|problem| format!("shard {problem}"))
    }
}

/// Count of the numbers in a row of a cell.
pub const NUMBERS: usize = 15;

/// Figures of a finished cell, row by row: mean, V and divergence, each with its standard error, the largest weight and the largest
/// contribution; then V of one ray by one-sample MIS and from each size of pool, each with its standard error, and the bias of pools. NaN
/// and infinity are stored as `None`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// Index of the cell in the grid, or behind it for materials.
    pub cell: usize,
    /// Rows of the cell: models outermost, then samplers, then lights; after them those of perfect sampling, models, then lights.
    pub rows: Vec<[Option<f64>; NUMBERS]>,
}

impl Finished {
    /// Makes the line of a cell from its figures.
    #[must_use]
    pub fn of(cell: usize, rows: &[Measured]) -> Self {
        let row = |of: &Measured| {
            let pair = |of: Estimate| [of.value, of.standard_error];
            let [mean, v, kl] = [of.figures.mean, of.figures.v, of.figures.kl].map(pair);
            let [mis, small, large] = of.rays.unwrap_or([Estimate::UNKNOWN; 3]).map(pair);
            let pairs = [
                mean,
                v,
                kl,
                [of.max_weight, of.max_contribution],
                mis,
                small,
                large,
            ];
            let mut numbers = [of.bias; NUMBERS];
            for (number, x) in numbers.iter_mut().zip(pairs.as_flattened()) {
                *number = Some(*x);
            }
            numbers.map(|x| x.filter(|x| x.is_finite()))
        };
        Self {
            cell,
            rows: rows.iter().map(row).collect(),
        }
    }

    /// Returns the figures of the rows.
    #[must_use]
    pub fn measured(&self) -> Vec<Measured> {
        let row = |row: &[Option<f64>; NUMBERS]| {
            let number = |place: usize| row[place].unwrap_or(f64::NAN);
            let of = |place: usize| Estimate {
                value: number(place),
                standard_error: number(place + 1),
            };
            Measured {
                figures: Figures {
                    mean: of(0),
                    v: of(2),
                    kl: of(4),
                },
                max_weight: number(6),
                weight_bound: None,
                max_contribution: number(7),
                rays: row[8].map(|_| [8, 10, 12].map(of)),
                bias: row[14],
            }
        };
        self.rows.iter().map(row).collect()
    }
}

/// Content of a part file, read to its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// Header from the first line.
    pub header: Header,
    /// Cells, in the order in which they were finished.
    pub finished: Vec<Finished>,
    /// Number of bytes up to the end of the last whole line.
    whole: usize,
}

/// Returns the part files in `dir`, by name.
///
/// # Errors
///
/// Returns [`Error::Part`] if the folder cannot be read or holds no part file.
pub fn find(dir: &Path) -> Result<Vec<PathBuf>, Error> {
    let paths = |entries: fs::ReadDir| {
        entries
            .map(|entry| Ok(entry?.path()))
            .collect::<io::Result<Vec<PathBuf>>>()
    };
    let mut found = fs::read_dir(dir)
        .and_then(paths)
        .map_err(|source| refuse(dir, format!("cannot read: {source}")))?;
    found.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("cells-") && name.ends_with(".jsonl")
    });
    if found.is_empty() {
        return Err(refuse(
            dir,
            "contains no part of a study (cells-I-of-N.jsonl)",
        ));
    }
    found.sort();
    Ok(found)
}

/// Reads a part file, except for a last line that is torn.
///
/// # Errors
///
/// Returns [`Error::Part`] if the file cannot be read, is not a part file, or is damaged elsewhere than at its end.
pub fn read(path: &Path) -> Result<Read, Error> {
    let bytes = fs::read(path).map_err(|source| refuse(path, format!("cannot read: {source}")))?;
    parse(path, &bytes)?
        .ok_or_else(|| refuse(path, "is no part of a study: its header line is missing"))
}

/// Parses the part in `bytes`; `None` if not even its first line is whole.
///
/// # Errors
///
/// Returns [`Error::Part`] if the content is damaged beyond its last line.
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Option<Read>, Error> {
    let Some(last) = bytes.iter().rposition(|byte| *byte == b'\n') else {
        return Ok(None);
    };
    let mut lines = bytes[..last].split(|byte| *byte == b'\n');
    let first = lines.next().unwrap_or_default();
    // Parts of earlier versions have no checksums; their format distinguishes them.
    let (first, is_right) = unseal(first).unwrap_or_else(|| (first.to_vec(), true));
    if !is_right {
        return Err(refuse(
            path,
            "line 1 is damaged: its checksum is wrong; delete the file",
        ));
    }
    let header: Header =
        serde_json::from_slice(&first).map_err(|_| refuse(path, "is no part of a study"))?;
    if header.format != FORMAT {
        return Ok(Some(Read {
            header,
            finished: Vec::new(),
            whole: last + 1,
        }));
    }
    let shard = header.shard().map_err(|problem| refuse(path, problem))?;
    let mut finished = Vec::new();
    for (line, number) in lines.zip(2..) {
        let damaged = |problem: &str| {
            let advice = "delete the line, and `hairis study` computes it again";
            refuse(
                path,
                format!("line {number} is damaged: {problem}; {advice}"),
            )
        };
        let (line, is_right) = unseal(line).ok_or_else(|| damaged("not a cell"))?;
        if !is_right {
            return Err(damaged("its checksum is wrong"));
        }
        let cell: Finished = serde_json::from_slice(&line).map_err(|_| damaged("not a cell"))?;
        if cell.cell >= header.work() || !shard.owns(cell.cell) {
            return Err(damaged(&format!(
                "cell {} is not of shard {shard}",
                cell.cell
            )));
        }
        if cell.rows.len() != header.rows_of(cell.cell) {
            return Err(damaged(&format!(
                "{} rows, expected {}",
                cell.rows.len(),
                header.rows_of(cell.cell)
            )));
        }
        finished.push(cell);
    }
    Ok(Some(Read {
        header,
        finished,
        whole: last + 1,
    }))
}

/// Returns the error for a part, or a folder of parts, that cannot be used.
pub(super) fn refuse(path: &Path, problem: impl Into<String>) -> Error {
    Error::Part {
        path: path.to_owned(),
        problem: problem.into(),
    }
}

/// Part file that is being written, one finished cell at a time.
#[derive(Debug)]
pub struct Part(Appended);

impl Part {
    /// Opens the part file of `header` in `dir`, or begins it. Returns the cells that it has as well.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] if the file cannot be written, and [`Error::Part`] if the file belongs to another study, is damaged, or is
    /// in use.
    pub fn open(dir: &Path, header: &Header) -> Result<(Self, Vec<Finished>), Error> {
        let shard = header.shard().map_err(Error::Usage)?;
        let path = dir.join(format!("cells-{}-of-{}.jsonl", shard.index(), shard.of()));
        let output = Error::output(&path);
        let file = Appended::open(&path)?;
        let bytes = fs::read(&path).map_err(&output)?;
        let first = line(header).map_err(&output)?;
        let (whole, finished) = match parse(&path, &bytes)? {
            Some(read) => {
                if let Some([field, was, is]) = read.header.difference(header) {
                    let run = format!("belongs to a run with {field} {was}, expected {is}");
                    return Err(refuse(
                        &path,
                        format!("{run}; pass another --out or delete the file"),
                    ));
                }
                (read.whole, read.finished)
            }
            None if first.starts_with(&bytes) => (0, Vec::new()),
            None => return Err(refuse(&path, "is no part of a study")),
        };
        file.cut(whole)?;
        if whole == 0 {
            file.append(&first)?;
        }
        Ok((Self(file), finished))
    }

    /// Returns the path of the part file.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// Appends a finished cell to the file, as a line with its checksum.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] if the line cannot be written.
    pub fn keep(&self, finished: &Finished) -> Result<(), Error> {
        let line = line(finished).map_err(Error::output(self.path()))?;
        self.0.append(&line)
    }
}
