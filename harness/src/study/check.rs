//! Checks of every row.

use super::rows::{Row, Strategy};
use crate::efficiency::{FALSE_ALARM, z_bound};
use crate::sampler::Sampler;
use crate::stats::sidak;

/// Rounding of a weight in single precision, relative to its bound.
const ROUNDING: f64 = 1e-4;

/// A line for each figure that cannot be right.
///
/// - No weight is above its proven bound.
/// - Under the constant light, which every direction sees, the samplers of a model agree on the mean: all of their
///   scores together stay below the bound that they pass by chance in one of [`FALSE_ALARM`]'s inverse runs.
/// - The same holds for the means of rays from 8 + 8 candidates against those of samples, under every light.
pub(super) fn failures(rows: &[Row<'_>], lights: &[String]) -> Vec<String> {
    let name = |row: &Row<'_>| {
        let (model, sampler) = (row.model.name(), row.strategy.name());
        format!("cell {}, {model} {sampler}, {}", row.cell.index, lights[row.light])
    };
    let mut failures = Vec::new();
    for row in rows.iter().filter(|row| row.measured.max_weight > row.weight_bound * (1.0 + ROUNDING)) {
        let (weight, bound) = (row.measured.max_weight, row.weight_bound);
        failures.push(format!("{}: a weight of {weight} is above its bound {bound}", name(row)));
    }
    let mut scores = Vec::new();
    // Perfect sampling has directions of another, and their mean.
    let is_sampled = |row: &&Row<'_>| row.light == 0 && row.strategy != Strategy::Perfect;
    let constant: Vec<&Row<'_>> = rows.iter().filter(is_sampled).collect();
    for of_model in constant.chunks(Sampler::ALL.len()) {
        for row in &of_model[1..] {
            let [first, mean] = [of_model[0], row].map(|row| row.measured.figures.mean);
            let z = (mean.value - first.value) / mean.standard_error.hypot(first.standard_error);
            scores.push((if z.is_nan() { f64::INFINITY } else { z.abs() }, *row));
        }
    }
    let bound = z_bound(sidak(FALSE_ALARM, scores.len()));
    for (z, row) in scores.into_iter().filter(|(z, _)| *z > bound) {
        let first = Sampler::ALL[0].name();
        failures.push(format!(
            "{}: its mean is {z:.2} standard errors from that of {first}, allowed {bound:.2}",
            name(row)
        ));
    }
    let biased: Vec<(f64, &Row<'_>)> =
        rows.iter().filter_map(|row| Some((row.measured.rays?.bias?.abs(), row))).collect();
    let bound = z_bound(sidak(FALSE_ALARM, biased.len()));
    for (z, row) in biased.into_iter().filter(|(z, _)| *z > bound) {
        failures.push(format!(
            "{}: the mean of rays from candidates is {z:.2} standard errors from that of samples, allowed {bound:.2}",
            name(row)
        ));
    }
    failures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Estimate;
    use crate::study::Grid;
    use crate::study::cell::Measured;
    use crate::study::rays::Rays;
    use crate::study::rows::{Bounds, rows};
    use crate::study::tally::Figures;
    use crate::subject::ModelKind;

    #[test]
    fn weights_above_their_bound_and_means_apart_are_found() {
        let of = |value, standard_error| Estimate { value, standard_error };
        let row = Measured {
            figures: Figures { mean: of(3.0, 0.01), v: of(0.2, 0.01), kl: of(0.1, 0.01) },
            max_weight: 1.0,
            max_contribution: 2.0,
            rays: Some(Rays { mis: of(1.4, 0.1), chosen: [of(0.2, 0.01), of(0.1, 0.01)], bias: Some(-1.0) }),
        };
        let mut cells = vec![vec![row; 5 * ModelKind::ALL.len() * Strategy::ALL.len()]; 2];
        let lights = ["constant", "smooth", "sun", "rectangle", "sky"].map(str::to_owned);
        let bounds = Bounds::over(Grid::QUICK);
        let found = |cells: &[Vec<Measured>]| failures(&rows(Grid::QUICK, cells, &bounds, 5), &lights);
        assert_eq!(found(&cells), [""; 0]);
        cells[0][0].max_weight = 1e3;
        cells[1][5].figures.mean.value = 3.1;
        let said = found(&cells);
        assert_eq!(said.len(), 2, "{said:?}");
        assert!(
            said[0].starts_with("cell 0, gaussian uniform, constant: a weight of 1000 is above its bound 20.7"),
            "{said:?}"
        );
        assert!(
            said[1].starts_with("cell 1, gaussian published, constant: its mean is 7.07 standard errors"),
            "{said:?}"
        );
        cells[1][5].figures.mean.value = f64::NAN;
        assert_eq!(found(&cells).len(), 2, "no number is no agreement");
        let biased = Rays { mis: of(1.4, 0.1), chosen: [of(0.2, 0.01); 2], bias: Some(-9.0) };
        cells[1][9].rays = Some(biased);
        let said = found(&cells);
        let words = "cell 1, gaussian published, sky: the mean of rays from candidates is 9.00 standard errors from";
        assert!(said.len() == 3 && said[2].starts_with(words), "{said:?}");
    }
}
