//! Difference in look between the all-Cauchy model and the Gaussian one, over the study's grid.
//!
//! # What is measured
//!
//! Measured are, for each cell of the [`Grid`] and each choice of the Cauchy model's widths ([`Width`]), one of which [fits](crate::fit)
//! all parameters, the albedo of either model and the distance of their `S cos theta_i` over the sphere. `S cos theta_i` is the mean of
//! RGB, per steradian of `wi`. The distance is in L1 and in L2, relative to the Gaussian model's own norm,
//! - as they are,
//! - with the Cauchy model scaled to the albedo of the Gaussian one: the shape alone,
//! - either after a blur of [`SIGMA_DEG`], which stands for a light of that width or a view without finer detail. The blur is the von
//!   Mises-Fisher density of `kappa = 1 / sigma^2`, the Gaussian of the sphere.
//!
//! An L1 of 0.3 means a difference of 30% of the light that the Gaussian model reflects: light reflected elsewhere, not at all, or in
//! addition. With equal albedos, half of that light has moved.
//!
//! # Method
//!
//! Quadrature in double precision of the reference's bells; nothing is sampled. S is a sum of three products of a function
//! of `theta_i` and one of `phi`, so that albedos and L2 norms are products of integrals on a line. L1 is a sum over the
//! product of both rules. The blur uses spherical harmonics up to a degree beyond which the coefficients vanish. Tests
//! compare the figures to 1e-3 with those of twice the resolution, and the blur with its integral.

pub mod best;
pub mod blur;
pub mod lobes;
pub mod measure;
pub mod output;
pub mod refit;

pub use best::least;
pub use blur::SIGMA_DEG;
pub use measure::{Differences, Norms};
pub use output::Summary;
pub(crate) use output::albedo_ratio;

use crate::study::{Cell, Grid};
use blur::{Blur, Harmonics};
use core::convert::Infallible;
use hairis::model::Bell;
use hairis::{HairParams, ParamError};
use hairis_harness::journal::Journal;
use hairis_instruments::error::Error;
use hairis_variants::Cauchy;
use lobes::{Kind, ViewedHair};
use measure::{HairValues, NUMBERS};
use rayon::prelude::*;

/// Number of points of the rule on each panel between breakpoints.
pub const ORDER: usize = 8;

/// Number of latitudes, and of longitudes of half a sphere, at which blurred functions are compared.
pub const LATITUDES: usize = 96;

/// Choice of the widths of the Cauchy model: a factor `k` on the widths of the Gaussian one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Equal widths, as in the paper: [`Cauchy::PAPER`].
    Paper,
    /// Bells of the same half width at half height: [`Cauchy::HALF_WIDTH`].
    HalfWidth,
    /// Bells of the same area: [`Cauchy::AREA`].
    Area,
    /// Factor with the least mean square, over the grid, of the relative L2 difference without blur or scale.
    BestOfGrid,
    /// Factor with the least L2 difference without blur or scale, for each cell.
    BestOfCell,
    /// No factor. All parameters of each hair are [fitted](crate::fit) in L1, from all inclinations of the grid together.
    Refitted,
}

impl Width {
    /// Every choice of widths, in the order of reports.
    pub const ALL: [Self; 6] = [
        Self::Paper,
        Self::HalfWidth,
        Self::Area,
        Self::BestOfGrid,
        Self::BestOfCell,
        Self::Refitted,
    ];

    /// Returns the name of the choice in reports and in rows.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::HalfWidth => "half-width",
            Self::Area => "area",
            Self::BestOfGrid => "best-of-grid",
            Self::BestOfCell => "best-of-cell",
            Self::Refitted => "refitted",
        }
    }
}

/// Row of the table of differences: a cell with one choice of widths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferenceRow {
    /// Hair, and the inclination that it is seen from.
    pub cell: Cell,
    /// Choice of the Cauchy model's widths.
    pub width: Width,
    /// Differences that were measured.
    pub figures: Differences,
}

/// Differences between the two models over a grid, for every choice of widths.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Grid whose cells were measured.
    pub grid: Grid,
    /// Rows: cells outermost, in the order of the grid, then [`Width::ALL`].
    pub rows: Vec<DifferenceRow>,
    /// Parameters of the Cauchy model of [`Width::Refitted`], one entry per hair, whose inclinations are consecutive cells.
    refits: Vec<HairParams>,
}

impl Difference {
    /// Computes the differences over a grid, on all cores. Figures that `journal` holds are taken from it, and new ones are added. Most of
    /// the time goes into the fits, so `progress` is called with the number of fits done and of all fits.
    ///
    /// # Errors
    ///
    /// Returns an error if `journal` cannot be read or written. The hair of [`Grid::FULL`] and [`Grid::QUICK`] is accepted.
    pub fn over(
        grid: Grid,
        journal: &Journal,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Self, Error> {
        const BEST: &str = "best factor";
        let key = |cell: &Cell| format!("difference in cell {}", cell.index);
        let cells: Vec<Cell> = grid.cells().collect();
        // All hair is needed for the best factor, and after that the hair of cells that are left.
        let is_needed = |cell: &Cell| !(journal.has(BEST) && journal.has(&key(cell)));
        let hair: Vec<Option<HairValues>> = cells
            .par_iter()
            .map(|cell| {
                journal.check()?;
                is_needed(cell)
                    .then(|| hair(cell))
                    .transpose()
                    .map_err(Error::from)
            })
            .collect::<Result<_, Error>>()?;
        let [best_of_grid] = journal.numbers(BEST, || {
            let squares = |k: f64| {
                let [sum] = journal.numbers(&format!("square for factor {k:e}"), || {
                    let squares: Vec<f64> = hair
                        .par_iter()
                        .flatten()
                        .map(|hair| hair.square_error(k))
                        .collect();
                    Ok::<_, Error>([squares.iter().sum()])
                })?;
                Ok::<_, Error>(sum)
            };
            Ok::<_, Error>([least(squares)?])
        })?;
        let refits = refit::all(grid, journal, progress)?;
        let blur = Blur::new(SIGMA_DEG.to_radians(), LATITUDES, LATITUDES);
        let rows = (cells.par_iter().zip(&hair)).map(|(cell, hair)| {
            let find = || {
                let hair = hair.as_ref().ok_or_else(|| Error::Missing(key(cell)))?;
                let refit = &refits[refit::hair_of(&grid, cell)];
                let found = figures(hair, best_of_grid, refit, &blur);
                let numbers: Vec<f64> = found.iter().flat_map(Differences::numbers).collect();
                Ok::<_, Error>(core::array::from_fn(|place| numbers[place]))
            };
            let numbers = journal.numbers::<{ NUMBERS * Width::ALL.len() }, _>(&key(cell), find)?;
            let (all, _) = numbers.as_chunks();
            let row = |(width, numbers): (Width, &[f64; NUMBERS])| DifferenceRow {
                cell: *cell,
                width,
                figures: Differences::from_numbers(*numbers),
            };
            Ok(Width::ALL.into_iter().zip(all).map(row).collect())
        });
        let rows = rows.collect::<Result<Vec<Vec<DifferenceRow>>, Error>>()?;
        Ok(Self {
            grid,
            rows: rows.into_iter().flatten().collect(),
            refits,
        })
    }

    /// Returns the parameters of the Cauchy model of [`Width::Refitted`] for the hair of a cell.
    pub(crate) fn refit(&self, cell: &Cell) -> &HairParams {
        &self.refits[refit::hair_of(&self.grid, cell)]
    }

    /// Returns the rows of one choice of widths, in the order of the grid.
    pub fn of(&self, width: Width) -> impl Iterator<Item = &DifferenceRow> + Clone {
        self.rows.iter().filter(move |row| row.width == width)
    }
}

/// Returns the harmonics of the blurred `S cos theta_i`, seen from `theta_o` in rad: for the Gaussian model, and for a Cauchy model with
/// its widths times `k`.
pub(crate) fn blurred(params: &HairParams, theta_o: f64, k: f64) -> Vec<Harmonics> {
    let view = ViewedHair::new(params, theta_o);
    let rule = view.rule(ORDER);
    let values = [Kind::GAUSSIAN, Kind::cauchy(k)].map(|kind| rule.values(&view, kind));
    Blur::new(SIGMA_DEG.to_radians(), 1, 1).harmonics(&rule, &values)
}

/// Returns the figures of a hair, one for each choice of its widths.
fn figures(
    hair: &HairValues,
    best_of_grid: f64,
    refit: &HairParams,
    blur: &Blur,
) -> Vec<Differences> {
    let kinds = Width::ALL.map(|width| {
        Kind::cauchy(match width {
            Width::Paper => f64::from(Cauchy::PAPER.width_factor()),
            Width::HalfWidth => f64::from(Cauchy::HALF_WIDTH.width_factor()),
            Width::Area => f64::from(Cauchy::AREA.width_factor()),
            Width::BestOfGrid => best_of_grid,
            Width::BestOfCell => {
                let Ok(best) = least(|k| Ok::<_, Infallible>(hair.square_error(k)));
                best
            }
            Width::Refitted => return Kind::refitted(refit),
        })
    });
    hair.figures(&kinds, blur)
}

/// Prepares the hair of a cell, seen from its inclination.
///
/// # Errors
///
/// Returns an error if the hair is rejected.
pub fn hair(cell: &Cell) -> Result<HairValues, ParamError> {
    let params: HairParams = cell.params()?;
    Ok(HairValues::new(
        ViewedHair::new(&params, f64::from(cell.theta_o_deg).to_radians()),
        ORDER,
    ))
}
