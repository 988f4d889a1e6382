//! Derivatives of the distance.

use basin::{CostFunction, Gradient};
use hairis_study::fit::Look;
use hairis_study::fit::objective::*;
use hairis_study::fit::points::Points;
use hairis_study::fit::variables::Variables;
use hairis_study::fit::{FitConfig, Norm};
use hairis_variants::ModelId;

#[test]
fn derivatives_are_differences_of_the_distance() {
    const STEP: f64 = 2e-3;
    let (_, from) = ModelId::Gaussian.presets().next().expect("a preset");
    let look = Look {
        model: ModelId::Gaussian,
        values: from,
    };
    let chiang = ModelId::Chiang.measured();
    for (to, start) in [
        (ModelId::Cauchy, ModelId::Cauchy.measured()),
        (ModelId::Chiang, chiang),
        (ModelId::Chiang, chiang.with("color", &[0.6, 0.4, 0.2])),
        (ModelId::Chiang, chiang.with("melanin", &[0.5, 0.2])),
        (ModelId::Chiang, chiang.with("melanin_amount", &[0.5, 0.4])),
    ] {
        for norm in [Norm::L1, Norm::L2, Norm::Blurred] {
            let config = FitConfig {
                norm,
                views: vec![-0.3, 0.6],
                weights: vec![1.0, 2.0],
                ..FitConfig::default()
            };
            let points = Points::new(&look, to, &config, 0).expect("legal values");
            let variables = Variables::new(&start, &[]);
            let x: Vec<f64> = variables.start().iter().map(|x| x + 0.05).collect();
            let x = variables.clamped(x);
            let problem = Distance::new(to, &points, &variables, norm);
            let (cost, slopes) = problem.cost_and_gradient(&x).expect("legal values");
            let same = problem.cost(&x).expect("legal values");
            assert!((cost - same).abs() < 1e-12, "{cost} {same}");
            let most = slopes
                .iter()
                .fold(0.0, |most: f64, slope| most.max(slope.abs()));
            for (place, slope) in slopes.iter().enumerate() {
                let [up, down] = [STEP, -STEP].map(|step| {
                    let mut x = x.clone();
                    x[place] += step;
                    problem.cost(&x).expect("legal values")
                });
                let want = (up - down) / (2.0 * STEP);
                let error = (slope - want).abs() / most;
                assert!(error < 5e-3, "{to:?} {norm:?} {place}: {slope} {want}");
            }
        }
    }
}
