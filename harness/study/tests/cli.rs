//! Tests of the binary `hairis-study`, which is run as scripts run it.

mod claims;
mod fit;
mod study;

use clap::Parser as _;
use hairis_program::trial::{self, Run, names};
use hairis_study::args::{Args, Claims, Command as Subcommand, Study};
use std::process::Command;

fn command(args: &[&str]) -> Command {
    trial::command(env!("CARGO_BIN_EXE_hairis-study"), args)
}

fn run(args: &[&str], input: &[u8]) -> Run {
    Run::of(&mut command(args), input).unwrap()
}

#[test]
fn help_names_the_command_as_users_type_it() {
    for (args, usage) in [
        (&["--help"][..], "Usage: hairis <COMMAND>"),
        (&["study", "--help"], "Usage: hairis study "),
        (&["merge", "--help"], "Usage: hairis merge "),
        (&["claims", "--help"], "Usage: hairis claims "),
        (&["fit", "--help"], "Usage: hairis fit "),
    ] {
        let run = run(args, b"");
        assert_eq!((run.code, run.err.len()), (Some(0), 0), "{args:?}");
        let is_usage = |line: &String| line.starts_with(usage);
        assert!(run.out.iter().any(is_usage), "{args:?}: {:?}", run.out);
    }
    assert!(run(&["--version"], b"").out[0].starts_with("hairis-study "));
}

#[test]
fn no_command_overwrites_the_report_of_another() {
    let out = |command| match Args::try_parse_from(["hairis", command])
        .expect("no flag is required")
        .command
    {
        Subcommand::Study(Study { out, .. }) | Subcommand::Claims(Claims { out, .. }) => out,
        command => panic!("{command:?} writes no report"),
    };
    let compare = hairis_harness::args::Args::try_parse_from(["hairis", "compare"]);
    let hairis_harness::args::Command::Compare(compare) = compare.unwrap().command else {
        panic!("another command");
    };
    assert_ne!(compare.out, out("study"), "both write a report.html");
    assert_eq!(
        out("claims"),
        out("study"),
        "the report of the study shows the verdicts"
    );
}
