//! Estimators: a model, with the strategy by which its directions are drawn.

use super::grid::Cell;
use hairis_harness::sampler::{Sampler, weight_bound};
use hairis_harness::subject::ModelKind;
use hairis_harness::variance::Measured;

/// Sampler of a row, or `None` for perfect sampling of the hair; see [`variance`](hairis_harness::variance).
pub(super) type Strategy = Option<Sampler>;

/// Model, with the strategy by which its directions are drawn.
pub(super) type Estimator = (ModelKind, Strategy);

/// Samplers that sentences distinguish: the published one, and the matched one that is the default of a renderer.
pub(super) const TOLD: [Sampler; 2] = [Sampler::Published, Sampler::Matched];

/// Returns every strategy, in the order of reports.
pub(super) fn strategies() -> impl Iterator<Item = Strategy> + Clone {
    samplers().chain([None])
}

/// Returns the samplers that can be run.
pub(super) fn samplers() -> impl Iterator<Item = Strategy> + Clone {
    Sampler::ALL.into_iter().map(Some)
}

/// Returns each of some strategies on each model.
pub(super) fn on_each_model(
    of: impl Iterator<Item = Strategy> + Clone,
) -> impl Iterator<Item = Estimator> + Clone {
    ModelKind::ALL
        .into_iter()
        .flat_map(move |model| of.clone().map(move |strategy| (model, strategy)))
}

/// Returns the name of a strategy in reports and in rows.
pub(super) fn name(strategy: Strategy) -> &'static str {
    strategy.map_or("perfect", Sampler::name)
}

/// Returns the published sampler on the same model, which gains are measured against.
pub(super) const fn published((model, _): Estimator) -> Estimator {
    (model, Some(Sampler::Published))
}

/// Returns the index of a row within its cell. Perfect sampling comes after all samplers of all models.
pub(super) const fn place((model, strategy): Estimator, light: usize, lights: usize) -> usize {
    let line = match strategy {
        Some(sampler) => model as usize * Sampler::ALL.len() + sampler as usize,
        None => ModelKind::ALL.len() * Sampler::ALL.len() + model as usize,
    };
    line * lights + light
}

/// Sets the proven bounds on the weights in a cell, which do not depend on the light.
pub(super) fn set_bounds(cell: &Cell, measured: &mut [Measured], lights: usize) {
    let (params, theta_o) = (cell.params().ok(), f64::from(cell.theta_o_deg).to_radians());
    for (model, strategy) in on_each_model(samplers()) {
        let bound = strategy
            .zip(params.as_ref())
            .and_then(|(of, params)| weight_bound(model, of, params, theta_o));
        let first = place((model, strategy), 0, lights);
        measured[first..first + lights]
            .iter_mut()
            .for_each(|row| row.weight_bound = bound);
    }
}
