//! Tests of shaders on a Vulkan driver, and on WebGPU in a browser. They have the bits of one lane if arithmetic keeps its order, and the
//! accuracy of one lane otherwise.

use crate::gradients::Weighted;
use crate::languages::{compile_glsl, tool, write_words};
use crate::slang;
use crate::support::{Case, Tally, some_targets, unsigned, visit_code_of_models};
use hairis_conformance::cases;
use hairis_shaders::driver as shader_driver;
use hairis_shaders::{
    Call, Function, Language, Program, Rounding, Target, every_operation, print, spirv,
};
use hairis_variants::{Registered, Visitor};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Program that compiles and runs a compute shader.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Host {
    /// A Vulkan driver, behind naga.
    Vulkan,
    /// WebGPU of Chromium: Tint and `SwiftShader`.
    Browser,
}

impl Host {
    /// Returns those of three kinds of arithmetic that a slow test has: fewer in a browser, which is slower.
    fn targets(self, all: [Target; 3]) -> impl Iterator<Item = Target> {
        let count = match self {
            Self::Vulkan => 2,
            Self::Browser => 1,
        };
        some_targets(all, count)
    }
}

/// Host that is available on this machine, and a folder for its files.
pub(crate) struct Driver {
    pub(crate) dir: TempDir,
    /// True if the host rounds every division and square root to nearest, in any language.
    pub(crate) is_software: bool,
    host: Host,
    program: PathBuf,
}

impl Driver {
    /// Returns `None` if a compiler or Vulkan is missing, or if `HAIRIS_CHROMIUM` does not name a browser.
    pub(crate) fn new(host: Host) -> Option<Self> {
        let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
        let dir = TempDir::new().expect("a folder for shaders");
        let mut is_software = true;
        let program = match host {
            Host::Browser => {
                if std::env::var_os("HAIRIS_CHROMIUM").is_none() {
                    println!("HAIRIS_CHROMIUM names no browser: skipped");
                    return None;
                }
                tests.join("webgpu.mjs")
            }
            Host::Vulkan => {
                let [source, program] = [tests.join("vulkan.c"), dir.path().join("vulkan")];
                let [from, to] = [&source, &program].map(|path| path.to_string_lossy());
                let arguments = ["-std=c99", "-O1", &from, "-o", &to, "-lvulkan"];
                if let Err(error) = tool("gcc", &arguments)? {
                    println!("no Vulkan to link with: skipped: {error}");
                    return None;
                }
                let device = Command::new(&program).output().expect("it starts");
                let device = String::from_utf8_lossy(&device.stdout).into_owned();
                print!("{device}");
                is_software = device.contains("in software");
                program
            }
        };
        Some(Self {
            dir,
            is_software,
            host,
            program,
        })
    }

    /// Returns the rounding of `fma`, which drivers may choose.
    pub(crate) fn rounding(&self) -> Rounding {
        let program = every_operation(Target::Fused);
        let function = &program.functions()[0];
        let module = self.dir.path().join("operations.spv");
        write_words(&module, &spirv::module(&program).expect("naga accepts it"));
        let numbers = [1.0 + f32::EPSILON, 1.0 - f32::EPSILON, -1.0];
        let got = self.run(&module, "operations", function, &numbers);
        let rounding = [Rounding::Once, Rounding::Twice];
        let mut right = rounding
            .into_iter()
            .filter(|rounding| got == function.run(&numbers, *rounding));
        right.next().expect("each operation has one of two results")
    }

    /// Returns the targets whose bits are known: quotients of a GPU are IEEE's only if a module requires it.
    pub(crate) fn kept(&self) -> Vec<Target> {
        let of_gpu = self.is_software.then_some(Target::Gpu);
        [Target::Exact, Target::Fused]
            .into_iter()
            .chain(of_gpu)
            .collect()
    }

    /// Returns the number as it is compared. A GPU's `fma` flushes denormals, whatever the module requires, and tiny numbers then have
    /// other last digits, so they are compared as 0.
    fn compared(&self, target: Target, x: f32) -> f32 {
        let is_flushed = target == Target::Fused && !self.is_software;
        if is_flushed && x.abs() < 1e-24 {
            0.0
        } else {
            x
        }
    }

    /// Writes a program as a plain WGSL module, with an entry point per function.
    fn plain(&self, program: &Program) -> PathBuf {
        let source = print(program, Language::Wgsl) + &shader_driver(program, Language::Wgsl);
        let module = self.dir.path().join("plain");
        match self.host {
            Host::Browser => fs::write(&module, source).expect("the folder is ours"),
            Host::Vulkan => {
                write_words(
                    &module,
                    &spirv::translate(&source).expect("naga accepts it"),
                );
            }
        }
        module
    }

    pub(crate) fn run(
        &self,
        module: &Path,
        entry: &str,
        function: &Function,
        inputs: &[f32],
    ) -> Vec<f32> {
        let [input, output] = ["input", "output"].map(|name| self.dir.path().join(name));
        let bytes: Vec<u8> = inputs.iter().flat_map(|x| x.to_le_bytes()).collect();
        fs::write(&input, bytes).expect("the folder is ours");
        let mut command = match self.host {
            Host::Browser => Command::new("node"),
            Host::Vulkan => Command::new(&self.program),
        };
        if self.host == Host::Browser {
            command.arg(&self.program);
        }
        let said = command
            .args([module, Path::new(entry), &input, &output])
            .arg(function.inputs().len().to_string())
            .arg(function.output().len().to_string())
            .output()
            .expect("the program starts");
        let stderr = String::from_utf8_lossy(&said.stderr);
        assert!(said.status.success(), "{entry}: {stderr}");
        let bytes = fs::read(&output).expect("the program wrote it");
        let (chunks, _) = bytes.as_chunks::<4>();
        chunks
            .iter()
            .map(|bytes| f32::from_le_bytes(*bytes))
            .collect()
    }
}

/// Calls whose results are compared. The calls of a shading point are parts of them.
const CALLS: [Call; 3] = [Call::EvalHit, Call::SampleHit, Call::Material];

#[derive(Clone, Copy)]
struct Kept<'a>(&'a Tally);

impl Visitor for Kept<'_> {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Some(driver) = Driver::new(Host::Vulkan) else {
            return;
        };
        let cases = Case::<M>::many(cases(4096), 44);
        let rounding = driver.rounding();
        for target in driver.kept() {
            // Lavapipe moves the last digit of 2 to 4% of the directions that are drawn from the cylinder.
            if target == Target::Gpu && M::NAME.ends_with("-diffuse") {
                continue;
            }
            let mut program = Program::of::<M>(target);
            let calls = CALLS.map(|call| program.function(call).clone());
            program.keep(calls.to_vec());
            let module = driver.dir.path().join("module.spv");
            write_words(&module, &spirv::module(&program).expect("naga accepts it"));
            for (call, function) in CALLS.into_iter().zip(&calls) {
                let inputs: Vec<f32> = cases.iter().flat_map(|case| case.arguments(call)).collect();
                let expected = cases.iter().map(|case| match target {
                    Target::Exact => case.results(call),
                    _ => function.run(&case.arguments(call), rounding),
                });
                // Drivers may lose the sign of 0, which has no meaning in a material or a derivative.
                let compared = |numbers: Vec<f32>| -> Vec<f32> {
                    let numbers = numbers.into_iter().map(|x| driver.compared(target, x));
                    match call {
                        Call::Material => numbers.map(unsigned).collect(),
                        _ => numbers.collect(),
                    }
                };
                let expected: Vec<_> = expected.map(compared).collect();
                let got = compared(driver.run(&module, call.name(), function, &inputs));
                let name = format!("{} {} {target:?}", program.name(), call.name());
                self.0.count(function, &got, &expected, &name);
                // GLSL cannot state how divisions round.
                if target == Target::Exact && driver.is_software {
                    let mut one = program.clone();
                    one.keep(vec![function.clone()]);
                    let [glsl, slang] = [
                        compile_glsl(&one, driver.dir.path()),
                        slang::precise(&one, function, driver.dir.path()),
                    ];
                    let both = [("GLSL", "main", glsl), ("Slang", call.name(), slang)];
                    for (language, entry, module) in both {
                        let Some(module) = module else { continue };
                        let got = compared(driver.run(&module, entry, function, &inputs));
                        let name = format!("{name} in {language}");
                        self.0.count(function, &got, &expected, &name);
                    }
                }
            }
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn shaders_that_keep_their_order_have_the_bits_of_one_lane() {
    let tally = Tally::default();
    visit_code_of_models(Kept(&tally));
    tally.check();
}

/// Returns quantiles of the errors of values and densities relative to double precision, over arguments that are numbers: 50%, 99% and
/// 99.9%.
fn quantiles(got: &[f32], exact: &[f64]) -> [f64; 3] {
    let pairs = got
        .iter()
        .zip(exact)
        .filter(|(_, exact)| **exact > 1e-8 && exact.is_finite());
    let mut errors: Vec<f64> = pairs
        .map(|(got, exact)| (f64::from(*got) / exact - 1.0).abs())
        .collect();
    errors.sort_by(f64::total_cmp);
    assert!(errors.len() > got.len() / 4, "{} errors", errors.len());
    [0.5, 0.99, 0.999].map(|share| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a place"
        )]
        let place = (share * errors.len() as f64) as usize;
        errors[place]
    })
}

/// Cases, the results of `EvalHit` for them in double precision, and the errors of one lane.
pub(crate) struct Doubles<'a, M: Registered> {
    cases: &'a [Case<M>],
    results: Vec<f64>,
    of_one: [f64; 3],
}

impl<'a, M: Registered> Doubles<'a, M> {
    pub(crate) fn new(cases: &'a [Case<M>]) -> Self {
        let program = Program::of::<M>(Target::Exact);
        let function = program.function(Call::EvalHit);
        let double = |case: &Case<M>| {
            let arguments = case.arguments(Call::EvalHit);
            let arguments: Vec<f64> = arguments.into_iter().map(f64::from).collect();
            function.run_double(&arguments).0
        };
        let one = cases.iter().flat_map(|case| case.results(Call::EvalHit));
        let results: Vec<f64> = cases.iter().flat_map(double).collect();
        let of_one = quantiles(&one.collect::<Vec<_>>(), &results);
        Self {
            cases,
            results,
            of_one,
        }
    }

    /// Checks that the errors of `EvalHit` are less than twice those of one lane, and that non-finite arguments of `EvalHit` and
    /// `SampleHit` evaluate to zero. `results` runs one of these two functions.
    pub(crate) fn check(
        &self,
        [eval, sample]: [&Function; 2],
        name: &str,
        results: impl Fn(&Function, &[f32]) -> Vec<f32>,
    ) {
        let inputs = |call| -> Vec<f32> {
            let arguments = self.cases.iter().flat_map(|case| case.arguments(call));
            arguments.collect()
        };
        let evals = results(eval, &inputs(Call::EvalHit));
        let samples = results(sample, &inputs(Call::SampleHit));
        let of_these = quantiles(&evals, &self.results);
        println!("{name}: {of_these:?}, one lane {:?}", self.of_one);
        for (these, one) in of_these.iter().zip(self.of_one) {
            assert!(*these < 2.0 * one.max(1e-6), "{name}");
        }
        // Non-finite directions evaluate to zero.
        let results = evals.chunks(4).zip(samples.chunks(11));
        for (case, (eval, sample)) in self.cases.iter().zip(results) {
            let is_number = |x: &[f32; 3]| x.iter().all(|x| x.is_finite());
            if !is_number(&case.wo) || !is_number(&case.wi) {
                assert_eq!(eval, [0.0; 4], "{name}: {case}");
            }
            if !is_number(&case.wo) || case.xi.iter().any(|x| x.is_nan()) {
                assert_eq!(
                    sample[3..],
                    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0],
                    "{name}: {case}"
                );
            }
        }
    }
}

#[derive(Clone, Copy)]
struct Plain(Host);

impl Visitor for Plain {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Some(driver) = Driver::new(self.0) else {
            return;
        };
        let cases = Case::<M>::many(cases(4096), 45);
        let exact = Doubles::new(&cases);
        for target in self
            .0
            .targets([Target::Gpu, Target::Exact, Target::GpuNative])
        {
            let mut program = Program::of::<M>(target);
            let calls = CALLS.map(|call| program.function(call).clone());
            program.keep(calls.to_vec());
            let module = driver.plain(&program);
            let name = format!("{} {target:?}", program.name());
            let [eval, sample, _] = &calls;
            exact.check([eval, sample], &name, |function, inputs| {
                driver.run(&module, function.name(), function, inputs)
            });
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn plain_shaders_have_the_accuracy_of_one_lane() {
    visit_code_of_models(Plain(Host::Vulkan));
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn shaders_of_a_browser_have_the_accuracy_of_one_lane() {
    visit_code_of_models(Plain(Host::Browser));
}

#[derive(Clone, Copy)]
struct Gradients(Host);

impl Visitor for Gradients {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Some(driver) = Driver::new(self.0) else {
            return;
        };
        let rounding = (self.0 == Host::Vulkan).then(|| driver.rounding());
        for target in self.0.targets([Target::Gpu, Target::Exact, Target::Fused]) {
            let mut program = Program::of::<M>(target);
            let cases = Weighted::both::<M>(&mut program);
            let run = |module: &Path, cases: &Weighted| {
                let (gradient, inputs) = (&cases.gradient, cases.all.concat());
                driver.run(module, gradient.name(), gradient, &inputs)
            };
            let plain = driver.plain(&program);
            let kept = driver.dir.path().join("kept");
            write_words(&kept, &spirv::module(&program).expect("naga accepts it"));
            for cases in &cases {
                let gradient = &cases.gradient;
                let name = format!("{} {} {target:?}", program.name(), gradient.name());
                if driver.kept().contains(&target)
                    && let Some(rounding) = rounding
                {
                    let read = |x| unsigned(driver.compared(target, x));
                    cases.check_bits(&run(&kept, cases), rounding, read, &name);
                }
                cases.check(&run(&plain, cases), &format!("{name} in WGSL"));
            }
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn gradients_of_shaders_are_those_of_differences() {
    visit_code_of_models(Gradients(Host::Vulkan));
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn gradients_in_a_browser_are_those_of_differences() {
    visit_code_of_models(Gradients(Host::Browser));
}
