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

mod best;
mod blur;
mod lobes;
mod measure;
mod output;
mod refit;

pub(crate) use best::least;
pub use blur::SIGMA_DEG;
pub use measure::{Differences, Norms};
pub(crate) use output::{Summary, albedo_ratio};

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
const ORDER: usize = 8;

/// Number of latitudes, and of longitudes of half a sphere, at which blurred functions are compared.
const LATITUDES: usize = 96;

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

fn hair(cell: &Cell) -> Result<HairValues, ParamError> {
    let params: HairParams = cell.params()?;
    Ok(HairValues::new(
        ViewedHair::new(&params, f64::from(cell.theta_o_deg).to_radians()),
        ORDER,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_harness::subject::ModelKind;
    use hairis_instruments::direction::fibre_direction;
    use hairis_instruments::quadrature::{SphereIntegrator, Tolerance};
    use hairis_reference::{HairReference, Reference};
    use std::sync::LazyLock;

    static QUICK: LazyLock<Difference> = LazyLock::new(|| {
        Difference::over(Grid::QUICK, &Journal::default(), &|_, _| ()).expect("accepted")
    });

    #[test]
    fn the_best_factors_are_the_best_in_their_norm() {
        let found = &*QUICK;
        assert_eq!(found.rows.len(), Grid::QUICK.len() * Width::ALL.len());
        let squares = |width| {
            found
                .of(width)
                .map(|row| row.figures.plain.l2.powi(2))
                .sum::<f64>()
        };
        for width in [Width::Paper, Width::HalfWidth, Width::Area] {
            assert!(
                squares(Width::BestOfGrid) < squares(width),
                "over the grid, {width:?}"
            );
        }
        for rows in found.rows.chunks(Width::ALL.len()) {
            let [others @ .., best, _] = rows else {
                panic!("no rows")
            };
            for other in others {
                assert!(
                    best.figures.plain.l2 <= other.figures.plain.l2 + 1e-9,
                    "{best:?} {other:?}"
                );
            }
        }
    }

    #[test]
    fn no_refit_is_further_away_than_a_factor() {
        let found = &*QUICK;
        let views = Grid::QUICK.theta_o_deg.len() * Width::ALL.len();
        for rows in found.rows.chunks(views) {
            // Light that is reflected elsewhere, from all inclinations.
            let distance = |width: Width| -> f64 {
                let rows = rows.iter().filter(|row| row.width == width);
                let light = rows.map(|row| row.figures.plain.l1 * row.figures.albedo_gaussian);
                light.sum()
            };
            let refitted = distance(Width::Refitted);
            for width in [
                Width::Paper,
                Width::HalfWidth,
                Width::Area,
                Width::BestOfGrid,
            ] {
                assert!(refitted < distance(width), "{width:?} {:?}", rows[0].cell);
            }
        }
    }

    #[test]
    fn figures_are_those_of_the_reference_by_another_quadrature() {
        let cell = Grid::QUICK.cell(17);
        let (params, theta_o) = (
            cell.params().expect("accepted"),
            f64::from(cell.theta_o_deg).to_radians(),
        );
        let found = hair(&cell)
            .expect("accepted")
            .figures(&[Kind::cauchy(1.0)], &Blur::new(0.2, 32, 32))[0];
        let wo = fibre_direction(theta_o, 0.0)
            .as_vec3()
            .as_dvec3()
            .to_array();
        let [gaussian, cauchy] = ModelKind::ALL.map(|model| {
            HairReference::<f64>::prepare(&params.desc().map(f64::from), model.shape(), wo)
        });
        let scale = found.albedo_gaussian / found.albedo_cauchy;
        let desc = params.desc();
        let mut sphere = SphereIntegrator::new().with_tolerance(Tolerance {
            max_panels: 4_000,
            ..Tolerance::relative(1e-5)
        });
        for (alpha, beta) in [
            (desc.alpha[0], desc.beta[0]),
            (desc.alpha[1], desc.beta[1]),
            (desc.alpha[2], desc.beta[2]),
        ] {
            sphere = sphere.theta_lobe(f64::from(2.0 * alpha) - theta_o, f64::from(2.0 * beta));
        }
        let r = sphere.integrate(|theta, phi| {
            let wi = fibre_direction(theta, phi).to_array();
            let [a, b] = [gaussian.eval(wi), cauchy.eval(wi)]
                .map(|s| theta.cos() * s.iter().sum::<f64>() / 3.0);
            [
                a,
                b,
                (a - b).abs(),
                (a - b).powi(2),
                (a - scale * b).abs(),
                (a - scale * b).powi(2),
                a * a,
            ]
        });
        let [a, b, l1, square, shape_l1, shape_square, norm] = r.value;
        let pairs = [
            (found.albedo_gaussian, a),
            (found.albedo_cauchy, b),
            (found.plain.l1, l1 / a),
            (found.plain.l2, (square / norm).sqrt()),
            (found.shape.l1, shape_l1 / a),
            (found.shape.l2, (shape_square / norm).sqrt()),
        ];
        for (place, (got, want)) in pairs.into_iter().enumerate() {
            assert!((got / want - 1.0).abs() < 5e-4, "{place}: {got} {want}");
        }
    }
}
