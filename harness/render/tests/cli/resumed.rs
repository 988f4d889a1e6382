//! Pictures that were stopped, extended, or rendered in shards.

use super::{SMALL, channels, refuse, render, succeed};
use tempfile::TempDir;

/// A shard's part stays, and may be continued by the same run alone.
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
        (&["--no-multiple"], "multiple=true, expected multiple=false"),
    ] {
        let refused = refuse(&folder, &[&["render"], &flags[..], &SMALL, other].concat());
        assert!(
            refused.contains(words) && refused.contains("a.1-of-2.part"),
            "{refused}"
        );
    }
}

/// Passes end by the clock, for shading points as for paths.
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

/// A picture has the same bits in every channel however it came to be.
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

/// A finished picture does not stand in the way of another one with the same name.
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

/// A run that was killed goes on, and its picture is that of one that was not. What it had written is whole.
#[cfg(unix)]
#[test]
fn killed_runs_go_on() {
    let folder = TempDir::new().expect("a folder");
    let flags = [
        "render",
        "head",
        "--out",
        "a.exr",
        "--spp",
        "1000000",
        "--strands",
        "300",
        "--size",
        "24x24",
    ];
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_hairis-render"))
        .args(flags)
        .current_dir(folder.path())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("it starts");
    let part = folder.path().join("a.part");
    let start = std::time::Instant::now();
    while !part.exists() && start.elapsed().as_secs() < 120 {
        std::thread::sleep(core::time::Duration::from_millis(20));
    }
    // The picture that grows follows the part.
    while !folder.path().join("a.png").exists() && start.elapsed().as_secs() < 120 {
        std::thread::sleep(core::time::Duration::from_millis(20));
    }
    child.kill().expect("it runs, or has ended");
    child.wait().expect("ended");
    let samples = |file: &str| {
        let all = channels(&folder, file);
        f32::from_bits(
            all.iter()
                .find(|(name, _)| name == "samples")
                .expect("a layer")
                .1[0],
        )
    };
    let grown = samples("a.exr");
    assert!(grown > 0.0, "the picture grows");
    let target = (grown + 8.0).to_string();
    let flags = [
        "render",
        "head",
        "--strands",
        "300",
        "--size",
        "24x24",
        "--spp",
        &target,
    ];
    succeed(&folder, &[&flags[..], &["--out", "a.exr"]].concat());
    succeed(&folder, &[&flags[..], &["--out", "b.exr"]].concat());
    assert!(
        channels(&folder, "a.exr") == channels(&folder, "b.exr"),
        "{grown} samples, and then {target}"
    );
}
