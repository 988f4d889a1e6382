//! Tests that samples agree with value and density.

use super::Tested;
use super::handles::Material;
use super::support::{Draws, angles, direction, lanes_of};
use crate::comparison::{LargestError, relative};
use crate::size::cases;
use core::f64::consts::PI;
use hairis::simd::Level;

pub fn a_sample_agrees_with_eval_and_pdf(tested: &Tested) {
    let mut worst = LargestError::default();
    let mut draws = Draws(53);
    for (model, factor) in tested.forms() {
        for _ in 0..cases(10_000) {
            let params = draws.params(10.0);
            let d = params.desc();
            let width = [d.beta[0], d.beta[1], d.beta[2], d.gamma_tt, d.gamma_g]
                .into_iter()
                .fold(4.0, f32::min)
                * factor;
            // Effect of a rounded direction on a bell of that width.
            let scale = f64::from(width) / (f64::from(width) + 0.1);
            let wo = direction(draws.between(-1.5, 1.5), draws.between(-PI, PI));
            let bsdf = Material::new(model, &params).prepare(wo);
            for _ in 0..8 {
                let xi = draws.xi3();
                let wide = Level::available()
                    .map(|level| bsdf.with_level(level).sample8(&lanes_of(&[xi; 8])).lane(1));
                for s in wide.chain([bsdf.sample(xi)]).flatten() {
                    let [theta, phi] = angles(wo, s.wi);
                    if theta.cos() < 1e-2 || PI - phi < 1e-2 || (phi - 0.5 * PI).abs() < 1e-3 {
                        continue;
                    }
                    let e = bsdf.eval_pdf(s.wi);
                    worst.see(relative(s.pdf, f64::from(e.pdf), 0.0) * scale, || {
                        format!("{s:?} {e:?} wo {wo:?} {d:?}")
                    });
                    let by = f64::from(s.value[1]) * theta.cos() / f64::from(s.pdf);
                    let weight = relative(s.weight[1], by, 1e-20);
                    assert!(
                        weight < 1e-4,
                        "weight is not value cos / pdf, off by {weight}: {s:?}"
                    );
                }
            }
        }
    }
    worst.check(
        "sample against pdf, times width / (width + 0.1)",
        tested.rows.sample_eval,
    );
}
