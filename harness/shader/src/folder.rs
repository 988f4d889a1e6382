//! `hairis shader --out`: writes a folder of models in every language, with an index and examples.

use super::{Source, model};
use crate::args::{Shader, ShaderArithmetic, ShaderTarget};
use clap::ValueEnum as _;
use core::fmt::Write as _;
use hairis_materials::MaterialSpec;
use hairis_program::error::Error;
use hairis_program::files::whole;
use hairis_program::program::print;
use hairis_shaders::{Call, Program, Rounding};
use hairis_variants::ModelId;
use std::collections::BTreeSet;
use std::fs;
use std::io::{ErrorKind, Write as _};
use std::path::Path;

/// README before the table of files. Its title, of any version, distinguishes a folder of this command from others.
const HEAD: &str = include_str!("folder/head.md");
/// README after the table, if there are examples.
const EXAMPLES: &str = include_str!("folder/examples.md");
/// End of the README.
const TAIL: &str = include_str!("folder/tail.md");

/// Program in one language that shades one hair: its file, and how the README says to run it.
struct Example {
    target: ShaderTarget,
    file: &'static str,
    text: &'static str,
    usage: &'static str,
}

const ALL_EXAMPLES: [Example; 3] = [
    Example {
        target: ShaderTarget::C,
        file: "example.c",
        text: include_str!("folder/example.c"),
        usage: include_str!("folder/c.md"),
    },
    Example {
        target: ShaderTarget::Wgsl,
        file: "example.html",
        text: include_str!("folder/example.html"),
        usage: include_str!("folder/webgpu.md"),
    },
    Example {
        target: ShaderTarget::Python,
        file: "example.py",
        text: include_str!("folder/example.py"),
        usage: include_str!("folder/python.md"),
    },
];

/// Writes a file per model and language, `README.md`, and examples unless the flags select some functions only.
///
/// # Errors
///
/// Returns the errors of [`run`](super::run), and [`Error::Usage`] if the folder has files of another origin. Nothing is written unless
/// every model is printed.
pub(super) fn write(
    flags: &Shader,
    materials: &[(String, MaterialSpec)],
    dir: &Path,
) -> Result<(), Error> {
    let models = if flags.model.is_some() || flags.material.is_some() {
        vec![model(flags, materials)?]
    } else {
        models(flags.sampler.as_deref())?
    };
    refuse_others(dir)?;
    let targets = targets(flags);
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    let mut index = HEAD.replace("VERSION", env!("CARGO_PKG_VERSION"));
    let endings = targets
        .iter()
        .map(|target| format!("`.{}`", ending(*target)));
    let _ = writeln!(
        index,
        "| model | sampler | lobes | floats of a material, version | operations of a hit | {} |\n|{}",
        endings.collect::<Vec<_>>().join(" | "),
        "---|".repeat(5 + targets.len())
    );
    let mut first = None;
    for id in models {
        let mut links = String::new();
        let mut row = String::new();
        for target in &targets {
            let (program, text) = id.visit(Source {
                flags,
                target: *target,
                materials,
            })?;
            let file = format!("hairis_{}.{}", program.name(), ending(*target));
            let _ = write!(links, " [{file}]({file}) |");
            files.push((file, text));
            if row.is_empty() {
                row = properties(id, &program);
            }
            first.get_or_insert(program);
        }
        let _ = writeln!(index, "{row}{links}");
    }
    let printed = files.len();
    let first = first.expect("a model and a language");
    if flags.calls.is_empty() && flags.only.is_empty() {
        let fill = |text: &str| {
            let capitals = capitals(first.name());
            let text = text.replace("MODEL", first.name());
            text.replace("TYPE", &capitals).into_bytes()
        };
        let examples = ALL_EXAMPLES
            .iter()
            .filter(|example| targets.contains(&example.target));
        let mut usages = String::new();
        for example in examples {
            files.push((example.file.to_owned(), fill(example.text)));
            usages += example.usage;
        }
        if !usages.is_empty() {
            index += &EXAMPLES.replace("EXPECTED", &expected(&first));
            index += &usages.replace("MODEL", first.name());
        }
    }
    index += TAIL;
    files.push(("README.md".to_owned(), index.into_bytes()));
    fs::create_dir_all(dir).map_err(Error::output(dir))?;
    for (file, text) in &files {
        whole(&dir.join(file), |out| out.write_all(text))?;
    }
    print(format!(
        "{printed} files of source in {}: see {}\n",
        dir.display(),
        dir.join("README.md").display()
    ))
}

/// Rejects a folder whose files this command did not write.
fn refuse_others(dir: &Path) -> Result<(), Error> {
    let mut entries = match fs::read_dir(dir) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        entries => entries.map_err(Error::output(dir))?,
    };
    let readme = fs::read_to_string(dir.join("README.md"));
    if entries.next().is_none() || readme.is_ok_and(|text| is_of_command(&text)) {
        return Ok(());
    }
    Err(Error::Usage(format!(
        "--out must be a new folder, an empty one, or one that this command wrote, got {}, which has other files",
        dir.display()
    )))
}

/// Returns true if a README has the title that this command writes, of any version.
fn is_of_command(readme: &str) -> bool {
    let title = readme.lines().next().unwrap_or_default();
    let version = title
        .strip_prefix("# hairis ")
        .and_then(|rest| rest.strip_suffix(" as source"));
    version.is_some_and(|version| {
        version.starts_with(|c: char| c.is_ascii_digit()) && !version.contains(' ')
    })
}

/// Returns the languages that the flags leave open. SPIR-V needs a feature of the build, and Python another arithmetic than `fused`.
fn targets(flags: &Shader) -> Vec<ShaderTarget> {
    if let Some(target) = flags.target {
        return vec![target];
    }
    let all = ShaderTarget::value_variants().iter().copied();
    let is_open = |target: &ShaderTarget| match target {
        ShaderTarget::Spirv => cfg!(feature = "spirv"),
        ShaderTarget::Python => flags.arithmetic != Some(ShaderArithmetic::Fused),
        _ => true,
    };
    all.filter(is_open).collect()
}

/// Returns the extension of a language's files.
const fn ending(target: ShaderTarget) -> &'static str {
    match target {
        ShaderTarget::C => "h",
        ShaderTarget::Wgsl => "wgsl",
        ShaderTarget::Glsl => "glsl",
        ShaderTarget::Hlsl => "hlsl",
        ShaderTarget::Msl => "metal",
        ShaderTarget::Slang => "slang",
        ShaderTarget::Python => "py",
        ShaderTarget::Spirv => "spv",
    }
}

/// Returns the row of the index up to its links.
fn properties(id: ModelId, program: &Program) -> String {
    let mut functions = program.functions().iter();
    let hit = functions.find(|function| function.name() == Call::EvalHit.name());
    format!(
        "| {} | {} | {} | {}, `{:08x}` | {} |",
        id.name(),
        id.choice().map_or("-", |(_, word)| word),
        id.lobes().join(", "),
        program.material().len(),
        program.layout(),
        hit.map_or("-".to_owned(), |hit| hit.operations().to_string()),
    )
}

/// Returns the lines that the examples print, computed by the interpreter.
fn expected(program: &Program) -> String {
    let run = |call: Call, inputs: &[f32]| program.function(call).run(inputs, Rounding::Once);
    let mut presets = program.presets().iter();
    let brown = presets.find(|preset| preset.name() == "params_brown");
    let params = brown.expect("every model has it").run(&[], Rounding::Once);
    let (wo, h, wi, xi) = ([0.6, 0.8, 0.0], [0.0], [-0.6, 0.64, 0.48], [0.3, 0.6, 0.9]);
    let inputs = [&run(Call::Material, &params)[..], &wo, &h, &wi, &xi].concat();
    let results = run(Call::EvalSampleHit, &inputs);
    let words = |range: core::ops::Range<usize>| {
        let words: Vec<_> = results[range].iter().map(|x| format!("{x:.3}")).collect();
        words.join(" ")
    };
    format!(
        "value {}, pdf {}\nsample {}, weight {}",
        words(0..3),
        words(3..4),
        words(4..7),
        words(11..14)
    )
}

/// Returns the name of a type: `KajiyaKay` for `kajiya_kay`.
fn capitals(name: &str) -> String {
    let capital = |word: &str| {
        let (first, rest) = word.split_at(word.len().min(1));
        first.to_uppercase() + rest
    };
    name.split('_').map(capital).collect()
}

/// Returns the first entry of every name and the `matched` sampler of models that have one. With a word, returns the entries of that word.
fn models(word: Option<&str>) -> Result<Vec<ModelId>, Error> {
    let choice = |id: &ModelId| id.choice().map(|(_, word)| word);
    let has = |id: &ModelId| match word {
        Some(_) => choice(id) == word,
        None => id.is_default() || choice(id) == Some("matched"),
    };
    let models: Vec<_> = ModelId::ALL.iter().copied().filter(has).collect();
    if models.is_empty() {
        let words: BTreeSet<_> = ModelId::ALL.iter().filter_map(choice).collect();
        let words: Vec<_> = words.into_iter().collect();
        return Err(Error::Usage(format!(
            "--sampler must be one of {}, got {:?}",
            words.join(", "),
            word.unwrap_or_default()
        )));
    }
    Ok(models)
}
