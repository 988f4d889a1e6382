//! Time of the generated calls on an NVIDIA GPU, and of the papers' formulas beside them.
//!
//! `cargo bench -p hairis-benches --bench cuda` prints a record. It compiles the C header of each model by nvcc, with several kinds of
//! arithmetic and several flags, and times their kernels in turns. Each variant is first compared with the first of its model.

use core::fmt::Write as _;
use core::sync::atomic::{AtomicUsize, Ordering};
use hairis_shaders::{Call, Function, Language, Program, Target, print};
use hairis_variants::ModelId;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs, thread};

/// Kinds of arithmetic, with flags of nvcc. The first has the bits of one lane.
const VARIANTS: [(&str, Target, &[&str]); 6] = [
    ("exact", Target::Exact, &["-fmad=false"]),
    ("exact default", Target::Exact, &[]),
    ("fused", Target::Fused, &["-fmad=false"]),
    ("fused fast", Target::Fused, &["-use_fast_math"]),
    ("gpu-native", Target::GpuNative, &[]),
    ("gpu-native fast", Target::GpuNative, &["-use_fast_math"]),
];

/// Models whose formulas are beside this file, and the lines before each.
const PORTS: [(ModelId, &str); 4] = [
    (ModelId::Gaussian, "#include \"port_published.cuh\"\n"),
    (
        ModelId::Cauchy,
        "#define PORT_CAUCHY\n#include \"port_published.cuh\"\n",
    ),
    (ModelId::KajiyaKay, "#include \"port_kajiya_kay.cuh\"\n"),
    (ModelId::Chiang, "#include \"port_chiang.cuh\"\n"),
];

/// Directions per shading point of `eval`, as in `bench.cuh`.
const DIRECTIONS: usize = 16;

/// Flags of the ports.
const PORT_VARIANTS: [(&str, &[&str]); 2] = [("port", &[]), ("port fast", &["-use_fast_math"])];

const FILES: [(&str, &str); 6] = [
    ("bench.cuh", include_str!("cuda/bench.cuh")),
    ("kernels.cuh", include_str!("cuda/kernels.cuh")),
    ("port.cuh", include_str!("cuda/port.cuh")),
    ("port_chiang.cuh", include_str!("cuda/port_chiang.cuh")),
    (
        "port_kajiya_kay.cuh",
        include_str!("cuda/port_kajiya_kay.cuh"),
    ),
    (
        "port_published.cuh",
        include_str!("cuda/port_published.cuh"),
    ),
];

/// A file of kernels, and where its table is listed.
struct Unit {
    model: String,
    variant: &'static str,
    table: String,
    source: String,
    flags: &'static [&'static str],
}

impl Unit {
    /// The functions of a program, then `before`, and the kernels that call what begins with `call` and with `of`.
    fn new(
        program: &Program,
        id: ModelId,
        (variant, flags): (&'static str, &'static [&'static str]),
        [before, call, of]: [&str; 3],
    ) -> Self {
        let model = program.name().to_owned();
        let table = format!("{model}_{}", variant.replace([' ', '-'], "_"));
        let preset = id.presets().next().expect("a model has a preset").0;
        let operations = |call: &str| {
            let functions = program.functions();
            let function = functions.iter().find(|function| function.name() == call);
            function.map_or(0, Function::operations)
        };
        let each = operations("eval") + operations("prepare") / DIRECTIONS;
        let [eval, sample, both, gradient] = [
            "eval_hit",
            "sample_hit",
            "eval_sample_hit",
            "eval_hit_gradient",
        ]
        .map(operations);
        let source = format!(
            "#include \"bench.cuh\"\n{}#define NAME {table}\n\
             #define OPERATIONS {eval}, {sample}, {both}, {each}, {gradient}\n\
             #define PRESET hairis_{model}_params_{}\n#define CALL(name) {call}##name\n\
             #define TYPE(name) {of}##name\n{before}#include \"kernels.cuh\"\n",
            print(program, Language::C),
            preset.replace('-', "_"),
        );
        Self {
            model,
            variant,
            table,
            source,
            flags,
        }
    }

    fn object(&self, dir: &Path) -> PathBuf {
        dir.join(&self.table).with_extension("o")
    }
}

/// The program with the calls that are timed, and a gradient.
fn traced(id: ModelId, target: Target) -> Program {
    let mut program = Program::of_id(id, target);
    let calls = [
        Call::Material,
        Call::Prepare,
        Call::Eval,
        Call::EvalHit,
        Call::SampleHit,
        Call::EvalSampleHit,
    ];
    let mut functions: Vec<Function> = calls.map(|call| program.function(call).clone()).into();
    functions.push(program.function(Call::EvalHit).gradient());
    program.keep(functions);
    program
}

fn units() -> Vec<Unit> {
    let mut units = Vec::new();
    for id in ModelId::ALL.iter().copied() {
        let mut pascal = String::new();
        for (variant, target, flags) in VARIANTS {
            let program = traced(id, target);
            pascal = (program.name().split('_'))
                .map(|word| word[..1].to_uppercase() + &word[1..])
                .collect();
            let [call, of] = [
                format!("hairis_{}_", program.name()),
                format!("Hairis{pascal}"),
            ];
            let parts = ["#define GRADIENT\n", &call, &of];
            units.push(Unit::new(&program, id, (variant, flags), parts));
        }
        if let Some((_, port)) = PORTS.iter().find(|(model, _)| *model == id) {
            let mut program = traced(id, Target::Exact);
            // The function that reads parameters declares them and the presets.
            program.keep(vec![program.function(Call::Material).clone()]);
            let before = format!("#define TYPE_OF_PARAMS Hairis{pascal}Params\n{port}");
            let parts = [before.as_str(), "port_", "Port"];
            units.extend(PORT_VARIANTS.map(|variant| Unit::new(&program, id, variant, parts)));
        }
    }
    units
}

/// First line that a program prints, or its last. `None` if it cannot be run.
fn line(program: &str, arguments: &[&str], is_last: bool) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = if is_last {
        text.lines().next_back()
    } else {
        text.lines().next()
    };
    output
        .status
        .success()
        .then(|| line.unwrap_or_default().to_owned())
}

fn nvcc(dir: &Path, arguments: &[&str]) -> Result<(), String> {
    let output = Command::new("nvcc")
        .arg("-O3")
        .arg("-arch=native")
        .arg("-I")
        .arg(dir)
        .args(arguments)
        .output()
        .map_err(|error| error.to_string())?;
    if output.status.success() {
        Ok(())
    } else {
        Err(String::from_utf8_lossy(&output.stderr).into_owned())
    }
}

/// Writes and compiles the units and the program, on every core.
fn build(dir: &Path, units: &[Unit]) -> Result<PathBuf, String> {
    let write = |name: &str, text: &str| {
        fs::write(dir.join(name), text).map_err(|error| format!("{name}: {error}"))
    };
    for (name, text) in FILES {
        write(name, text)?;
    }
    let mut list = String::new();
    for Unit { table, .. } in units {
        let _ = writeln!(list, "extern \"C\" const Entry {table}[5];");
    }
    list += "#define VARIANTS";
    for Unit {
        model,
        variant,
        table,
        ..
    } in units
    {
        let _ = write!(list, " \\\n    X(\"{model}\", \"{variant}\", {table})");
    }
    write("variants.cuh", &(list + "\n"))?;
    write("main.cu", include_str!("cuda/main.cu"))?;
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(unit) = units.get(next.fetch_add(1, Ordering::Relaxed)) {
            let name = format!("{}.cu", unit.table);
            write(&name, &unit.source)?;
            let [from, to] = [dir.join(&name), unit.object(dir)];
            let [from, to] = [&from, &to].map(|path| path.to_string_lossy());
            nvcc(dir, &[unit.flags, &["-c", &from, "-o", &to]].concat())?;
        }
        Ok(())
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let all: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let done = all
            .into_iter()
            .map(|thread| thread.join().expect("no panic"));
        done.collect::<Result<Vec<()>, String>>()
    })?;
    let program = dir.join("main");
    let mut paths = vec![dir.join("main.cu")];
    paths.extend(units.iter().map(|unit| unit.object(dir)));
    let mut arguments: Vec<_> = paths.iter().map(|path| path.to_string_lossy()).collect();
    arguments.extend(["-o".into(), program.to_string_lossy()]);
    let arguments: Vec<&str> = arguments.iter().map(AsRef::as_ref).collect();
    nvcc(dir, &arguments)?;
    Ok(program)
}

fn main() -> ExitCode {
    // Cargo runs benches as tests, too: few hits then.
    let is_bench = env::args().any(|word| word == "--bench");
    let gpu = line(
        "nvidia-smi",
        &["--query-gpu=name,driver_version", "--format=csv,noheader"],
        false,
    );
    let (Some(gpu), Some(compiler)) = (gpu, line("nvcc", &["--version"], true)) else {
        println!("no GPU, or no nvcc: nothing is timed");
        return ExitCode::SUCCESS;
    };
    println!("# GPU: {}", gpu.replace(", ", ", driver "));
    println!("# nvcc: {compiler}");
    let dir = env::temp_dir().join(format!("hairis-cuda-{}", std::process::id()));
    let done = fs::create_dir_all(&dir)
        .map_err(|error| error.to_string())
        .and_then(|()| build(&dir, &units()))
        .and_then(|program| {
            let [hits, rounds] = if is_bench {
                ["16777216", "21"]
            } else {
                ["65536", "1"]
            };
            let status = Command::new(program).args([hits, rounds]).status();
            match status.map_err(|error| error.to_string())? {
                status if status.success() => Ok(()),
                status => Err(format!("the program that times ended with {status}")),
            }
        });
    let _ = fs::remove_dir_all(&dir);
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
