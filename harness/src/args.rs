//! The flags. clap checks them; the number of the shard is checked with the cells, by the command.

use clap::{Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Hair scattering: evaluate it line by line, and compare implementations, models and samplers.
#[derive(Clone, Debug, Parser)]
#[command(name = "hairis", version, arg_required_else_help = false)]
pub struct Args {
    /// The subcommand.
    #[command(subcommand)]
    pub command: Command,
}

const FORMAT: &str = r#"A request. Angles are in radians, directions of unit length in the frame of the fibre:
  {"model":"gaussian"|"cauchy", "sampler":"published"|"matched" (default "published"),
   "params":{"alpha":[R,TT,TRT], "beta":[R,TT,TRT], "gamma_tt":x, "gamma_g":x, "phi_g":x,
             "i_r":[r,g,b], "i_tt":[r,g,b], "i_trt":[r,g,b], "i_g":x},
   "wo":[u,v,w], "wi":[u,v,w]}     or "xi":[lobe,theta,phi] in place of "wi"
The other models, "kajiya-kay" and "chiang", have fields of their own: see harness/src/guide/eval.md. Builds
with the feature `every-sampler` also have the samplers "matched-5" and "matched-25", and "select":"by-channel".

The answer to "wi", and to "xi" (lobe null: discarded, and 0 for the rest):
  {"s":[r,g,b], "pdf":x, "pdf_lobe":[R,TT,TRT-g,glint]}
  {"wi":[u,v,w], "s":[r,g,b], "pdf":x, "pdf_lobe":[R,TT,TRT-g,glint],
   "lobe":"r"|"tt"|"trt"|"glint"|null, "weight":[r,g,b]}

The answer to a refused line, a blank one included, is {"error":"field: problem"}. The other lines still
run, and the exit code is 2."#;

const STUDY: &str = "\
Files in DIR: report.html, and its plots in figures/; study.csv, the rows, which depend on the
seed and the build alone; difference.csv, how different the models look; refitted.csv, the Cauchy
model fitted to each hair; materials.csv, the rows of --model and --material; study.json, the
settings; times.csv and efficiency.csv, which depend on the machine as well. With the features
`parquet` and `png` of the build: study, efficiency and difference as .parquet, the plots as .png.
Finished cells are kept in DIR/cells-I-of-N.jsonl: the same command continues from there.";

const SHADER: &str = "\
Every file has the presets of the model as functions without arguments: hairis_gaussian_material_brown(). `exact` is the
default of c, `gpu` that of the other targets: see variants/shaders/src/guide/generated.md.

  hairis shader --model gaussian --target c > hairis_gaussian.h
  hairis shader --model chiang --target wgsl --call eval_hit --call sample_hit > chiang.wgsl
  hairis shader --material red.json --target glsl --call eval_hit --only value
  hairis shader --out DIR";

const FIT: &str = "\
Standard output has the fitted material, as `hairis eval` reads it. Files in DIR: fitted.json, the same; fit.json, the distance by
view, by lobe and by start; report.html, and its plots in figures/. The same flags give the same values.

  hairis fit --from gaussian --preset brown --to cauchy > soft.json
  hairis fit --material mine.json --to chiang --norm l2 --fix eta";

/// The subcommands, each with its flags.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Evaluate JSON Lines: one request per line on standard input, one answer per line on standard output
    #[command(after_help = FORMAT)]
    Eval(Eval),
    /// Compare scalar code with eight lanes and the Gaussian model with the all-Cauchy one: speed, agreement, variance
    Compare(Compare),
    /// Measure every sampler of both models under every light over the whole parameter grid; an interrupted run
    /// continues
    #[command(after_help = STUDY)]
    Study(Study),
    /// Compare each claim of the paper with figures: true, true within limits, or false
    Claims(Claims),
    /// Print a model as source of another language, which needs no other file
    #[command(after_help = SHADER)]
    Shader(Shader),
    /// Find the parameters of a model whose look is nearest to that of another, and print them
    #[command(after_help = FIT)]
    Fit(Fit),
    /// Join the parts of a study that ran in shards into the same tables as one run
    Merge(Merge),
}

/// Flags of `hairis eval`.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Eval {
    /// The code path that computes the answers
    #[arg(long, value_enum, default_value_t = CodePath::X8)]
    pub path: CodePath,
}

/// Code path of `hairis eval`. All give the same fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CodePath {
    /// One direction per call, in single precision
    Scalar,
    /// Eight lines per call, in single precision: eight materials and shading points, one per lane
    X8,
    /// Slices, in single precision: neighbouring lines on the same hair with the same wo share a call
    Batch,
    /// The formulas line by line, in double precision, on the input as it is: the other paths round it
    F64,
}

/// Flags of `hairis compare`.
#[derive(Clone, Debug, clap::Args)]
pub struct Compare {
    /// A short run, of less than 40 seconds
    #[arg(long)]
    pub quick: bool,
    /// Seed of everything that is drawn; results but for the timings depend on it alone
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder for compare.json, report.html and figures/; made if missing
    #[arg(long, value_name = "DIR", default_value = "out/compare")]
    pub out: PathBuf,
    /// Environment light, latitude-longitude, as a .hdr or .exr file [default: a procedural sky]
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Layer of the .exr environment [default: the only one with colour]
    #[arg(long, value_name = "NAME", requires = "env")]
    pub layer: Option<String>,
    /// Model of the registry to measure, each of its presets with every sampler; may be repeated
    #[arg(long, value_name = "NAME")]
    pub model: Vec<String>,
    /// Material to measure likewise, in the JSON of `hairis eval`; may be repeated
    #[arg(long, value_name = "FILE")]
    pub material: Vec<PathBuf>,
}

/// Flags of `hairis study`.
#[derive(Clone, Debug, clap::Args)]
pub struct Study {
    /// A few cells and samples, in less than two minutes
    #[arg(long)]
    pub quick: bool,
    /// Seed of everything that is drawn; rows depend on it alone
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder for the results; made if missing. Shards may share it
    #[arg(long, value_name = "DIR", default_value = "out/study")]
    pub out: PathBuf,
    /// Environment light, latitude-longitude, as a .hdr or .exr file [default: a procedural sky]
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Layer of the .exr environment [default: the only one with colour]
    #[arg(long, value_name = "NAME", requires = "env")]
    pub layer: Option<String>,
    /// Model of the registry to measure beside the hair of the grid, each of its presets with every sampler; may be repeated
    #[arg(long, value_name = "NAME")]
    pub model: Vec<String>,
    /// Material to measure likewise, in the JSON of `hairis eval`; may be repeated
    #[arg(long, value_name = "FILE")]
    pub material: Vec<PathBuf>,
    /// Compute only part I of N (I from 1 to N), for `hairis merge` to join
    #[arg(
        long,
        value_name = "I/N",
        default_value = "1/1",
        hide_default_value = true
    )]
    pub shard: String,
}

/// Flags of `hairis claims`.
#[derive(Clone, Debug, clap::Args)]
pub struct Claims {
    /// A few cells and samples, in less than 30 seconds
    #[arg(long)]
    pub quick: bool,
    /// Seed of everything that is drawn; results but for the timings depend on it alone
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder for claims.json; made if missing. A study that finishes in the same folder shows the verdicts in its report
    #[arg(long, value_name = "DIR", default_value = "out/study")]
    pub out: PathBuf,
}

/// Flags of `hairis shader`.
#[derive(Clone, Debug, clap::Args)]
pub struct Shader {
    /// Name of the model, as in `hairis eval` [default: that of the material]
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
    /// Add the materials of this file, JSON as `hairis eval` reads, as functions named after it
    #[arg(long, value_name = "FILE")]
    pub material: Option<PathBuf>,
    /// Scale every material so that it returns no more light than it receives
    #[arg(long)]
    pub conserving: bool,
    /// Rounding of products and sums [default: exact for c, gpu for the others]
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

/// Flags of `hairis fit`.
#[derive(Clone, Debug, clap::Args)]
pub struct Fit {
    /// Name of the model that is fitted to
    #[arg(
        long,
        value_name = "NAME",
        required_unless_present = "material",
        conflicts_with = "material"
    )]
    pub from: Option<String>,
    /// Preset of that model [default: its first]
    #[arg(long, value_name = "NAME", requires = "from")]
    pub preset: Option<String>,
    /// Material that is fitted to, in the JSON of `hairis eval`, in place of --from
    #[arg(long, value_name = "FILE")]
    pub material: Option<PathBuf>,
    /// Fit to many looks of --from in place of one: DIR gets fits.csv, and standard output a table
    #[arg(long, value_enum, conflicts_with_all = ["preset", "material"], requires = "from")]
    pub over: Option<FitOver>,
    /// Name of the model whose parameters are wanted
    #[arg(long, value_name = "NAME")]
    pub to: String,
    /// Norm of the difference of `S cos theta_i`
    #[arg(long, value_enum, default_value_t = FitNorm::L1)]
    pub norm: FitNorm,
    /// Inclination of a view, in degrees; may be repeated [default: eight views of equal solid angle]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub theta_o_deg: Vec<f64>,
    /// Weight of each view of --theta-o-deg, in their order; ratios alone count [default: 1 each]
    #[arg(long, value_name = "X", requires = "theta_o_deg")]
    pub weight: Vec<f64>,
    /// Field of the second model that keeps its value of the start; may be repeated
    #[arg(long, value_name = "FIELD")]
    pub fix: Vec<String>,
    /// Number of starts: the first has the values of the first model, or is the first preset
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u8).range(1..))]
    pub starts: u8,
    /// Seed of the directions and of the starts
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder for the results; made if missing
    #[arg(long, value_name = "DIR", default_value = "out/fit")]
    pub out: PathBuf,
}

/// Looks of `hairis fit --over`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FitOver {
    /// Every preset of the model
    Presets,
    /// Hair of the grid of `hairis study --quick`, from its inclinations
    Quick,
    /// Hair of the whole grid
    Full,
}

/// Norm of `hairis fit`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FitNorm {
    /// Light that is reflected elsewhere, not at all, or in addition
    L1,
    /// Root mean square, in which peaks count more
    L2,
    /// L1 after a blur of 10 degrees
    Blurred,
}

/// Arguments of `hairis merge`.
#[derive(Clone, Debug, clap::Args)]
pub struct Merge {
    /// Folder for the results; made if missing
    #[arg(value_name = "OUT_DIR")]
    pub out: PathBuf,
    /// Folders that hold the parts; one may hold several
    #[arg(value_name = "PART_DIR", required = true)]
    pub parts: Vec<PathBuf>,
    /// Environment light of the parts, to time its look-up [default: the procedural sky if the parts used it, else no times]
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Layer of the .exr environment [default: the only one with colour]
    #[arg(long, value_name = "NAME", requires = "env")]
    pub layer: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_command_overwrites_the_report_of_another() {
        let out = |command| match Args::try_parse_from(["hairis", command])
            .expect("no flag is required")
            .command
        {
            Command::Compare(Compare { out, .. })
            | Command::Study(Study { out, .. })
            | Command::Claims(Claims { out, .. }) => out,
            command => panic!("{command:?} writes no report"),
        };
        assert_ne!(out("compare"), out("study"), "both write a report.html");
        assert_eq!(
            out("claims"),
            out("study"),
            "the report of the study shows the verdicts"
        );
    }
}
