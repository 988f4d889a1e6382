//! Tests that samples agree with value and density.

use super::Tested;
use super::handles::Material;
use super::support::{Draws, angles, direction, double, lanes_of, oracle};
use crate::comparison::{LargestError, over, relative};
use crate::size::cases;
use core::f64::consts::PI;
use hairis::simd::Level;

pub fn a_sample_agrees_with_eval_and_pdf(tested: &Tested) {
    let mut worst = LargestError::default();
    let mut draws = Draws(53);
    for (model, factor) in tested.forms() {
        for _ in 0..cases(10_000) {
            let params = draws.params(10.0);
            let wo = direction(draws.between(-1.5, 1.5), draws.between(-PI, PI));
            let bsdf = Material::new(model, &params).prepare(wo);
            let reference = oracle(&tested.formulas, &params, factor, wo);
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
                    // Without a bound a lobe is too faint to be sampled as it should.
                    if let Some((_, allowed)) = reference.error_bound(double(s.wi)) {
                        let error = over(s.pdf, f64::from(e.pdf), allowed, tested.pdf_floor);
                        worst.see(error, || format!("{s:?} {e:?} wo {wo:?} {params:?}"));
                    }
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
    // Either of the two densities may be off by the bound.
    worst.check("sample against pdf, over its bound", 2.0);
}
