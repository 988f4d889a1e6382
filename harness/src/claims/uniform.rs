//! Importance sampling against uniform sampling, over the parameter grid.

use super::claim::{Claim, Figure, Side, Threshold, Words, geometric_mean, largest, smallest};
use super::hair::HairFigures;
use super::{FoundCells, hair_of};
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::study::{Cell, Grid, Plan, StudyBudget, variances};
use crate::subject::ModelKind;
use hairis::ParamError;

const WORDS: Words = Words {
    id: "better-than-uniform",
    quotation: "our importance sampling method always yields better sample efficiency than uniform sampling",
    source: "section 5",
};

/// Widest R within the limits, in degrees.
const NARROW: f32 = 10.0;

const THRESHOLD: Threshold = Threshold {
    of: "V of the published sampler over V of uniform sampling, constant light",
    side: Side::AtMost,
    bound: 1.0,
    limits: "β_R ≤ 10°",
};

/// The example: rough hair with wide glints, all else as in the default hair.
fn example() -> Option<Cell> {
    let is = |cell: &Cell| cell.values() == [20.0, 45.0, 20.0, 35.0, 0.5, 0.0];
    (0..Grid::FULL.len()).map(|index| Grid::FULL.cell(index)).find(is)
}

/// V of uniform sampling and of the published sampler on the example, Gaussian model, from samples.
fn measured(plan: &Plan<'_>, cell: &Cell) -> Result<[Estimate; 2], ParamError> {
    let budget = if plan.quick { 1 << 18 } else { 1 << 22 };
    let budget = StudyBudget { samples: budget, light_samples: 8, pools: 0 };
    let v = variances(plan, budget, cell, &[Sampler::Uniform, Sampler::Published])?;
    // Models outermost, then samplers, then lights: the constant light is the first of five.
    Ok([v[0], v[5]])
}

/// The claim.
pub(super) fn claim(plan: &Plan<'_>, cells: &FoundCells) -> Result<Claim, ParamError> {
    let ratio = |found: &HairFigures| found.published.over(found.uniform);
    let all = || cells.iter().map(|(_, _, found)| ratio(found));
    let narrow = cells.iter().filter(|(cell, ..)| cell.beta_r_deg <= NARROW).map(|(_, _, found)| ratio(found));
    let worse = |of: ModelKind| {
        let is =
            |(_, model, found): &&(Cell, ModelKind, HairFigures)| *model == of && ratio(found).value > THRESHOLD.bound;
        cells.iter().filter(is).count()
    };
    let (worst, within) = (largest(all()), largest(narrow));
    let [gaussian, cauchy] = ModelKind::ALL.map(worse);
    let of_each = cells.len() / ModelKind::ALL.len();

    let mut further = Vec::new();
    let mut said = String::new();
    if let Some(cell) = example() {
        let [uniform, published] = measured(plan, &cell)?;
        let exact = hair_of(&cell, ModelKind::Gaussian)?.found();
        let at = "β_R = 20°, γ_TT = 45°, γ_g = 20°, θ_o = 0°";
        further.extend([
            Figure::sampled(format!("V of the published sampler, Gaussian, {at}, measured"), published, ""),
            Figure::sampled(format!("V of uniform, Gaussian, {at}, measured"), uniform, ""),
            Figure::integral(format!("V of the published sampler, Gaussian, {at}"), exact.published, ""),
            Figure::integral(format!("V of uniform, Gaussian, {at}"), exact.uniform, ""),
        ]);
        said = format!(", as at {at}: {:.3} against {:.3}", published.value, uniform.value);
    }
    further.extend([
        Figure::count("cells worse than uniform, Gaussian", gaussian, "cells"),
        Figure::count("cells worse than uniform, Cauchy", cauchy, "cells"),
        Figure::count("cells of each model", of_each, "cells"),
        Figure::integral("V of the published sampler over V of uniform, least", smallest(all()), ""),
        Figure::integral("V of the published sampler over V of uniform, geometric mean", geometric_mean(all()), ""),
    ]);
    let sentence = format!(
        "Uniform sampling has the lower variance in {gaussian} of {of_each} cells on the Gaussian model and in {cauchy} \
         on the Cauchy model{said}; the worst ratio is {:.2}, that for β_R ≤ 10° {:.2}.",
        worst.value, within.value
    );
    Ok(Claim::judge(
        WORDS,
        THRESHOLD,
        [
            Figure::integral("V of the published sampler over V of uniform, most, both models", worst, ""),
            Figure::integral("V of the published sampler over V of uniform, most for β_R ≤ 10°", within, ""),
        ],
        further,
        sentence,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::claim::Bounded;
    use crate::claims::hair_of;
    use crate::light::Sky;

    #[test]
    fn the_example_is_that_of_the_record() {
        let sky = Sky::default().environment();
        let plan = Plan { seed: 3, quick: true, environment: &sky };
        let cell = example().expect("in the grid");
        let [uniform, published] = measured(&plan, &cell).expect("accepted");
        let exact = hair_of(&cell, ModelKind::Gaussian).expect("accepted").found();
        let near = |of: Bounded, value: f64| (of.value - value).abs() < 1e-3;
        assert!(near(exact.uniform, 0.267) && near(exact.published, 0.302), "{exact:?}");
        for (got, want) in [(uniform, exact.uniform), (published, exact.published)] {
            assert!(got.z_score(want.value).abs() < 4.0, "{got:?} {want:?}");
        }
    }
}
