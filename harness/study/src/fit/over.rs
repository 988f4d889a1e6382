//! Fits to many looks, with their residuals as a table.

use super::{FitConfig, Look, Residual, first_start, fit, residuals};
use crate::difference::Summary;
use crate::study::Grid;
use hairis::ParamError;
use hairis_instruments::columns::Columns;
use hairis_instruments::progress::Progress;
use hairis_instruments::table::{Table, number};
use hairis_variants::{ModelId, Parameters, Values};

/// Fit to one of many looks, with its residuals from the inclinations of the fit.
#[derive(Clone, Debug)]
pub struct Refit {
    /// Name of the look.
    pub name: String,
    /// Values that were found.
    pub values: Values,
    /// Distance over all views of each of the [`rules`](super::rules).
    pub distances_of_rules: Vec<f64>,
    /// Distance over all views.
    pub distance: f64,
    /// Error of the distance.
    pub error: f64,
    /// Residuals of the first start, by view.
    pub before: Vec<Residual>,
    /// Residuals of the fitted values, by view.
    pub after: Vec<Residual>,
}

/// Returns each hair of a grid once: `from` with the values of the hair, and a name that states its axes.
///
/// # Errors
///
/// Returns no error for [`Grid::FULL`] and [`Grid::QUICK`], whose hair is accepted.
pub fn hair_of(grid: Grid, from: ModelId) -> Result<Vec<(String, Look)>, ParamError> {
    let views = grid.theta_o_deg.len();
    let cells = grid.cells().step_by(views.max(1));
    let look = |cell: crate::study::Cell| {
        let [beta, gamma_tt, gamma_g, phi_g, i_g, _] = cell.values();
        let name = format!(
            "beta_r {beta}° gamma_tt {gamma_tt}° gamma_g {gamma_g}° phi_g {phi_g}° i_g {i_g}"
        );
        let values = cell.params()?.values();
        Ok((
            name,
            Look {
                model: from,
                values,
            },
        ))
    };
    cells.map(look).collect()
}

/// Fits `to` to every look, on all cores, and measures the residuals.
///
/// # Errors
///
/// Returns an error if a value of a look is out of its range.
pub fn refits(
    looks: &[(String, Look)],
    to: ModelId,
    config: &FitConfig,
    progress: &Progress<'_>,
) -> Result<Vec<Refit>, ParamError> {
    let refit = |(name, look): &(String, Look)| {
        let found = fit(look, to, config, &|_, _| ())?;
        let start = Look {
            model: found.found.model,
            values: first_start(look, to),
        };
        Ok(Refit {
            name: name.clone(),
            values: found.found.values,
            distances_of_rules: found.distances_of_rules,
            distance: found.distance,
            error: found.error,
            before: residuals(look, &start, &found.points)?,
            after: residuals(look, &found.found, &found.points)?,
        })
    };
    progress.map(looks, refit).into_iter().collect()
}

/// Returns the refits as columns, with one row per look and view.
///
/// | column | content |
/// |---|---|
/// | `look`, `theta_o_deg` | name of the look, inclination of the viewer in degrees |
/// | `l1_start`, `l1`, `l2_start`, `l2` | distance of `S cos theta_i` per channel, relative to the look's norm, at the start and fitted |
/// | `l1_mean_start`, `l1_mean` | L1 of the mean of RGB |
/// | `albedo`, `albedo_start`, `albedo_fitted` | integrals of `S cos theta_i`, mean of RGB |
/// | `field` or `field[i]` | fitted values, angles in radians |
#[must_use]
pub fn columns(refits: &[Refit]) -> Columns {
    let rows = || {
        refits.iter().flat_map(|refit| {
            let views = refit.before.iter().zip(&refit.after);
            views.map(move |(before, after)| (refit, before, after))
        })
    };
    let columns = Columns::default()
        .text("look", rows().map(|(refit, ..)| refit.name.clone()))
        .number("theta_o_deg", rows().map(|(_, _, row)| row.theta_o_deg))
        .number("l1_start", rows().map(|(_, row, _)| row.l1))
        .number("l1", rows().map(|(_, _, row)| row.l1))
        .number("l2_start", rows().map(|(_, row, _)| row.l2))
        .number("l2", rows().map(|(_, _, row)| row.l2))
        .number("l1_mean_start", rows().map(|(_, row, _)| row.l1_mean))
        .number("l1_mean", rows().map(|(_, _, row)| row.l1_mean))
        .number("albedo", rows().map(|(_, _, row)| row.albedo_from))
        .number("albedo_start", rows().map(|(_, row, _)| row.albedo_to))
        .number("albedo_fitted", rows().map(|(_, _, row)| row.albedo_to));
    let values = rows().map(|(refit, ..)| refit.values);
    value_columns(columns, &values.collect::<Vec<_>>())
}

/// Adds a column for each number of the fields, `field` or `field[i]`. All values are of one model, and the first of them decides which
/// fields there are.
pub(crate) fn value_columns(mut columns: Columns, all: &[Values]) -> Columns {
    let Some(first) = all.first() else {
        return columns;
    };
    for (index, field) in first.fields().iter().enumerate() {
        let count = field.kind.width();
        for place in (0..count).filter(|_| first.has_at(index)) {
            let name = if count == 1 {
                field.name.to_owned()
            } else {
                format!("{}[{place}]", field.name)
            };
            let of = |values: &Values| f64::from(values.numbers_at(index)[place]);
            columns = columns.number(name, all.iter().map(of));
        }
    }
    columns
}

/// Name of a distance, and the function that returns it.
type NamedDistance = (&'static str, fn(&Residual) -> f64);

/// Distances of which medians are told.
const DISTANCES: [NamedDistance; 3] = [
    ("L1", |row| row.l1),
    ("L2", |row| row.l2),
    ("L1, mean of RGB", |row| row.l1_mean),
];

/// Returns summaries of a distance at the start and after the fit, over looks and views.
fn summaries(refits: &[Refit], of: fn(&Residual) -> f64) -> [Summary; 2] {
    [
        Summary::of(refits.iter().flat_map(|refit| &refit.before).map(of)),
        Summary::of(refits.iter().flat_map(|refit| &refit.after).map(of)),
    ]
}

/// Returns a verdict for each distance.
#[must_use]
pub fn verdicts(refits: &[Refit]) -> [[String; 2]; 3] {
    DISTANCES.map(|(name, of)| {
        let [before, after] = summaries(refits, of);
        let [median, most, from] = [after.median, after.most, before.median].map(number::percent);
        [
            name.to_owned(),
            format!("Median {median} (worst {most}), from {from} at the start."),
        ]
    })
}

/// Returns a table of the medians and the worst of the distances, over looks and views.
pub fn table(title: &str, refits: &[Refit]) -> Table {
    let mut table = Table::new(title).texts(["distance"]).numbers([
        "median at the start",
        "worst",
        "median fitted",
        "worst",
    ]);
    for (name, of) in DISTANCES {
        let [before, after] = summaries(refits, of);
        let cells = [before.median, before.most, after.median, after.most].map(number::percent);
        table.push([name.to_owned()].into_iter().chain(cells));
    }
    table.note("Of S cos θᵢ over the sphere, relative to the norm of the model that is fitted to, by look and view.")
}
