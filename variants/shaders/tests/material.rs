//! Tests of the constants of materials in single precision, as generated source computes them, against those of the library.

use crate::support::{Case, Random, every_model};
use hairis::Hit;
use hairis::model::Single;
use hairis::simd::Vec3x;
use hairis_shaders::{Program, Target, numbers};
use hairis_variants::{Kind, Parameters, Registered, Values};

/// Draws parameters from their whole ranges, ends included.
fn legal<P: Parameters>(random: &mut Random) -> P {
    loop {
        let mut values: Values = P::default().values();
        for (place, field) in P::FIELDS.iter().enumerate() {
            if !values.has_at(place) {
                continue;
            }
            if let Kind::Word(words) = field.kind {
                let word = random.choose(words);
                values = values.with_word(field.name, word);
            } else if let Some([least, most]) = field.range() {
                let number = || match random.unit() {
                    x if x < 0.05 => least,
                    x if x < 0.1 => most,
                    _ if most == f32::MAX => random.range(-100.0, 100.0).exp2(),
                    _ if least > 0.0 => {
                        random.range(least.ln(), most.ln()).exp().clamp(least, most)
                    }
                    _ => random.range(least, most),
                };
                let numbers: Vec<f32> = core::iter::repeat_with(number)
                    .take(field.kind.width())
                    .collect();
                values = values.with(field.name, &numbers);
            }
        }
        if let Ok(params) = P::from_values(&values) {
            return params;
        }
    }
}

/// Returns the distance of two numbers of a field in units in the last place of the second. Sines, cosines and probabilities count in
/// units in the last place of 1, because no result depends on more.
fn units(field: &str, got: f32, expected: f32) -> f64 {
    let is_share = [
        "sin_shift",
        "cos_shift",
        "selection",
        "bounds",
        "intensity",
        "importance",
    ]
    .iter()
    .any(|name| field.contains(name));
    let size = if is_share { 1.0 } else { expected.abs() };
    let ulp = f64::from(size.max(f32::MIN_POSITIVE)) * f64::from(f32::EPSILON);
    if got == expected {
        0.0
    } else {
        (f64::from(got) - f64::from(expected)).abs() / ulp
    }
}

/// Returns the largest distance of each field over materials, in units in the last place.
fn distances<M: Registered>(draw: impl Fn(&mut Random) -> M::Params) -> Vec<(String, f64)> {
    let program = Program::of::<M>(Target::Exact);
    let places: Vec<String> = program.material().places().collect();
    let mut worst = vec![0.0_f64; places.len()];
    let mut random = Random(60);
    for _ in 0..10_000 {
        let params = draw(&mut random);
        let single = numbers(&M::constants::<Single<f32>>(&params.values()));
        let double = numbers(&M::MODEL.material(&params));
        for (place, (got, expected)) in single.into_iter().zip(double).enumerate() {
            let distance = units(&places[place], got, expected);
            assert!(
                !distance.is_nan(),
                "{} of {params:?}: {got}, {expected}",
                places[place]
            );
            worst[place] = worst[place].max(distance);
        }
    }
    places.into_iter().zip(worst).collect()
}

/// Least number whose relative error counts.
const LEAST: f64 = 1e-8;

/// Returns the relative errors of values and densities above [`LEAST`] that the constants' distance causes: median, 99.9% and largest. The
/// fourth number is the logarithm of the largest number over [`LEAST`].
fn effect<M: Registered>() -> [f64; 4] {
    let mut errors = Vec::new();
    let mut brightest = LEAST;
    for case in Case::<M>::smooth(20_000, 61) {
        let [wo, wi] = [case.wo, case.wi].map(|[x, y, z]| Vec3x::new(x, y, z));
        let at = |material: &M::Material<f32>| {
            let prepared = M::prepare::<f32, f32>(material, Hit::new(wo, case.h));
            let eval = M::eval::<f32, f32>(&prepared, wi);
            [eval.value[0], eval.value[1], eval.value[2], eval.pdf].map(f64::from)
        };
        let pairs = at(&M::constants::<Single<f32>>(&case.values))
            .into_iter()
            .zip(at(&case.material));
        for (got, exact) in pairs.filter(|(_, exact)| *exact > LEAST) {
            errors.push((got / exact - 1.0).abs());
            brightest = brightest.max(exact);
        }
    }
    errors.sort_by(f64::total_cmp);
    let at = |less: usize| errors[errors.len() - 1 - less];
    let range = (brightest / LEAST).ln();
    [at(errors.len() / 2), at(errors.len() / 1000), at(0), range]
}

/// Largest distance of a constant in units in the last place, in everyday and in any legal materials.
const MOST: f64 = 8.0;

fn check_closeness<M: Registered>() {
    let name = format!("{} {:?}", M::NAME, M::CHOICE);
    let [everyday, legal] = [
        distances::<M>(|random| random.material()),
        distances::<M>(legal),
    ];
    // Constants of a model that has more are tested on the model alone.
    let own = |((place, _), _): &((String, f64), (String, f64))| !place.starts_with("fiber");
    for ((place, everyday), (_, legal)) in everyday.into_iter().zip(legal).filter(own) {
        if everyday > 0.0 || legal > 0.0 {
            println!("{name} {place}: {everyday:.1}, {legal:.1}");
        }
        assert!(
            everyday <= MOST && legal <= MOST,
            "{name} {place}: {everyday}, {legal}"
        );
    }
    let effect = effect::<M>();
    println!("{name}: value and density {effect:?}");
    // Variances of the lobes are among the constants of both fibres with absorption: what they are off by is multiplied by the exponent, which is at most the
    // logarithm of the largest number over the least.
    let most = if matches!(
        M::NAME,
        "chiang" | "chiang-diffuse" | "chiang-scattering" | "d-eon"
    ) {
        MOST * f64::from(f32::EPSILON) * effect[3]
    } else {
        1e-6
    };
    assert!(effect[2] < most, "{name}: {effect:?}");
}

#[test]
fn single_precision_has_the_constants_of_the_library() {
    every_model!(check_closeness);
}
