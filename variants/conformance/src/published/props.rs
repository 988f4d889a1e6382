//! Properties of every input: totality over all bit patterns, reciprocity, and samples that agree with eval and pdf.

use super::Tested;
use super::handles::{Bsdf8, Material};
use super::support::{Draws, direction, lanes_of, materials, packet};
use super::support::{Kind, angles};
use crate::comparison::{LargestError, relative};
use crate::strategies::{config, finite, hair, vectors};
use core::f64::consts::PI;
use glam::Vec3;
use hairis::simd::{Level, f32x8};
use hairis::{HairParams, Lobe};
use proptest::array::uniform3;
use proptest::prelude::*;

/// Cases of each property of random inputs.
const CASES: u32 = 20_000;

/// Every number of a packet of eight, for `wi` and `xi` in every lane.
fn numbers(bsdf: &Bsdf8, level: Level, wi: Vec3, xi: [f32; 3]) -> (Vec<f32>, Vec<f32>) {
    let first = |x: &f32x8| x.as_array()[0];
    let e = bsdf.with_level(level).eval_pdf8(&packet(&[wi]));
    let s = bsdf.with_level(level).sample8(&lanes_of(&[xi; 8]));
    let mut positive: Vec<f32> = e
        .value
        .iter()
        .chain([&e.pdf, &s.pdf])
        .chain(&s.value)
        .chain(&s.weight)
        .map(first)
        .collect();
    for lobe in bsdf.lobes8(&packet(&[wi])).0 {
        positive.extend([first(&lobe.value), first(&lobe.pdf)]);
        positive.extend(lobe.color.iter().map(first));
    }
    (
        positive,
        [s.wi.x, s.wi.y, s.wi.z, s.slot].iter().map(first).collect(),
    )
}

/// Every number of one lane.
fn scalar_numbers(
    material: &Material<'_>,
    wo: Vec3,
    wi: Vec3,
    xi: [f32; 3],
) -> (Vec<f32>, Vec<f32>) {
    let bsdf = material.prepare(wo);
    let e = bsdf.eval_pdf(wi);
    let mut positive = [&e.value[..], &[e.pdf, bsdf.pdf(wi)], &bsdf.eval(wi)].concat();
    for lobe in bsdf.lobes(wi).0 {
        positive.extend([lobe.value, lobe.pdf]);
    }
    positive.extend(bsdf.albedo().0.as_flattened());
    let mut any = vec![];
    if let Some(s) = bsdf.sample(xi) {
        positive.extend(s.value.iter().chain(&s.weight).chain([&s.pdf]));
        any.extend(s.wi.to_array());
    }
    (positive, any)
}

pub fn finite_inputs_give_finite_outputs(tested: &Tested) {
    // Uniform numbers are in [0, 1); all else is as wild as floats are.
    let xi = uniform3(finite().prop_map(|x| x.abs().fract()));
    let input = (hair(), vectors(), vectors(), xi);
    proptest!(config(file!(), CASES), |((hair, wo, wi, xi) in input)| {
        let material = Material::new(tested.model(), &hair.params);
        let mut all = vec![scalar_numbers(&material, wo, wi, xi)];
        for level in Level::available() {
            let bsdf = Material::prepare_packed([&material; 8], level, &packet(&[wo]));
            all.push(numbers(&bsdf, level, wi, xi));
        }
        for (positive, any) in all {
            prop_assert!(positive.iter().all(|x| x.is_finite() && *x >= 0.0), "{positive:?}");
            prop_assert!(any.iter().all(|x| x.is_finite()), "{any:?}");
        }
    });
}

pub fn nothing_panics_on_nan_and_infinity(tested: &Tested) {
    let anything = prop_oneof![1 => finite(), 1 => proptest::num::f32::ANY];
    let input = (hair(), [(); 3].map(|()| uniform3(anything.clone())));
    proptest!(config(file!(), CASES), |((hair, [wo, wi, xi]) in input)| {
        let [wo, wi] = [wo, wi].map(Vec3::from_array);
        let material = Material::new(tested.model(), &hair.params);
        let (positive, _) = scalar_numbers(&material, Vec3::Y, wi, [0.5; 3]);
        prop_assert!(positive.iter().all(|x| *x >= 0.0), "{positive:?}");
        let _ = scalar_numbers(&material, wo, wi, xi);
        for level in Level::available() {
            let bsdf = Material::prepare_packed([&material; 8], level, &packet(&[wo]));
            let _ = numbers(&bsdf, level, wi, xi);
        }
    });
}

pub fn a_sample_agrees_with_eval_and_pdf(tested: &Tested) {
    let mut worst = LargestError::default();
    let mut draws = Draws(53);
    for (model, factor) in tested.forms() {
        for _ in 0..10_000 {
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

pub fn eval_is_reciprocal(tested: &Tested) {
    let mut worst = LargestError::default();
    let mut draws = Draws(51);
    for (model, _) in tested.forms() {
        for params in materials(Kind::Wide)
            .into_iter()
            .chain(materials(Kind::Grid).into_iter().step_by(17))
        {
            let material = Material::new(model, &params);
            for _ in 0..2000 {
                let mut any = || {
                    direction(
                        draws.sign() * draws.between(0.0, 1.5),
                        draws.between(-PI, PI),
                    )
                };
                let (a, b) = (any(), any());
                if PI - angles(a, b)[1] < 1e-3 {
                    continue;
                }
                let (there, back) = (material.prepare(a).eval(b), material.prepare(b).eval(a));
                for c in 0..3 {
                    worst.see(relative(there[c], f64::from(back[c]), 1e-12), || {
                        format!("{a:?} {b:?} {params:?}")
                    });
                }
            }
        }
    }
    worst.check("reciprocity", tested.rows.reciprocity);
}

pub fn every_lobe_has_a_density_of_its_own(tested: &Tested) {
    // The sum over lobes of probability times pdf is what `sample` draws from: none may go below 0 or be missing.
    let model = tested.model();
    let bsdf = Material::new(model, &HairParams::bright()).prepare(Vec3::new(0.6, 0.8, 0.0));
    let mut draws = Draws(52);
    let mut seen = [0; 4];
    for _ in 0..10_000 {
        if let Some(s) = bsdf.sample(draws.xi3()) {
            seen[s.lobe.index()] += 1;
            assert!(
                bsdf.lobes(s.wi)[s.lobe].pdf > 0.0,
                "{s:?} has no density from its own lobe"
            );
        }
    }
    assert!(
        Lobe::ALL.into_iter().all(|lobe| seen[lobe.index()] > 50),
        "lobes seen: {seen:?}"
    );
}
