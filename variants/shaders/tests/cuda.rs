//! Tests of the header on an NVIDIA GPU, compiled by nvcc.

use crate::c::{compile, exists, run, source};
use crate::gradients::Weighted;
use crate::support::{Case, Tally, fusing_level, unsigned, visit_every_model};
use crate::vulkan::Doubles;
use hairis_conformance::cases;
use hairis_shaders::{Call, Function, Program, Rounding, Target};
use hairis_variants::{Registered, Visitor};
use std::path::PathBuf;
use tempfile::TempDir;

/// Flags that make products and sums round separately.
pub(crate) const APART: &[&str] = &["-fmad=false"];

/// Compiles the driver of a program for the GPU of this machine, in a new folder.
pub(crate) fn compiled(program: &Program, flags: &[&str]) -> (TempDir, PathBuf) {
    let dir = TempDir::new().expect("a folder for the program");
    let flags = [&["-arch=native"], flags].concat();
    let binary = compile(dir.path(), &source(program), "nvcc", &flags);
    let binary = binary.unwrap_or_else(|error| panic!("{} in CUDA: {error}", program.name()));
    (dir, binary)
}

/// Returns true if nvcc and a GPU are available.
pub(crate) fn has_gpu() -> bool {
    exists("nvcc") && exists("nvidia-smi")
}

fn every_model_on_a_gpu<V: Visitor + Copy>(visitor: V) {
    if has_gpu() {
        visit_every_model(visitor);
    }
}

/// Comparison with the bits of one lane, for a compiler that keeps products and sums separate.
#[derive(Clone, Copy)]
struct Apart<'a>(Target, &'a Tally);

impl Visitor for Apart<'_> {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Self(target, tally) = self;
        let program = Program::of::<M>(target);
        let (_dir, binary) = compiled(&program, APART);
        let cases = Case::<M>::many(cases(4096), 51);
        for call in Call::ALL {
            let function = program.function(call);
            let arguments = || cases.iter().map(|case| case.arguments(call));
            let expected: Vec<_> = match (target, fusing_level()) {
                (Target::Exact, _) => cases.iter().map(|case| case.results(call)).collect(),
                (_, Some(level)) if call == Call::EvalSampleHit => {
                    let (eights, _) = cases.as_chunks::<8>();
                    let results = eights.iter().flat_map(|eight| Case::results8(eight, level));
                    results.collect()
                }
                _ => {
                    let once = |arguments: Vec<f32>| function.run(&arguments, Rounding::Once);
                    arguments().map(once).collect()
                }
            };
            let inputs: Vec<f32> = arguments().flatten().collect();
            let got = run(&binary, function.name(), &inputs);
            // NaN has another sign on a GPU, and in a shading point a 0 may have taken its sign from it.
            let read = |x| match call {
                Call::Prepare => unsigned(x),
                _ => x,
            };
            let got: Vec<f32> = got.into_iter().map(read).collect();
            let expected = expected.into_iter();
            let expected: Vec<Vec<f32>> = expected
                .map(|results| results.into_iter().map(read).collect())
                .collect();
            let name = format!("{} {} {target:?} in CUDA", program.name(), call.name());
            tally.count(function, &got, &expected, &name);
        }
    }
}

fn check_apart(target: Target) {
    let tally = Tally::default();
    every_model_on_a_gpu(Apart(target, &tally));
    tally.check();
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn cuda_has_the_bits_of_one_lane() {
    check_apart(Target::Exact);
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn fused_cuda_has_the_bits_of_a_level_that_fuses() {
    check_apart(Target::Fused);
}

/// Comparison with double precision, for flags that leave the last digits to the compiler.
#[derive(Clone, Copy)]
struct Accuracy(&'static [&'static str]);

impl Visitor for Accuracy {
    type Output = ();

    fn visit<M: Registered>(self) {
        let cases = Case::<M>::many(cases(4096), 53);
        let exact = Doubles::new(&cases);
        for target in [Target::Exact, Target::Fused, Target::GpuNative] {
            let mut program = Program::of::<M>(target);
            let calls = [Call::EvalHit, Call::SampleHit].map(|call| program.function(call).clone());
            program.keep(calls.to_vec());
            let (_dir, binary) = compiled(&program, self.0);
            let name = format!("{} {target:?} in CUDA {:?}", program.name(), self.0);
            let results =
                |function: &Function, inputs: &[f32]| run(&binary, function.name(), inputs);
            exact.check(calls.each_ref(), &name, results);
        }
    }
}

/// By default nvcc contracts products and sums.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn cuda_has_the_accuracy_of_one_lane() {
    every_model_on_a_gpu(Accuracy(&[]));
}

/// Fast math of nvcc flushes denormals and approximates quotients and roots, but keeps NaN and the order of sums.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn fast_cuda_has_the_accuracy_of_one_lane() {
    every_model_on_a_gpu(Accuracy(&["-use_fast_math"]));
}

#[derive(Clone, Copy)]
struct Gradients;

impl Visitor for Gradients {
    type Output = ();

    fn visit<M: Registered>(self) {
        let mut program = Program::of::<M>(Target::Exact);
        let cases = Weighted::both::<M>(&mut program);
        for flags in [APART, &[]] {
            let (_dir, binary) = compiled(&program, flags);
            for cases in &cases {
                let gradient = &cases.gradient;
                let name = format!("{} {} in CUDA {flags:?}", program.name(), gradient.name());
                let got = run(&binary, gradient.name(), &cases.all.concat());
                if flags == APART {
                    // A 0 may have taken its sign from a NaN.
                    cases.check_bits(&got, Rounding::Once, unsigned, &name);
                }
                cases.check(&got, &name);
            }
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn gradients_in_cuda_have_the_bits_of_the_graph() {
    every_model_on_a_gpu(Gradients);
}
