//! A finished study, and its files.

use super::cell::Measured;
use super::columns::Columns;
use super::part::{self, FORMAT, Finished, Header, Read};
use super::rows::{self, Bounds, Row, Strategy, rows};
use super::times::{self, PER_POINT, Time};
use super::{Grid, Shard, check, grid_of, summary};
use crate::difference::Difference;
use crate::efficiency::ModelKind;
use crate::error::Error;
use crate::files::whole;
use crate::machine::Machine;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::table::Table;
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Every cell of a study, in the order of the grid.
#[derive(Clone, Debug)]
pub struct Study {
    pub(super) header: Header,
    pub(super) cells: Vec<Vec<Measured>>,
    pub(super) bounds: Bounds,
}

/// Times of a sample, measured on this machine.
#[derive(Clone, Debug)]
pub struct Times(Vec<Time>);

impl Times {
    /// Measures them, with nothing else at work: in about three seconds, or less than one if `quick`.
    #[must_use]
    pub fn measure(seed: u64, quick: bool) -> Self {
        Self(times::measure(seed, if quick { 15 } else { 75 }))
    }

    /// Median time of a sample in ns, for 1, 4 or 16 samples a gather point; not a number for others.
    pub(crate) fn ns(&self, model: ModelKind, sampler: Sampler, per_point: usize) -> Estimate {
        times::ns(&self.0, model, sampler, per_point)
    }
}

impl Study {
    /// The study whose cells are in `parts`, each with the file it was read from.
    ///
    /// # Errors
    ///
    /// [`Error::Part`] if they are not of one study, or of one that this program does not know; [`Error::Missing`],
    /// naming what, if cells are missing.
    pub fn join(parts: &[(PathBuf, Read)]) -> Result<Self, Error> {
        let Some((path, first)) = parts.first() else {
            return Err(Error::Missing("no parts".to_owned()));
        };
        let header = &first.header;
        let refuse = |path: &Path, problem: String| Error::Part { path: path.to_owned(), problem };
        let grid = grid_of(header.quick);
        let known = header.format == FORMAT
            && header.models.iter().map(String::as_str).eq(ModelKind::ALL.map(ModelKind::name))
            && header.samplers.iter().map(String::as_str).eq(Sampler::ALL.map(Sampler::name))
            && header.cells == grid.len();
        if !known {
            return Err(refuse(path, format!("is of version {} with another grid or other samplers", header.version)));
        }
        let of = header.shard().map_err(|problem| refuse(path, problem))?.of();
        let mut found: Vec<Option<(&Path, &Finished)>> = vec![None; header.cells];
        let mut shards = Vec::new();
        for (path, part) in parts {
            if let Some([field, this, that]) = part.header.difference(header) {
                let first = parts[0].0.display();
                return Err(refuse(path, format!("is of a run with {field} {this}, but {first} has {that}")));
            }
            let shard = part.header.shard().map_err(|problem| refuse(path, problem))?;
            if shard.of() != of {
                return Err(refuse(
                    path,
                    format!("is one of {} parts, but {} is one of {of}", shard.of(), parts[0].0.display()),
                ));
            }
            shards.push(shard);
            for cell in &part.finished {
                match found[cell.cell] {
                    Some((other, before)) if before != cell => {
                        return Err(refuse(path, format!("has another cell {} than {}", cell.cell, other.display())));
                    }
                    _ => found[cell.cell] = Some((path, cell)),
                }
            }
        }
        if let Some(what) = missing(of, &shards, |index| found[index].is_some(), header.cells) {
            return Err(Error::Missing(what));
        }
        let cells = found.into_iter().flatten().map(|(_, cell)| cell.measured()).collect();
        let bounds = Bounds::over(grid);
        Ok(Self { header: Header { shard: Shard::WHOLE.to_string(), ..header.clone() }, cells, bounds })
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

    fn rows(&self) -> Vec<Row<'_>> {
        rows(self.grid(), &self.cells, &self.bounds, self.header.lights.len())
    }

    /// The cells it is of.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        grid_of(self.header.quick)
    }

    /// Seed, and whether it is the short run: what times are measured by.
    #[must_use]
    pub const fn settings(&self) -> (u64, bool) {
        (self.header.seed, self.header.quick)
    }

    /// The rows: what depends on the plan and the build alone.
    ///
    /// The sampler `perfect` would draw with a density proportional to the mean of RGB of `S cos theta_i`: all of its
    /// weights are the albedo.
    ///
    /// | column | what it is |
    /// |---|---|
    /// | `cell` .. `light` | what the row is of; widths, `phi_g` and `theta_o` in degrees |
    /// | `mean`, `mean_se` | integral of `L S cos theta_i`, mean of RGB, with its standard error |
    /// | `v`, `v_se` | relative variance of one sample |
    /// | `ess_per_1000` | effective sample size of 1000 samples, `1000 / (1 + v)` |
    /// | `samples_for_1_percent` | samples to a relative error of 1%, `v / 1e-4` |
    /// | `max_weight`, `weight_bound` | largest mean of RGB of a weight, whatever the light, and its proven bound where there is one; of `perfect` the estimate of the albedo |
    /// | `max_contribution` | largest contribution, in means; under constant light the largest weight in means |
    /// | `kl`, `kl_se` | Kullback-Leibler divergence of the density from the normalised integrand, nats; under constant light that from `S cos theta_i` |
    #[must_use]
    pub fn columns(&self) -> Columns {
        rows::columns(&self.rows(), &self.header.lights)
    }

    /// The rows' efficiencies: what depends on the machine as well.
    ///
    /// For 1, 4 and 16 samples a gather point: the time of a sample in ns, `1 / (V seconds)`, and by what factor less
    /// variance than `ou` it has in equal time; of `perfect`, which has no time, none of it.
    #[must_use]
    pub fn efficiencies(&self, times: &Times) -> Columns {
        const NAMES: [[&str; 3]; 3] = [
            ["ns_at_1", "efficiency_at_1", "gain_at_1"],
            ["ns_at_4", "efficiency_at_4", "gain_at_4"],
            ["ns_at_16", "efficiency_at_16", "gain_at_16"],
        ];
        let (rows, lights) = (self.rows(), self.header.lights.len());
        let mut columns = rows::keys(&rows, &self.header.lights)
            .number("v", rows.iter().map(|row| row.measured.figures.v.value))
            .number("v_se", rows.iter().map(|row| row.measured.figures.v.standard_error));
        for (per_point, names) in PER_POINT.into_iter().zip(NAMES) {
            let ns = |model, strategy: Strategy| {
                strategy.sampler().map_or(f64::NAN, |sampler| times::ns(&times.0, model, sampler, per_point).value)
            };
            let cost = |row: &Row<'_>| row.measured.figures.v.value * ns(row.model, row.strategy);
            let ou = |row: &Row<'_>| {
                let place = rows::place(row.model, Sampler::Ou, row.light, lights);
                self.cells[row.cell.index][place].figures.v.value * ns(row.model, Sampler::Ou.into())
            };
            columns = columns
                .number(names[0], rows.iter().map(|row| ns(row.model, row.strategy)))
                .number(names[1], rows.iter().map(|row| 1e9 / cost(row)))
                .number(names[2], rows.iter().map(|row| ou(row) / cost(row)));
        }
        columns
    }

    /// What is wrong with the figures: weights beyond their proven bound, and samplers whose means disagree.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        check::failures(&self.rows(), &self.header.lights)
    }

    /// The tables that sum it up.
    #[must_use]
    pub fn summary(&self, times: &Times) -> Vec<Table> {
        summary::tables(&self.cells, &self.header.lights, &times.0)
    }

    /// Writes `study.csv` and `study.parquet` (the rows), `study.json` (the settings), `times.csv`, and `efficiency` and
    /// `difference` (how far apart the models are) as `.csv` and `.parquet` into `dir`, each as a whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::Output`] for the first that cannot be written.
    pub fn write(&self, dir: &Path, times: &Times, difference: &Difference) -> Result<(), Error> {
        let notes: Vec<(String, String)> = match serde_json::to_value(&self.header) {
            Ok(serde_json::Value::Object(fields)) => {
                fields.into_iter().map(|(k, v)| (format!("hairis.{k}"), v.to_string())).collect()
            }
            _ => Vec::new(),
        };
        let machine = json!({ "study": self.header, "times_measured_on": Machine::current() });
        let rows = self.columns();
        let (efficiencies, differences) = (self.efficiencies(times), difference.columns());
        whole(&dir.join("study.csv"), |out| rows.write_csv(out))?;
        whole(&dir.join("study.parquet"), |out| rows.write_parquet(&notes, out))?;
        whole(&dir.join("times.csv"), |out| times::columns(&times.0).write_csv(out))?;
        whole(&dir.join("efficiency.csv"), |out| efficiencies.write_csv(out))?;
        whole(&dir.join("efficiency.parquet"), |out| efficiencies.write_parquet(&notes, out))?;
        whole(&dir.join("difference.csv"), |out| differences.write_csv(out))?;
        whole(&dir.join("difference.parquet"), |out| differences.write_parquet(&notes, out))?;
        whole(&dir.join("study.json"), |out| writeln!(out, "{machine:#}"))
    }
}

/// What is missing of a study of `of` parts, in words; `None` if nothing is.
fn missing(of: usize, shards: &[Shard], has: impl Fn(usize) -> bool, cells: usize) -> Option<String> {
    let mut absent = Vec::new();
    let mut unfinished = Vec::new();
    for shard in Shard::all(of) {
        let owned = || (0..cells).filter(|index| shard.owns(*index));
        let done = owned().filter(|index| has(*index)).count();
        if done == owned().count() {
            continue;
        }
        if shards.contains(&shard) {
            unfinished.push(format!("shard {shard} has {done} of {} cells", owned().count()));
        } else {
            absent.push(shard.to_string());
        }
    }
    if !absent.is_empty() {
        let plural = if absent.len() == 1 { "" } else { "s" };
        unfinished.insert(0, format!("shard{plural} {} missing", absent.join(", ")));
    }
    (!unfinished.is_empty()).then(|| unfinished.join("; "))
}
