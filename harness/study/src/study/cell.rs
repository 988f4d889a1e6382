//! Cell of the grid: every sampler of both models, as rows of the study.

use super::grid::Cell;
use hairis::{HairParams, ParamError};
use hairis_harness::efficiency::PHI_O_DEG;
use hairis_harness::sampler::{Sampler, Scatter};
use hairis_harness::subject::ModelKind;
use hairis_harness::variance::{self, Measured, SOURCE, SampleBudget, Subject};
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::light::Light;
use hairis_instruments::sequence::stream_id;

/// Measures a cell: models outermost, then samplers, then lights. If the sampler that perfect sampling is estimated from is among
/// `samplers`, the figures of perfect sampling come after them: models, then lights.
///
/// The streams are keyed by the values of the cell, not by its index or by the thread that computes it.
///
/// # Errors
///
/// Returns an error if the hair of the cell is rejected.
pub fn measure(
    seed: u64,
    budget: SampleBudget,
    lights: &[&dyn Light],
    cell: &Cell,
    samplers: &[Sampler],
) -> Result<Vec<Measured>, ParamError> {
    let params = cell.params()?;
    let subjects = ModelKind::ALL.into_iter().flat_map(|model| {
        let subject = move |sampler: &Sampler| (model.index(), model, *sampler);
        samplers.iter().map(subject)
    });
    Ok(of_subjects(seed, budget, lights, cell, &params, subjects))
}

/// Measures the Cauchy model with parameters of its own in place of the cell's: samplers outermost, then lights.
pub(super) fn measure_refit(
    seed: u64,
    budget: SampleBudget,
    lights: &[&dyn Light],
    cell: &Cell,
    params: &HairParams,
    samplers: &[Sampler],
) -> Vec<Measured> {
    // The streams come after those of all models.
    let model = ModelKind::ALL.len() as u64;
    let subject = |sampler: &Sampler| (model, ModelKind::Cauchy, *sampler);
    let subjects = samplers.iter().map(subject);
    of_subjects(seed, budget, lights, cell, params, subjects)
}

/// Measures subjects, each with a number among the streams of models; after them comes perfect sampling.
fn of_subjects(
    seed: u64,
    budget: SampleBudget,
    lights: &[&dyn Light],
    cell: &Cell,
    params: &HairParams,
    subjects: impl Iterator<Item = (u64, ModelKind, Sampler)>,
) -> Vec<Measured> {
    let wo = fibre_direction(
        f64::from(cell.theta_o_deg).to_radians(),
        PHI_O_DEG.to_radians(),
    )
    .as_vec3();
    let key = stream_id(&cell.values().map(|value| u64::from(value.to_bits())));
    let subjects: Vec<Subject> = subjects
        .map(|(number, model, sampler)| Subject {
            scatter: Scatter::new(model, sampler, params, wo),
            stream: [number, sampler.index()],
            is_source: sampler == SOURCE,
        })
        .collect();
    let found = variance::measure([seed, key], budget, lights, &subjects);
    let rows = found.iter().flat_map(|of| &of.sampler);
    let perfect = found.iter().flat_map(|of| &of.perfect);
    rows.chain(perfect).copied().collect()
}
