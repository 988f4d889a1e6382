//! The flags. clap checks them; the number of the shard is checked with the cells, by the command.

use clap::{Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Studies of hair scattering over a grid of hair, fits of models, and the claims of the paper.
#[derive(Clone, Debug, Parser)]
#[command(
    name = "hairis-study",
    bin_name = "hairis",
    version,
    arg_required_else_help = false
)]
pub struct Args {
    /// The subcommand.
    #[command(subcommand)]
    pub command: Command,
}

const STUDY: &str = "\
Files in DIR: report.html, and its plots in figures/; study.csv, the rows, which depend on the
seed and the build alone; difference.csv, how different the models look; refitted.csv, the Cauchy
model fitted to each hair; materials.csv, the rows of --model and --material; study.json, the
settings; times.csv and efficiency.csv, which depend on the machine as well. With the features
`parquet` and `png` of the build: study, efficiency and difference as .parquet, the plots as .png.
Finished cells are kept in DIR/cells-I-of-N.jsonl: the same command continues from there.";

const FIT: &str = "\
Standard output has the fitted material, as `hairis eval` reads it, and standard error the verdicts. Files in DIR: fitted.json, the same; fit.json, the distance by
view, by lobe and by start; report.html, and its plots in figures/. The same flags give the same values.

  hairis fit --from gaussian --preset brown --to cauchy > soft.json
  hairis fit --material mine.json --to chiang --norm l2 --fix eta";

/// The subcommands, each with its flags.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Measure every sampler of both models under every light over the whole parameter grid; an interrupted run
    /// continues
    #[command(after_help = STUDY)]
    Study(Study),
    /// Compare each claim of the paper with figures: true, true within limits, or false
    Claims(Claims),
    /// Find the parameters of a model whose look is nearest to that of another, and print them
    #[command(after_help = FIT)]
    Fit(Fit),
    /// Join the parts of a study that ran in shards into the same tables as one run
    Merge(Merge),
}

/// Flags of `hairis study`.
#[derive(Clone, Debug, clap::Args)]
pub struct Study {
    /// A few cells and samples, in less than two minutes
    #[arg(long)]
    pub quick: bool,
    /// Fewer still, for tests that ask for no figure
    #[arg(long, hide = true, conflicts_with = "quick")]
    pub tiny: bool,
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
    /// Print the tables, and the verdicts on standard error
    #[arg(long)]
    pub tables: bool,
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
    /// Fewer still, for tests that ask for no figure
    #[arg(long, hide = true, conflicts_with = "quick")]
    pub tiny: bool,
    /// Seed of everything that is drawn; results but for the timings depend on it alone
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Print the tables, and the verdicts on standard error
    #[arg(long)]
    pub tables: bool,
    /// Folder for claims.json; made if missing. A study that finishes in the same folder shows the verdicts in its report
    #[arg(long, value_name = "DIR", default_value = "out/study")]
    pub out: PathBuf,
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
    /// Fit to many looks of --from in place of one: DIR gets fits.csv
    #[arg(long, value_enum, conflicts_with_all = ["preset", "material"], requires = "from")]
    pub over: Option<FitOver>,
    /// Print the table of --over, and its verdicts on standard error
    #[arg(long, requires = "over")]
    pub tables: bool,
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
    /// Print the tables, and the verdicts on standard error
    #[arg(long)]
    pub tables: bool,
    /// Environment light of the parts, to time its look-up [default: the procedural sky if the parts used it, else no times]
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Layer of the .exr environment [default: the only one with colour]
    #[arg(long, value_name = "NAME", requires = "env")]
    pub layer: Option<String>,
}
