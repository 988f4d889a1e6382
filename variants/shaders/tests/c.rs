//! Tests that the header compiles without warnings as C and C++, and has the bits of one lane.

use crate::gradients::Weighted;
use crate::support::{
    Case, differing, every_model, fusing_level, is_long, same, visit_code_of_models,
    visit_every_model,
};
use hairis_conformance::cases;
use hairis_shaders::{Call, Function, Language, Program, Rounding, Target, driver, print};
use hairis_variants::{KajiyaKay, Parameters, Registered, Visitor};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// Warnings that a host may have switched on.
const STRICT: &[&str] = &["-pedantic", "-Wall", "-Wextra", "-Werror"];

/// Warnings of nvcc and of its host compiler, without the warnings about code that nvcc itself writes.
const NVCC_STRICT: &[&str] = &["-Werror", "all-warnings", "-Xcompiler", "-Wall,-Wextra"];

pub(crate) fn exists(compiler: &str) -> bool {
    let found = Command::new(compiler).arg("--version").output();
    let found = found.is_ok_and(|output| output.status.success());
    if !found {
        println!("{compiler} is not installed: skipped");
    }
    found
}

/// Compiles a file with all warnings as errors; with nvcc, as CUDA.
pub(crate) fn compile(
    dir: &Path,
    source: &str,
    compiler: &str,
    flags: &[&str],
) -> Result<PathBuf, String> {
    let (file, warnings) = match compiler {
        "nvcc" => ("main.cu", NVCC_STRICT),
        _ if compiler.ends_with("++") => ("main.cpp", STRICT),
        _ => ("main.c", STRICT),
    };
    let (file, program) = (dir.join(file), dir.join("main"));
    fs::write(&file, source).expect("the folder is ours");
    let mut command = Command::new(compiler);
    command
        .args(flags)
        .args(warnings)
        .arg(&file)
        .arg("-o")
        .arg(&program)
        .arg("-lm");
    let Output { status, stderr, .. } = command.output().expect("the compiler starts");
    if status.success() {
        Ok(program)
    } else {
        Err(String::from_utf8_lossy(&stderr).into_owned())
    }
}

/// Runs a compiled driver on these inputs, and returns its results.
pub(crate) fn run(program: &Path, function: &str, inputs: &[f32]) -> Vec<f32> {
    let output = started(Command::new(program), function, inputs);
    assert!(output.status.success(), "{function}: {}", output.status);
    let (chunks, _) = output.stdout.as_chunks::<4>();
    chunks
        .iter()
        .map(|bytes| f32::from_le_bytes(*bytes))
        .collect()
}

fn started(mut command: Command, function: &str, inputs: &[f32]) -> Output {
    let mut child = command
        .arg(function)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let bytes: Vec<u8> = inputs.iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut stdin = child.stdin.take().expect("standard input is a pipe");
    // The program reads all of its input before it writes; whether it ended before shows in its status.
    let _ = stdin.write_all(&bytes);
    drop(stdin);
    child.wait_with_output().expect("the program ends")
}

/// Compiles the driver of a program by gcc, without contraction, in a new folder. Returns `None` if gcc is not installed.
pub(crate) fn compiled(program: &Program) -> Option<(TempDir, PathBuf)> {
    if !exists("gcc") {
        return None;
    }
    let dir = TempDir::new().expect("a folder for the program");
    let binary = compile(dir.path(), &source(program), "gcc", &["-std=c99", "-O1"]);
    let binary = binary.unwrap_or_else(|error| panic!("{}: {error}", program.name()));
    Some((dir, binary))
}

/// Compiles the driver of a program in Metal by g++, with Metal's operations from a header in this folder. Returns `None` if g++ is not
/// installed.
pub(crate) fn compiled_metal(program: &Program) -> Option<(TempDir, PathBuf)> {
    if !exists("g++") {
        return None;
    }
    let dir = TempDir::new().expect("a folder for the program");
    let main = driver(program, Language::C).replace("HairisVec3", "float3");
    let source = print(program, Language::Msl) + &main;
    let include = concat!("-I", env!("CARGO_MANIFEST_DIR"), "/tests");
    let flags = ["-std=c++14", "-O1", "-ffp-contract=off", include];
    let binary = compile(dir.path(), &source, "g++", &flags);
    let binary = binary.unwrap_or_else(|error| panic!("{} in Metal: {error}", program.name()));
    Some((dir, binary))
}

pub(crate) fn source(program: &Program) -> String {
    print(program, Language::C) + &driver(program, Language::C)
}

/// Returns the number of cases, over all calls, that differ from one lane in a bit.
fn differences<M: Registered>(program: &Program, binary: &Path, cases: &[Case<M>]) -> usize {
    let mut differ = 0;
    for call in Call::ALL {
        let inputs: Vec<f32> = cases.iter().flat_map(|case| case.arguments(call)).collect();
        let expected: Vec<_> = cases.iter().map(|case| case.results(call)).collect();
        let function = program.function(call);
        differ += differing(function, &run(binary, function.name(), &inputs), &expected);
    }
    differ
}

/// Host that ends with SIGFPE at an invalid operation, a division by zero or an overflow, where `HAIRIS_TRAPS` is set; with `CONTROL`, at
/// once.
const TRAPS: &str = "
#include <fenv.h>
#include <stdlib.h>
__attribute__((constructor)) static void trap(void) {
    if (!getenv(\"HAIRIS_TRAPS\")) return;
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#ifdef CONTROL
    volatile float zero = 0, quotient = zero / zero;
    (void)quotient;
#endif
}
";

#[derive(Clone, Copy)]
struct Checked<'a> {
    compiler: &'static str,
    flags: &'a [&'a str],
    count: usize,
    /// True if everyday arguments are to raise no exception.
    traps: bool,
}

impl Checked<'_> {
    /// Compiles the driver of a model's program.
    fn compiled(self, program: &Program, dir: &Path) -> PathBuf {
        let (end, flags) = if self.traps {
            (TRAPS, [&["-D_GNU_SOURCE"], self.flags].concat())
        } else {
            ("", self.flags.to_vec())
        };
        let binary = compile(dir, &(source(program) + end), self.compiler, &flags);
        binary.unwrap_or_else(|error| panic!("{}: {error}", program.name()))
    }
}

impl Visitor for Checked<'_> {
    type Output = ();

    fn visit<M: Registered>(self) {
        let program = Program::of::<M>(Target::Exact);
        let dir = TempDir::new().expect("a folder for the program");
        let binary = self.compiled(&program, dir.path());
        let cases = Case::<M>::many(cases(self.count), 42);
        let differ = differences(&program, &binary, &cases);
        let name = program.name();
        assert_eq!(differ, 0, "{name} by {}: cases that differ", self.compiler);
        if self.traps {
            let found = trapped::<M>(&program, &binary);
            assert!(
                found.is_empty(),
                "{name} by {} {:?}: {found:?}",
                self.compiler,
                self.flags
            );
        }
    }
}

/// Returns the calls of a model that end a host with traps on everyday arguments.
fn trapped<M: Registered>(program: &Program, binary: &Path) -> Vec<&'static str> {
    let cases = Case::<M>::everyday(8192, 7);
    let ends = |call: &Call| {
        let arguments = cases.iter().flat_map(|case| case.arguments(*call));
        let inputs: Vec<f32> = arguments.collect();
        let mut command = Command::new(binary);
        command.env("HAIRIS_TRAPS", "1");
        let name = program.function(*call).name();
        !started(command, name, &inputs).status.success()
    };
    let found = Call::ALL.into_iter().filter(ends);
    found.map(Call::name).collect()
}

#[test]
fn c_has_the_bits_of_one_lane() {
    if exists("gcc") {
        visit_every_model(Checked {
            compiler: "gcc",
            flags: &["-std=c99", "-O1"],
            count: 1024,
            traps: false,
        });
    }
}

/// Everyday arguments raise no exception, and any arguments give the bits of one lane.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn optimised_c_has_the_bits_of_one_lane_and_raises_no_exception() {
    let levels: &[&str] = if is_long() { &["-O2", "-O3"] } else { &["-O2"] };
    // Clang computes unused lanes of packed numbers, unless it is told that exceptions matter.
    let clang = "-ffp-exception-behavior=maytrap";
    for (compiler, more) in [("gcc", &[][..]), ("clang", &[clang][..])] {
        if !exists(compiler) {
            continue;
        }
        let all = Checked {
            compiler,
            flags: &["-std=c99", "-DCONTROL"],
            count: 4096,
            traps: cfg!(all(target_os = "linux", target_arch = "x86_64")),
        };
        if all.traps {
            let program = Program::of::<KajiyaKay>(Target::Exact);
            let dir = TempDir::new().expect("a folder for the program");
            let control = all.compiled(&program, dir.path());
            let control = trapped::<KajiyaKay>(&program, &control);
            assert_eq!(
                control.len(),
                Call::ALL.len(),
                "the control raises exceptions"
            );
        }
        for level in levels {
            let flags = [&["-std=c99", level], more].concat();
            visit_code_of_models(Checked {
                flags: &flags,
                ..all
            });
            let found = if all.traps {
                "no exceptions"
            } else {
                "not trapped"
            };
            println!("generated C by {compiler} {}: {found}", flags.join(" "));
        }
    }
}

/// Clang contracts by default if the machine has fused instructions, but the pragma in the header forbids it.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn clang_keeps_products_and_sums_apart() {
    let can_fuse = fusing_level().is_some() && cfg!(target_arch = "x86_64");
    let flags: &[&str] = if can_fuse {
        &["-O2", "-mfma"]
    } else {
        &["-O2"]
    };
    if exists("clang") {
        visit_code_of_models(Checked {
            compiler: "clang",
            flags,
            count: 4096,
            traps: false,
        });
    }
}

/// The language is what differs from C, so that no level of optimisation is needed.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn cpp_has_the_bits_of_one_lane() {
    for compiler in ["g++", "clang++"] {
        if exists(compiler) {
            visit_code_of_models(Checked {
                compiler,
                flags: &["-std=c++17", "-O0", "-ffp-contract=off"],
                count: 4096,
                traps: false,
            });
        }
    }
}

fn check_gradients<M: Registered>() {
    let mut program = Program::of::<M>(Target::Exact);
    let cases = Weighted::both::<M>(&mut program);
    let Some((_dir, binary)) = compiled(&program) else {
        return;
    };
    for cases in &cases {
        let gradient = &cases.gradient;
        let name = format!("{} {} in C", program.name(), gradient.name());
        let got = run(&binary, gradient.name(), &cases.all.concat());
        cases.check_bits(&got, Rounding::Once, |x| x, &name);
        cases.check(&got, &name);
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn gradients_in_c_have_the_bits_of_the_graph() {
    every_model!(check_gradients, visit_code_of_models);
}

/// Control: the comparison detects contraction.
#[test]
fn contraction_is_found() {
    struct Contracted;
    impl Visitor for Contracted {
        type Output = ();
        fn visit<M: Registered>(self) {
            let program = Program::of::<M>(Target::Exact);
            let dir = TempDir::new().expect("a folder for the program");
            let flags = ["-std=gnu99", "-O2", "-mfma", "-ffp-contract=fast"];
            let binary = compile(dir.path(), &source(&program), "gcc", &flags);
            let binary = binary.expect("contraction is no error");
            let cases = Case::<M>::many(1024, 42);
            let differ = differences(&program, &binary, &cases);
            assert!(differ > 100, "{differ} cases differ with contraction");
        }
    }
    if fusing_level().is_some() && cfg!(target_arch = "x86_64") && exists("gcc") {
        hairis_variants::ModelId::Gaussian.visit(Contracted);
    }
}

#[test]
fn fast_math_is_refused() {
    let program = Program::of::<KajiyaKay>(Target::Exact);
    let dir = TempDir::new().expect("a folder for the program");
    for (compiler, flag) in [
        ("gcc", "-ffast-math"),
        ("gcc", "-ffinite-math-only"),
        ("clang", "-ffast-math"),
    ] {
        if exists(compiler) {
            let error = compile(dir.path(), &source(&program), compiler, &[flag]);
            let error = error.expect_err("fast arithmetic is refused");
            assert!(
                error.contains("compile without fast math"),
                "{compiler} {flag}: {error}"
            );
        }
    }
}

/// The example of the README runs as a user without Rust compiles it.
#[test]
fn the_example_of_the_readme_runs() {
    if !exists("gcc") {
        return;
    }
    let readme = include_str!("../README.md");
    let (_, rest) = readme.split_once("```c\n").expect("an example in C");
    let (example, _) = rest.split_once("```").expect("its end");
    let dir = TempDir::new().expect("a folder for the program");
    let program = Program::of::<hairis::Published<hairis::Gaussian>>(Target::Exact);
    fs::write(
        dir.path().join("hairis_gaussian.h"),
        print(&program, Language::C),
    )
    .expect("ours");
    for (compiler, flag) in [("gcc", "-std=c99"), ("g++", "-std=c++17")] {
        let binary = compile(dir.path(), example, compiler, &[flag, "-O2"]);
        let output = Command::new(binary.expect("the example compiles")).output();
        let output = output.expect("the example runs").stdout;
        let text = String::from_utf8_lossy(&output).replace(',', " ");
        println!("{text}");
        let numbers = text
            .split_whitespace()
            .filter_map(|word| word.parse::<f32>().ok());
        let numbers: Vec<f32> = numbers.collect();
        let [r, _, _, pdf, weight, ..] = numbers[..] else {
            panic!("seven numbers, got {text}")
        };
        // The weight is value * cos theta_i / pdf.
        assert!(r > 0.0 && pdf > 0.0 && weight <= 1.001 * r / pdf, "{text}");
    }
}

/// Two models share a file, and have functions for their materials by name.
#[test]
fn headers_share_a_file_and_have_materials() {
    if !exists("gcc") {
        return;
    }
    let dir = TempDir::new().expect("a folder for the program");
    let programs = [
        Program::of::<KajiyaKay>(Target::Exact),
        Program::of::<hairis::Published<hairis::Gaussian>>(Target::Exact),
    ];
    let mut text: String = programs
        .iter()
        .map(|program| print(program, Language::C))
        .collect();
    let first = programs[0].materials().first().map(Function::name);
    text += &format!(
        "#include <stdio.h>\nint main(void) {{\n    HairisKajiyaKayMaterial other = hairis_kajiya_kay_{}();\n    \
         HairisGaussianMaterial m = hairis_gaussian_material_brown();\n    (void)other;\n    \
         return fwrite(&m, sizeof m, 1, stdout) != 1;\n}}\n",
        first.expect("a model has a preset")
    );
    let binary = compile(dir.path(), &text, "gcc", &["-std=c99"]).expect("both headers compile");
    let brown = programs[1].materials().iter();
    let brown = brown
        .clone()
        .find(|function| function.name() == "material_brown");
    let expected = brown.expect("brown is a preset").run(&[], Rounding::Once);
    let got = run(&binary, "", &[]);
    assert!(got.len() == expected.len() && got.iter().zip(&expected).all(|(a, b)| same(*a, *b)));
    let params = hairis::HairParams::PRESETS
        .iter()
        .find(|(name, _)| *name == "brown");
    let (_, params) = params.expect("brown is a preset");
    let model = <hairis::Published<hairis::Gaussian> as Registered>::MODEL;
    let numbers = hairis_shaders::numbers(&hairis::model::Model::material(&model, params));
    assert_eq!(got, numbers, "the numbers of the material");
}
