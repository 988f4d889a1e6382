//! Pictures that were stopped, extended, or rendered in shards.

use super::{SMALL, channels, refuse, render, succeed};
#[cfg(unix)]
use hairis_render::part::Part;
use tempfile::TempDir;

/// Checks that a shard's part stays, and that only the same run may continue it.
#[test]
fn parts_of_other_runs_are_refused_by_name() {
    let folder = TempDir::new().expect("a folder");
    let flags = ["head", "--spp", "2", "--out", "a.exr", "--shard", "1/2"];
    render(&folder, &flags);
    render(&folder, &flags);
    for (other, words) in [
        (
            &["--crop", "0,0,20,20"][..],
            "crop=0,0,40,40, expected crop=0,0,20,20",
        ),
        (&["--seed", "2"], "seed=1, expected seed=2"),
        (&["--turn", "3"], "turn=0, expected turn=3"),
        (
            &["--rectangles", "area"],
            "rectangles=SolidAngle, expected rectangles=Area",
        ),
        (&["--meet", "surface"], "meet=Axis, expected meet=Surface"),
        (&["--no-multiple"], "multiple=true, expected multiple=false"),
    ] {
        let refused = refuse(&folder, &[&["render"], &flags[..], &SMALL, other].concat());
        assert!(
            refused.contains(words) && refused.contains("a.1-of-2.part"),
            "{refused}"
        );
    }
}

/// Checks that passes end by the clock, for shading points as for paths.
#[test]
fn time_ends_every_estimate() {
    let folder = TempDir::new().expect("a folder");
    for (integrator, pass) in [("gather", 32_u16), ("path", 4)] {
        let wrote = render(
            &folder,
            &[
                "head",
                "--integrator",
                integrator,
                "--time",
                "0.05",
                "--out",
                "a.exr",
            ],
        );
        let all = channels(&folder, "a.exr");
        let samples = &all
            .iter()
            .find(|(name, _)| name == "samples")
            .expect("a layer")
            .1;
        let count = f32::from_bits(samples[0]);
        assert!(
            count >= f32::from(pass) && count % f32::from(pass) == 0.0,
            "{integrator}: {count} samples: {wrote}"
        );
    }
    let refused = refuse(
        &folder,
        &["render", "area", "--time", "1", "--shard", "1/2"],
    );
    assert!(
        refused.contains("--time") && refused.contains("--shard"),
        "{refused}"
    );
}

/// Checks that a picture has the same bits in every channel, however it came to be.
#[test]
fn more_samples_and_shards_make_the_picture_of_one_run() {
    let scenes: [&[&str]; 3] = [
        &["box", "--integrator", "path", "--mis", "resampled"],
        &["area-head", "--integrator", "gather"],
        &["env", "--integrator", "gather", "--mis", "resampled"],
    ];
    for scene in scenes {
        let folder = TempDir::new().expect("a folder");
        let image = |name: &str, flags: &[&str]| {
            render(&folder, &[scene, &["--out", name], flags].concat());
        };
        image("once.exr", &["--spp", "16"]);
        let once = channels(&folder, "once.exr");
        let names: Vec<&str> = once.iter().map(|(name, _)| name.as_str()).collect();
        assert!(
            names.contains(&"albedo.G")
                && names.contains(&"tangent.X")
                && names.contains(&"Z")
                && names.contains(&"variance"),
            "{names:?}"
        );
        image("more.exr", &["--spp", "8"]);
        assert!(
            channels(&folder, "more.exr") != once,
            "{scene:?}: 8 samples"
        );
        image("more.exr", &["--spp", "16"]);
        assert!(
            channels(&folder, "more.exr") == once,
            "{scene:?}: 8 samples and then 16"
        );
        let parts = ["1", "2", "3"].map(|index| {
            image(
                "shards.exr",
                &["--spp", "16", "--shard", &format!("{index}/3")],
            );
            format!("shards.{index}-of-3.part")
        });
        let [a, b, c] = parts.each_ref().map(String::as_str);
        let missing = refuse(&folder, &["merge", "merged.exr", a, c]);
        assert!(missing.contains("tiles are in no part"), "{missing}");
        succeed(&folder, &["merge", "merged.exr", c, a, b]);
        assert!(channels(&folder, "merged.exr") == once, "{scene:?}: merged");
    }
}

/// Checks that a finished picture does not stand in the way of another one with the same name.
#[test]
fn finished_pictures_are_replaced() {
    let folder = TempDir::new().expect("a folder");
    for flags in [
        ["--spp", "4", "--seed", "1"],
        ["--spp", "4", "--seed", "2"],
        ["--spp", "2", "--seed", "2"],
    ] {
        render(&folder, &[&["head", "--out", "a.exr"][..], &flags].concat());
    }
    let reused = channels(&folder, "a.exr");
    render(
        &folder,
        &["head", "--out", "b.exr", "--spp", "2", "--seed", "2"],
    );
    assert!(reused == channels(&folder, "b.exr"));
}

/// Checks that a run that was killed continues to the picture of a run that was not, and that its files were whole.
#[cfg(unix)]
#[test]
fn killed_runs_go_on() {
    let folder = TempDir::new().expect("a folder");
    let flags = ["render", "head", "--strands", "300", "--size", "24x24"];
    for (signal, code, words) in [
        ("KILL", None, ""),
        ("TERM", Some(143), "interrupted by SIGTERM"),
        ("INT", Some(130), "interrupted by SIGINT"),
    ] {
        let picture = format!("{signal}.exr");
        let child = std::process::Command::new(env!("CARGO_BIN_EXE_hairis-render"))
            .args(flags)
            .args(["--out", &picture, "--spp", "1000000"])
            .current_dir(folder.path())
            // One thread leaves fewer samples, which are rendered again.
            .env("RAYON_NUM_THREADS", "1")
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("it starts");
        let part = folder.path().join(format!("{signal}.part"));
        let start = std::time::Instant::now();
        // The picture that grows follows the part.
        let preview = folder.path().join(format!("{signal}.png"));
        while !preview.exists() && start.elapsed().as_secs() < 120 {
            std::thread::sleep(core::time::Duration::from_millis(20));
        }
        std::process::Command::new("kill")
            .args([format!("-{signal}"), child.id().to_string()])
            .status()
            .expect("sent");
        let output = child.wait_with_output().expect("ended");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), code, "{errors}");
        let last = errors.lines().last().unwrap_or_default();
        assert!(
            last.contains(words) && (code.is_none() || last.contains(&format!("{signal}.part"))),
            "{errors}"
        );
        let grown = channels(&folder, &picture);
        let samples = &grown
            .iter()
            .find(|(name, _)| name == "samples")
            .expect("a layer")
            .1;
        assert!(f32::from_bits(samples[0]) > 0.0, "the picture grows");
        let saved = Part::read(&part).expect("whole").film.most_samples();
        let target = (saved + 8).to_string();
        for picture in [&picture, "once.exr"] {
            succeed(
                &folder,
                &[&flags[..], &["--spp", &target, "--out", picture]].concat(),
            );
        }
        assert!(
            channels(&folder, &picture) == channels(&folder, "once.exr"),
            "{signal}: {saved} samples, and then {target}"
        );
        std::fs::remove_file(folder.path().join("once.part")).expect("there");
    }
}

/// Checks that an invalid count of threads is reported, and that the run continues.
#[test]
fn odd_counts_of_threads_are_reported() {
    let folder = TempDir::new().expect("a folder");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_hairis-render"))
        .args(["render", "area", "--spp", "1", "--out", "a.exr"])
        .args(SMALL)
        .env("RAYON_NUM_THREADS", "many")
        .current_dir(folder.path())
        .output()
        .expect("it starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    assert!(
        errors.starts_with("RAYON_NUM_THREADS must be a whole number of threads, got \"many\""),
        "{errors}"
    );
}
