//! All the tables, cell by cell.

use super::case::Case;
use super::cells::{self, Lit};
use super::reference::{by_quadrature, of_environment};
use super::result::{Check, EfficiencyResult, EfficiencySettings, Technique};
use super::{
    BETA_R_DEG, CONVERGENCE_THETA_O_DEG, EfficiencyConfig, FALSE_ALARM, ModelKind, PHI_O_DEG, Reference, SAMPLERS,
    SUN_DEG, THETA_O_DEG, with_beta,
};
use crate::light::{Constant, Light, Rectangle, Smooth};
use crate::progress::Progress;
use crate::sampler::Sampler;
use crate::sequence::SequenceKind;
use crate::stats::sidak;
use core::f64::consts::SQRT_2;
use hairis::ParamError;
use statrs::function::erf::erfc_inv;

/// Places of the lights in the order of reports.
const CONSTANT: usize = 0;
const SUN: usize = 2;
const AREA: usize = 3;
const ENVIRONMENT: usize = 4;

/// The largest V of an environment for which convergence is shown.
const CONVERGENCE_V: f64 = 100.0;

/// Computes every table. `progress` is called from the workers with the number of cells done and of all cells.
///
/// # Errors
/// When the parameters of the sweep are refused, which valid parameters of the run exclude.
pub fn run(
    config: &EfficiencyConfig<'_>,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<EfficiencyResult, ParamError> {
    let constant = Constant::white();
    let smooth = Smooth::new();
    let sun = super::sun();
    let area = Rectangle::figure_6a();
    let lights: [&dyn Light; 5] = [&constant, &smooth, &sun, &area, config.environment];

    let cases: Vec<Case> = product(&ModelKind::ALL, &THETA_O_DEG)
        .into_iter()
        .map(|(model, theta_o)| Case::new(model, &config.params, theta_o))
        .collect();
    let mut sweep_cases = Vec::new();
    for beta_r in BETA_R_DEG {
        let params = with_beta(&config.params, beta_r)?;
        for (model, theta_o) in product(&ModelKind::ALL, &THETA_O_DEG) {
            sweep_cases.push((beta_r, Case::new(model, &params, theta_o)));
        }
    }

    let case_indices: Vec<usize> = (0..cases.len()).collect();
    let reference_cells = product(&case_indices, &[0, 1, 2, 3, 4]);
    let estimators = product(&SAMPLERS, &SequenceKind::ALL);
    let row_cells = product(&reference_cells, &estimators);
    let techniques: Vec<Technique> = Technique::all().collect();
    let mis_cells = product(&product(&case_indices, &[SUN, AREA, ENVIRONMENT]), &techniques);
    let sizes: Vec<usize> = (2..24).map(|k| 1_usize << k).take_while(|n| *n <= config.budget.convergence_n).collect();
    let convergence_cases: Vec<usize> =
        case_indices.iter().copied().filter(|&c| cases[c].theta_o_deg == CONVERGENCE_THETA_O_DEG).collect();
    let convergence_cells =
        |lights: &[usize]| product(&product(&product(&convergence_cases, lights), &estimators), &sizes);
    let sweep_indices: Vec<usize> = (0..sweep_cases.len()).collect();
    let sweep_cells = product(&sweep_indices, &SAMPLERS);
    let v_cells = product(&case_indices, &SAMPLERS);

    let total = reference_cells.len()
        + row_cells.len()
        + mis_cells.len()
        + convergence_cells(&[CONSTANT, AREA, ENVIRONMENT]).len()
        + sweep_cells.len()
        + v_cells.len();
    let progress = Progress::new(total, progress);

    let budget = &config.budget;
    let references: Vec<Reference> = progress.map(&reference_cells, |&(case, light)| {
        if light == ENVIRONMENT {
            let passes = budget.reference_passes;
            of_environment(&cases[case], config.environment, budget.quadrature_texels, passes, config.seed)
        } else {
            by_quadrature(&cases[case], lights[light])
        }
    });
    // Under a sun that few samples ever see, a curve of convergence shows which of its points have seen it.
    let steady = |&case: &usize| references[case * lights.len() + ENVIRONMENT].v.iter().all(|v| *v < CONVERGENCE_V);
    let mut convergence_lights = vec![CONSTANT, AREA];
    if convergence_cases.iter().all(steady) {
        convergence_lights.push(ENVIRONMENT);
    }
    let convergence_cells = convergence_cells(&convergence_lights);
    let lit = |case: usize, light: usize| Lit {
        light: lights[light],
        index: light as u64,
        reference: &references[case * lights.len() + light],
    };

    let rows = progress.map(&row_cells, |&((case, light), (sampler, sequence))| {
        cells::row(config, &cases[case], sampler, sequence, &lit(case, light))
    });
    let mis_rows = progress.map(&mis_cells, |&((case, light), technique)| {
        cells::mis_row(config, &cases[case], technique, &lit(case, light))
    });
    let convergence = progress.map(&convergence_cells, |&(((case, light), (sampler, sequence)), n)| {
        cells::convergence_point(config, &cases[case], sampler, sequence, &lit(case, light), n)
    });
    let beta_sweep = progress.map(&sweep_cells, |&(index, sampler)| {
        let (beta_r, case) = &sweep_cases[index];
        cells::sweep_row(config, case, sampler, *beta_r)
    });
    let reference_v = progress.map(&v_cells, |&(case, sampler)| {
        // The row of this case under constant light, independent numbers.
        let wanted = ((case, CONSTANT), (sampler, SequenceKind::Independent));
        let v = row_cells.iter().zip(&rows).find(|(cell, _)| **cell == wanted).map(|(_, row)| row.v);
        v.map(|v| cells::reference_v(config, &cases[case], sampler, v))
    });

    let mut result = EfficiencyResult {
        settings: EfficiencySettings {
            seed: config.seed,
            budget: config.budget,
            theta_o_deg: THETA_O_DEG,
            phi_o_deg: PHI_O_DEG,
            sun_deg: SUN_DEG,
            convergence_theta_o_deg: CONVERGENCE_THETA_O_DEG,
            lights: lights.iter().map(|light| light.name().to_owned()).collect(),
            costs: config.costs,
        },
        reference_v: reference_v.into_iter().flatten().collect(),
        rows,
        mis_rows,
        convergence,
        beta_sweep,
        check: Check::of(&[], 0),
    };
    result.check = check(&result);
    Ok(result)
}

/// Every pair of an `a` and a `b`, the latter running faster.
fn product<A: Copy, B: Copy>(a: &[A], b: &[B]) -> Vec<(A, B)> {
    a.iter().flat_map(|&x| b.iter().map(move |&y| (x, y))).collect()
}

/// Holds every z-score against the bound that all of them together pass with probability `1 - FALSE_ALARM`.
pub(super) fn check(result: &EfficiencyResult) -> Check {
    let of = |model: ModelKind, sampler: Sampler| format!("{} {}", model.name(), sampler.name());
    let rows = result.rows.iter().map(|r| {
        let place = format!("{} {}, {}", of(r.model, r.sampler), r.sequence.name(), r.light);
        (r.tested, r.z, format!("{place}, theta_o {}: mean", r.theta_o_deg))
    });
    let mis = result.mis_rows.iter().map(|r| {
        (r.tested, r.z, format!("{} {}, {}, theta_o {}: mean", r.model.name(), r.name, r.light, r.theta_o_deg))
    });
    let convergence = result.convergence.iter().map(|r| {
        let place = format!("{} {}, {}", of(r.model, r.sampler), r.sequence.name(), r.light);
        (r.tested, r.z, format!("{place}, means of {}: bias", r.n))
    });
    let (tested, left_out): (Vec<_>, Vec<_>) = rows.chain(mis).chain(convergence).partition(|(tested, ..)| *tested);
    let untested = left_out.len();
    let mut scores: Vec<(f64, String)> = tested.into_iter().map(|(_, z, what)| (z, what)).collect();
    for r in &result.beta_sweep {
        let place = format!("{}, beta_r {}, theta_o {}", of(r.model, r.sampler), r.beta_r_deg, r.theta_o_deg);
        scores.push((r.z_quadrature, format!("{place}: V against quadrature")));
        scores.push((r.z, format!("{place}: mean")));
    }
    for r in &result.reference_v {
        let place = format!("{}, constant, theta_o {}", of(r.model, r.sampler), r.theta_o_deg);
        scores.push((r.z_quadrature, format!("{place}: V against quadrature")));
        if let Some(z) = r.z_recorded {
            scores.push((z, format!("{place}: V against the recorded figure")));
        }
    }
    Check::of(&scores, untested)
}

impl Check {
    /// Holds scores, each with its place, against the bound that all of them together pass with probability `1 - FALSE_ALARM`.
    pub(crate) fn of(scores: &[(f64, String)], untested: usize) -> Self {
        let bound = z_bound(sidak(FALSE_ALARM, scores.len()));
        let size = |z: f64| if z.is_nan() { f64::INFINITY } else { z.abs() };
        Self {
            tests: scores.len(),
            untested,
            false_alarm: FALSE_ALARM,
            bound,
            largest_z: scores.iter().map(|(z, _)| size(*z)).fold(0.0, f64::max),
            failures: scores
                .iter()
                .filter(|(z, _)| size(*z) > bound)
                .map(|(z, what)| format!("{what}: {z:.2} standard errors off, allowed {bound:.2}"))
                .collect(),
        }
    }
}

/// The `|z|` of a two-sided p-value.
pub(crate) fn z_bound(p: f64) -> f64 {
    SQRT_2 * erfc_inv(p)
}
