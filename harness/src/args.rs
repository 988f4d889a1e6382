//! The flags, which clap checks.

use clap::{Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;

/// Text that `hairis` prints without arguments.
pub const ENTRANCE: &str = "\
hairis evaluates models of light scattered by hair, and measures what samplers
and SIMD are worth.

  eval      values, densities and samples of any model, from lines of JSON
  compare   speed, accuracy and variance on this machine: 20 s with --quick
  shader    a model as source of C, WGSL, GLSL, HLSL, Metal, Slang and others
  referee   what is right and wrong in the hair of another program
  fit       the parameters of one model whose look is nearest to that of another
  study     every sampler on a grid of hair and views; merge joins its parts
  claims    what the paper claims, each claim with figures

Try:
  hairis eval --example gaussian | hairis eval
  hairis compare --quick
  hairis shader --model gaussian --target wgsl

hairis COMMAND --help lists the flags of a command.
";

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
The other models, "kajiya-kay", "chiang" and "d-eon", have fields of their own: see harness/src/guide/eval.md. Builds
with the feature `every-sampler` also have the samplers "matched-5" and "matched-25", "select":"by-channel", and the
models "gaussian-diffuse", "cauchy-diffuse", "chiang-diffuse" and "chiang-scattering".

The answer to "wi", and to "xi" (lobe null: discarded, and 0 for the rest):
  {"s":[r,g,b], "pdf":x, "pdf_lobe":[R,TT,TRT-g,glint]}
  {"wi":[u,v,w], "s":[r,g,b], "pdf":x, "pdf_lobe":[R,TT,TRT-g,glint],
   "lobe":"r"|"tt"|"trt"|"glint"|null, "weight":[r,g,b]}

The answer to a refused line, a blank one included, is {"error":"field: problem"}. The other lines still
run, and the exit code is 2."#;

/// The subcommands, each with its flags. Those of other programs have the words that go to the program.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Evaluate JSON Lines: one request per line on standard input, one answer per line on standard output
    #[command(after_help = FORMAT)]
    Eval(Eval),
    /// Compare scalar code with eight lanes and the Gaussian model with the all-Cauchy one: speed, agreement, variance
    Compare(Compare),
    /// Measure every sampler of both models under every light over the whole parameter grid; an interrupted run
    /// continues
    Study(Words),
    /// Compare each claim of the paper with figures: true, true within limits, or false
    Claims(Words),
    /// Print a model as source of another language, which needs no other file
    Shader(Words),
    /// Write values of a model in double precision, and say what is wrong with those of another program
    Referee(Words),
    /// Find the parameters of a model whose look is nearest to that of another, and print them
    Fit(Words),
    /// Join the parts of a study that ran in shards into the same tables as one run
    Merge(Words),
}

/// Words of a subcommand that another program executes, `--help` among them.
#[derive(Clone, Debug, clap::Args)]
#[command(
    disable_help_flag = true,
    after_help = "The flag --help of the subcommand lists its flags."
)]
pub struct Words {
    /// Flags and arguments of the subcommand
    #[arg(
        value_name = "WORD",
        trailing_var_arg = true,
        allow_hyphen_values = true
    )]
    pub words: Vec<OsString>,
}

/// Flags of `hairis eval`.
#[derive(Clone, Debug, clap::Args)]
pub struct Eval {
    /// The code path that computes the answers
    #[arg(long, value_enum, default_value_t = CodePath::X8)]
    pub path: CodePath,
    /// Print a request for a model, which can be edited and answered, and read none
    #[arg(long, value_name = "MODEL", conflicts_with = "path")]
    pub example: Option<String>,
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
    /// A short run, of less than 20 seconds on two cores
    #[arg(long)]
    pub quick: bool,
    /// Seed of everything that is drawn; results but for the timings depend on it alone
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder for compare.json, report.html and figures/; made if missing
    #[arg(long, value_name = "DIR", default_value = "out/compare")]
    pub out: PathBuf,
    /// Print the tables, and the verdicts on standard error
    #[arg(long)]
    pub tables: bool,
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
