//! Finished study, joined from its parts.

use super::estimator::{TOLD, set_bounds};
use super::part::{self, FORMAT, Finished, Header, Read, refuse};
use super::{Grid, Place};
use hairis::ParamError;
use hairis_harness::materials::NamedMaterial;
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_harness::times::Times;
use hairis_harness::variance::{Figures, Measured};
use hairis_instruments::error::Error;
use hairis_instruments::light::Environment;
use hairis_instruments::shard::Shard;
use hairis_instruments::stats::Estimate;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// V on the refitted Cauchy model in a cell, for each of [`TOLD`], light by light.
pub(super) type RefitVariances = [Vec<Estimate>; TOLD.len()];

/// V on the refitted Cauchy model, by cell. V is unknown under an environment that is not given.
#[derive(Clone, Debug, Default)]
pub(super) struct Refits(pub(super) Vec<RefitVariances>);

/// Study that is finished: every cell, in the order of the grid.
#[derive(Clone, Debug)]
pub struct Study {
    pub(super) header: Header,
    /// Rows of each cell of the grid.
    pub cells: Vec<Vec<Measured>>,
    /// Rows of the materials, each seen from the inclinations of the grid in turn.
    pub(super) materials: Vec<Vec<Measured>>,
    /// Times on this machine, unknown until [`time`](Self::time).
    pub(super) times: Times,
    /// V on the refitted Cauchy model, unknown until [`refit`](Self::refit).
    pub(super) refits: Refits,
}

impl Study {
    /// Joins `parts` to a study, each with the file that it was read from.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Part`] if the parts do not belong to one study, or belong to one of another version; returns [`Error::Missing`],
    /// which names the missing parts, if cells are missing.
    pub fn join(parts: &[(PathBuf, Read)]) -> Result<Self, Error> {
        let Some((first, Read { header, .. })) = parts.first() else {
            return Err(Error::Missing("no parts".to_owned()));
        };
        let grid = header.size().grid();
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
        let mut found: Vec<Option<(&Path, &Finished)>> = vec![None; header.work()];
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
        if let Some(what) = missing(&shards, |index| found[index].is_some(), header.work()) {
            return Err(Error::Missing(what));
        }
        let named = header.materials.iter().map(NamedMaterial::of_key);
        let named = named
            .collect::<Result<Vec<_>, _>>()
            .map_err(|problem| refuse(first, format!("has a material that {problem}")))?;
        let lights = header.lights.len();
        let bounded = |(_, cell): (&Path, &Finished)| {
            let mut measured = cell.measured();
            match Place::of(cell.cell, &grid) {
                Place::Cell(cell) => set_bounds(&cell, &mut measured, lights),
                Place::Material(place, theta_o_deg) => {
                    named[place].set_bounds(theta_o_deg, &mut measured, lights)?;
                }
            }
            Ok(measured)
        };
        let found = found.into_par_iter().flatten().map(bounded);
        let mut cells = found.collect::<Result<Vec<Vec<Measured>>, ParamError>>()?;
        let materials = cells.split_off(header.cells);
        let header = Header {
            shard: Shard::WHOLE.to_string(),
            ..header.clone()
        };
        Ok(Self {
            cells,
            materials,
            header,
            times: Times::default(),
            refits: Refits::default(),
        })
    }

    /// Returns a study of the same figures in each cell, with V given by the index of a row and the light.
    #[must_use]
    pub fn of_figures(header: Header, v: &dyn Fn(usize, &str) -> f64) -> Self {
        let of = |value| Estimate {
            value,
            standard_error: 0.01 * value,
        };
        let lights = header.lights.len();
        let row = |place: usize| Measured {
            figures: Figures {
                mean: of(3.0),
                v: of(v(place / lights, &header.lights[place % lights])),
                kl: of(0.1),
            },
            max_weight: 1.0,
            weight_bound: None,
            max_contribution: 2.0,
            rays: Some([1.4, 0.2, 0.1].map(of)),
            bias: Some(-1.0),
        };
        let row: Vec<Measured> = (0..header.rows()).map(row).collect();
        let cells = header.size().grid().cells().map(|cell| {
            let mut rows = row.clone();
            set_bounds(&cell, &mut rows, lights);
            rows
        });
        Self {
            cells: cells.collect(),
            materials: Vec::new(),
            header,
            times: Times::default(),
            refits: Refits::default(),
        }
    }

    /// Reads every part file in `dirs` and joins the parts.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`join`](Self::join), and [`Error::Part`] if a file cannot be read or is damaged.
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

    /// Returns the header, which holds the inputs that the rows depend on.
    #[must_use]
    pub const fn header(&self) -> &Header {
        &self.header
    }

    /// Returns the grid whose cells the study has.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.header.size().grid()
    }

    /// Measures the times of this machine, with nothing else at work. Without an environment, the time of its look-up stays unknown.
    pub fn time(&mut self, environment: Option<&Environment>) {
        let (seed, rounds) = (self.header.seed, self.header.size().rounds());
        self.times = Times::measure(seed, rounds, environment).with_rays(seed, rounds, environment);
    }

    /// Returns true if there are materials beside the hair of the grid.
    #[must_use]
    pub const fn has_materials(&self) -> bool {
        !self.materials.is_empty()
    }

    /// Returns true if the environment is the one among the lights of the study.
    #[must_use]
    pub fn has_environment(&self, environment: &Environment) -> bool {
        self.header.environment == part::digest(environment)
    }
}

/// Returns the missing parts of a study, in words; `None` if it is complete.
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
