//! Claims of the paper, each with its figures and the verdict that follows from them.
//!
//! - `energy`: the estimated energies are within 1%.
//! - `tails`: wider tails do not increase variance.
//! - `uniform`: always better than uniform sampling.
//! - `grazing`: discarding samples at grazing angles does no harm.
//! - `performance`: the all-Cauchy model is sampled better, light by light.
//! - `bounds`, `glint`: the cost of the misprints, and the interval of the glint.
//!
//! # Verdicts
//!
//! A [`Claim`] has a [`Threshold`], stated beside it, and two figures: the worst of all the cases that the claim is made for, and the worst
//! within stated limits. If the first keeps the threshold, the claim holds. If only the second does, the claim holds within those limits.
//! Otherwise the claim is false. A figure keeps the threshold only with a margin: two of its standard errors, or the error of the
//! quadrature. Nothing else decides ([`Claim::verdict`]).
//!
//! # Determinism
//!
//! Figures depend on the seed and on the build, whatever the number of threads. Figures whose [`Origin`] is [`Timed`](Origin::Timed), all
//! of them in one claim, depend on the machine as well.

pub mod bounded;
pub mod bounds;
pub mod claim;
pub mod energy;
pub mod glint;
pub mod grazing;
pub mod hair;
mod performance;
mod tables;
pub mod tails;
pub mod uniform;

pub use claim::{Claim, Figure, Origin, Role, Side, Threshold, Verdict};
pub use tables::{report, tables};

use crate::study::part::Header;
use crate::study::{Cell, Grid, Plan, Size};
use hair::{Hair, HairFigures};
use hairis::ParamError;
use hairis_harness::journal::Journal;
use hairis_harness::subject::ModelKind;
use hairis_instruments::error::Error;
use hairis_instruments::light::Sky;
use hairis_instruments::machine;
use hairis_instruments::machine::Machine;
use hairis_instruments::progress::Progress;
use hairis_instruments::shard::Shard;
use serde::Serialize;

/// Results of `hairis claims`, written to `claims.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Claims {
    /// Settings of the command.
    pub settings: Settings,
    /// Machine and build that computed the figures.
    pub machine: Machine,
    /// Verdicts in the order of the paper's sections, with the misprints last.
    pub claims: Vec<Claim>,
}

/// Settings of `hairis claims` that the figures depend on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Settings {
    /// Seed of everything that was drawn.
    pub seed: u64,
    /// Whether this was the short run.
    pub quick: bool,
    /// Number of cells of the parameter grid.
    pub cells: usize,
    /// Number of samples of each model in a cell.
    pub samples: usize,
    /// Names of the lights, in the order of the claims.
    pub lights: [&'static str; 5],
}

/// Quadrature results of every cell and model.
type FoundCells = [(Cell, ModelKind, HairFigures)];

/// Returns the header that holds everything the figures depend on. Runs with equal headers have equal figures, except for times.
#[must_use]
pub fn header(seed: u64, size: Size) -> Header {
    let sky = Sky::default().environment();
    let plan = Plan {
        seed,
        size,
        lights: (&sky).into(),
        materials: &[],
    };
    plan.header(Shard::WHOLE)
}

/// Computes the claims with this seed, on the cells and with the samples of a study of this size. Workers
/// call `progress` with the share that is done, from 0 to 1, in no order. Figures that `journal` holds are taken from it, and new ones are
/// added.
///
/// # Errors
///
/// Returns an error if `journal` cannot be read or written. The hair of the grid is within the accepted ranges.
pub fn run(
    seed: u64,
    size: Size,
    journal: &Journal,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Claims, Error> {
    let sky = Sky::default().environment();
    let plan = Plan {
        seed,
        size,
        lights: (&sky).into(),
        materials: &[],
    };
    let grid = plan.grid();
    // Quadrature and sampling take about equally long.
    let [first, second] = [0.0, 0.5].map(|begin| {
        move |done: usize, total: usize| progress(begin + 0.5 * done as f64 / total as f64)
    });
    let cells = by_quadrature(grid, journal, &Progress::new(grid.len(), &first))?;

    let mut claims = vec![
        energy::claim(),
        tails::claim(),
        uniform::claim(&plan, &cells, journal)?,
        grazing::claim()?,
    ];
    claims.extend(performance::claims(
        &plan,
        journal,
        &Progress::new(grid.len(), &second),
    )?);
    claims.extend([
        bounds::claim(&cells),
        glint::density(&cells)?,
        glint::interval(&cells)?,
    ]);
    let lights = performance::LIGHTS.map(|light| light.words);
    let settings = Settings {
        seed,
        quick: size.is_quick(),
        cells: grid.len(),
        samples: plan.budget().samples,
        lights,
    };
    Ok(Claims {
        settings,
        machine: machine!(),
        claims,
    })
}

/// Returns all figures that are sampled under the lights of a plan: the claims by light, and those of the example.
///
/// # Errors
///
/// Returns an error if hair is rejected, or if a figure cannot be kept.
pub fn sampled(plan: &Plan<'_>, journal: &Journal) -> Result<Vec<String>, Error> {
    let progress = Progress::new(plan.grid().len(), &|_, _| ());
    let (claims, _) = performance::by_light(plan, journal, &progress)?;
    let example = uniform::measured(plan, &uniform::example(), journal)?;
    let claims = claims.iter().map(|claim| format!("{claim:?}"));
    Ok(claims.chain([format!("{example:?}")]).collect())
}

/// Returns the hair of a cell.
///
/// # Errors
///
/// Returns an error if the hair is rejected.
pub fn hair_of(cell: &Cell, model: ModelKind) -> Result<Hair, ParamError> {
    Ok(Hair::new(
        model,
        &cell.params()?,
        f64::from(cell.theta_o_deg).to_radians(),
    ))
}

/// Integrates every cell of `grid` on all cores.
fn by_quadrature(
    grid: Grid,
    journal: &Journal,
    progress: &Progress<'_>,
) -> Result<Vec<(Cell, ModelKind, HairFigures)>, Error> {
    let cells: Vec<Cell> = grid.cells().collect();
    let found = |cell: &Cell| {
        ModelKind::ALL.map(|model| {
            let key = format!("quadrature of cell {}, {}", cell.index, model.name());
            let find = || hair_of(cell, model).map(|hair| hair.found().numbers());
            let numbers = journal.numbers(&key, find)?;
            Ok((*cell, model, HairFigures::from_numbers(numbers)))
        })
    };
    progress.map(&cells, found).into_iter().flatten().collect()
}
