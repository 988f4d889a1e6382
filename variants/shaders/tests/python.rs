//! Tests that the module of Python has the bits of one lane with `NumPy`. Accuracy and derivatives in the frameworks are tested by
//! `.ci/frameworks.py`.

use crate::gradients::Weighted;
use crate::operations;
use crate::support::{Case, Random, Tally, every_model};
use hairis_conformance::cases;
use hairis_shaders::{Call, Language, Program, Rounding, Target, driver, every_operation, print};
use hairis_variants::{KajiyaKay, Registered};
use std::env;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// Python that has `NumPy`.
fn python() -> String {
    env::var("HAIRIS_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// Writes a program with its driver into a new folder. Returns `None` if `NumPy` is not installed.
fn written(program: &Program) -> Option<TempDir> {
    let found = Command::new(python()).args(["-c", "import numpy"]).output();
    if !found.is_ok_and(|output| output.status.success()) {
        println!("{} has no NumPy: skipped", python());
        return None;
    }
    let dir = TempDir::new().expect("a folder for the program");
    let source = print(program, Language::Python) + &driver(program, Language::Python);
    fs::write(dir.path().join("model.py"), source).expect("the folder is ours");
    Some(dir)
}

/// Runs Python in a folder with all warnings as errors.
fn execute(dir: &Path, arguments: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(python())
        .args(["-W", "error"])
        .args(arguments)
        .current_dir(dir)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("Python starts");
    let mut stdin = child.stdin.take().expect("standard input is a pipe");
    // The program reads all of its input before it writes.
    stdin.write_all(input).expect("the program reads");
    drop(stdin);
    child.wait_with_output().expect("the program ends")
}

/// Runs a function of a program that was written with its driver. As a module it is compiled once.
fn run(dir: &TempDir, function: &str, inputs: &[f32]) -> Vec<f32> {
    let bytes: Vec<u8> = inputs.iter().flat_map(|x| x.to_le_bytes()).collect();
    let output = execute(dir.path(), &["-m", "model", function], &bytes);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{function}: {message}");
    let (chunks, _) = output.stdout.as_chunks::<4>();
    chunks
        .iter()
        .map(|bytes| f32::from_le_bytes(*bytes))
        .collect()
}

#[test]
fn every_operation_is_right_in_python() {
    for target in [Target::Exact, Target::Gpu] {
        let program = every_operation(target);
        if let Some(dir) = written(&program) {
            let got = run(&dir, "operations", &operations::operands());
            let expected = operations::expected(&program, Rounding::Twice);
            operations::check(&program, &got, &expected, "Python");
        }
    }
}

fn check_bits<M: Registered>() {
    let mut program = Program::of::<M>(Target::Exact);
    let gradients = program.clone();
    let cases = Case::<M>::many(cases(4096), 42);
    let tally = Tally::default();
    let Some(dir) = written(&program) else {
        return;
    };
    for call in Call::ALL {
        let inputs: Vec<f32> = cases.iter().flat_map(|case| case.arguments(call)).collect();
        let expected: Vec<_> = cases.iter().map(|case| case.results(call)).collect();
        let function = program.function(call);
        let name = format!("{} {}", program.name(), function.name());
        tally.count(
            function,
            &run(&dir, function.name(), &inputs),
            &expected,
            &name,
        );
    }
    tally.check();
    program = gradients;
    let weighted = Weighted::both::<M>(&mut program);
    let dir = written(&program).expect("NumPy was there");
    for cases in &weighted {
        let gradient = &cases.gradient;
        let name = format!("{} {} in Python", program.name(), gradient.name());
        let got = run(&dir, gradient.name(), &cases.all.concat());
        cases.check_bits(&got, Rounding::Once, |x| x, &name);
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn numpy_has_the_bits_of_one_lane() {
    every_model!(check_bits, visit_code_of_models);
}

/// Numbers, lists, rows and tuples are arguments; shapes broadcast, and results have the common shape.
#[test]
fn arguments_of_python_broadcast_and_bad_ones_are_named() {
    let program = Program::of::<KajiyaKay>(Target::GpuNative);
    let Some(dir) = written(&program) else {
        return;
    };
    let script = r#"
import numpy, model
hair = model.material(model.params_brown())
one = model.eval_hit(hair, (0, .6, .8), 0, [0, .8, .6])
assert one.pdf.shape == () and len(one.value) == 3 and float(one.pdf) > 0
wi = numpy.array([[0, 0], [.8, .6], [.6, .8]])
for wo in (numpy.array([0, .6, .8]), numpy.array([[0], [.6], [.8]]), (0, numpy.array([.6, .6]), .8)):
    two = model.eval_hit(hair, wo, 0, wi)
    assert two.pdf.shape == (2,) and two.pdf[0] == one.pdf and two.value[0].dtype == numpy.float32
assert model.eval_hit(hair, (0, .6, .8), 0, wi, numpy).pdf.tolist() == two.pdf.tolist()
grid = model.sample_hit(hair, (0, .6, .8), numpy.zeros((4, 1)), numpy.full((3, 1, 5), .5))
assert grid.slot.shape == (4, 5) and numpy.stack(grid.wi).shape == (3, 4, 5)
lobes = model.lobes(model.prepare(hair, (0, .6, .8), 0), wi)
assert all(x.shape == (2,) for x in lobes.color + lobes.value)
assert model.eval_hit(hair, (0, .6, .8), 0, numpy.zeros((3, 0))).pdf.shape == (0,)
assert model.eval_hit(hair, (0, numpy.nan, .8), 0, wi).pdf.tolist() == [0, 0]
many = model.material(model.params_brown()._replace(exponent=[8, 9, 10]))
assert all(x.shape == (3,) for x in model._flat(many))
for arguments, message in [
    ((hair, (0, 1), 0, wi), "wo must have 3 components in its first dimension, got 2"),
    ((hair, wi, 0, wi.T), "wi must have 3 components in its first dimension, got 2"),
    ((hair, 1.0, 0, wi), "wo must have 3 components in its first dimension, got 1"),
    ((hair, wi, [0, 0, 0], wi), "h must broadcast with the arguments before it, of shape (2,), got (3,)"),
    ((hair, wi, "far", wi), "h must be a number or an array of numbers, got 'far'"),
    ((hair, wi, None, wi), "h must be a number or an array of numbers, got None"),
    ((hair, wi, "0.5", wi), "h must be a number or an array of numbers, got '0.5'"),
    ((hair, {}, 0, wi), "wo must have 3 components in its first dimension, got 0"),
    ((1, wi, 0, wi), "material must be a Material, got 1, which has no field"),
    ((model.params_brown(), wi, 0, wi), "material must be a Material, got Params"),
]:
    try:
        model.eval_hit(*arguments)
    except (TypeError, ValueError) as error:
        assert message in str(error) and "\n" not in str(error), error
    else:
        raise AssertionError(message)
"#;
    let output = execute(dir.path(), &["-c", script], b"");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
}

/// Random operands reach every bit pattern of literals that a material may have.
#[test]
fn python_reads_every_literal_as_its_float() {
    let mut program = Program::of::<KajiyaKay>(Target::Exact);
    let mut random = Random(44);
    let numbers: Vec<f32> = (0..program.material().len())
        .map(|i| match i {
            0 => f32::INFINITY,
            1 => f32::NEG_INFINITY,
            2 => f32::NAN,
            3 => f32::MAX,
            4 => 1e-45,
            _ => random.range(-1.0, 1.0) * random.range(-120.0, 120.0).exp2(),
        })
        .collect();
    program.add_material("odd", &numbers);
    let Some(dir) = written(&program) else {
        return;
    };
    let script = "import sys, numpy, model\nsys.stdout.buffer.write(numpy.float32(list(model._flat(model.material_odd()))).tobytes())";
    let output = execute(dir.path(), &["-c", script], b"");
    let (chunks, _) = output.stdout.as_chunks::<4>();
    let got = chunks.iter().map(|bytes| f32::from_le_bytes(*bytes));
    assert!(got.clone().count() == numbers.len());
    for (got, expected) in got.zip(&numbers) {
        assert!(
            crate::support::same(got, *expected),
            "{got}, not {expected}"
        );
    }
}
