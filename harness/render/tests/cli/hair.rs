//! Hair of the caller's own: materials of files, and parameters on top of presets.

use super::{SMALL, channels, refuse, render, run};
use hairis_render::part::Part;
use std::fs;
use std::io::pipe;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const CHIANG: &str =
    r#"{"model": "chiang", "params": {"beta_m": 0.3, "beta_n": 0.3, "sigma_a": [0.25, 0.5, 1.0]}}"#;

/// Makes a folder with two files of the same name, a file of two materials, and one as editors of Windows
/// write it.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, text).expect("written");
    };
    write("a/mine.json", CHIANG);
    write(
        "b/mine.json",
        r#"{"model":"kajiya-kay","params":{"kd":[0.4,0.3,0.2],"ks":[0.1,0.1,0.1],"exponent":80}}"#,
    );
    let spread = CHIANG.replace(", ", ",\r\n  ");
    write("windows.json", &format!("\u{feff}{spread}\r\n"));
    // Lines of `hairis eval`, query and all.
    let red = CHIANG.replace(
        "\"sigma_a\": [0.25, 0.5, 1.0]",
        "\"melanin_amount\": [0.6, 0.9]",
    );
    let line = |text: &str| text.replace("}}", "},\"wo\":[0,1,0],\"wi\":[0,0,1],\"h\":0.5}");
    write("two.jsonl", &format!("{}\n{}\n", line(CHIANG), line(&red)));
    write("bad.json", &CHIANG.replace("0.3,", "3,"));
    write("empty.json", " \n");
    write(
        "cut.json",
        "{\"model\": \"chiang\",\n\"params\": {\"beta_m\": ",
    );
    write("utf16.json", "");
    fs::write(folder.path().join("utf16.json"), b"\xff\xfe{\0}\0").expect("written");
    folder
}

/// Returns the line of everything that the sums of a picture depend on.
fn line(folder: &TempDir, part: &str) -> String {
    let bytes = fs::read(folder.path().join(part)).expect("a part");
    let text = String::from_utf8_lossy(&bytes);
    text.lines().nth(1).expect("a line").to_owned()
}

#[test]
fn materials_of_files_are_those_of_presets_with_their_values() {
    let folder = folder();
    let flags = |more: &[&str], out: &str| {
        let flags = ["furnace-one", "--spp", "2", "--seed", "3", "--out", out];
        render(&folder, &[&flags, more].concat());
        channels(&folder, out)
    };
    let expected = flags(
        &[
            "--model",
            "chiang",
            "--set",
            "sigma_a=0.25,0.5,1",
            "--set",
            "tilt=0.03",
        ],
        "set.exr",
    );
    let blond = flags(&["--model", "chiang", "--hair", "blond"], "blond.exr");
    assert_ne!(expected, blond, "the values show");
    for (file, out) in [("a/mine.json", "a.exr"), ("windows.json", "windows.exr")] {
        let got = flags(&["--material", file, "--set", "tilt=0.03"], out);
        assert_eq!(got, expected, "{file}");
    }
    // Equal hair is one run, however it is named.
    assert_eq!(line(&folder, "a.part"), line(&folder, "windows.part"));
    assert!(line(&folder, "a.part").contains("sigma_a=0.25,0.5,1"));
}

#[test]
fn several_materials_are_several_pictures() {
    let folder = folder();
    let flags = ["furnace-one", "--spp", "2", "--out", "p.exr"];
    let materials = [
        "--material",
        "a/mine.json",
        "--material",
        "b/mine.json",
        "--material",
        "two.jsonl",
    ];
    let said = render(&folder, &[&flags[..], &materials].concat());
    assert_eq!(said.lines().count(), 4, "{said}");
    let names = ["p-mine.exr", "p-mine-2.exr", "p-two-1.exr", "p-two-2.exr"];
    let pictures = names.map(|name| channels(&folder, name));
    assert!(!folder.path().join("p.exr").exists());
    assert_eq!(pictures[0], pictures[2], "the same material");
    assert_ne!(pictures[0], pictures[1]);
    assert_ne!(pictures[0], pictures[3]);
    let single = [
        "furnace-one",
        "--spp",
        "2",
        "--material",
        "b/mine.json",
        "--out",
        "b.exr",
    ];
    render(&folder, &single);
    assert_eq!(channels(&folder, "b.exr"), pictures[1]);
}

#[test]
fn what_becomes_of_standard_output_does_not_matter_to_files() {
    let folder = folder();
    let run_into = |out: Stdio, flags: &[&str]| -> Output {
        Command::new(env!("CARGO_BIN_EXE_hairis-render"))
            .args(flags)
            .stdout(out)
            .stderr(Stdio::piped())
            .current_dir(folder.path())
            .spawn()
            .and_then(|child| child.wait_with_output())
            .expect("it runs")
    };
    let closed = || {
        let (_, writer) = pipe().expect("a pipe");
        Stdio::from(writer)
    };
    let is_finished = |part: &str| {
        Part::read(&folder.path().join(part))
            .expect("a part")
            .finished
    };
    let flags = |more: &[&'static str]| {
        let base = ["render", "furnace-one", "--spp", "1", "--profile"];
        [&base, &SMALL[..], more].concat()
    };
    let both = ["--material", "a/mine.json", "--material", "b/mine.json"];
    let shard = ["--out", "s.exr", "--shard", "1/1"];
    for flags in [
        flags(&[&both[..], &["--out", "p.exr"]].concat()),
        flags(&shard),
        vec!["merge", "s.exr", "s.1-of-1.part"],
    ] {
        let output = run_into(closed(), &flags);
        assert!(output.status.success(), "{flags:?}: {output:?}");
    }
    assert!(is_finished("p-mine.part") && is_finished("p-mine-2.part"));
    for name in ["p-mine.exr", "p-mine-2.exr", "s.exr"] {
        assert!(folder.path().join(name).exists(), "{name}");
    }
    // A disk that is full is an error, after everything is written.
    #[cfg(target_os = "linux")]
    {
        let full = fs::OpenOptions::new().write(true).open("/dev/full");
        let output = run_into(full.expect("there").into(), &flags(&["--out", "full.exr"]));
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(is_finished("full.part") && folder.path().join("full.exr").exists());
    }
}

#[test]
fn hair_that_is_not_legal_is_refused_by_name() {
    let folder = folder();
    for (flags, words) in [
        (
            &["--material", "bad.json"][..],
            &["bad.json", "params.beta_m", "got 3"][..],
        ),
        (&["--material", "none.json"], &["none.json", "cannot read"]),
        (&["--material", "."], &["--material .", "cannot read"]),
        (&["--material", "empty.json"], &["empty.json", "nothing"]),
        (
            &["--material", "cut.json"],
            &["cut.json", "params.beta_m", "line 2"],
        ),
        (&["--material", "utf16.json"], &["utf16.json", "UTF-16"]),
        (
            &["--material", "a/mine.json", "--hair", "red"],
            &["--material", "--hair"],
        ),
        (
            &["--material", "a/mine.json", "--sampler", "best"],
            &["chiang", "best", "mean"],
        ),
        (&["--set", "beta"], &["--set beta", "NAME=VALUE"]),
        (
            &["--set", "sigma_a=1,1,1"],
            &["--set sigma_a", "gaussian", "i_trt"],
        ),
        (
            &["--set", "beta=0.1,0.1"],
            &["--set beta", "3 numbers", "got 2"],
        ),
        (
            &["--set", "gamma_tt=-1"],
            &["--set gamma_tt", "width", "got -1"],
        ),
        (
            &["--set", "gamma_tt=wide"],
            &["--set gamma_tt", "number", "wide"],
        ),
        (
            &["--set", "gamma_tt=0.1", "--set", "gamma_tt=0.2"],
            &["--set gamma_tt", "twice"],
        ),
        (
            &[
                "--material",
                "a/mine.json",
                "--set",
                "melanin=1,0",
                "--set",
                "color=1,1,1",
            ],
            &["--set melanin", "color"],
        ),
    ] {
        let all = [&["render", "furnace-one"], flags, &SMALL].concat();
        let line = refuse(&folder, &all);
        assert!(
            words.iter().all(|word| line.contains(word)),
            "{flags:?}: {line}"
        );
    }
    assert!(!folder.path().join("out").exists(), "nothing is rendered");
}

#[test]
fn hair_that_scatters_uniformly_has_no_model() {
    let folder = folder();
    let flags = ["furnace-iso", "--spp", "1", "--out", "iso.exr"];
    render(&folder, &flags);
    let isotropic = line(&folder, "iso.part");
    assert!(
        isotropic.contains("hair=isotropic") && !isotropic.contains("model="),
        "{isotropic}"
    );
    for (flags, words) in [
        (["--model", "nope"], ["--model", "nope"]),
        (["--sampler", "nope"], ["--sampler", "nope"]),
        (["--hair", "nope"], ["--hair", "nope"]),
    ] {
        let line = refuse(
            &folder,
            &[&["render", "furnace-iso"], &flags[..], &SMALL].concat(),
        );
        assert!(
            words.iter().all(|word| line.contains(word)),
            "{flags:?}: {line}"
        );
    }
    for (more, word) in [
        (&["--model", "chiang"][..], "model=chiang sampler=published"),
        (&["--sampler", "uniform"], "model=gaussian sampler=uniform"),
        (&["--set", "i_g=0"], "i_g=0 "),
    ] {
        render(
            &folder,
            &[&["furnace-iso", "--spp", "1", "--out", "own.exr"], more].concat(),
        );
        let line = line(&folder, "own.part");
        assert!(line.contains(word), "{more:?}: {line}");
    }
}

#[test]
fn a_depth_says_what_it_cuts_off() {
    let folder = folder();
    let clear = ["--model", "chiang", "--set", "sigma_a=0,0,0"];
    let said = |more: &[&str]| {
        let flags = ["render", "furnace-iso", "--spp", "4", "--out", "c.exr"];
        let output = run(&folder, &[&flags, &clear[..], more, &SMALL].concat());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stderr).expect("text")
    };
    let lines = |text: &str| {
        text.lines()
            .filter(|line| line.contains("leaves out"))
            .count()
    };
    assert_eq!(lines(&said(&["--depth", "8"])), 1);
    assert_eq!(lines(&said(&["--depth", "10000"])), 0, "nothing that shows");
    assert_eq!(lines(&said(&[])), 0);
    // Hair that returns more than it receives, of paths without end.
    let raw = [
        "render",
        "furnace-iso",
        "--hair",
        "default",
        "--energy",
        "raw",
        "--spp",
        "1",
    ];
    let line = refuse(&folder, &[&raw[..], &SMALL].concat());
    assert!(
        line.contains("--depth") && line.contains("default"),
        "{line}"
    );
}
