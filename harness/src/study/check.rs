//! Checks of every row.

use super::output::Study;
use super::rows::{Row, name};
use crate::efficiency::{FALSE_ALARM, z_bound};
use crate::lights::CONSTANT;
use crate::sampler::Sampler;
use hairis_instruments::stats::sidak;

/// Rounding of a weight in single precision, relative to its bound.
const ROUNDING: f64 = 1e-4;

impl Study {
    /// A line for each figure that cannot be right.
    ///
    /// - No weight is above its proven bound.
    /// - Under the constant light, which every direction sees, the samplers of a model agree on the mean: all of their
    ///   scores together stay below the bound that they pass by chance in one of [`FALSE_ALARM`]'s inverse runs.
    /// - The same holds for the means of rays from 8 + 8 candidates against those of samples, under every light.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let rows = self.rows();
        let place = |row: &Row<'_>| {
            let (model, strategy) = row.of;
            format!(
                "cell {}, {} {}, {}",
                row.cell.index,
                model.name(),
                name(strategy),
                self.lights()[row.light]
            )
        };
        let mut failures = Vec::new();
        for row in &rows {
            let weight = row.measured.max_weight;
            if let Some(bound) = row
                .measured
                .weight_bound
                .filter(|bound| weight > bound * (1.0 + ROUNDING))
            {
                failures.push(format!(
                    "{}: a weight of {weight} is above its bound {bound}",
                    place(row)
                ));
            }
        }
        let mut beyond = |scores: &[(f64, &Row<'_>)], of: &str, other: &str| {
            let bound = z_bound(sidak(FALSE_ALARM, scores.len()));
            for (z, row) in scores.iter().filter(|(z, _)| *z > bound) {
                failures.push(format!(
                    "{}: {of} is {z:.2} standard errors from that of {other}, allowed {bound:.2}",
                    place(row)
                ));
            }
        };
        // Perfect sampling has directions of another, and their mean.
        let constant: Vec<&Row<'_>> = rows
            .iter()
            .filter(|row| row.light == CONSTANT && row.of.1.is_some())
            .collect();
        let scores = constant.chunks(Sampler::ALL.len()).flat_map(|of_model| {
            of_model[1..].iter().map(|row| {
                let [first, mean] = [of_model[0], row].map(|row| row.measured.figures.mean);
                let z =
                    (mean.value - first.value) / mean.standard_error.hypot(first.standard_error);
                (if z.is_nan() { f64::INFINITY } else { z.abs() }, *row)
            })
        });
        beyond(
            &scores.collect::<Vec<_>>(),
            "its mean",
            Sampler::ALL[0].name(),
        );
        let biases = rows
            .iter()
            .filter_map(|row| Some((row.measured.bias?.abs(), row)));
        beyond(
            &biases.collect::<Vec<_>>(),
            "the mean of rays from candidates",
            "samples",
        );
        failures
    }
}

#[cfg(test)]
mod tests {
    use crate::study::cell::Measured;
    use crate::study::output::{Study, Times};
    use crate::study::rows::set_bounds;
    use crate::study::tally::Figures;
    use crate::study::{Grid, Plan};
    use hairis_instruments::light::Sky;
    use hairis_instruments::shard::Shard;
    use hairis_instruments::stats::Estimate;

    #[test]
    fn weights_above_their_bound_and_means_apart_are_found() {
        let of = |value, standard_error| Estimate {
            value,
            standard_error,
        };
        let row = Measured {
            figures: Figures {
                mean: of(3.0, 0.01),
                v: of(0.2, 0.01),
                kl: of(0.1, 0.01),
            },
            max_weight: 1.0,
            weight_bound: None,
            max_contribution: 2.0,
            rays: Some([of(1.4, 0.1), of(0.2, 0.01), of(0.1, 0.01)]),
            bias: Some(-1.0),
        };
        let plan = Plan {
            seed: 1,
            quick: true,
            environment: &Sky::default().environment(),
        };
        let header = plan.header(Shard::WHOLE);
        let mut cells = vec![vec![row; header.rows()]; 2];
        cells
            .iter_mut()
            .zip(Grid::QUICK.cells())
            .for_each(|(rows, cell)| set_bounds(&cell, rows, 5));
        let found = |cells: &[Vec<Measured>]| {
            Study {
                header: header.clone(),
                cells: cells.to_vec(),
                times: Times::default(),
            }
            .failures()
        };
        assert_eq!(found(&cells), [""; 0]);
        cells[0][0].max_weight = 1e3;
        cells[1][5].figures.mean.value = 3.1;
        let said = found(&cells);
        assert_eq!(said.len(), 2, "{said:?}");
        assert!(
            said[0].starts_with(
                "cell 0, gaussian uniform, constant: a weight of 1000 is above its bound 20.7"
            ),
            "{said:?}"
        );
        assert!(
            said[1].starts_with(
                "cell 1, gaussian published, constant: its mean is 7.07 standard errors"
            ),
            "{said:?}"
        );
        cells[1][5].figures.mean.value = f64::NAN;
        assert_eq!(found(&cells).len(), 2, "no number is no agreement");
        cells[1][9].bias = Some(-9.0);
        let said = found(&cells);
        let words = "cell 1, gaussian published, clear sky: the mean of rays from candidates is 9.00 standard errors from";
        assert!(said.len() == 3 && said[2].starts_with(words), "{said:?}");
    }
}
