//! The flags, which clap checks.

use clap::{Parser, ValueEnum};
use std::path::PathBuf;

const SHADER: &str = "\
Every file has the presets of the model as functions without arguments: hairis_gaussian_material_brown(). `exact` is the
default of c, `gpu-native` of python, and `gpu` of the other targets: see variants/shaders/src/guide/generated.md.

  hairis shader --model gaussian --target c > hairis_gaussian.h
  hairis shader --model chiang --target wgsl --call eval_hit --call sample_hit > chiang.wgsl
  hairis shader --material red.json --target glsl --call eval_hit --only value
  hairis shader --model dual-scattering --material red.json --conserving --target wgsl
  hairis shader --out DIR";

/// Print a model as source of another language, which needs no other file
#[derive(Clone, Debug, Parser)]
#[command(name = "hairis-shader", bin_name = "hairis shader", version, after_help = SHADER)]
pub struct Shader {
    /// Name of the model, as in `hairis eval`, or dual-scattering for multiple scattering by the averages of materials of any model
    /// [default: that of the material]
    #[arg(long, value_name = "NAME", required_unless_present_any = ["material", "out"])]
    pub model: Option<String>,
    /// Word of the model's sampler, or of chiang's `select`, as in `hairis eval` [default: the first]
    #[arg(long, visible_alias = "select", value_name = "WORD")]
    pub sampler: Option<String>,
    /// The language
    #[arg(long, value_enum, required_unless_present = "out")]
    pub target: Option<ShaderTarget>,
    /// Print this function alone; may be given several times [default: all]
    #[arg(long = "call", value_name = "CALL", value_enum)]
    pub calls: Vec<ShaderCall>,
    /// Compute this field of the results alone, and nothing that others need; may be given several times
    #[arg(long, value_name = "FIELD")]
    pub only: Vec<String>,
    /// Print the gradients of `material`, `eval` and `eval_hit` as well
    #[arg(long)]
    pub gradient: bool,
    /// Add the materials of this file, JSON as `hairis eval` reads, as functions named after it: letters a to z, digits, and one `_`, `-`, `.`
    /// or space between words
    #[arg(long, value_name = "FILE")]
    pub material: Option<PathBuf>,
    /// Scale every material so that it returns no more light than it receives
    #[arg(long)]
    pub conserving: bool,
    /// Rounding of products and sums [default: exact for c, gpu-native for python, gpu for the others]
    #[arg(long, value_enum)]
    pub arithmetic: Option<ShaderArithmetic>,
    /// Write a folder in place of standard output: a file for each model and language that the other flags leave open, a README and
    /// examples; made if missing
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Language of `hairis shader`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShaderTarget {
    /// C99, C++, CUDA and `OpenCL` C in one header
    C,
    /// WGSL, of WebGPU
    Wgsl,
    /// GLSL 4.00 or 3.20 ES
    Glsl,
    /// HLSL from shader model 5
    Hlsl,
    /// The Metal shading language
    Msl,
    /// Slang, whose compiler differentiates the functions
    Slang,
    /// Python over arrays of `NumPy`, JAX, `PyTorch` or Dr.Jit, which differentiate it
    Python,
    /// SPIR-V, a compute shader per function over arrays; needs a build with the feature `spirv`
    Spirv,
}

/// Function of `hairis shader`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum ShaderCall {
    /// Constants of a material, from its parameters
    Material,
    /// Constants of a shading point
    Prepare,
    /// Value and density of a shading point at a direction
    Eval,
    /// Sampled direction of a shading point
    Sample,
    /// Value, colour and density of each lobe
    Lobes,
    /// `prepare` and `eval` in one
    EvalHit,
    /// `prepare` and `sample` in one
    SampleHit,
    /// `prepare`, `eval` and `sample` in one
    EvalSampleHit,
}

/// Arithmetic of `hairis shader`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShaderArithmetic {
    /// Products and sums round apart: the bits of one lane
    Exact,
    /// Products with sums round once: the bits of AVX2
    Fused,
    /// Products with sums round once or twice
    Gpu,
    /// Likewise, with the target's powers and logarithms to the base 2
    GpuNative,
}
