//! Tests that the compilers of a language accept the printed source.

use crate::support::{Random, every_model};
use hairis_conformance::is_full;
use hairis_shaders::{Call, Function, Language, Program, Target, driver, print, spirv};
use hairis_variants::Registered;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Traces a model, and adds the derivatives to its functions.
pub(crate) fn with_gradients<M: Registered>(target: Target) -> Program {
    let mut program = Program::of::<M>(target);
    let mut functions = program.functions().to_vec();
    for call in [Call::Eval, Call::EvalHit] {
        functions.push(program.function(call).gradient());
    }
    program.keep(functions);
    program
}

pub(crate) fn write_words(file: &Path, words: &[u32]) {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    fs::write(file, bytes).expect("the folder is ours");
}

/// Runs a tool, and returns its output as the error if it fails. Returns `None` if the tool is not installed.
pub(crate) fn tool(name: &str, arguments: &[&str]) -> Option<Result<(), String>> {
    let Ok(output) = Command::new(name).args(arguments).output() else {
        println!("{name} is not installed: skipped");
        return None;
    };
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    Some(if output.status.success() {
        Ok(())
    } else {
        Err(said)
    })
}

fn check_wgsl<M: Registered>() {
    let all = [Target::Gpu, Target::Exact, Target::GpuNative];
    // Naga takes a second per program, as its own code is not optimised.
    let count = if is_full() { all.len() } else { 1 };
    for target in all.into_iter().take(count) {
        let program = with_gradients::<M>(target);
        let source = print(&program, Language::Wgsl) + &driver(&program, Language::Wgsl);
        if let Err(error) = spirv::translate(&source) {
            panic!("{} {target:?}: {error}", program.name());
        }
    }
}

#[test]
fn naga_accepts_wgsl() {
    every_model!(check_wgsl);
}

/// Compiles the last function of a program in GLSL to SPIR-V.
pub(crate) fn compile_glsl(program: &Program, dir: &Path) -> Option<PathBuf> {
    let (file, out) = (dir.join("main.comp"), dir.join("glsl.spv"));
    let source = print(program, Language::Glsl) + &driver(program, Language::Glsl);
    fs::write(&file, format!("#version 450\n{source}")).expect("the folder is ours");
    let arguments = ["-V", &file.to_string_lossy(), "-o", &out.to_string_lossy()];
    let said = tool("glslangValidator", &arguments)?;
    said.unwrap_or_else(|error| panic!("{}: {error}", program.name()));
    Some(out)
}

/// A fragment shader of ES compiles, and computes in 32 bits.
fn check_fragment_shader(program: &Program, dir: &Path) {
    let file = dir.join("main.frag");
    let source = print(program, Language::Glsl);
    let main = "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n";
    fs::write(&file, format!("#version 320 es\n{source}{main}")).expect("the folder is ours");
    let Ok(tree) = Command::new("glslangValidator")
        .arg("-i")
        .arg(&file)
        .output()
    else {
        return;
    };
    let tree = String::from_utf8_lossy(&tree.stdout);
    let half = ["ERROR", "mediump", "lowp"]
        .into_iter()
        .find(|word| tree.contains(word));
    let lines = || {
        tree.lines()
            .filter(|line| half.is_some_and(|word| line.contains(word)))
    };
    assert!(half.is_none(), "{}: {:?}", program.name(), lines().next());
    assert!(tree.contains("highp"), "{}: {tree}", program.name());
}

/// Returns an HLSL shader whose entry point calls the last function with numbers from a buffer.
fn hlsl(program: &Program) -> String {
    let glsl = driver(program, Language::Glsl);
    let body = glsl
        .split_once("return;\n")
        .expect("a driver checks its range")
        .1;
    let body = body.trim_end().trim_end_matches('}');
    let body = body.replace("vec3", "float3");
    format!(
        "{}StructuredBuffer<float> inputs : register(t0);\nRWStructuredBuffer<float> outputs : register(u1);\n\
         [numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {{\n    uint i = id.x;\n{body}}}\n",
        print(program, Language::Hlsl)
    )
}

/// Compiles the last function of a program in HLSL to SPIR-V.
pub(crate) fn compile_hlsl(program: &Program, dir: &Path) -> Option<PathBuf> {
    let (file, out) = (dir.join("main.hlsl"), dir.join("hlsl.spv"));
    fs::write(&file, hlsl(program)).expect("the folder is ours");
    let [from, to] = [&file, &out].map(|path| path.to_string_lossy());
    let arguments = ["-D", "-V", "-S", "comp", "-e", "main", &from, "-o", &to];
    let said = tool("glslangValidator", &arguments)?;
    said.unwrap_or_else(|error| panic!("{} in HLSL: {error}", program.name()));
    Some(out)
}

fn check_glslang<M: Registered>() {
    let dir = TempDir::new().expect("a folder for shaders");
    let program = with_gradients::<M>(Target::Gpu);
    let Some(compiled) = compile_glsl(&program, dir.path()) else {
        return;
    };
    if let Some(Err(error)) = tool("spirv-val", &[&compiled.to_string_lossy()]) {
        panic!("{} in GLSL: {error}", program.name());
    }
    compile_hlsl(&program, dir.path());
    check_fragment_shader(&program, dir.path());
    for program in [program, with_gradients::<M>(Target::Exact)] {
        let module = spirv::module(&program).expect("naga accepts it");
        let file = dir.path().join("module.spv");
        write_words(&file, &module);
        if let Some(Err(error)) = tool("spirv-val", &[&file.to_string_lossy()]) {
            panic!("{} in SPIR-V: {error}", program.name());
        }
    }
}

#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn glslang_accepts_glsl_and_hlsl() {
    every_model!(check_glslang, visit_code_of_models);
}

fn check_opencl<M: Registered>() {
    let program = Program::of::<M>(Target::Exact);
    let name = program.name();
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    let capitals: String = name.split('_').map(capital).collect();
    // Instructions of the processor: without a library of OpenCL the two functions would be calls.
    let source = format!(
        "#ifdef __NVPTX__\n#define sqrt __nvvm_sqrt_rn_f\n#define fabs __builtin_fabsf\n#endif\n{}\n\
         __kernel void shade(__global const Hairis{capitals}Params *params, __global const float *x,\n    \
         __global Hairis{capitals}Eval *eval, __global Hairis{capitals}Sample *sample) {{\n    \
         const Hairis{capitals}Material m = hairis_{name}_material(*params);\n    \
         const HairisVec3 wo = hairis_vec3(x[0], x[1], x[2]), wi = hairis_vec3(x[4], x[5], x[6]);\n    \
         *eval = hairis_{name}_eval_hit(m, wo, x[3], wi);\n    \
         *sample = hairis_{name}_sample_hit(m, wo, x[3], wi);\n}}\n",
        print(&program, Language::C)
    );
    let dir = TempDir::new().expect("a folder for shaders");
    let [file, out] = ["main.cl", "out"].map(|name| dir.path().join(name));
    fs::write(&file, source).expect("the folder is ours");
    let [file, out] = [file, out].map(|path| path.to_string_lossy().into_owned());
    let compile = |target: &[&str]| {
        let usual = [
            "-x",
            "cl",
            "-cl-std=CL1.2",
            "-O2",
            "-ffp-contract=off",
            "-S",
        ];
        let builtin = [
            "-Xclang",
            "-finclude-default-header",
            "-Wall",
            "-Wextra",
            "-Werror",
        ];
        let files = [&file, "-o", &out];
        let said = tool("clang", &[&usual[..], &builtin, target, &files].concat())?;
        said.unwrap_or_else(|error| panic!("{name} for {target:?}: {error}"));
        Some(fs::read_to_string(&out).expect("the compiler wrote it"))
    };
    compile(&["-target", "spir64", "-emit-llvm"]);
    if let Some(ptx) = compile(&["-target", "nvptx64-nvidia-nvcl"]) {
        assert!(ptx.contains("sqrt.rn.f32"), "{name}: its square roots");
        for word in ["bra", "call", "fma.rn"] {
            let mut lines = ptx.lines().filter(|line| !line.contains("//"));
            let line =
                lines.find(|line| line.split_whitespace().any(|part| part.starts_with(word)));
            assert_eq!(line, None, "{name}: PTX with {word}");
        }
    }
}

/// The C header compiles as `OpenCL` C, and for PTX to code without a branch or a call.
#[test]
#[ignore = "slow: .ci/shaders.sh runs it"]
fn clang_compiles_opencl_and_ptx() {
    every_model!(check_opencl, visit_code_of_models);
}

fn check_arithmetic<M: Registered>() {
    for target in [Target::Exact, Target::Fused, Target::Gpu, Target::GpuNative] {
        let program = with_gradients::<M>(target);
        let [c, wgsl, glsl, hlsl, msl, slang] = [
            Language::C,
            Language::Wgsl,
            Language::Glsl,
            Language::Hlsl,
            Language::Msl,
            Language::Slang,
        ]
        .map(|language| print(&program, language));
        // Sums that round to an integer use the language's rounding function.
        let magic = ["8388608.0", "8388723.0", "8388735.0"];
        let is_magic = |line: &&str| magic.iter().any(|number| line.contains(number));
        for text in [&wgsl, &msl, &slang] {
            for line in text.lines().filter(is_magic) {
                let rounds = line.contains("round(") || line.contains("rint(");
                let is_helper = line.contains("8388735.0; }") || line.contains("8388735.0f; }");
                let subtracts = line.contains("8388723.0f -")
                    || line.contains("8388735.0f -")
                    || line.ends_with(" - 8388735.0f;");
                assert!(
                    rounds || is_helper || subtracts,
                    "sum that compilers take apart: {line}"
                );
            }
        }
        // XLA takes sums apart as well, and derivatives by a framework need to know a step.
        if target != Target::Fused {
            let python = print(&program, Language::Python);
            let sums = python.lines().filter(is_magic);
            let mut sums = sums.filter(|line| line.contains(" + ") || line.contains("fma("));
            let other = sums.find(|line| !line.contains("o.rounded("));
            assert_eq!(other, None, "{}: a step", program.name());
        }
        // Numbers are declared precise, so that compilers keep the order of their arithmetic.
        for text in [&glsl, &hlsl] {
            let numbers = text
                .lines()
                .filter(|line| line.contains(" x") && line.contains(" = "));
            for line in numbers.filter(|line| !line.contains("bool m")) {
                let is_result = line.trim_start().starts_with("result.");
                assert!(
                    is_result || line.contains("precise float x"),
                    "not precise: {line}"
                );
            }
        }
        // Languages without infinity have no literal of it.
        for text in [&wgsl, &c] {
            let mut words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            assert!(
                words.all(|word| !["inf", "inff"].contains(&word)),
                "a literal of infinity"
            );
        }
        // Drivers take `h < 1 || -1 < h` for true, so that the test for NaN is a function.
        let functions = program.functions().iter();
        let tested = functions.flat_map(|function| {
            let (graph, schedule) = (function.graph(), function.schedule());
            let is_test = |place: &u32| graph.tested_number(*place).is_some();
            schedule.into_iter().filter(is_test)
        });
        let tested = tested.count();
        for text in [&wgsl, &glsl, &hlsl, &msl] {
            // The helper occurs once where it is defined, and once each for the second operand of `min` and `max`.
            let found = text.matches("is_number(").count();
            assert_eq!(found, 3 + tested, "{}: tests of numbers", program.name());
        }
        // The language's own functions may return either operand for NaN.
        for line in wgsl.lines() {
            assert!(!line.contains(" min(") && !line.contains(" max("), "{line}");
        }
    }
}

#[test]
fn text_avoids_what_compilers_do() {
    every_model!(check_arithmetic);
}

/// Returns the number of instructions of a kind in a module.
fn count(words: &[u32], op: u32) -> usize {
    let (mut at, mut count) = (5, 0);
    while at < words.len() {
        count += usize::from(words[at] & 0xffff == op);
        at += (words[at] >> 16) as usize;
    }
    count
}

/// Every arithmetic instruction is decorated against reordering, and with exact arithmetic every entry point requires IEEE arithmetic.
#[test]
fn spirv_keeps_the_order_of_arithmetic() {
    for target in [Target::Exact, Target::Gpu] {
        let program = Program::of::<hairis_variants::KajiyaKay>(target);
        let mut source = print(&program, Language::Wgsl);
        source += &driver(&program, Language::Wgsl);
        let plain = spirv::translate(&source).expect("naga accepts it");
        let kept = spirv::module(&program).expect("naga accepts it");
        let arithmetic = |words: &[u32]| -> usize {
            let instructions = [127, 129, 131, 133, 136];
            instructions.iter().map(|op| count(words, *op)).sum()
        };
        assert!(arithmetic(&plain) > 500, "instructions of arithmetic");
        let decorations = count(&plain, 71) + arithmetic(&kept);
        assert_eq!(count(&kept, 71), decorations, "a decoration each");
        let [entry_points, controls] = [15, 17].map(|op| count(&kept, op));
        let modes = count(&kept, 16);
        if target == Target::Gpu {
            assert_eq!((modes, controls), (entry_points, 1), "nothing is asked");
            assert_eq!(kept.len(), plain.len() + 3 * arithmetic(&kept), "no more");
        } else {
            assert_eq!((modes, controls), (4 * entry_points, 4), "three modes each");
        }
    }
}

/// Every literal is read as the float it stands for, by a reader of decimals in double precision.
#[test]
fn literals_are_exact() {
    let mut program = Program::of::<hairis_variants::KajiyaKay>(Target::Exact);
    let mut random = Random(43);
    let len = program.material().len();
    let mut expected = Vec::new();
    let special = [
        f32::MAX,
        f32::MIN_POSITIVE,
        -0.0,
        1e-44,
        16_777_217.0,
        0.1,
        -3.5,
    ];
    for i in 0..40 {
        let numbers: Vec<f32> = (0..len)
            .map(|j| match special.get(i * len + j) {
                Some(special) => *special,
                None => random.range(-1.0, 1.0) * random.range(-120.0, 120.0).exp2(),
            })
            .collect();
        program.add_material(&format!("m{i}"), &numbers);
        expected.extend(numbers);
    }
    program.keep(Vec::new());
    for language in Language::ALL {
        let text = print(&program, language);
        let at = text.find("material_m0").expect("the first material");
        // Words of assignments, and in Python of arguments, that begin as numbers do.
        let words = text[at..].split([' ', '=', '(', ',', ';', '\n']);
        let is_number = |word: &&str| word.starts_with(|c: char| c == '-' || c.is_ascii_digit());
        let literals: Vec<&str> = words
            .filter(|word| is_number(word) && *word != "->")
            .map(|word| word.trim_end_matches('f'))
            .collect();
        assert_eq!(literals.len(), expected.len());
        for (literal, number) in literals.iter().zip(&expected) {
            let read = if literal.contains("0x") {
                from_hexadecimal(literal)
            } else {
                literal.parse().expect("a decimal number")
            };
            #[expect(clippy::cast_possible_truncation, reason = "as compilers do")]
            let single = read as f32;
            assert_eq!(single.to_bits(), number.to_bits(), "{language:?} {literal}");
            // Tint rejects decimals above the largest float.
            assert!(
                language != Language::Wgsl || read == f64::from(*number),
                "{literal}"
            );
        }
    }
}

fn from_hexadecimal(literal: &str) -> f64 {
    let (sign, rest) = match literal.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, literal),
    };
    let (digits, exponent) = rest
        .trim_start_matches("0x")
        .split_once('p')
        .expect("a power");
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let all = u32::from_str_radix(&format!("{whole}{fraction}"), 16).expect("digits");
    let places = i32::try_from(4 * fraction.len()).expect("few digits");
    let exponent: i32 = exponent.parse().expect("an exponent");
    sign * f64::from(all) * f64::from(exponent - places).exp2()
}

fn check_comments<M: Registered>() {
    let program = with_gradients::<M>(Target::Exact);
    for function in program.functions() {
        let graph = function.graph();
        for place in function.schedule() {
            let (name, call) = (program.name(), function.name());
            let stage = graph.origin(place).stage;
            assert!(
                stage.is_some(),
                "{name} {call}: an operation without a stage"
            );
        }
    }
    for language in Language::ALL {
        let text = print(&program, language);
        let sign = if language == Language::Python {
            "        # "
        } else {
            "    // "
        };
        let comments = text.lines().filter(|line| line.starts_with(sign));
        let is_place = |line: &str| line.contains(".rs");
        assert!(
            !comments.clone().any(is_place),
            "{language:?}: a place in Rust"
        );
        assert!(comments.count() > 20, "{language:?}: comments");
    }
}

/// Every operation of every model stands below a comment that states what it computes.
#[test]
fn comments_are_in_the_words_of_the_models() {
    every_model!(check_comments);
}

/// Layouts that differ have versions that differ, so that code that uploads numbers notices a change.
#[test]
fn the_layout_has_a_version() {
    let layouts: Vec<u32> = [
        Program::of::<hairis::Published<hairis::Gaussian>>(Target::Exact).layout(),
        Program::of::<hairis::Matched<hairis::Gaussian>>(Target::Exact).layout(),
        Program::of::<hairis_variants::KajiyaKay>(Target::Exact).layout(),
        Program::of::<hairis_variants::Chiang>(Target::Exact).layout(),
    ]
    .into();
    let mut unique = layouts.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(
        unique.len(),
        layouts.len(),
        "layouts that differ have versions that differ"
    );
    let program = Program::of::<hairis_variants::KajiyaKay>(Target::Gpu);
    assert_eq!(
        program.layout(),
        layouts[2],
        "the layout is that of the model, on every target"
    );
    for language in Language::ALL {
        let text = print(&program, language);
        let before = if language == Language::Python {
            "LAYOUT = "
        } else {
            ""
        };
        assert!(
            text.contains(&format!("{before}{:#010x}", program.layout())),
            "{language:?}"
        );
    }
    let called: Vec<&str> = program.functions().iter().map(Function::name).collect();
    assert_eq!(called, Call::ALL.map(Call::name));
}
