//! Writes the manual pages and the completions for bash, fish and zsh of `hairis` and `hairis-render` into a folder, for releases.
//!
//! It is a package of its own because it needs the flags of every program, and two crates that no program needs.

use clap::{Command, CommandFactory as _, Parser};
use clap_complete::{Shell, generate_to};
use hairis_program::error::Error;
use hairis_program::program;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Write the manual pages and shell completions of `hairis` and `hairis-render`.
#[derive(Debug, Parser)]
#[command(name = "hairis-manual", version)]
struct Args {
    /// Folder for the files; made if missing
    #[arg(value_name = "DIR")]
    out: PathBuf,
}

/// Returns `hairis` with the flags of the programs that it starts in place of the words that it passes on.
fn hairis() -> Command {
    let study = hairis_study::args::Args::command();
    let shader = hairis_shader::args::Shader::command().name("shader");
    let referee = hairis_referee::args::Args::command().name("referee");
    let others = study.get_subcommands().cloned();
    let others: Vec<Command> = others.chain([shader, referee]).collect();
    let mut hairis = hairis_harness::args::Args::command();
    for other in others {
        let name = other.get_name().to_owned();
        // Names of programs and versions are those of the parent.
        hairis = hairis.mut_subcommand(name, |_| other.version(None::<&str>));
    }
    hairis
}

fn run(flags: &Args) -> Result<(), Error> {
    let out = &flags.out;
    fs::create_dir_all(out).map_err(Error::output(out))?;
    for command in [hairis(), hairis_render::args::Args::command()] {
        let name = command.get_name().to_owned();
        for shell in [Shell::Bash, Shell::Fish, Shell::Zsh] {
            generate_to(shell, &mut command.clone(), &name, out).map_err(Error::output(out))?;
        }
        clap_mangen::generate_to(command, out).map_err(Error::output(out))?;
    }
    Ok(())
}

fn main() -> ExitCode {
    program::run("hairis-manual", None, run)
}
