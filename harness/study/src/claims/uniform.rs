//! Importance sampling compared with uniform sampling, over the parameter grid.

use super::bounded::{Bounded, Spread, largest};
use super::claim::{Claim, Figure, Origin, Side, Statement};
use super::{FoundCells, hair_of};
use crate::study::{Cell, Grid, Plan, Size, variances};
use hairis::ParamError;
use hairis_harness::journal::Journal;
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_harness::variance::SampleBudget;
use hairis_instruments::error::Error;
use hairis_instruments::light::Constant;
use hairis_instruments::stats::Estimate;

const STATEMENT: Statement = Statement {
    id: "better-than-uniform",
    quotation: "our importance sampling method always yields better sample efficiency than uniform sampling",
    source: "section 5",
    of: "V of the published sampler over V of uniform sampling, constant light",
    side: Side::AtMost,
    bound: 1.0,
    limits: "β_R ≤ 10°",
};

/// Widest R lobe within the limits, in degrees.
const NARROW: f32 = 10.0;

/// Returns the cell of the example: rough hair with wide glints, and all else as in the default hair.
///
/// # Panics
///
/// Panics if the grid has no such cell.
#[must_use]
pub fn example() -> Cell {
    let is = |cell: &Cell| cell.values() == [20.0, 45.0, 20.0, 35.0, 0.5, 0.0];
    Grid::FULL.cells().find(is).expect("a cell of the grid")
}

/// Measures V of uniform sampling and of the published sampler on the example with the Gaussian model, from samples.
///
/// # Errors
///
/// Returns an error if the hair is rejected, or if a figure cannot be kept.
pub fn measured(plan: &Plan<'_>, cell: &Cell, journal: &Journal) -> Result<[Estimate; 2], Error> {
    let budget = match plan.size {
        Size::Tiny => 1 << 14,
        Size::Quick => 1 << 18,
        Size::Full => 1 << 22,
    };
    let budget = SampleBudget {
        samples: budget,
        light_samples: 8,
        pools: 0,
    };
    let of = |sampler: Sampler| {
        let key = format!("V of {} on the example", sampler.name());
        let find = || {
            let all = variances(plan, budget, cell, &[sampler])?;
            let mut rows = all.iter().filter(|of| of.model == ModelKind::Gaussian);
            let row = rows.find(|of| of.light == Constant::NAME);
            let v = row.map_or(Estimate::UNKNOWN, |of| of.v);
            Ok::<_, ParamError>([v.value, v.standard_error])
        };
        let [value, standard_error] = journal.numbers(&key, find)?;
        Ok::<_, Error>(Estimate {
            value,
            standard_error,
        })
    };
    Ok([of(Sampler::Uniform)?, of(Sampler::Published)?])
}

/// Judges importance sampling against uniform sampling.
pub(super) fn claim(
    plan: &Plan<'_>,
    cells: &FoundCells,
    journal: &Journal,
) -> Result<Claim, Error> {
    let ratios: Vec<(&Cell, ModelKind, Bounded)> = cells
        .iter()
        .map(|(cell, model, found)| (cell, *model, found.published.over(found.uniform)))
        .collect();
    let ratio: Spread = ratios.iter().map(|(.., ratio)| *ratio).collect();
    let within = largest(
        ratios
            .iter()
            .filter(|(cell, ..)| cell.beta_r_deg <= NARROW)
            .map(|(.., ratio)| *ratio),
    );
    let worse = |of: ModelKind| {
        ratios
            .iter()
            .filter(|(_, model, ratio)| *model == of && ratio.value > STATEMENT.bound)
            .count()
    };
    let [gaussian, cauchy] = ModelKind::ALL.map(worse);
    let of_each = cells.len() / ModelKind::ALL.len();

    let cell = example();
    let [uniform, published] = measured(plan, &cell, journal)?;
    let exact = hair_of(&cell, ModelKind::Gaussian)?.found();
    let at = "β_R = 20°, γ_TT = 45°, γ_g = 20°, θ_o = 0°";
    let [of_published, of_uniform] = ["the published sampler", "uniform"]
        .map(|sampler| format!("V of {sampler}, Gaussian, {at}"));

    let mut figures = Figure::integrals([
        (
            "V of the published sampler over V of uniform, most, both models",
            ratio.most,
        ),
        (
            "V of the published sampler over V of uniform, most for β_R ≤ 10°",
            within,
        ),
    ]);
    figures.extend([
        Figure::new(
            format!("{of_published}, measured"),
            Origin::Sampled,
            published,
        ),
        Figure::new(format!("{of_uniform}, measured"), Origin::Sampled, uniform),
        Figure::new(of_published, Origin::Quadrature, exact.published),
        Figure::new(of_uniform, Origin::Quadrature, exact.uniform),
        Figure::cells("cells worse than uniform, Gaussian", gaussian),
        Figure::cells("cells worse than uniform, Cauchy", cauchy),
        Figure::cells("cells of each model", of_each),
    ]);
    figures.extend(Figure::integrals([
        (
            "V of the published sampler over V of uniform, least",
            ratio.least,
        ),
        (
            "V of the published sampler over V of uniform, geometric mean",
            ratio.mean,
        ),
    ]));
    let sentence = format!(
        "Uniform sampling has the lower variance in {gaussian} of {of_each} cells on the Gaussian model and in {cauchy} \
         on the Cauchy model, as at {at}: {:.3} against {:.3}; the worst ratio is {:.2}, that for β_R ≤ 10° {:.2}.",
        published.value, uniform.value, ratio.most.value, within.value
    );
    Ok(STATEMENT.judge(figures, sentence))
}
