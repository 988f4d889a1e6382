//! Command-line flags.

use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// Values of hair models in double precision, and verdicts on those of other programs.
#[derive(Clone, Debug, Parser)]
#[command(name = "hairis referee", bin_name = "hairis referee", version)]
pub struct Args {
    /// The subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands, each with its flags.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Write cases with value, density and lobes in double precision, one object per line
    Vectors(Vectors),
    /// Say what is right and what is wrong in the answers of another program
    Check(Check),
}

/// Flags of `hairis referee vectors`.
#[derive(Clone, Debug, clap::Args)]
pub struct Vectors {
    /// Model of the registry
    #[arg(long, value_name = "NAME")]
    pub model: String,
    /// The model's sampler, whose density is wanted [default: the model's first]
    #[arg(long, value_name = "WORD")]
    pub sampler: Option<String>,
    /// Shading points: a preset of the model seen from one direction each
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub scenes: u32,
    /// Directions of each shading point
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub directions: u32,
    /// Seed of the directions
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Write a table with a header in place of lines of JSON
    #[arg(long)]
    pub csv: bool,
}

/// Flags of `hairis referee check`.
#[derive(Clone, Debug, clap::Args)]
pub struct Check {
    /// Cases as `vectors` writes them, each with the `value`, `pdf` and `lobes` of another program; - for standard input
    pub file: PathBuf,
    /// Relative error below which a number is right
    #[arg(long, value_name = "X", default_value_t = 1e-3, value_parser = tolerance)]
    pub tolerance: f64,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if (1e-12..=0.1).contains(&x) => Ok(x),
        _ => Err("must be a number from 1e-12 to 0.1".to_owned()),
    }
}
