//! Refits: samples that the all-Cauchy model saves once its parameters are fitted to the look of the Gaussian one.

use super::cell::measure_refit;
use super::estimator::TOLD;
use super::finished::{RefitVariances, Refits, Study};
use super::grid::{Cell, columns_of};
use super::view::{Gain, gain};
use crate::difference::Difference;
use core::cell::OnceCell;
use hairis::ParamError;
use hairis_harness::journal::Journal;
use hairis_harness::lights::Lights;
use hairis_harness::subject::ModelKind;
use hairis_harness::variance::SampleBudget;
use hairis_instruments::columns::Columns;
use hairis_instruments::error::Error;
use hairis_instruments::light::Environment;
use hairis_instruments::progress::Progress;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::{Table, number};
use hairis_variants::Parameters as _;

impl Study {
    /// Measures V on the Cauchy model of [`Width::Refitted`](crate::difference::Width::Refitted). Without an environment, V under it stays
    /// unknown. Figures that `journal` holds are taken from it, and new ones are added. `progress` is called with the numbers of cells done
    /// and of all cells.
    ///
    /// # Errors
    ///
    /// Returns an error if `journal` cannot be read or written.
    pub fn refit(
        &mut self,
        difference: &Difference,
        environment: Option<&Environment>,
        journal: &Journal,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<(), Error> {
        let lights = Lights::from(environment).all();
        let budget = SampleBudget {
            samples: self.header.samples,
            light_samples: self.header.light_samples,
            pools: 0,
        };
        let of_cell = |cell: &Cell| {
            let found = OnceCell::new();
            let of = |sampler: usize, name: &String| {
                let Some(light) = lights.iter().position(|light| light.name() == *name) else {
                    return Ok(Estimate::UNKNOWN);
                };
                let find = || {
                    let found = found.get_or_init(|| {
                        let refit = difference.refit(cell);
                        measure_refit(self.header.seed, budget, &lights, cell, refit, &TOLD)
                    });
                    let v = found[sampler * lights.len() + light].figures.v;
                    Ok::<_, ParamError>([v.value, v.standard_error])
                };
                let sampler = TOLD[sampler].name();
                let key = format!(
                    "V of {sampler} on the refit under {name} in cell {}",
                    cell.index
                );
                let [value, standard_error] = journal.numbers(&key, find)?;
                Ok(Estimate {
                    value,
                    standard_error,
                })
            };
            let mut rows = RefitVariances::default();
            for (sampler, row) in rows.iter_mut().enumerate() {
                let names = self.header.lights.iter();
                *row = names
                    .map(|name| of(sampler, name))
                    .collect::<Result<_, Error>>()?;
            }
            Ok(rows)
        };
        let cells: Vec<Cell> = self.grid().cells().take(self.cells.len()).collect();
        let found = Progress::new(cells.len(), progress).map(&cells, of_cell);
        self.refits = Refits(found.into_iter().collect::<Result<_, Error>>()?);
        Ok(())
    }

    /// Returns V of a sampler of [`TOLD`] on the Gaussian model over that on the refitted Cauchy model; `None` if no cell is sure.
    pub(super) fn gain_of_refit(&self, sampler: usize, light: usize) -> Option<Gain> {
        let gaussian = (ModelKind::Gaussian, Some(TOLD[sampler]));
        let rows = self.rows_of(gaussian, light).zip(&self.refits.0);
        gain(rows.map(|(row, refit)| [row.v(), refit[sampler][light]]))
    }

    /// Returns the table of samples saved, with equal widths and refitted; `None` before [`refit`](Self::refit).
    pub(super) fn refit_table(&self) -> Option<Table> {
        if self.refits.0.is_empty() {
            return None;
        }
        let title =
            "Samples that the Cauchy model saves, with equal widths and refitted, over the grid";
        let mut table = Table::new(title).texts(["sampler", "light"]).numbers([
            "equal: median",
            "cells above 0 / below 0",
            "refitted: median",
            "cells above 0 / below 0",
            "geometric mean",
            "left out",
        ]);
        for (place, sampler) in TOLD.into_iter().enumerate() {
            for (light, name) in self.lights().iter().enumerate() {
                let pair = ModelKind::ALL.map(|model| (model, Some(sampler)));
                let shares = |gain: &Gain| gain.shares.map(number::percent).join(" / ");
                let equal = self.gain(pair, light).map_or_else(
                    || vec![String::new(); 2],
                    |gain| vec![saved(gain.median), shares(&gain)],
                );
                let refitted = self.gain_of_refit(place, light).map_or_else(
                    || vec![String::new(); 4],
                    |gain| {
                        let [median, mean] = [gain.median, gain.geometric_mean].map(saved);
                        vec![median, shares(&gain), mean, gain.unsure.to_string()]
                    },
                );
                let keys = [sampler.name().to_owned(), name.clone()].into_iter();
                table.push(keys.chain(equal).chain(refitted));
            }
        }
        Some(table.note(
            "1 − V on the Cauchy model / V on the Gaussian model. Refitted: all parameters of the Cauchy model fitted to the \
             look of the Gaussian one. ±: one standard error.",
        ))
    }

    /// Returns V on the refitted Cauchy model, and its parameters, as columns.
    ///
    /// | column | content |
    /// |---|---|
    /// | `cell` .. `theta_o_deg` | the cell, as in the study's rows |
    /// | `v_SAMPLER_LIGHT` and its `_se` | relative variance of one sample; empty where it is not known |
    /// | `field` or `field[i]` | fitted parameters, angles in radians |
    pub(super) fn refit_columns(&self, difference: &Difference) -> Columns {
        let cells: Vec<Cell> = self.grid().cells().take(self.refits.0.len()).collect();
        let mut columns = columns_of(cells.iter());
        for (place, sampler) in TOLD.into_iter().enumerate() {
            for (light, name) in self.lights().iter().enumerate() {
                let name = format!("v_{}_{}", sampler.name(), name.replace(' ', "_"));
                let rows = self.refits.0.iter();
                columns = columns.estimate(&name, rows.map(|row| row[place][light]));
            }
        }
        let values = cells.iter().map(|cell| difference.refit(cell).values());
        crate::fit::value_columns(columns, &values.collect::<Vec<_>>())
    }
}

/// Returns the share of the samples that a gain saves, with its error.
pub(super) fn saved(gain: Estimate) -> String {
    let less = Estimate {
        value: 100.0 * (1.0 - 1.0 / gain.value),
        standard_error: 100.0 * gain.standard_error / gain.value.powi(2),
    };
    number::estimate(&less) + "%"
}
