//! Tests of modules of Slang: its compiler accepts them for every language, and results and derivatives on a Vulkan driver are right.

use crate::gradients::Weighted;
use crate::languages::tool;
use crate::support::{Case, some_targets, visit_code_of_models};
use crate::vulkan::{Doubles, Driver, Host};
use hairis_conformance::cases;
use hairis_shaders::spirv::translate;
use hairis_shaders::{Call, Function, Language, Program, Target, driver, print};
use hairis_variants::{KajiyaKay, Registered, Visitor};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Flags with which arithmetic keeps its order on a Vulkan driver.
pub(crate) const PRECISE: [&str; 2] = ["-DHAIRIS_PRECISE=precise", "-emit-spirv-via-glsl"];

/// Returns a module of these functions with their entry points.
fn module(program: &Program, functions: &[Function]) -> String {
    let mut program = program.clone();
    program.keep(functions.to_vec());
    print(&program, Language::Slang) + &driver(&program, Language::Slang)
}

/// Compiles an entry point of a module, or all, by the compiler of the Python that `HAIRIS_SLANG` names, to a file of each language.
/// Returns `None` without one.
fn compile_to<const N: usize>(
    source: &str,
    dir: &Path,
    languages: [&str; N],
    entry: Option<&str>,
    flags: &[&str],
) -> Option<[PathBuf; N]> {
    let Some(python) = env::var_os("HAIRIS_SLANG") else {
        println!("HAIRIS_SLANG names no Python with slangpy: skipped");
        return None;
    };
    let file = dir.join("model.slang");
    fs::write(&file, source).expect("the folder is ours");
    let mut command = Command::new(python);
    command
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/slangc.py"))
        .arg(&file)
        .arg("-fvk-use-entrypoint-name");
    if let Some(entry) = entry {
        command.args(["-entry", entry, "-stage", "compute"]);
    }
    let out = languages.map(|language| {
        command.args(["-target", language]);
        // The compiler knows CUDA's files by `.cu` alone.
        dir.join(match language {
            "cuda" => "module.cu".into(),
            _ => format!("module.{language}"),
        })
    });
    for path in &out {
        command.arg("-o").arg(path);
    }
    let output = command
        .args(flags)
        .env("SLANG_RUN_SPIRV_VALIDATION", "1")
        .output()
        .expect("Python starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && message.is_empty(),
        "{languages:?} {flags:?}: {message}"
    );
    Some(out)
}

/// Compiles an entry point of a module, or all, to SPIR-V.
fn compile(source: &str, dir: &Path, entry: Option<&str>, flags: &[&str]) -> Option<PathBuf> {
    compile_to(source, dir, ["spirv"], entry, flags).map(|[out]| out)
}

/// Compiles a function to a compute shader by its name in SPIR-V, with arithmetic that keeps its order.
pub(crate) fn precise(program: &Program, function: &Function, dir: &Path) -> Option<PathBuf> {
    let source = module(program, core::slice::from_ref(function));
    compile(&source, dir, Some(function.name()), &PRECISE)
}

#[derive(Clone, Copy)]
struct Languages;

impl Visitor for Languages {
    type Output = ();

    fn visit<M: Registered>(self) {
        let dir = TempDir::new().expect("a folder for the module");
        let program = Program::of::<M>(Target::Gpu);
        let (name, spirv) = (program.name(), dir.path().join("hlsl.spv"));
        let languages = ["wgsl", "hlsl", "metal", "cuda"];
        for (call, entry) in [
            (Call::EvalSampleHit, "eval_sample_hit"),
            (Call::EvalHit, "eval_hit_backward"),
        ] {
            let source = module(&program, &[program.function(call).clone()]);
            let Some(out) = compile_to(&source, dir.path(), languages, Some(entry), &[]) else {
                return;
            };
            let text = out
                .each_ref()
                .map(|path| fs::read_to_string(path).expect("the compiler wrote it"));
            for (language, text) in languages.iter().zip(&text) {
                assert!(text.contains(entry), "{name} {entry} by {language}");
            }
            let [from, to] = [&out[1], &spirv].map(|path| path.to_string_lossy());
            let glslang = ["-D", "-V", "-S", "comp", "-e", entry, &from, "-o", &to];
            if let Some(Err(error)) = tool("glslangValidator", &glslang) {
                panic!("{name} {entry} by HLSL: {error}");
            }
            if let Err(error) = translate(&text[0]) {
                panic!("{name} {entry} by WGSL: {error}");
            }
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn slang_compiles_to_every_language() {
    visit_code_of_models(Languages);
}

/// Every function of the smallest model, its derivatives included.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn slang_differentiates_every_function() {
    let dir = TempDir::new().expect("a folder for the module");
    let program = Program::of::<KajiyaKay>(Target::Gpu);
    let all = module(&program, program.functions());
    compile(&all, dir.path(), None, &[]);
}

#[derive(Clone, Copy)]
struct Accuracy;

impl Visitor for Accuracy {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Some(driver) = Driver::new(Host::Vulkan) else {
            return;
        };
        let cases = Case::<M>::many(cases(4096), 45);
        let exact = Doubles::new(&cases);
        for target in some_targets([Target::Gpu, Target::GpuNative], 1) {
            let program = Program::of::<M>(target);
            let calls = [Call::EvalHit, Call::SampleHit].map(|call| program.function(call));
            let source = module(&program, &calls.map(Clone::clone));
            let Some(module) = compile(&source, driver.dir.path(), None, &[]) else {
                return;
            };
            let name = format!("{} {target:?} in Slang", program.name());
            exact.check(calls, &name, |function, inputs| {
                driver.run(&module, function.name(), function, inputs)
            });
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn modules_of_slang_have_the_accuracy_of_one_lane() {
    visit_code_of_models(Accuracy);
}

/// Runs the derivatives of a function by the compiler of Slang, after `edit` of the module.
fn backward(
    driver: &Driver,
    program: &Program,
    cases: &Weighted,
    edit: impl Fn(String) -> String,
) -> Option<Vec<f32>> {
    let source = edit(module(program, core::slice::from_ref(&cases.function)));
    let entry = format!("{}_backward", cases.function.name());
    let module = compile(&source, driver.dir.path(), Some(&entry), &[])?;
    Some(driver.run(&module, &entry, &cases.gradient, &cases.all.concat()))
}

#[derive(Clone, Copy)]
struct Derivatives;

impl Visitor for Derivatives {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Some(driver) = Driver::new(Host::Vulkan) else {
            return;
        };
        let program = Program::of::<M>(Target::Gpu);
        for call in [Call::Material, Call::EvalHit] {
            let cases = Weighted::new::<M>(&program, call);
            let Some(got) = backward(&driver, &program, &cases, |source| source) else {
                return;
            };
            let name = format!("{} {} in Slang", program.name(), call.name());
            cases.check(&got, &name);
            // The gradient of the graph, printed.
            let source = module(&program, core::slice::from_ref(&cases.gradient));
            let entry = cases.gradient.name();
            let module = compile(&source, driver.dir.path(), Some(entry), &[])
                .expect("the compiler was there");
            let printed = driver.run(&module, entry, &cases.gradient, &cases.all.concat());
            cases.check(&printed, &format!("{name}, printed"));
            let results = cases.function.output().len();
            for (got, inputs) in got.chunks(cases.gradient.output().len()).zip(&cases.all) {
                let mut derivatives = got[results..].iter();
                assert!(derivatives.all(|x| x.is_finite()), "{name}: {inputs:?}");
            }
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn derivatives_of_slang_are_those_of_differences() {
    visit_code_of_models(Derivatives);
}

/// Derivatives that the compiler would have without those of the module are found.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn wrong_derivatives_of_slang_are_found() {
    let Some(driver) = Driver::new(Host::Vulkan) else {
        return;
    };
    let program = Program::of::<KajiyaKay>(Target::Gpu);
    let cases = Weighted::new::<KajiyaKay>(&program, Call::EvalHit);
    for (right, wrong) in [
        ("? d * ($pmantissa(a) / a) : 0.0f", "? d : 0.0f"),
        ("d * (0.5f / sqrt(a))", "d / sqrt(a)"),
    ] {
        let right = right.replace("$p", "hairis_kajiya_kay_");
        let edit = |source: String| {
            assert_eq!(source.matches(&right).count(), 1, "{right}");
            source.replace(&right, wrong)
        };
        let Some(got) = backward(&driver, &program, &cases, edit) else {
            return;
        };
        let [median, most] = cases.errors(&got, wrong);
        println!("{wrong}: {median:e}, {most:e}");
        assert!(median > 1e-6 || most > 1e-3, "{wrong}");
    }
}
