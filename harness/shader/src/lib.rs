//! `hairis shader`: prints a model as source of another language. The functions of its binary, `hairis-shader`.

pub mod args;
mod folder;
#[cfg(any(doc, doctest))]
pub mod guide;

use args::{Shader, ShaderArithmetic, ShaderCall, ShaderTarget};
use hairis::Material;
use hairis_materials::MaterialSpec;
use hairis_materials::material::{find_model, find_sampler};
use hairis_program::error::Error;
use hairis_program::program::print;
use hairis_shaders::{Call, Function, Language, Program, Target, check_name, numbers};
use hairis_variants::{ModelId, Parameters, Registered, Values, Visitor};
use std::fs;
use std::path::Path;

/// Name that stands for the functions of dual scattering in place of a model's.
const DUAL: &str = "dual-scattering";

/// Prints one model on standard output, or writes models into a folder.
///
/// # Errors
///
/// Returns [`Error::Usage`] if there is no such model, field or material, and [`Error::Write`] or [`Error::Output`] if the output fails.
pub fn run(flags: &Shader) -> Result<(), Error> {
    let materials = flags.material.as_deref().map_or(Ok(Vec::new()), read)?;
    if let Some(dir) = &flags.out {
        return folder::write(flags, &materials, dir);
    }
    let Some(target) = flags.target else {
        return Err(Error::Usage("--target must name a language".to_owned()));
    };
    if flags.model.as_deref() == Some(DUAL) {
        return print(dual_scattering(flags, target, &materials)?);
    }
    let id = model(flags, &materials)?;
    let (_, text) = id.visit(Source {
        flags,
        target,
        materials: &materials,
    })?;
    print(text)
}

/// Reads the materials of a file, each with the name of its function: that of the file, in lower case and with underscores for separators.
fn read(file: &Path) -> Result<Vec<(String, MaterialSpec)>, Error> {
    let refuse =
        |problem: String| Error::Usage(format!("--material {}: {problem}", file.display()));
    let text = fs::read_to_string(file).map_err(|error| refuse(error.to_string()))?;
    let materials = MaterialSpec::parse_all(&text).map_err(refuse)?;
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let stem = stem.replace([' ', '-', '.'], "_").to_ascii_lowercase();
    let is_single = materials.len() == 1;
    let named = |(place, material): (usize, MaterialSpec)| {
        let name = if is_single {
            stem.clone()
        } else {
            format!("{stem}_{place}")
        };
        check_name(&name).map_err(|problem| refuse(format!("{problem}; rename the file")))?;
        Ok((name, material))
    };
    (1..).zip(materials).map(named).collect()
}

/// Returns the entry of the registry that the flags and the materials name.
fn model(flags: &Shader, materials: &[(String, MaterialSpec)]) -> Result<ModelId, Error> {
    let first = materials.first().map(|(_, material)| material.model);
    let name = flags.model.as_deref().or(first.map(ModelId::name));
    let name = name.unwrap_or_default();
    let of_name = find_model(name).map_err(|problem| Error::Usage(format!("--model {problem}")))?;
    if let Some((_, other)) = materials
        .iter()
        .find(|(_, material)| material.model.name() != name)
    {
        let other = other.model.name();
        return Err(Error::Usage(format!(
            "--material must be of the model {name}, got one of {other}"
        )));
    }
    let Some(word) = &flags.sampler else {
        return Ok(if flags.model.is_none() {
            first.unwrap_or(of_name)
        } else {
            of_name
        });
    };
    find_sampler(of_name, word).map_err(|problem| Error::Usage(format!("--sampler {problem}")))
}

/// Visitor that prints a model and returns the program and its source.
struct Source<'a> {
    flags: &'a Shader,
    target: ShaderTarget,
    materials: &'a [(String, MaterialSpec)],
}

impl Visitor for Source<'_> {
    type Output = Result<(Program, Vec<u8>), Error>;

    fn visit<M: Registered>(self) -> Self::Output {
        let flags = self.flags;
        let arithmetic = arithmetic(flags, self.target)?;
        let mut program = Program::of_id(ModelId::of::<M>(), arithmetic);
        let functions = functions(flags, &program)?;
        for (name, _) in self.materials {
            refuse_taken(flags, &program, &functions, name)?;
        }
        let mut add = |name: &str, params: M::Params| -> Result<(), Error> {
            let scale = if flags.conserving {
                Material::new(&M::MODEL, &params).conserving_scale()
            } else {
                1.0
            };
            let params = params.scaled(scale)?;
            program.add_material(name, &numbers(&M::MODEL.material(&params)));
            Ok(())
        };
        if flags.conserving {
            for (name, params) in M::Params::PRESETS {
                add(
                    &name.replace('-', "_"),
                    M::Params::from_values(&params.values())?,
                )?;
            }
        }
        for (name, material) in self.materials {
            let values: &Values = &material.values;
            add(name, M::Params::from_values(values)?)?;
        }
        program.keep(functions);
        let text = source(&program, self.target)?;
        Ok((program, text))
    }
}

/// Returns the arithmetic that the flags ask for.
fn arithmetic(flags: &Shader, target: ShaderTarget) -> Result<Target, Error> {
    Ok(match (flags.arithmetic, target) {
        (Some(ShaderArithmetic::Exact), _) | (None, ShaderTarget::C) => Target::Exact,
        (Some(ShaderArithmetic::Fused), ShaderTarget::Python) => {
            return Err(Error::Usage(
                "--arithmetic must be exact, gpu or gpu-native for python, whose frameworks have no fma that rounds once, got fused"
                    .to_owned(),
            ));
        }
        (Some(ShaderArithmetic::Fused), _) => Target::Fused,
        (Some(ShaderArithmetic::GpuNative), _) | (None, ShaderTarget::Python) => Target::GpuNative,
        (Some(ShaderArithmetic::Gpu), _) | (None, _) => Target::Gpu,
    })
}

/// Returns a program in a language.
fn source(program: &Program, target: ShaderTarget) -> Result<Vec<u8>, Error> {
    let language = match target {
        ShaderTarget::C => Language::C,
        ShaderTarget::Wgsl => Language::Wgsl,
        ShaderTarget::Glsl => Language::Glsl,
        ShaderTarget::Hlsl => Language::Hlsl,
        ShaderTarget::Msl => Language::Msl,
        ShaderTarget::Slang => Language::Slang,
        ShaderTarget::Python => Language::Python,
        ShaderTarget::Spirv => return spirv(program),
    };
    Ok(hairis_shaders::print(program, language).into_bytes())
}

/// Returns the functions of dual scattering, with the averages of each material.
fn dual_scattering(
    flags: &Shader,
    target: ShaderTarget,
    materials: &[(String, MaterialSpec)],
) -> Result<Vec<u8>, Error> {
    let of_models = [
        ("--call", !flags.calls.is_empty()),
        ("--only", !flags.only.is_empty()),
        ("--gradient", flags.gradient),
        ("--sampler", flags.sampler.is_some()),
    ];
    if let Some((flag, _)) = of_models.iter().find(|(_, is_given)| *is_given) {
        return Err(Error::Usage(format!(
            "{flag} must be left out with --model {DUAL}, which has functions of its own"
        )));
    }
    let mut program = Program::dual_scattering(arithmetic(flags, target)?);
    for (name, material) in materials {
        let material = material.model.material(&material.values)?;
        let material = if flags.conserving {
            material.conserving()
        } else {
            material
        };
        program.add_dual_material(name, &material.dual_scattering());
    }
    source(&program, target)
}

#[cfg(feature = "spirv")]
fn spirv(program: &Program) -> Result<Vec<u8>, Error> {
    let words = hairis_shaders::spirv::module(program).map_err(Error::Usage)?;
    Ok(words.into_iter().flat_map(u32::to_le_bytes).collect())
}

#[cfg(not(feature = "spirv"))]
fn spirv(_: &Program) -> Result<Vec<u8>, Error> {
    Err(Error::Usage(
        "--target spirv needs a build with `--features spirv`: cargo build --release -p hairis-shader --features spirv".to_owned(),
    ))
}

/// Rejects a material whose function would have the name of another function.
fn refuse_taken(
    flags: &Shader,
    program: &Program,
    functions: &[Function],
    name: &str,
) -> Result<(), Error> {
    let name = format!("material_{name}");
    let is_taken = |by: &[Function]| by.iter().any(|function| function.name() == name);
    let by = if is_taken(program.materials()) {
        "a preset"
    } else if is_taken(functions) {
        "another function"
    } else {
        return Ok(());
    };
    let file = flags.material.as_deref().unwrap_or(Path::new(""));
    Err(Error::Usage(format!(
        "--material must have a name of its own, got {}: {name} is {by}; rename the file",
        file.display()
    )))
}

/// Returns the functions that the flags name.
fn functions(flags: &Shader, program: &Program) -> Result<Vec<Function>, Error> {
    let calls = flags.calls.iter().map(|call| match call {
        ShaderCall::Material => Call::Material,
        ShaderCall::Prepare => Call::Prepare,
        ShaderCall::Eval => Call::Eval,
        ShaderCall::Sample => Call::Sample,
        ShaderCall::Lobes => Call::Lobes,
        ShaderCall::EvalHit => Call::EvalHit,
        ShaderCall::SampleHit => Call::SampleHit,
        ShaderCall::EvalSampleHit => Call::EvalSampleHit,
    });
    let mut calls: Vec<Call> = calls.collect();
    if calls.is_empty() {
        calls.extend(Call::ALL);
    }
    let only: Vec<&str> = flags.only.iter().map(String::as_str).collect();
    let mut functions: Vec<Function> = Vec::new();
    for call in calls {
        let whole = program.function(call);
        if functions.iter().any(|known| known.name() == whole.name()) {
            continue;
        }
        let function = if only.is_empty() {
            whole.clone()
        } else {
            match whole.only(&only) {
                Some(function) => function,
                None if flags.calls.is_empty() => continue,
                None => {
                    let fields: Vec<_> = whole
                        .output()
                        .fields
                        .iter()
                        .map(|field| field.name.as_str())
                        .collect();
                    let (name, fields) = (whole.name(), fields.join(", "));
                    return Err(Error::Usage(format!(
                        "--only must be fields of {name}: {fields}, got {}",
                        only.join(", ")
                    )));
                }
            }
        };
        let gradient = (flags.gradient
            && matches!(call, Call::Material | Call::Eval | Call::EvalHit))
        .then(|| function.gradient());
        functions.push(function);
        functions.extend(gradient);
    }
    if functions.is_empty() {
        return Err(Error::Usage(format!(
            "--only must be fields of a function's result, got {}",
            only.join(", ")
        )));
    }
    Ok(functions)
}
