//! Checks of every row of a finished study.

use super::estimator::name;
use super::finished::Study;
use super::rows::Row;
use hairis_harness::materials;
use hairis_harness::variance::check::{self, Checked};
use hairis_instruments::light::Constant;

impl Study {
    /// Returns a line for each figure that cannot be right: a weight above its proven bound, samplers of a model that disagree on the mean
    /// under the constant light, and means of rays from candidates that disagree with those of samples.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let rows = self.rows();
        let checked = rows.iter().map(|row: &Row<'_>| {
            let (model, strategy) = row.of;
            let (cell, model, light) = (row.cell.index, model.name(), &*self.lights()[row.light]);
            Checked {
                place: format!("cell {cell}, {model} {}, {light}", name(strategy)),
                group: format!("{cell} {model}"),
                // Perfect sampling uses directions of another sampler, and their mean.
                is_constant: light == Constant::NAME && strategy.is_some(),
                measured: row.measured,
            }
        });
        let mut failures = check::failures(&checked.collect::<Vec<_>>());
        failures.extend(materials::failures(&self.material_rows()));
        failures
    }
}
