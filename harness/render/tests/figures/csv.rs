//! Tests of `figures::csv`.

use clap::Parser as _;
use hairis_instruments::stats::Estimate;
use hairis_render::args::{Args, Command};
use hairis_render::figures::csv::{Start, columns, command};
use std::process;

#[test]
fn the_names_of_the_columns_come_first() {
    let start = Start {
        scene: "env (a, b.exr)".to_owned(),
        light: "direct at shading points".to_owned(),
        hair: "glossy".to_owned(),
        sampler: "uniform",
        protocol: "equal samples",
        samples: Some(16),
    };
    let estimate = Estimate {
        value: 0.123_456_7,
        standard_error: f64::NAN,
    };
    let rows = [
        start.row("MSE", estimate, true),
        Start {
            samples: None,
            ..start
        }
        .row("slope", Estimate::exact(1234.567), false),
    ];
    let mut bytes = Vec::new();
    columns(&rows).write_csv(&mut bytes).expect("written");
    let want = "\
scene,light,hair,sampler,protocol,samples,figure,value,standard_error,below_reference
\"env (a, b.exr)\",direct at shading points,glossy,uniform,equal samples,16,MSE,0.12346,,yes
\"env (a, b.exr)\",direct at shading points,glossy,uniform,equal samples,,slope,1234.6,0.0,
";
    assert_eq!(String::from_utf8(bytes).expect("text"), want);
}

/// A shell reads the words of the line as they were given.
#[test]
fn the_command_line_is_quoted() {
    let words = [
        "hairis-render",
        "figures",
        "--out",
        "x",
        "--material",
        "folder/it's a `name`; $(rm).json",
        "--set",
        "i_r=[1, 1, 1]",
    ];
    let Command::Figures(flags) = Args::try_parse_from(words).expect("flags").command else {
        panic!("the subcommand")
    };
    let line = command(&flags, &["a b.exr".to_owned(), "\u{8336}\".exr".to_owned()]);
    let read = process::Command::new("bash")
        .args(["-c", &format!("printf '%s\\n' {line}")])
        .output()
        .expect("bash");
    let read = String::from_utf8(read.stdout).expect("UTF-8");
    let expected = [
        "hairis-render",
        "figures",
        "--env",
        "a b.exr",
        "--env",
        "\u{8336}\".exr",
        "--material",
        "it's a `name`; $(rm).json",
        "--set",
        "i_r=[1, 1, 1]",
        "--seed",
        "1",
    ];
    assert_eq!(read.lines().collect::<Vec<_>>(), expected);
}
