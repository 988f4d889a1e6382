//! A finished study, and its files.

use super::cell::Measured;
use super::columns::Columns;
use super::equal_time::{NOTHING, in_equal_time, time_ratio};
use super::part::{self, FORMAT, Finished, Header, Read};
use super::rays::{self, By};
use super::rows::{self, Bounds, Row, Strategy, rows};
use super::times::{self, PER_POINT, Time};
use super::{Grid, Shard, check, grid_of, report, summary, with_built_in_lights};
use crate::difference::Difference;
use crate::error::Error;
use crate::files::whole;
use crate::light::{Environment, Light};
use crate::machine::Machine;
use crate::rays::{RayTimes, measure_times};
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::table::Table;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Every cell of a study, in the order of the grid.
#[derive(Clone, Debug)]
pub struct Study {
    pub(super) header: Header,
    pub(super) cells: Vec<Vec<Measured>>,
    pub(super) bounds: Bounds,
}

/// Times of a sample, of a look-up of the light and, on request, of a ray without its tracing, measured on this machine.
#[derive(Clone, Debug)]
pub struct Times {
    of_samples: Vec<Time>,
    of_rays: Vec<RayTimes>,
}

impl Times {
    /// Measures them, with nothing else at work: in about three seconds, or less than one if `quick`. Without an
    /// environment its look-up is not known.
    #[must_use]
    pub fn measure(seed: u64, quick: bool, environment: Option<&Environment>) -> Self {
        with_built_in_lights(|built_in| {
            let mut lights = built_in.to_vec();
            lights.extend(environment.map(|map| map as &dyn Light));
            let rounds = if quick { 15 } else { 75 };
            Self { of_samples: times::measure(seed, rounds, &lights), of_rays: Vec::new() }
        })
    }

    /// Measures those of rays as well: in about five seconds, or one if `quick`.
    #[must_use]
    pub fn with_rays(self, seed: u64, quick: bool, environment: Option<&Environment>) -> Self {
        with_built_in_lights(|built_in| {
            let mut lights = built_in.to_vec();
            lights.extend(environment.map(|map| map as &dyn Light));
            Self {
                of_rays: measure_times(&rays::subjects(), &lights, seed, if quick { 9 } else { 75 }, |_| ()),
                ..self
            }
        })
    }

    /// Median time of a sample in ns, for 1, 4 or 16 samples per shading point; not a number for others.
    pub(crate) fn ns(&self, model: ModelKind, sampler: Sampler, per_point: usize) -> Estimate {
        times::ns(&self.of_samples, model, sampler, per_point)
    }

    /// Median time of a ray under a light of this name, without its tracing, in ns; not a number if it was not measured.
    pub(super) fn ray_ns(&self, of: (ModelKind, Sampler), light: &str, by: By) -> Estimate {
        rays::ns(&self.of_rays, of, light, by)
    }

    /// Median time of a look-up of the light at this place in ns; not a number if it was not measured.
    pub(super) fn look_up(&self, light: usize) -> Estimate {
        times::look_up(&self.of_samples, light)
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
            return Err(refuse(
                path,
                format!("is of version {}, whose grid or samplers differ from those of this program", header.version),
            ));
        }
        let of = header.shard().map_err(|problem| refuse(path, problem))?.of();
        let mut found: Vec<Option<(&Path, &Finished)>> = vec![None; header.cells];
        let mut shards = Vec::new();
        for (path, part) in parts {
            if let Some([field, this, that]) = part.header.difference(header) {
                let first = parts[0].0.display();
                return Err(refuse(path, format!("belongs to a run with {field} {this}, but {first} has {that}")));
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
                        return Err(refuse(path, format!("differs in cell {} from {}", cell.cell, other.display())));
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

    /// The reason why the content of a `claims.json` has no place in the report of this study; `None` if it has one.
    #[must_use]
    pub fn refusal_of(&self, claims: &Value) -> Option<String> {
        if !report::has_claims(claims) {
            return Some("it is damaged".to_owned());
        }
        let Header { seed, quick, cells, samples, .. } = &self.header;
        let expected = json!({ "seed": seed, "quick": quick, "cells": cells, "samples": samples });
        let fields = expected.as_object().into_iter().flatten();
        fields
            .map(|(name, here)| (name, here, &claims["settings"][name]))
            .find(|(_, here, there)| here != there)
            .map(|(name, here, there)| format!("it belongs to a run with {name} {there}, expected {here}"))
    }

    /// Whether the environment is the one among the lights.
    #[must_use]
    pub fn has_environment(&self, environment: &Environment) -> bool {
        self.header.environment == part::digest(environment)
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
    /// | `v_mis`, `v_mis_se` | V of one ray of direct light by one-sample MIS, without occlusion |
    /// | `v_4_4`, `v_8_8` and their `_se` | the same of a ray chosen from 4 + 4 and from 8 + 8 candidates |
    /// | `v_mis_visible_25` .. `v_8_8_visible_75` | the same with 25, 50 and 75% of the directions visible: `(V + 1)/v - 1` |
    /// | `pool_bias` | bias of the mean of the estimates from 8 + 8 candidates against `mean`, in standard errors; empty where too few pools decide it |
    #[must_use]
    pub fn columns(&self) -> Columns {
        rows::columns(&self.rows(), &self.header.lights)
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
    pub fn efficiencies(&self, times: &Times) -> Columns {
        let (rows, lights) = (self.rows(), self.header.lights.len());
        let v = |row: &Row<'_>| row.measured.figures.v;
        let against_published: Vec<Estimate> = rows
            .iter()
            .map(|row| match row.strategy {
                Strategy::By(Sampler::Published) => Estimate::exact(1.0),
                _ => {
                    let place = rows::place(row.model, Sampler::Published, row.light, lights);
                    self.cells[row.cell.index][place].figures.v.ratio(&v(row))
                }
            })
            .collect();
        let look_ups: Vec<Estimate> = (0..lights).map(|light| times.look_up(light)).collect();
        let look_up =
            |row: &Row<'_>| if row.strategy == Strategy::Perfect { Estimate::UNKNOWN } else { look_ups[row.light] };
        let mut columns = rows::keys(&rows, &self.header.lights)
            .estimate("v", rows.iter().map(v))
            .estimate("break_even", against_published.iter().copied())
            .estimate("look_up_ns", rows.iter().map(look_up));
        for per_point in PER_POINT {
            let ns = |row: &Row<'_>| {
                row.strategy.sampler().map_or(Estimate::UNKNOWN, |sampler| times.ns(row.model, sampler, per_point))
            };
            let efficiency = |row: &Row<'_>, more: Estimate| 1e9 / (v(row).value * (ns(row).value + more.value));
            let gain = |(row, gain): (&Row<'_>, &Estimate), more: Estimate| {
                if row.strategy == Strategy::By(Sampler::Published) {
                    // Against itself: exactly 1 wherever its time is known.
                    return if more.value.is_nan() { Estimate::UNKNOWN } else { *gain };
                }
                in_equal_time(*gain, time_ratio(times.ns(row.model, Sampler::Published, per_point), ns(row), more))
            };
            let gains = |with: bool| -> Vec<Estimate> {
                let more = |row: &Row<'_>| if with { look_up(row) } else { NOTHING };
                rows.iter().zip(&against_published).map(|(row, of)| gain((row, of), more(row))).collect()
            };
            columns = columns
                .number(format!("ns_at_{per_point}"), rows.iter().map(|row| ns(row).value))
                .number(format!("efficiency_at_{per_point}"), rows.iter().map(|row| efficiency(row, NOTHING)))
                .estimate(&format!("gain_at_{per_point}"), gains(false))
                .number(
                    format!("look_up_efficiency_at_{per_point}"),
                    rows.iter().map(|row| efficiency(row, look_up(row))),
                )
                .estimate(&format!("look_up_gain_at_{per_point}"), gains(true));
        }
        rays::efficiencies(columns, &rows, &self.header.lights, times)
    }

    /// Errors in the figures: weights beyond their proven bound, and samplers whose means disagree.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        check::failures(&self.rows(), &self.header.lights)
    }

    /// The tables that sum it up.
    #[must_use]
    pub fn summary(&self, times: &Times) -> Vec<Table> {
        summary::tables(&self.cells, &self.header.lights, times)
    }

    /// Writes `study.csv` (the rows), `efficiency.csv`, `difference.csv` (how far apart the models are), `times.csv` and
    /// `study.json` (the settings) into `dir`, with feature `parquet` the first three as `.parquet` too, each as a whole or not
    /// at all.
    ///
    /// # Errors
    ///
    /// [`Error::Output`] for the first that cannot be written.
    pub fn write(&self, dir: &Path, times: &Times, difference: &Difference) -> Result<(), Error> {
        let machine = json!({ "study": self.header, "times_measured_on": Machine::current() });
        let rows = self.columns();
        let (efficiencies, differences) = (self.efficiencies(times), difference.columns());
        whole(&dir.join("times.csv"), |out| times::columns(&times.of_samples, &self.header.lights).write_csv(out))?;
        for (name, columns) in [("study", &rows), ("efficiency", &efficiencies), ("difference", &differences)] {
            whole(&dir.join(format!("{name}.csv")), |out| columns.write_csv(out))?;
            #[cfg(feature = "parquet")]
            whole(&dir.join(format!("{name}.parquet")), |out| columns.write_parquet(&self.notes(), out))?;
        }
        whole(&dir.join("study.json"), |out| writeln!(out, "{machine:#}"))
    }
}

#[cfg(feature = "parquet")]
impl Study {
    /// The header, as metadata.
    fn notes(&self) -> Vec<(String, String)> {
        let header = serde_json::to_value(&self.header).unwrap_or_default();
        let fields = header.as_object().into_iter().flatten();
        fields.map(|(key, value)| (format!("hairis.{key}"), value.to_string())).collect()
    }
}

/// Missing parts of a study of `of` parts, in words; `None` if it is complete.
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
