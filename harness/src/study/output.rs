//! A finished study, and its files.

use super::cell::Measured;
use super::part::{self, FORMAT, Finished, Header, Read, refuse};
use super::rays;
use super::rows::{Row, published, set_bounds};
use super::times::PER_POINT;
use super::view::Counted;
use super::{Grid, report};
use crate::difference::Difference;
use crate::sampler::Sampler;
use crate::subject::ModelKind;
use hairis_instruments::columns::Columns;
use hairis_instruments::error::Error;
use hairis_instruments::files::{whole, write_json};
use hairis_instruments::light::Environment;
use hairis_instruments::machine;
use hairis_instruments::shard::Shard;
use hairis_instruments::stats::Estimate;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

pub use super::times::Times;

/// Every cell of a study, in the order of the grid.
#[derive(Clone, Debug)]
pub struct Study {
    pub(super) header: Header,
    pub(super) cells: Vec<Vec<Measured>>,
    /// Times on this machine; unknown until [`time`](Self::time).
    pub(super) times: Times,
}

impl Study {
    /// The study whose cells are in `parts`, each with the file it was read from.
    ///
    /// # Errors
    ///
    /// [`Error::Part`] if they are not of one study, or of one that this program does not know; [`Error::Missing`],
    /// naming what, if cells are missing.
    pub fn join(parts: &[(PathBuf, Read)]) -> Result<Self, Error> {
        let Some((first, Read { header, .. })) = parts.first() else {
            return Err(Error::Missing("no parts".to_owned()));
        };
        let grid = Grid::of(header.quick);
        let known = header.format == FORMAT
            && header
                .models
                .iter()
                .map(String::as_str)
                .eq(ModelKind::ALL.map(ModelKind::name))
            && header
                .samplers
                .iter()
                .map(String::as_str)
                .eq(Sampler::ALL.map(Sampler::name))
            && header.cells == grid.len();
        if !known {
            let version = &header.version;
            let problem = format!(
                "is of version {version}, whose grid or samplers differ from those of this program"
            );
            return Err(refuse(first, problem));
        }
        let mut found: Vec<Option<(&Path, &Finished)>> = vec![None; header.cells];
        let mut shards: Vec<Shard> = Vec::new();
        for (path, part) in parts {
            if let Some([field, this, that]) = part.header.difference(header) {
                let problem = format!(
                    "belongs to a run with {field} {this}, but {} has {that}",
                    first.display()
                );
                return Err(refuse(path, problem));
            }
            let shard = part
                .header
                .shard()
                .map_err(|problem| refuse(path, problem))?;
            shards.push(shard);
            let of = shards[0].of();
            if shard.of() != of {
                let problem = format!(
                    "is one of {} parts, but {} is one of {of}",
                    shard.of(),
                    first.display()
                );
                return Err(refuse(path, problem));
            }
            for cell in &part.finished {
                match found[cell.cell] {
                    Some((other, before)) if before != cell => {
                        return Err(refuse(
                            path,
                            format!("differs in cell {} from {}", cell.cell, other.display()),
                        ));
                    }
                    _ => found[cell.cell] = Some((path, cell)),
                }
            }
        }
        if let Some(what) = missing(&shards, |index| found[index].is_some(), header.cells) {
            return Err(Error::Missing(what));
        }
        let cells = found.into_par_iter().flatten().map(|(_, cell)| {
            let mut measured = cell.measured();
            set_bounds(&grid.cell(cell.cell), &mut measured, header.lights.len());
            measured
        });
        let header = Header {
            shard: Shard::WHOLE.to_string(),
            ..header.clone()
        };
        Ok(Self {
            cells: cells.collect(),
            header,
            times: Times::default(),
        })
    }

    /// Reads every part file in `dirs` and joins them.
    ///
    /// # Errors
    ///
    /// As [`join`](Self::join), and [`Error::Part`] if a file cannot be read or is damaged.
    pub fn read(dirs: &[PathBuf]) -> Result<Self, Error> {
        let mut parts: Vec<(PathBuf, Read)> = Vec::new();
        for dir in dirs {
            for path in part::find(dir)? {
                let read = part::read(&path)?;
                parts.push((path, read));
            }
        }
        Self::join(&parts)
    }

    /// Header: inputs that the rows depend on.
    #[must_use]
    pub const fn header(&self) -> &Header {
        &self.header
    }

    /// The cells it is of.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        Grid::of(self.header.quick)
    }

    /// Measures the times of this machine, with nothing else at work. Without an environment its look-up is not known.
    pub fn time(&mut self, environment: Option<&Environment>) {
        let Header { seed, quick, .. } = self.header;
        self.times = Times::measure(seed, quick, environment).with_rays(seed, quick, environment);
    }

    /// The content of a `claims.json` for the report of this study.
    ///
    /// # Errors
    ///
    /// The reason why it has no place there.
    pub fn claims(&self, content: &[u8]) -> Result<Value, String> {
        let claims = serde_json::from_slice(content)
            .ok()
            .filter(report::has_claims);
        let claims: Value = claims.ok_or("it is damaged")?;
        let header = json!(self.header);
        for name in ["seed", "quick", "cells", "samples"] {
            let (here, there) = (&header[name], &claims["settings"][name]);
            if here != there {
                return Err(format!(
                    "it belongs to a run with {name} {there}, expected {here}"
                ));
            }
        }
        Ok(claims)
    }

    /// Whether the environment is the one among the lights.
    #[must_use]
    pub fn has_environment(&self, environment: &Environment) -> bool {
        self.header.environment == part::digest(environment)
    }

    /// The rows' efficiencies: what depends on the machine as well.
    ///
    /// | column | what it is |
    /// |---|---|
    /// | `cell` .. `light`, `v`, `v_se` | as in [`columns`](Self::columns) |
    /// | `break_even`, `break_even_se` | V of `published` over `v`: the time of a sample, in times of `published`, at which it loses in equal time |
    /// | `look_up_ns`, `look_up_ns_se` | time of a look-up of the light in a direction, ns |
    /// | `ns_at_N`, `efficiency_at_N` | time of a sample, ns, and `1 / (V seconds)`, for N of 1, 4 and 16 samples per shading point |
    /// | `gain_at_N`, `gain_at_N_se` | by what factor less variance than `published` it has in equal time |
    /// | `look_up_efficiency_at_N` .. `look_up_gain_at_N_se` | the three with the look-up counted in every sample's time |
    ///
    /// | `ray_ns_mis`, `ray_ns_4_4`, `ray_ns_8_8` and their `_se` | time of a ray without its tracing, ns |
    /// | `gain_4_4_at_P_us`, `gain_8_8_at_P_us` and their `_se` | efficiency of such a ray over one-sample MIS where a ray costs P of 0.1, 0.3, 1 and 3 µs, half of the directions visible |
    ///
    /// Of `perfect`, which has no time, the first two lines alone, without a break-even where its V is 0. A look-up that was
    /// not timed ([`Times::measure`]) leaves its columns empty.
    #[must_use]
    pub fn efficiencies(&self) -> Columns {
        let rows = self.rows();
        // Against itself: exactly 1.
        let is_published = |row: &Row<'_>| row.of == published(row.of);
        let against_published = |row: &Row<'_>| match is_published(row) {
            true => Estimate::exact(1.0),
            false => self
                .row(row.cell, published(row.of), row.light)
                .v()
                .ratio(&row.v()),
        };
        let gains: Vec<Estimate> = rows.iter().map(against_published).collect();
        let look_up = |row: &Row<'_>| {
            row.of
                .1
                .map_or(Estimate::UNKNOWN, |_| self.times.look_up(row.light))
        };
        let mut columns = self
            .keys(&rows)
            .estimate("v", rows.iter().map(Row::v))
            .estimate("break_even", gains.iter().copied())
            .estimate("look_up_ns", rows.iter().map(look_up));
        for per_point in PER_POINT {
            let ns = |row: &Row<'_>| self.ns(row.of, per_point).value;
            columns = columns.number(format!("ns_at_{per_point}"), rows.iter().map(ns));
            for (prefix, counted) in [("", Counted::Sample), ("look_up_", Counted::LookUp)] {
                let efficiency = |row: &Row<'_>| {
                    1e9 / (row.v().value * (ns(row) + self.more(row.light, counted).value))
                };
                let gain = |(row, gain): (&Row<'_>, &Estimate)| {
                    let time =
                        self.time_ratio([published(row.of), row.of], row.light, per_point, counted);
                    if is_published(row) && !time.value.is_nan() {
                        *gain
                    } else {
                        gain.times(&time)
                    }
                };
                columns = columns
                    .number(
                        format!("{prefix}efficiency_at_{per_point}"),
                        rows.iter().map(efficiency),
                    )
                    .estimate(
                        &format!("{prefix}gain_at_{per_point}"),
                        rows.iter().zip(&gains).map(gain),
                    );
            }
        }
        rays::efficiencies(columns, &rows, self)
    }

    /// Writes `study.csv` (the rows), `efficiency.csv`, `difference.csv` (how far apart the models are), `times.csv` and
    /// `study.json` (the settings) into `dir`, with feature `parquet` the first three as `.parquet` too, each as a whole or not
    /// at all.
    ///
    /// # Errors
    ///
    /// [`Error::Output`] for the first that cannot be written.
    pub fn write(&self, dir: &Path, difference: &Difference) -> Result<(), Error> {
        whole(&dir.join("times.csv"), |out| {
            self.times.columns(self.lights()).write_csv(out)
        })?;
        let tables = [
            ("study", self.columns()),
            ("efficiency", self.efficiencies()),
            ("difference", difference.columns()),
        ];
        for (name, columns) in tables {
            whole(&dir.join(format!("{name}.csv")), |out| {
                columns.write_csv(out)
            })?;
            #[cfg(feature = "parquet")]
            whole(&dir.join(format!("{name}.parquet")), |out| {
                columns.write_parquet(self.notes(), out)
            })?;
        }
        let settings = json!({ "study": self.header, "times_measured_on": machine!() });
        write_json(&dir.join("study.json"), &settings)
    }
}

#[cfg(feature = "parquet")]
impl Study {
    /// The header, as metadata.
    fn notes(&self) -> Vec<(String, String)> {
        let header = serde_json::to_value(&self.header).unwrap_or_default();
        let fields = header.as_object().into_iter().flatten();
        fields
            .map(|(key, value)| (format!("hairis.{key}"), value.to_string()))
            .collect()
    }
}

/// Missing parts of a study, in words; `None` if it is complete.
fn missing(shards: &[Shard], has: impl Fn(usize) -> bool, cells: usize) -> Option<String> {
    let (mut absent, mut unfinished) = (Vec::new(), Vec::new());
    for shard in Shard::all(shards[0].of()) {
        let owned: Vec<usize> = (0..cells).filter(|index| shard.owns(*index)).collect();
        let done = owned.iter().filter(|index| has(**index)).count();
        if done < owned.len() && shards.contains(&shard) {
            unfinished.push(format!("shard {shard} has {done} of {} cells", owned.len()));
        } else if done < owned.len() {
            absent.push(shard.to_string());
        }
    }
    if !absent.is_empty() {
        let plural = if absent.len() == 1 { "" } else { "s" };
        unfinished.insert(0, format!("shard{plural} {} missing", absent.join(", ")));
    }
    (!unfinished.is_empty()).then(|| unfinished.join("; "))
}
