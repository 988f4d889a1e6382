//! Tests of each operation alone, in every language that runs here, which find a fault in a printer's table.

use crate::c::{compiled, compiled_metal, run};
use crate::cuda;
use crate::languages::{compile_glsl, compile_hlsl, write_words};
use crate::slang;
use crate::support::{Random, differing, same};
use crate::vulkan::{Driver, Host};
use hairis::simd::trace::Op;
use hairis_shaders::{Kind, Language, Program, Rounding, Target, every_operation, print, spirv};

/// Returns operands of every kind. Denormals are left out, because targets may flush them. Halves are left out, because WGSL rounds them
/// the other way in sums with 2^23 and an odd number.
pub(crate) fn operands() -> Vec<f32> {
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.25,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        0.75,
        114.25,
    ];
    let mut all = Vec::new();
    for a in special {
        for b in special {
            all.extend([a, b, special[all.len() / 3 % special.len()]]);
        }
    }
    let mut random = Random(50);
    while all.len() < 3 * 1024 {
        all.push((random.unit() - 0.5) * random.range(-20.0, 20.0).exp2());
    }
    all.truncate(3 * 1024);
    all
}

/// Returns the results of the graph, one entry per triple of operands.
pub(crate) fn expected(program: &Program, rounding: Rounding) -> Vec<Vec<f32>> {
    let function = &program.functions()[0];
    let all = operands();
    let (triples, _) = all.as_chunks::<3>();
    triples
        .iter()
        .map(|triple| function.run(triple, rounding))
        .collect()
}

pub(crate) fn check(program: &Program, got: &[f32], expected: &[Vec<f32>], language: &str) {
    let function = &program.functions()[0];
    if differing(function, got, expected) == 0 {
        return;
    }
    let mut wrong = String::new();
    for (at, place) in function.results().iter().enumerate() {
        let pairs = got.chunks(function.results().len()).zip(expected);
        let pairs = pairs.map(|(got, expected)| (got[at], expected[at]));
        let mut differ = pairs
            .enumerate()
            .filter(|(_, (got, expected))| !same(*got, *expected));
        if let Some((case, (got, expected))) = differ.next() {
            let (kind, triple) = (
                function.graph().node(*place).kind,
                &operands()[3 * case..][..3],
            );
            let others = differ.count();
            wrong +=
                &format!("{kind:?} of {triple:?}: {got}, not {expected}, and {others} others\n");
        }
    }
    panic!("{language}:\n{wrong}");
}

#[test]
fn every_operation_is_right_in_c() {
    for (target, rounding) in [
        (Target::Exact, Rounding::Once),
        (Target::Fused, Rounding::Once),
    ] {
        let program = every_operation(target);
        if let Some((_dir, binary)) = compiled(&program) {
            let got = run(&binary, "operations", &operands());
            check(&program, &got, &expected(&program, rounding), "C");
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn every_operation_is_right_in_cuda() {
    if !cuda::has_gpu() {
        return;
    }
    for target in [Target::Exact, Target::Fused] {
        let program = every_operation(target);
        let (_dir, binary) = cuda::compiled(&program, cuda::APART);
        let got = run(&binary, "operations", &operands());
        check(&program, &got, &expected(&program, Rounding::Once), "CUDA");
    }
}

/// No compiler of Metal runs here, so its operations are written in C++.
#[test]
fn every_operation_is_right_in_metal() {
    for target in [Target::Exact, Target::Gpu] {
        let program = every_operation(target);
        if let Some((_dir, binary)) = compiled_metal(&program) {
            let got = run(&binary, "operations", &operands());
            check(&program, &got, &expected(&program, Rounding::Once), "Metal");
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn every_operation_is_right_on_a_driver() {
    let Some(driver) = Driver::new(Host::Vulkan) else {
        return;
    };
    for target in driver.kept() {
        let program = every_operation(target);
        let expected = expected(&program, driver.rounding());
        let module = driver.dir.path().join("module.spv");
        write_words(&module, &spirv::module(&program).expect("naga accepts it"));
        let function = &program.functions()[0];
        let got = driver.run(&module, "operations", function, &operands());
        check(&program, &got, &expected, "SPIR-V");
        // Other languages cannot state how divisions round.
        if !driver.is_software {
            continue;
        }
        if let Some(module) = compile_glsl(&program, driver.dir.path()) {
            let got = driver.run(&module, "main", function, &operands());
            check(&program, &got, &expected, "GLSL");
        }
        if let Some(module) = compile_hlsl(&program, driver.dir.path()) {
            let got = driver.run(&module, "main", function, &operands());
            check(&program, &got, &expected, "HLSL");
        }
        if let Some(module) = slang::precise(&program, function, driver.dir.path()) {
            let got = driver.run(&module, "operations", function, &operands());
            check(&program, &got, &expected, "Slang");
        }
    }
}

/// Every operation that lanes record is among those that are compared.
#[test]
fn every_operation_is_compared() {
    let program = every_operation(Target::GpuNative);
    let nodes = program.functions()[0].graph().nodes();
    let has = |op: Op| nodes.iter().any(|node| node.kind == Kind::Op(op));
    for op in [
        Op::Add,
        Op::Sub,
        Op::Mul,
        Op::Div,
        Op::Neg,
        Op::MulAdd,
        Op::Exp2,
        Op::Log2,
        Op::Sqrt,
        Op::Abs,
        Op::Min,
        Op::Max,
        Op::TimesSign,
        Op::NegateIf,
        Op::ShiftLeft23,
        Op::Mantissa,
        Op::Exponent,
        Op::Upper,
        Op::Less,
        Op::AtLeast,
        Op::And,
        Op::Or,
        Op::Not,
        Op::Select,
    ] {
        assert!(has(op), "{op:?}");
    }
    for language in Language::ALL {
        assert!(
            print(&program, language).contains("operations"),
            "{language:?} prints all"
        );
    }
}
