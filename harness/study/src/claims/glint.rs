//! Density of the glint: as printed, without an end, and as sampled, which ends at a right angle.

use super::FoundCells;
use super::bounded::{Bounded, Spread, integrals, largest};
use super::claim::{Claim, Figure, Origin, Side, Statement};
use super::hair::Hair;
use crate::study::Grid;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::params::HairDesc;
use hairis::{HairParams, ParamError};
use hairis_harness::subject::ModelKind;
use hairis_reference::errata;

const DENSITY: Statement = Statement {
    id: "misprint-glint-density",
    quotation: "p(φ_i) = p(φ)/2 = γ_g / (2 (C_g − D_g) ((|φ| − φ_g)² + γ_g²))",
    source: "section 3.2.2, appendix D",
    of: "total of the density over all azimuths, less 1",
    side: Side::AtMost,
    bound: 1e-6,
    limits: "the glints of the parameter grid with the smallest excess",
};

const INTERVAL: Statement = Statement {
    id: "glint-interval",
    quotation: "Then we sample φ in the domain [0, π/2], and change its sign to its corresponding half of the lobe.",
    source: "appendix D",
    of: "growth of V, constant light, from azimuths up to 1e-7 rad from π to those up to 1e-8 rad",
    side: Side::AtMost,
    bound: 1e-6,
    limits: "hair that transmits (TT) besides",
};

/// Distances from `|phi| = pi` at which the second moment is cut off, rad.
const GAPS: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];

/// Returns the grid's glints of the stronger kind, one per pair of widths and half angles, without R and, unless `tt`, without TT.
///
/// # Errors
///
/// Returns an error if hair is rejected.
pub fn glints(tt: bool) -> Result<Vec<HairParams>, ParamError> {
    let base = *HairParams::bright().desc();
    let (grid, none) = (Grid::FULL, [0.0; 3]);
    let strongest = grid.intensity_g.iter().copied().fold(0.0, f32::max);
    let hair = |gamma_g: &f32, phi_g: &f32| {
        HairParams::new(&HairDesc {
            gamma_g: gamma_g.to_radians(),
            phi_g: phi_g.to_radians(),
            i_g: strongest,
            i_r: none,
            i_tt: if tt { base.i_tt } else { none },
            ..base
        })
    };
    grid.gamma_g_deg
        .iter()
        .flat_map(|gamma_g| grid.phi_g_deg.iter().map(move |phi_g| hair(gamma_g, phi_g)))
        .collect()
}

/// Returns the total of the printed density, less 1.
pub fn excess(params: &HairParams) -> Bounded {
    let HairDesc { phi_g, gamma_g, .. } = params.desc().map(f64::from);
    let printed = |phi: f64| [2.0 * errata::glint(phi_g, gamma_g, phi)];
    let [total] = integrals(printed, &[0.0, FRAC_PI_2, PI], phi_g, gamma_g);
    total.plus(-1.0)
}

/// Judges the printed density.
pub(super) fn density(cells: &FoundCells) -> Result<Claim, ParamError> {
    let Spread { most, least, .. } = glints(false)?.iter().map(excess).collect();
    let bias: Spread = cells
        .iter()
        .map(|(.., found)| found.uncut_bias.magnitude())
        .collect();
    let sentence = format!(
        "Samples end at a right angle and the printed density does not: it totals {:.3} to {:.3}, and an estimator that \
         divides by it is up to {:.1}% too dark.",
        1.0 + least.value,
        1.0 + most.value,
        100.0 * bias.most.value,
    );
    let figures = Figure::integrals([
        ("total of the density above 1, most on the grid", most),
        ("total of the density above 1, least on the grid", least),
        (
            "relative loss of an estimator that divides by it, most",
            bias.most,
        ),
        (
            "relative loss of an estimator that divides by it, least",
            bias.least,
        ),
    ]);
    Ok(DENSITY.judge(figures, sentence))
}

/// Returns V over azimuths up to `gap` from pi: of the published sampler, and with glints drawn from [0, pi].
#[must_use]
pub fn up_to(hair: &Hair, gap: f64) -> [Bounded; 2] {
    let decades = (1..).map(|k| 10.0_f64.powi(-k)).take_while(|x| *x > gap);
    let ends: Vec<f64> = [0.0]
        .into_iter()
        .chain(decades.map(|x| PI - x))
        .chain([PI - gap])
        .collect();
    hair.second_moments(&ends).map(|of| of.plus(-1.0))
}

/// Returns the contribution to V of azimuths from `10 gap` to `gap` away from pi.
#[must_use]
pub fn decade(hair: &Hair, gap: f64) -> [Bounded; 2] {
    hair.second_moments(&[PI - 10.0 * gap, PI - gap])
}

/// Judges the end of the glint's samples at a right angle.
pub(super) fn interval(cells: &FoundCells) -> Result<Claim, ParamError> {
    let (alone, with_tt) = (glints(false)?, glints(true)?);
    let last = GAPS[GAPS.len() - 1];
    let growth = |model: ModelKind, all: &[HairParams], place: usize| {
        largest(
            all.iter()
                .map(|params| decade(&Hair::new(model, params, 0.0), last)[place]),
        )
    };
    let both = |all: &[HairParams], place: usize| {
        largest(ModelKind::ALL.map(|model| growth(model, all, place)))
    };
    let worst = both(&alone, 0);
    let ratio: Spread = cells
        .iter()
        .map(|(.., found)| found.published.over(found.whole))
        .collect();
    let sentence = format!(
        "Behind a right angle TRT-g alone covers the tail of the glints and vanishes at π: without R and TT the variance \
         on the Cauchy model is infinite, V growing by {:.4} a decade; with all lobes V is {:.3} times that of glints \
         drawn from [0, π] (geometric mean; {:.2} to {:.2}).",
        worst.value, ratio.mean.value, ratio.least.value, ratio.most.value,
    );
    let mut figures = Figure::integrals([
        (
            "growth of V, TRT and glints alone, most of the grid's glints",
            worst,
        ),
        (
            "growth of V, TT besides, most of the grid's glints",
            both(&with_tt, 0),
        ),
        (
            "growth of V, TRT and glints alone, Gaussian",
            growth(ModelKind::Gaussian, &alone, 0),
        ),
        (
            "growth of V, TRT and glints alone, glints on [0, π]",
            both(&alone, 1),
        ),
    ]);
    // The widest glints, furthest from the viewer, leave the most of themselves beyond the right angle.
    let widest = Hair::new(ModelKind::Cauchy, &alone[alone.len() - 1], 0.0);
    let at = "γ_g = 20°, φ_g = 45°, I_g = 5, Cauchy";
    let mut add =
        |name, number: Bounded| figures.push(Figure::new(name, Origin::Quadrature, number));
    for gap in GAPS {
        let [published, whole] = up_to(&widest, gap);
        add(format!("V up to {gap:e} rad from π, {at}"), published);
        if gap == last {
            add(format!("the same, glints on [0, π], {at}"), whole);
        }
    }
    figures.extend(Figure::integrals([
        (
            "V over V of glints on [0, π], all lobes, geometric mean",
            ratio.mean,
        ),
        ("V over V of glints on [0, π], all lobes, most", ratio.most),
        (
            "V over V of glints on [0, π], all lobes, least",
            ratio.least,
        ),
    ]));
    Ok(INTERVAL.judge(figures, sentence))
}
