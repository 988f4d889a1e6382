//! Accuracy of one lane and of eight lanes against the paper's formulas in double precision.

use crate::cases::{Case, Cases, Region, angles};
use core::array::from_fn;
use core::fmt::Write as _;
use glam::Vec3;
use hairis::simd::Level;
use hairis::{HairParams, Vec3x8};
use hairis_reference::{HairReference, Reference, Shape};
use hairis_variants::{AnyMaterial, AnyMaterial8, ModelId, Parameters as _};

const CASES: usize = 10_000;
const SEED: u64 = 0x0a17;
/// Largest relative error of the pdf that is promised.
const PDF: f64 = 1e-5;
/// Largest relative error of S with Gaussian bells.
const S_GAUSSIAN: f64 = 1e-4;
/// Largest relative error of S with Cauchy bells.
const S_CAUCHY: f64 = 1e-5;

/// Answer of a code path: S and pdf.
type Answer = ([f32; 3], f32);

#[test]
fn gaussian_is_within_its_bounds_of_the_oracle() {
    check(ModelId::Gaussian, Shape::Gaussian, S_GAUSSIAN);
}

#[test]
fn cauchy_is_within_its_bounds_of_the_oracle() {
    check(ModelId::Cauchy, Shape::Cauchy, S_CAUCHY);
}

fn check(model: ModelId, shape: Shape, s_bound: f64) {
    let mut source = Cases::new(SEED);
    let cases: Vec<Case> = (0..CASES).map(|i| source.case(i)).collect();
    let mut paths = vec![(
        "scalar".to_owned(),
        cases.iter().map(|case| scalar(model, case)).collect(),
    )];
    paths.extend(
        Level::available().map(|level| (format!("x8 {level}"), eight(model, level, &cases))),
    );
    let (mut report, mut failed) = (String::new(), false);
    for (path, answers) in &paths {
        failed |= compare(
            &mut report,
            &format!("{} {path}", model.name()),
            shape,
            s_bound,
            &cases,
            answers,
        );
    }
    println!("{report}");
    assert!(
        !failed,
        "relative errors against the oracle in double precision:\n{report}"
    );
}

fn scalar(model: ModelId, case: &Case) -> Answer {
    let eval = material(model, case).prepare(case.wo).eval_pdf(case.wi);
    (eval.value, eval.pdf)
}

/// Evaluates eight different materials, shading points and directions per call.
fn eight(model: ModelId, level: Level, cases: &[Case]) -> Vec<Answer> {
    let (groups, rest) = cases.as_chunks::<8>();
    assert!(rest.is_empty(), "a number of cases that eight divides");
    let group = |group: &[Case; 8]| {
        let materials: [AnyMaterial; 8] = from_fn(|i| material(model, &group[i]));
        let wo = Vec3x8::from(group.map(|case| case.wo));
        let bsdfs = AnyMaterial8::pack(materials.each_ref())
            .unwrap()
            .with_level(level)
            .prepare8(&wo);
        let evals = bsdfs
            .with_level(level)
            .eval_pdf8(&Vec3x8::from(group.map(|case| case.wi)));
        [0, 1, 2, 3, 4, 5, 6, 7].map(|lane| (evals.lane(lane).value, evals.lane(lane).pdf))
    };
    groups.iter().flat_map(group).collect()
}

fn material(model: ModelId, case: &Case) -> AnyMaterial {
    model.material(&params(case).values()).unwrap()
}

fn params(case: &Case) -> HairParams {
    HairParams::new(&case.desc).unwrap()
}

/// Reports the worst and the 99.9th percentile of each region; returns true if a bound is not kept.
fn compare(
    report: &mut String,
    name: &str,
    shape: Shape,
    s_bound: f64,
    cases: &[Case],
    answers: &[Answer],
) -> bool {
    let mut failed = false;
    let errors: Vec<[f64; 2]> = cases
        .iter()
        .zip(answers)
        .map(|(case, answer)| errors(shape, case, answer))
        .collect();
    for (quantity, (label, bound)) in [("pdf", PDF), ("S", s_bound)].into_iter().enumerate() {
        for region in Region::ALL {
            let of_region = |i: &usize| cases[*i].region == region;
            let mut at: Vec<usize> = (0..cases.len()).filter(of_region).collect();
            at.sort_by(|a, b| errors[*a][quantity].total_cmp(&errors[*b][quantity]));
            let worst = at[at.len() - 1];
            let (most, high) = (
                errors[worst][quantity],
                errors[at[at.len() * 999 / 1000]][quantity],
            );
            writeln!(
                report,
                "{name}: {label:3} {region:9?} worst {most:.2e}, 99.9% below {high:.2e}"
            )
            .unwrap();
            if most.is_nan() || most > bound {
                failed = true;
                writeln!(
                    report,
                    "  beyond {bound:e}: {:?} gave {:?}",
                    cases[worst], answers[worst]
                )
                .unwrap();
            }
        }
    }
    failed
}

/// Returns the relative errors of the pdf and of S, as the worst channel. If the oracle returns 0, only exactly 0 is no error.
///
/// A Gaussian bell below about 2^-115 is 0 by design, so 2^-114 of each lobe's peak is no error of S. Peaks reach 1e7 here, so that is
/// 1e-27 at most and most often 1e-34, where everyday values are 1.
fn errors(shape: Shape, case: &Case, (value, pdf): &Answer) -> [f64; 2] {
    let parameters = params(case).desc().map(f64::from);
    let double = |w: Vec3| w.as_dvec3().to_array();
    let oracle = HairReference::prepare(&parameters, shape, double(case.wo));
    let expected = oracle.eval(double(case.wi));
    let cos_theta_d = (0.5 * (angles(case.wo).0 - angles(case.wi).0)).cos();
    let bell = if shape == Shape::Gaussian {
        2.0_f64.powi(-114)
    } else {
        0.0
    };
    let channel = |c: usize| {
        let p = &parameters;
        let peaks = p.i_r[c] + p.i_tt[c] + p.i_trt[c] * (1.0 + p.i_g);
        relative(
            value[c],
            expected[c],
            bell * peaks / (cos_theta_d * cos_theta_d),
        )
    };
    [
        relative(*pdf, oracle.pdf(double(case.wi)), 0.0),
        channel(0).max(channel(1)).max(channel(2)),
    ]
}

/// Returns the part of an error beyond `allowed`, relative to the expected value.
fn relative(got: f32, expected: f64, allowed: f64) -> f64 {
    let error = (f64::from(got) - expected).abs() - allowed;
    if error <= 0.0 { 0.0 } else { error / expected }
}
