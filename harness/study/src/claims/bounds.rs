//! Misprinted bounds A and B, without the factor of a half, which place samples off the sphere.

use super::FoundCells;
use super::bounded::{Bounded, Spread};
use super::claim::{Claim, Figure, Side, Statement};
use super::hair::longitudinal_grid;

const STATEMENT: Statement = Statement {
    id: "misprint-bounds",
    quotation: "A = atan((π/2 + θ_r − α) / β) and B = atan((−π/2 + θ_r − α) / β)",
    source: "section 3.2.1, appendix A",
    of: "share of the samples of a lobe with |θ_i| > 90°",
    side: Side::AtMost,
    bound: 1e-6,
    limits: "the lobe of the parameter grid that loses least",
};

/// Collects the spread of closed forms, whose error is the rounding of double precision.
fn spread(values: impl Iterator<Item = f64>) -> Spread {
    values
        .map(|value| Bounded {
            value,
            error: 1e-14,
        })
        .collect()
}

/// Judges the printed bounds.
pub(super) fn claim(cells: &FoundCells) -> Claim {
    let of_lobe = spread(
        longitudinal_grid()
            .into_iter()
            .map(|lobe| 1.0 - lobe.printed_mass()),
    );
    let of_hair = spread(cells.iter().map(|(.., found)| found.lost));
    // Samples that land on the sphere have the printed density, divided by the share that lands there.
    let bias = spread(
        cells
            .iter()
            .map(|(.., found)| found.lost / (1.0 - found.lost)),
    );
    let factor: Spread = cells
        .iter()
        .map(|(.., found)| found.printed.over(found.published))
        .collect();
    let sentence = format!(
        "A lobe loses {:.1}% to {:.0}% of its samples, a hair {:.1}% to {:.0}%; redrawn without renormalising they make \
         the result up to {:.0}% too bright, and counted as black they multiply the variance by {:.2} (geometric mean), \
         at most by {:.1}.",
        100.0 * of_lobe.least.value,
        100.0 * of_lobe.most.value,
        100.0 * of_hair.least.value,
        100.0 * of_hair.most.value,
        100.0 * bias.most.value,
        factor.mean.value,
        factor.most.value,
    );
    let figures = Figure::integrals([
        (
            "share of samples lost, most of a lobe on the grid",
            of_lobe.most,
        ),
        (
            "share of samples lost, least of a lobe on the grid",
            of_lobe.least,
        ),
        ("share of samples lost, most of a hair", of_hair.most),
        ("share of samples lost, least of a hair", of_hair.least),
        ("relative bias if lost samples are redrawn, most", bias.most),
        (
            "relative bias if lost samples are redrawn, least",
            bias.least,
        ),
        (
            "factor on V if lost samples count, geometric mean",
            factor.mean,
        ),
        ("factor on V if lost samples count, most", factor.most),
        ("factor on V if lost samples count, least", factor.least),
    ]);
    STATEMENT.judge(figures, sentence)
}
