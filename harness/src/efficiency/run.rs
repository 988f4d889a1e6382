//! Run of all the tables, cell by cell.

use super::case::Case;
use super::cells::{self, Place};
use super::reference::{by_quadrature, of_environment};
use super::result::{Check, EfficiencyResult, EfficiencySettings, Technique};
use super::{
    BETA_R_DEG, CONVERGENCE_THETA_O_DEG, EfficiencyConfig, FALSE_ALARM, ModelKind, PHI_O_DEG,
    Reference, SAMPLERS, THETA_O_DEG, with_beta,
};
use crate::lights::SUN_DEG;
use crate::sampler::Sampler;
use core::f64::consts::SQRT_2;
use hairis::{HairParams, ParamError};
use hairis_instruments::light::{Constant, Rectangle, Sun};
use hairis_instruments::progress::Progress;
use hairis_instruments::sequence::SequenceKind;
use hairis_instruments::stats::{Estimate, sidak};
use statrs::function::erf::erfc_inv;

/// Largest V of an environment for which convergence is shown.
const CONVERGENCE_V: f64 = 100.0;

/// Computes every table. Workers call `progress` with the number of cells done and of all cells.
///
/// # Errors
/// Returns an error if the parameters of the sweep are rejected, which does not happen if those of the run are valid.
pub fn run(
    config: &EfficiencyConfig<'_>,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<EfficiencyResult, ParamError> {
    let lights = config.lights.all();
    let poses = product(&ModelKind::ALL, &THETA_O_DEG);
    let of_hair = |params: &HairParams| -> Vec<Case> {
        poses
            .iter()
            .map(|&(model, theta_o)| Case::new(model, params, theta_o))
            .collect()
    };
    let cases = of_hair(&config.params);
    let mut sweep = Vec::new();
    for beta_r in BETA_R_DEG {
        sweep.extend(
            of_hair(&with_beta(&config.params, beta_r)?)
                .into_iter()
                .map(|case| (beta_r, case)),
        );
    }

    let lit_cases = product(
        &cases.iter().collect::<Vec<_>>(),
        &(0..lights.len()).collect::<Vec<_>>(),
    );
    let estimators = product(&SAMPLERS, &SequenceKind::ALL);
    let techniques: Vec<Technique> = Technique::all().collect();
    let sweep_cells = product(&sweep.iter().collect::<Vec<_>>(), &SAMPLERS);
    let sizes: Vec<usize> = (2..24)
        .map(|k| 1_usize << k)
        .take_while(|n| *n <= config.budget.convergence_n)
        .collect();
    let total = lit_cases.len() * (1 + estimators.len())
        + cases.len() * (3 * techniques.len() + SAMPLERS.len())
        + ModelKind::ALL.len() * 3 * estimators.len() * sizes.len()
        + sweep_cells.len();
    let progress = Progress::new(total, progress);

    let budget = &config.budget;
    let references: Vec<Reference> = progress.map(&lit_cases, |&(case, light)| {
        let light = lights[light];
        match config.lights.as_environment(light) {
            Some(map) => of_environment(
                case,
                map,
                budget.quadrature_texels,
                budget.reference_passes,
                config.seed,
            ),
            None => by_quadrature(case, light),
        }
    });
    let place = |(&(case, index), reference)| Place {
        config,
        case,
        light: lights[index],
        index,
        reference,
    };
    let places: Vec<Place<'_>> = lit_cases.iter().zip(&references).map(place).collect();
    let is_environment = |place: &Place<'_>| config.lights.as_environment(place.light).is_some();
    let under = |shown: &[&str]| -> Vec<Place<'_>> {
        places
            .iter()
            .filter(|place| shown.contains(&place.light.name()) || is_environment(place))
            .copied()
            .collect()
    };
    let mut converging = under(&[Constant::NAME, Rectangle::NAME]);
    converging.retain(|place| place.case.theta_o_deg == CONVERGENCE_THETA_O_DEG);
    // Under a sun that few samples hit, a curve of convergence would only show which of its points have hit it.
    let is_steady = |place: &Place<'_>| place.reference.v.iter().all(|v| *v < CONVERGENCE_V);
    if !converging
        .iter()
        .filter(|place| is_environment(place))
        .all(is_steady)
    {
        converging.retain(|place| !is_environment(place));
    }

    let row_cells = product(&places, &estimators);
    let rows = progress.map(&row_cells, |&(place, (sampler, sequence))| {
        place.row(sampler, sequence)
    });
    let mis_rows = progress.map(
        &product(&under(&[Sun::NAME, Rectangle::NAME]), &techniques),
        |&(place, technique)| place.mis_row(technique),
    );
    let convergence = progress.map(
        &product(&product(&converging, &estimators), &sizes),
        |&((place, estimator), n)| place.convergence_point(estimator.0, estimator.1, n),
    );
    let beta_sweep = progress.map(&sweep_cells, |&((beta_r, case), sampler)| {
        cells::sweep_row(config, case, sampler, *beta_r)
    });
    let constant = row_cells
        .iter()
        .zip(&rows)
        .filter(|((place, (_, sequence)), _)| {
            (place.light.name(), *sequence) == (Constant::NAME, SequenceKind::Independent)
        });
    let measured: Vec<(&Case, Sampler, Estimate)> = constant
        .map(|((place, _), row)| (place.case, row.sampler, row.v))
        .collect();
    let reference_v = progress.map(&measured, |&(case, sampler, v)| {
        cells::reference_v(config, case, sampler, v)
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
        reference_v,
        rows,
        mis_rows,
        convergence,
        beta_sweep,
        check: Check::of(&[], 0),
    };
    result.check = check(&result);
    Ok(result)
}

/// Returns every pair of an `a` and a `b`, the latter running faster.
fn product<A: Copy, B: Copy>(a: &[A], b: &[B]) -> Vec<(A, B)> {
    let mut pairs = Vec::with_capacity(a.len() * b.len());
    a.iter()
        .for_each(|&x| pairs.extend(b.iter().map(|&y| (x, y))));
    pairs
}

/// Checks every z-score against the bound that all of them together keep with probability `1 - FALSE_ALARM`.
#[must_use]
pub fn check(result: &EfficiencyResult) -> Check {
    let name = |model: ModelKind, sampler: Sampler| format!("{} {}", model.name(), sampler.name());
    let (mut scores, mut untested) = (Vec::new(), 0);
    let mut test = |tested: bool, z: f64, what: String| {
        if tested {
            scores.push((z, what));
        } else {
            untested += 1;
        }
    };
    for r in &result.rows {
        let place = format!(
            "{} {}, {}",
            name(r.model, r.sampler),
            r.sequence.name(),
            r.light
        );
        test(
            r.tested,
            r.z,
            format!("{place}, theta_o {}: mean", r.theta_o_deg),
        );
    }
    for r in &result.mis_rows {
        let place = format!("{} {}, {}", r.model.name(), r.name, r.light);
        test(
            r.tested,
            r.z,
            format!("{place}, theta_o {}: mean", r.theta_o_deg),
        );
    }
    for r in &result.convergence {
        let place = format!(
            "{} {}, {}",
            name(r.model, r.sampler),
            r.sequence.name(),
            r.light
        );
        test(r.tested, r.z, format!("{place}, means of {}: bias", r.n));
    }
    for r in &result.beta_sweep {
        let place = format!(
            "{}, beta_r {}, theta_o {}",
            name(r.model, r.sampler),
            r.beta_r_deg,
            r.theta_o_deg
        );
        test(
            true,
            r.z_quadrature,
            format!("{place}: V against quadrature"),
        );
        test(true, r.z, format!("{place}: mean"));
    }
    for r in &result.reference_v {
        let place = format!(
            "{}, constant, theta_o {}",
            name(r.model, r.sampler),
            r.theta_o_deg
        );
        test(
            true,
            r.z_quadrature,
            format!("{place}: V against quadrature"),
        );
        if let Some(z) = r.z_recorded {
            test(true, z, format!("{place}: V against the recorded figure"));
        }
    }
    Check::of(&scores, untested)
}

impl Check {
    /// Checks scores, each with its place, against the bound that all of them together keep with probability `1 - FALSE_ALARM`.
    pub fn of(scores: &[(f64, String)], untested: usize) -> Self {
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

/// Returns the `|z|` of a two-sided p-value.
#[must_use]
pub fn z_bound(p: f64) -> f64 {
    SQRT_2 * erfc_inv(p)
}
