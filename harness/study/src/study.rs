//! Study of both models with every sampler under every light, over the whole parameter grid.
//!
//! # What is measured
//!
//! For each cell of the [`Grid`], model, [`Sampler`] and light, the study measures the mean of `L S cos theta_i / pdf` (the mean of its
//! RGB, as in [`efficiency`](hairis_harness::efficiency)), its relative variance V per sample, and the Kullback-Leibler divergence of the density
//! from the normalised integrand, with standard errors. Further figures are the effective sample size, the samples to an error of 1%, and
//! the largest weight and contribution. [`Study::columns`](output::Study::columns) lists them.
//!
//! The sampler `perfect` is not runnable: its directions have a density proportional to the mean of RGB of `S cos theta_i`, the limit of
//! samplers of the hair that ignore the light. The V that is left belongs to the light. It is estimated from directions that are drawn
//! anyway. Its two integrals come from directions of the light and of the matched sampler of most bands, whose weights are bounded and vary
//! least. The albedo is the mean of the same weights, whose errors cancel against those of the integrals, so that V under constant light is
//! 0.
//!
//! V and the divergence are integrals. They are estimated with directions of the sampler and, for lights that do not cover the sphere, of
//! the light. The figures are those of the sampler alone, but no small light has to be hit by chance. With directions of the sampler alone,
//! a V of 1000 has an error of 10% after some hundred thousand samples, and that error is underestimated.
//!
//! Rays of direct light are measured as in [`rays`](hairis_harness::rays), from candidates of streams of their own: V of one ray by one-sample MIS
//! and from 4 + 4 and 8 + 8 candidates.
//!
//! # Determinism
//!
//! The rows depend only on the [`Plan`], on the build and on its instruction set: each cell draws from streams of its own and is computed
//! by one thread. Finished cells are kept in a part file, see [`part`], so that a stopped run continues and many processes can share the
//! work. Times are measured separately, by the process that writes the tables: of a sample, of a look-up of each light, and of a ray
//! without its tracing. The environment's times need its file, which `hairis merge` takes as an option.
//!
//! # Adding a sampler
//!
//! Add a variant of [`Sampler`], with its arms in `sampler.rs`.

pub mod cell;
pub mod check;
pub mod equal_time;
mod estimator;
pub mod finished;
pub mod grid;
pub mod output;
pub mod part;
mod rays;
mod refit;
pub mod report;
pub mod rows;
pub mod summary;

pub mod view;

pub use grid::{Cell, Grid, Size};

pub use view::gain;

use hairis::ParamError;
use hairis::simd::Level;
use hairis_harness::lights::Lights;
use hairis_harness::materials::NamedMaterial;
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_harness::variance::SampleBudget;
use hairis_instruments::error::Error;
use hairis_instruments::machine;
use hairis_instruments::shard::Shard;
use hairis_instruments::stats::Estimate;
use part::{Finished, Header};
use rayon::prelude::*;

/// Settings of a study, on which all of its rows depend.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// Seed of every stream.
    pub seed: u64,
    /// Size of the run.
    pub size: Size,
    /// Lights that every cell is measured under.
    pub lights: Lights<'a>,
    /// Materials beside the hair of the grid, seen from its inclinations.
    pub materials: &'a [NamedMaterial],
}

impl Plan<'_> {
    /// Returns the grid of the run.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.size.grid()
    }

    /// Returns the numbers of samples per cell.
    #[must_use]
    pub const fn budget(&self) -> SampleBudget {
        self.size.budget()
    }

    /// Returns the header of the part file of `shard`, with everything that the rows depend on.
    #[must_use]
    pub fn header(&self, shard: Shard) -> Header {
        let machine = machine!();
        let budget = self.budget();
        let changed = if machine.dirty == Some(true) {
            "+changes"
        } else {
            ""
        };
        Header {
            format: part::FORMAT.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: format!("{}{changed}", machine.commit),
            level: format!(
                "{}, compiled for {}",
                Level::detect().name(),
                machine.target_features.join("+")
            ),
            quick: self.size.is_quick(),
            seed: self.seed,
            samples: budget.samples,
            light_samples: budget.light_samples,
            pools: budget.pools,
            environment: self
                .lights
                .environment()
                .map_or_else(String::new, part::digest),
            models: ModelKind::ALL
                .iter()
                .map(|model| model.name().to_owned())
                .collect(),
            samplers: Sampler::ALL
                .iter()
                .map(|sampler| sampler.name().to_owned())
                .collect(),
            lights: self
                .lights
                .all()
                .iter()
                .map(|light| light.name().to_owned())
                .collect(),
            cells: self.grid().len(),
            materials: self.materials.iter().map(NamedMaterial::key).collect(),
            shard: shard.to_string(),
        }
    }
}

/// Unit of work: a cell of the grid, or a material seen from one inclination. Materials come after all cells.
pub(crate) enum Place {
    Cell(Cell),
    /// Index of the material, and inclination of the viewer in degrees.
    Material(usize, f64),
}

impl Place {
    /// Returns the work of an index: a cell of the grid, or else a material, each from the inclinations of the grid in turn.
    pub(crate) fn of(index: usize, grid: &Grid) -> Self {
        let Some(place) = index.checked_sub(grid.len()) else {
            return Self::Cell(grid.cell(index));
        };
        let inclinations = grid.theta_o_deg;
        let theta_o = inclinations[place % inclinations.len()];
        Self::Material(place / inclinations.len(), f64::from(theta_o))
    }
}

/// Computes the cells at `todo` on all cores. Workers pass each to `keep`, in no order.
///
/// # Errors
///
/// Returns the first error of `keep`, or an error if hair is rejected. The cells in work are then finished, and no others begun.
pub fn run(
    plan: &Plan<'_>,
    todo: &[usize],
    keep: impl Fn(Finished) -> Result<(), Error> + Sync,
) -> Result<(), Error> {
    let (grid, budget) = (plan.grid(), plan.budget());
    let lights = plan.lights.all();
    todo.par_iter().with_max_len(1).try_for_each(|&index| {
        let found = match Place::of(index, &grid) {
            Place::Cell(cell) => cell::measure(plan.seed, budget, &lights, &cell, &Sampler::ALL)?,
            Place::Material(material, theta_o_deg) => {
                plan.materials[material].measure(plan.seed, budget, plan.lights, theta_o_deg)?
            }
        };
        keep(Finished::of(index, &found))
    })
}

/// V of a sampler on a model under a light.
#[derive(Clone, Debug)]
pub struct Variance {
    pub(crate) model: ModelKind,
    /// Name of the light.
    pub(crate) light: String,
    pub(crate) v: Estimate,
}

/// Measures V of some samplers in one cell. With the budget of the plan, the figures are those of [`run`].
///
/// # Errors
///
/// Returns an error if the hair of the cell is rejected.
pub fn variances(
    plan: &Plan<'_>,
    budget: SampleBudget,
    cell: &Cell,
    samplers: &[Sampler],
) -> Result<Vec<Variance>, ParamError> {
    let lights = plan.lights.all();
    let found = cell::measure(plan.seed, budget, &lights, cell, samplers)?;
    let mut rows = found.iter();
    let mut all = Vec::new();
    for model in ModelKind::ALL {
        for _ in samplers {
            for (light, row) in lights.iter().zip(rows.by_ref()) {
                all.push(Variance {
                    model,
                    light: light.name().to_owned(),
                    v: row.figures.v,
                });
            }
        }
    }
    Ok(all)
}
