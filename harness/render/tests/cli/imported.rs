//! Hair from a file on a head, by the command line.

#[cfg(unix)]
use super::{channels, succeed};
use super::{refuse, run};
use std::fs;
use tempfile::TempDir;

/// Writes hair that stands on the upper half of a ball of 10 cm about (0, 5, 0), as Mitsuba's text.
fn dome(folder: &TempDir) {
    let mut text = String::new();
    for k in 0..60_u8 {
        let (height, turn) = (f32::from(k) / 60.0, 2.4 * f32::from(k));
        let across = (1.0 - height * height).sqrt();
        for radius in [10.0_f32, 12.0, 14.0] {
            let [x, y, z] = [across * turn.cos(), height, across * turn.sin()];
            // Tips bend down.
            let fall = 0.3 * (radius - 10.0) * (radius - 10.0);
            let [x, y, z] = [x, y, z].map(|along| radius * along);
            text += &format!("{x} {} {z} 0.2\n", 5.0 + y - fall);
        }
        text += "\n";
    }
    fs::write(folder.path().join("dome.txt"), text).expect("written");
    // An octahedron within the ball.
    let head = "v 9.9 5 0\nv -9.9 5 0\nv 0 14.9 0\nv 0 -4.9 0\nv 0 5 9.9\nv 0 5 -9.9\n\
        f 1 3 5\nf 5 3 2\nf 2 3 6\nf 6 3 1\nf 5 4 1\nf 2 4 5\nf 6 4 2\nf 1 4 6\n";
    fs::write(folder.path().join("head.obj"), head).expect("written");
}

#[test]
fn hair_from_a_file_stands_on_a_head() {
    let folder = TempDir::new().expect("a folder");
    dome(&folder);
    let base = [
        "render",
        "env",
        "--integrator",
        "path",
        "--import",
        "dome.txt",
        "--spp",
        "2",
        "--size",
        "16x16",
    ];
    let mut means = Vec::new();
    for (flags, said) in [
        (&[][..], ""),
        (&["--scalp", "auto"], "scalp: an ellipsoid of "),
        (&["--head", "head.obj"], ""),
        (
            &["--head", "head.obj", "--head-scale", "0.001"],
            "head.obj: warning: the head is ",
        ),
        (&["--curve", "linear"], ""),
    ] {
        let out = format!("{}.exr", means.len());
        let all: Vec<&str> = base
            .iter()
            .chain(flags)
            .chain(&["--out", &out])
            .copied()
            .collect();
        let output = run(&folder, &all);
        let [line, errors] =
            [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
        assert!(
            output.status.success() && errors.contains(said),
            "{flags:?}: {errors}"
        );
        let mean = line
            .split("mean ")
            .nth(1)
            .and_then(|rest| rest.split(',').next());
        means.push(mean.expect("a mean").to_owned());
    }
    let [none, scalp, mesh, tiny, linear] = &means[..] else {
        panic!("{means:?}")
    };
    assert!(
        none != scalp && none != mesh && scalp != mesh && mesh != tiny && none != linear,
        "{means:?}"
    );
}

#[test]
fn heads_are_refused_in_one_line() {
    let folder = TempDir::new().expect("a folder");
    dome(&folder);
    fs::write(
        folder.path().join("two.txt"),
        "0 0 0 .1\n0 9 0 .1\n\n1 0 0 .1\n1 9 0 .1\n",
    )
    .expect("written");
    for (import, flags, words) in [
        (
            "dome.txt",
            ["--head", "none.obj"],
            "none.obj: cannot be read",
        ),
        (
            "dome.txt",
            ["--head", "two.txt"],
            "two.txt: byte 0: a head must be a mesh",
        ),
        (
            "two.txt",
            ["--scalp", "auto"],
            "--scalp auto must have at least 10 strands, got 2",
        ),
    ] {
        let all = [&["render", "env", "--import", import][..], &flags].concat();
        let line = refuse(&folder, &all);
        assert!(line.contains(words), "{line} for {words}");
    }
    for flags in [
        &["--head", "head.obj"][..],
        &["--scalp", "auto"],
        &[
            "--import", "dome.txt", "--head", "head.obj", "--scalp", "auto",
        ],
        &["--import", "dome.txt", "--head-scale", "2"],
        &["--import", "dome.txt", "--curve", "loopy"],
    ] {
        let all = [&["render", "env"], flags].concat();
        assert_eq!(run(&folder, &all).status.code(), Some(2), "{flags:?}");
    }
}

/// Checks that a pipe is read once, and that another hair or head behind the same name is another picture.
#[cfg(unix)]
#[test]
fn files_from_a_pipe_are_told_apart() {
    use std::io::{Write as _, pipe};
    let folder = TempDir::new().expect("a folder");
    dome(&folder);
    let path = |name: &str| folder.path().join(name);
    let double = |name: &str, from: &str, to: &str| {
        let text = fs::read_to_string(path(name)).expect("written");
        let other = format!("other-{name}");
        fs::write(path(&other), text.replace(from, to)).expect("written");
        other
    };
    let hairs = [
        "dome.txt".to_owned(),
        double("dome.txt", " 0.2\n", " 0.4\n"),
    ];
    let heads = ["head.obj".to_owned(), double("head.obj", "9.9", "7.9")];
    let base = [
        "render",
        "env",
        "--integrator",
        "direct",
        "--spp",
        "1",
        "--size",
        "16x16",
    ];
    for (first, flag, files) in [
        (&[][..], "--import", hairs),
        (&["--import", "dome.txt"], "--head", heads),
    ] {
        for file in files {
            let flags = |name| [&base, first, &[flag, name]].concat();
            let (reader, mut writer) = pipe().expect("a pipe");
            // Short enough for the pipe to hold all of it.
            let content = fs::read(path(&file)).expect("written");
            writer.write_all(&content).expect("written");
            drop(writer);
            let output = std::process::Command::new(env!("CARGO_BIN_EXE_hairis-render"))
                .args([&flags("/dev/stdin")[..], &["--out", "piped.exr"]].concat())
                .current_dir(folder.path())
                .stdin(reader)
                .output()
                .expect("it starts");
            assert!(output.status.success(), "{flag} {file}: {output:?}");
            succeed(
                &folder,
                &[&flags(&file)[..], &["--out", "named.exr"]].concat(),
            );
            assert!(
                channels(&folder, "piped.exr") == channels(&folder, "named.exr"),
                "{flag} {file}"
            );
        }
    }
}
