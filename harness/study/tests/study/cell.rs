//! Figures of a cell against quadrature.

use hairis_harness::efficiency::{Case, SAMPLERS, by_quadrature, perfect_v, ray_v};
use hairis_harness::lights::Lights;
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_harness::variance::POOL_SIZES;
use hairis_harness::variance::{Measured, SOURCE, SampleBudget};
use hairis_instruments::light::{Constant, Sky};
use hairis_instruments::stats::Estimate;
use hairis_study::study::Grid;
use hairis_study::study::cell::*;
use hairis_study::study::grid::Cell;

const BUDGET: SampleBudget = SampleBudget {
    samples: 1 << 16,
    light_samples: 1 << 13,
    pools: 0,
};

fn cell_of(beta_r_deg: f32, theta_o_deg: f32) -> Cell {
    let is = |cell: &Cell| cell.beta_r_deg == beta_r_deg && cell.theta_o_deg == theta_o_deg;
    (0..Grid::QUICK.len())
        .map(|i| Grid::QUICK.cell(i))
        .find(is)
        .expect("in the grid")
}

#[test]
fn figures_agree_with_quadrature() {
    let lights = [Lights::default().all(), vec![&Constant]].concat();
    // Narrow hair that rarely hits the sun; the default; wide hair at grazing incidence.
    for (beta_r, theta_o) in [(2.5, 0.0), (7.5, 45.0), (20.0, 85.0)] {
        let cell = cell_of(beta_r, theta_o);
        let params = cell.params().expect("accepted");
        let found = measure(1, BUDGET, &lights, &cell, &Sampler::ALL).expect("accepted");
        let samplers = Sampler::ALL.len();
        for (m, model) in ModelKind::ALL.into_iter().enumerate() {
            let case = Case::new(model, &params, f64::from(theta_o));
            for (l, light) in lights.iter().take(4).enumerate() {
                let want = by_quadrature(&case, *light);
                for (sampler, v) in SAMPLERS.into_iter().zip(want.v) {
                    let found = &found[(m * samplers + sampler as usize) * 5 + l];
                    let place = format!(
                        "{beta_r} {theta_o} {model:?} {} {sampler:?}: {found:?}",
                        light.name()
                    );
                    let mean = found.figures.mean.z_score(want.value);
                    assert!(
                        mean.abs() < 5.0,
                        "{place}: mean {} is {mean} errors off",
                        want.value
                    );
                    let z = found.figures.v.z_score(v);
                    assert!(z.abs() < 5.0, "{place}: V {v} is {z} errors off");
                    let error = found.figures.v.standard_error;
                    assert!(error < 0.05 * v, "{place}: an error of {error}");
                }
                let found = &found[(ModelKind::ALL.len() * samplers + m) * 5 + l];
                let v = perfect_v(&case, *light);
                let place = format!(
                    "{beta_r} {theta_o} {model:?} {} perfect: {found:?}",
                    light.name()
                );
                let Estimate {
                    value,
                    standard_error,
                } = found.figures.v;
                if l == 0 {
                    assert!(
                        v.abs() < 1e-6 && value.abs() < 1e-12 && standard_error < 1e-9,
                        "{place}: V {v}"
                    );
                    continue;
                }
                let [mean, z] = [
                    found.figures.mean.z_score(want.value),
                    found.figures.v.z_score(v),
                ];
                assert!(
                    mean.abs() < 5.0,
                    "{place}: mean {} is {mean} errors off",
                    want.value
                );
                assert!(z.abs() < 5.0, "{place}: V {v} is {z} errors off");
                assert!(
                    standard_error < 0.05 * v,
                    "{place}: an error of {standard_error}"
                );
            }
        }
    }
}

#[test]
fn rays_agree_with_quadrature() {
    let lights = [Lights::default().all(), vec![&Constant]].concat();
    let budget = SampleBudget {
        pools: 1024,
        ..BUDGET
    };
    for (beta_r, theta_o) in [(7.5, 45.0), (20.0, 85.0)] {
        let cell = cell_of(beta_r, theta_o);
        let params = cell.params().expect("accepted");
        let found = measure(1, budget, &lights, &cell, &SAMPLERS).expect("accepted");
        for (m, model) in ModelKind::ALL.into_iter().enumerate() {
            let case = Case::new(model, &params, f64::from(theta_o));
            for (s, sampler) in SAMPLERS.into_iter().enumerate() {
                for (l, light) in lights.iter().take(4).enumerate() {
                    let found = &found[(m * SAMPLERS.len() + s) * 5 + l];
                    let [mis, pool] = ray_v(&case, *light, sampler);
                    let place = format!(
                        "{beta_r} {theta_o} {model:?} {} {sampler:?}: {found:?}",
                        light.name()
                    );
                    let bias = found
                        .bias
                        .unwrap_or_else(|| panic!("{place}: no test of the mean"));
                    assert!(bias.abs() < 5.0, "{place}: the mean is {bias} errors off");
                    let sizes = POOL_SIZES.map(|count| pool / f64::from(count));
                    for (v, want) in found
                        .rays
                        .expect("measured")
                        .into_iter()
                        .zip([mis, sizes[0], sizes[1]])
                    {
                        let z = v.z_score(want);
                        assert!(z.abs() < 5.0, "{place}: V {want} is {z} errors off");
                        assert!(
                            v.standard_error < 0.1 * want,
                            "{place}: an error of {}",
                            v.standard_error
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn figures_depend_on_the_seed_and_the_cell_alone() {
    let sky = Sky::default().environment();
    let lights = Lights::from(&sky).all();
    let budget = SampleBudget {
        samples: 256,
        light_samples: 64,
        pools: 4,
    };
    let of =
        |seed, cell: &Cell| measure(seed, budget, &lights, cell, &Sampler::ALL).expect("accepted");
    let cell = cell_of(7.5, 45.0);
    let found = of(1, &cell);
    let drawn = 2 * Sampler::ALL.len() * 5;
    assert_eq!(found.len(), drawn + 2 * 5);
    assert_eq!(
        found,
        of(1, &Cell { index: 7, ..cell }),
        "where the cell stands"
    );
    assert_ne!(found, of(2, &cell), "another seed");
    let alone = measure(1, budget, &lights, &cell, &[Sampler::Published]).expect("accepted");
    let among = |of: &Measured| found[..drawn].contains(of);
    assert!(alone.iter().all(among), "a sampler alone and among others");
    assert_eq!(
        alone.len(),
        10,
        "perfect sampling has nothing to be estimated from"
    );
    let source = measure(1, budget, &lights, &cell, &[SOURCE]).expect("accepted");
    assert_eq!(source[10..], found[drawn..], "its source alone");
}
