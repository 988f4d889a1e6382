//! Samplers against their own densities, and bounds of weights.

use glam::Vec3;
use hairis::HairParams;
use hairis_harness::sampler::*;
use hairis_harness::subject::ModelKind;
use hairis_instruments::sequence::Independent;
use wide::f32x8;

fn numbers(from: &mut Independent) -> [f32x8; 3] {
    core::array::from_fn(|_| f32x8::new(core::array::from_fn(|_| from.next_f32())))
}

#[test]
fn uniform_directions_are_unit_and_fill_the_sphere() {
    let mut from = Independent::new(1, 0);
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    for _ in 0..4_000 {
        let wi = uniform8(&numbers(&mut from));
        for lane in 0..8 {
            let wi = wi.lane(lane);
            assert!((wi.length() - 1.0).abs() < 1e-6, "{wi}");
            sum += wi / 32_000.0;
            squares += wi * wi / 32_000.0;
        }
    }
    // Standard errors of 0.0032 and 0.0017.
    assert!(sum.abs().max_element() < 0.015, "{sum}");
    assert!(
        (squares - Vec3::splat(1.0 / 3.0)).abs().max_element() < 0.008,
        "{squares}"
    );
}

#[test]
fn samples_agree_with_what_their_sampler_says_of_the_direction() {
    let params = HairParams::bright();
    let wo = Vec3::new(0.6, 0.64, 0.48);
    let mut from = Independent::new(1, 1);
    for model in ModelKind::ALL {
        for sampler in Sampler::ALL {
            let bsdf = Scatter::new(model, sampler, &params, wo);
            for _ in 0..200 {
                let sample = bsdf.sample8(&numbers(&mut from));
                let eval = bsdf.eval_pdf8(&sample.wi);
                for lane in 0..8 {
                    let at = |x: &f32x8| f64::from(x.as_array()[lane]);
                    if at(&sample.pdf) == 0.0 {
                        continue;
                    }
                    let wi = sample.wi.lane(lane);
                    let cos = f64::from(wi.y).hypot(f64::from(wi.z));
                    let place = format!("{model:?} {sampler:?} at {wi}");
                    assert!(
                        (at(&sample.pdf) / at(&eval.pdf) - 1.0).abs() < 1e-3,
                        "{place}: pdf"
                    );
                    for c in 0..3 {
                        let want = at(&eval.value[c]) * cos / at(&eval.pdf);
                        assert!(
                            (at(&sample.weight[c]) - want).abs() <= 1e-3 * want + 1e-20,
                            "{place}: weight"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn bounds_of_weights_are_held_and_nearly_reached() {
    let params = HairParams::bright();
    let mut from = Independent::new(1, 2);
    for theta_o in [0.0_f64, 0.8, 1.4] {
        let wo = hairis_instruments::direction::direction(theta_o.sin(), theta_o.cos(), 1.0);
        for model in ModelKind::ALL {
            for sampler in Sampler::ALL
                .into_iter()
                .filter(|sampler| *sampler != Sampler::Published)
            {
                let bound = weight_bound(model, sampler, &params, theta_o).expect("there is one");
                let bsdf = Scatter::new(model, sampler, &params, wo);
                let mut most = 0.0_f32;
                for _ in 0..20_000 {
                    let weight = bsdf.sample8(&numbers(&mut from)).weight;
                    most = (weight[0] + weight[1] + weight[2])
                        .to_array()
                        .into_iter()
                        .fold(most, f32::max);
                }
                let (most, near) = (
                    f64::from(most) / 3.0,
                    if sampler == Sampler::Uniform {
                        0.1
                    } else {
                        0.5
                    },
                );
                let place = format!("{model:?} {sampler:?} at {theta_o}");
                assert!(
                    most <= bound * (1.0 + 1e-5) && most > near * bound,
                    "{place}: {most} of {bound}"
                );
            }
        }
    }
}
