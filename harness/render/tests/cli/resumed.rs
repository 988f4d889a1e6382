//! Pictures that were stopped, extended, or rendered in shards.

use super::{SMALL, channels, refuse, render};
use tempfile::TempDir;

/// A shard's part stays, and may be continued by the same run alone.
#[test]
fn parts_of_other_runs_are_refused_by_name() {
    let folder = TempDir::new().expect("a folder");
    let flags = ["head", "--spp", "2", "--out", "a.exr", "--shard", "1/2"];
    render(&folder, &flags);
    render(&folder, &flags);
    for (other, words) in [
        (&["--crop", "0,0,20,20"][..], "crop=0,0,40,40, expected crop=0,0,20,20"),
        (&["--seed", "2"], "seed=1, expected seed=2"),
        (&["--turn", "3"], "turn=0, expected turn=3"),
        (&["--no-multiple"], "multiple=true, expected multiple=false"),
    ] {
        let refused = refuse(&folder, &[&["render"], &flags[..], &SMALL, other].concat());
        assert!(refused.contains(words) && refused.contains("a.1-of-2.part"), "{refused}");
    }
}

/// Passes end by the clock, for shading points as for paths.
#[test]
fn time_ends_every_estimate() {
    let folder = TempDir::new().expect("a folder");
    for (integrator, pass) in [("gather", 32_u16), ("path", 4)] {
        let wrote = render(&folder, &["area", "--integrator", integrator, "--time", "0.05", "--out", "a.exr"]);
        let all = channels(&folder, "a.exr");
        let samples = &all.iter().find(|(name, _)| name == "samples").expect("a layer").1;
        let count = f32::from_bits(samples[0]);
        assert!(count >= f32::from(pass) && count % f32::from(pass) == 0.0, "{integrator}: {count} samples: {wrote}");
    }
    let refused = refuse(&folder, &["render", "area", "--time", "1", "--shard", "1/2"]);
    assert!(refused.contains("--time") && refused.contains("--shard"), "{refused}");
}
