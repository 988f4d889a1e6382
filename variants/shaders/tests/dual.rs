//! Tests of the program of dual scattering, whose materials are averages.

use crate::c::compiled;
use crate::support::Random;
use glam::Vec3;
use hairis::dual_scattering::{Crossed, DualScattering};
use hairis::{Gaussian, HairParams, Matched, Material};
use hairis_conformance::{cases, is_full};
use hairis_shaders::{
    Function, Language, Program, Rounding, Target, driver, numbers, print, spirv,
};

/// Arguments of a function, and what one lane returns for them.
type Case = (Vec<f32>, Vec<f32>);

fn crossed(crossed: &Crossed) -> Vec<f32> {
    let Crossed {
        direct,
        scattered,
        shift,
        variance,
    } = crossed;
    [&[*direct][..], scattered, shift, variance].concat()
}

fn random(dual: &DualScattering<f32>, name: &str, random: &mut Random) -> Case {
    let material = numbers(dual);
    let mut direction = || {
        let theta = random.range(-1.57, 1.57);
        let phi = random.range(-3.0, 3.0);
        Vec3::new(
            theta.sin(),
            theta.cos() * phi.cos(),
            theta.cos() * phi.sin(),
        )
    };
    let (wo, wi) = (direction(), direction());
    let (theta, count) = (random.range(-1.5, 1.5), random.range(0.0, 9.0));
    let fibre = dual.averages(theta);
    let strands = Crossed::strands(&fibre, count);
    let rest = match name {
        "strands" => return ([material, vec![theta, count]].concat(), crossed(&strands)),
        "depth" => {
            let expected = crossed(&Crossed::depth(&fibre, count));
            return ([material, vec![theta, count]].concat(), expected);
        }
        _ => [wo.to_array(), wi.to_array(), [0.3, 0.2, 0.1]].concat(),
    };
    let gain = [random.range(0.0, 1.2), 1.0];
    let expected = dual.shade(wo.into(), wi.into(), [0.3, 0.2, 0.1], &strands, gain);
    (
        [material, rest, crossed(&strands), gain.to_vec()].concat(),
        expected.to_vec(),
    )
}

fn every_case(function: &Function) -> Vec<Case> {
    let hair = [HairParams::blond(), HairParams::black()];
    let duals =
        hair.map(|hair| DualScattering::new(&Material::new(&Matched::new(Gaussian), &hair)));
    let mut numbers = Random(63);
    (0..cases(512))
        .map(|k| random(&duals[k % 2], function.name(), &mut numbers))
        .collect()
}

#[test]
fn dual_scattering_has_the_bits_of_one_lane_as_a_graph_and_in_c() {
    let program = Program::dual_scattering(Target::Exact);
    let binary = compiled(&program);
    for function in program.functions() {
        let cases = every_case(function);
        let expected: Vec<f32> = cases
            .iter()
            .flat_map(|(_, expected)| expected.clone())
            .collect();
        let graph: Vec<f32> = cases
            .iter()
            .flat_map(|(inputs, _)| function.run(inputs, Rounding::Once))
            .collect();
        let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(
            expected.iter().any(|x| *x > 0.0),
            "{}: not all black",
            function.name()
        );
        assert_eq!(bits(&graph), bits(&expected), "{}", function.name());
        if let Some((_dir, binary)) = &binary {
            let inputs: Vec<f32> = cases
                .iter()
                .flat_map(|(inputs, _)| inputs.clone())
                .collect();
            let printed = crate::c::run(binary, function.name(), &inputs);
            assert_eq!(bits(&printed), bits(&expected), "{} in C", function.name());
        }
    }
}

#[test]
fn naga_accepts_dual_scattering() {
    let all = [Target::Gpu, Target::Exact, Target::GpuNative];
    for target in all.into_iter().take(if is_full() { 3 } else { 1 }) {
        let program = Program::dual_scattering(target);
        let source = print(&program, Language::Wgsl) + &driver(&program, Language::Wgsl);
        if let Err(error) = spirv::translate(&source) {
            panic!("{target:?}: {error}");
        }
    }
}
