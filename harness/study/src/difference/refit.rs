//! Refits: the Cauchy model whose parameters are fitted to the look of each hair of a grid.

use crate::fit::{FitConfig, Look, fit};
use crate::study::{Cell, Grid};
use hairis::{HairParams, ParamError};
use hairis_harness::journal::Journal;
use hairis_instruments::error::Error;
use hairis_instruments::progress::Progress;
use hairis_materials::material::single;
use hairis_variants::{ModelId, Parameters as _, Values};

/// Number of all numbers in the fields of hair.
const NUMBERS: usize = 19;

/// Returns the index of a cell's hair.
pub(super) const fn hair_of(grid: &Grid, cell: &Cell) -> usize {
    cell.index / grid.theta_o_deg.len()
}

/// Returns the fitted parameters of every hair.
pub(super) fn all(
    grid: Grid,
    journal: &Journal,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<HairParams>, Error> {
    let config = FitConfig::of_grid(&grid);
    let first_cells: Vec<Cell> = grid.cells().step_by(config.views.len().max(1)).collect();
    let refit = |cell: &Cell| {
        let find = || {
            let look = Look {
                model: ModelId::Gaussian,
                values: cell.params()?.values(),
            };
            let values = fit(&look, ModelId::Cauchy, &config, &|_, _| ())?
                .found
                .values;
            Ok::<_, ParamError>(numbers(&values))
        };
        let key = format!("refit of the hair of cell {}", cell.index);
        let numbers = journal.numbers(&key, find)?;
        Ok(HairParams::from_values(&values(&numbers))?)
    };
    let progress = Progress::new(first_cells.len(), progress);
    progress.map(&first_cells, refit).into_iter().collect()
}

/// Returns all numbers of the fields.
#[must_use]
pub fn numbers(of: &Values) -> [f64; NUMBERS] {
    let fields = 0..of.fields().len();
    let mut all = fields.flat_map(|index| of.numbers_at(index).iter().copied());
    core::array::from_fn(|_| all.next().map_or(f64::NAN, f64::from))
}

/// Restores values from their numbers.
///
/// # Panics
///
/// Panics if a number is not one of a legal field.
#[must_use]
pub fn values(of: &[f64; NUMBERS]) -> Values {
    let mut values = ModelId::Cauchy.measured();
    let mut rest = &of[..];
    for index in 0..values.fields().len() {
        let (numbers, others) = rest.split_at(values.numbers_at(index).len());
        let numbers: Vec<f32> = numbers.iter().map(|x| single(*x)).collect();
        values.set_at(index, &numbers).expect("a field of hair");
        rest = others;
    }
    values
}
