//! Subcommands that are programs of their own: they are found beside `hairis`, then on PATH, and get the rest of the words.
#![cfg(unix)]

use hairis_program::trial::{self, Run};
use std::env;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Folder with a `hairis` of its own, which finds no other program beside it.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        // A link in the folder of the build: the program is that of the link, and no copy is written while other tests start programs.
        let dir = TempDir::new_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
        fs::hard_link(env!("CARGO_BIN_EXE_hairis"), dir.path().join("hairis")).unwrap();
        fs::create_dir(dir.path().join("path")).unwrap();
        Self(dir)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn run(&self, args: &[&str]) -> Run {
        let mut command = trial::command(self.path("hairis").to_str().unwrap(), args);
        Run::of(command.env("PATH", self.path("path")), b"").unwrap()
    }
}

/// Makes a link to a program of the system, which stands for a program of `hairis`.
fn stand_in(system: &str, link: &Path) {
    let path = env::var_os("PATH").unwrap();
    let mut files = env::split_paths(&path).map(|dir| dir.join(system));
    symlink(files.find(|file| file.is_file()).unwrap(), link).unwrap();
}

#[test]
fn words_go_to_the_program_as_they_are() {
    let folder = Folder::new();
    stand_in("echo", &folder.path("hairis-study"));
    stand_in("echo", &folder.path("path/hairis-shader"));
    for (args, words) in [
        (
            &["study", "--quick", "--seed", "-1"][..],
            "study --quick --seed -1",
        ),
        (&["merge", "out", "a b"], "merge out a b"),
        (&["claims", "--no-such-flag"], "claims --no-such-flag"),
        (&["fit", "-h"], "fit -h"),
        (&["shader", "--target", "c"], "--target c"),
    ] {
        let run = folder.run(args);
        assert_eq!((run.code, run.err.len()), (Some(0), 0), "{args:?}");
        assert_eq!(run.out, [words], "{args:?}");
    }
    // The words of --help reach the program, whose `echo` prints them, or its own help.
    assert!(!folder.run(&["shader", "--help"]).out.is_empty());
}

#[test]
fn the_program_beside_hairis_comes_first_and_its_code_is_that_of_hairis() {
    let folder = Folder::new();
    stand_in("true", &folder.path("path/hairis-shader"));
    assert_eq!(folder.run(&["shader"]).code, Some(0));
    stand_in("false", &folder.path("hairis-shader"));
    assert_eq!(folder.run(&["shader"]).code, Some(1));
}

#[test]
fn a_missing_program_is_named_with_the_way_to_get_it() {
    let folder = Folder::new();
    for (args, words) in [
        (
            &["shader", "--help"][..],
            [
                "cargo install --path harness/shader",
                "cargo run --release -p hairis-shader -- ...",
            ],
        ),
        (
            &["fit"],
            [
                "cargo install --path harness/study",
                "cargo run --release -p hairis-study -- fit ...",
            ],
        ),
    ] {
        let run = folder.run(args);
        assert_eq!((run.code, run.out.len(), run.err.len()), (Some(2), 0, 1));
        for words in words {
            assert!(run.err[0].contains(words), "{:?}", run.err);
        }
    }
    fs::write(folder.path("hairis-study"), "not a program").unwrap();
    let run = folder.run(&["study"]);
    assert_eq!((run.code, run.err.len()), (Some(2), 1), "{:?}", run.err);
    assert!(run.err[0].contains("cannot start"), "{:?}", run.err);
}

#[test]
fn help_lists_every_subcommand() {
    let run = super::run(&["--help"], b"");
    for name in [
        "eval", "compare", "study", "claims", "shader", "referee", "fit", "merge",
    ] {
        let is_of = |line: &String| line.trim_start().starts_with(&format!("{name} "));
        assert!(run.out.iter().any(is_of), "{name}: {:?}", run.out);
    }
}

#[test]
fn without_arguments_it_shows_what_to_try_on_one_terminal() {
    let run = super::run(&[], b"");
    let tries = run.out.iter().filter(|line| line.starts_with("  hairis "));
    assert_eq!((tries.count(), run.err.len()), (3, 0), "{run:?}");
    let widest = run.out.iter().map(String::len).max();
    assert!(run.out.len() <= 20 && widest <= Some(80), "{:?}", run.out);
}
