//! Tests of `hairis-render fit`: the files that it writes, and the input that it rejects.

use super::{refuse, run, succeed};
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, IntegerBounds, Layer,
    LayerAttributes, Vec2, WritableImage as _,
};
use hairis_render::film::Crop;
use hairis_render::fit::Target;
use std::fs;
use tempfile::TempDir;

/// Renders a part of a small picture of the light that fits follow.
fn render(folder: &TempDir, flags: &[&str]) {
    let small = [
        "render",
        "lamps",
        "--strands",
        "300",
        "--size",
        "64x64",
        "--crop",
        "20,12,24,16",
    ];
    succeed(folder, &[&small, flags].concat());
}

const FIT: [&str; 10] = [
    "fit",
    "lamps",
    "--strands",
    "300",
    "--target",
    "a.exr",
    "--iterations",
    "2",
    "--spp",
    "2",
];

#[test]
fn a_fit_leaves_a_material_a_history_and_pictures() {
    let folder = TempDir::new().expect("a folder");
    render(
        &folder,
        &[
            "--hair", "red", "--depth", "2", "--spp", "4", "--out", "a.exr",
        ],
    );
    let flags = [
        "--hair", "brown", "--free", "i_g", "--fix", "alpha", "--out", "found",
    ];
    let fit = || run(&folder, &[&FIT[..], &flags].concat());
    let output = fit();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && !errors.contains("warning"),
        "{errors}"
    );
    let table = String::from_utf8_lossy(&output.stdout);
    assert!(
        table.contains("beta.TT") && table.contains("i_g"),
        "{table}"
    );
    assert!(!table.contains("alpha"), "{table}");
    let read = |name: &str| fs::read(folder.path().join("found").join(name)).expect("written");
    let csv = String::from_utf8(read("parameters.csv")).expect("text");
    let lines: Vec<&str> = csv.lines().collect();
    assert!(
        lines[0].starts_with("iteration,error,beta.R,") && lines.len() == 4,
        "{csv}"
    );
    assert!(read("parameters.svg").starts_with(b"<svg"));
    let sheet = image::load_from_memory(&read("pictures.png")).expect("a picture");
    assert_eq!((sheet.width(), sheet.height()), (3 * 24 + 2 * 4, 16));
    // The same bits again, and hair that the renderer takes.
    fs::rename(folder.path().join("found"), folder.path().join("first")).expect("renamed");
    fit();
    let first = fs::read(folder.path().join("first/parameters.csv")).expect("written");
    assert_eq!(first, read("parameters.csv"));
    render(
        &folder,
        &[
            "--material",
            "found/material.json",
            "--depth",
            "2",
            "--spp",
            "1",
            "--out",
            "b.exr",
        ],
    );
}

#[test]
fn light_that_a_fit_does_not_follow_is_remarked() {
    let folder = TempDir::new().expect("a folder");
    render(&folder, &["--hair", "red", "--spp", "1", "--out", "a.exr"]);
    let output = run(&folder, &[&FIT[..], &["--hair", "red"]].concat());
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && errors.contains("depth=None in place of depth=Some(2)"),
        "{errors}"
    );
}

/// Writes a picture of one value per channel, with the corner of its data window, in a display window of 8 x 8 pixels. Its
/// attribute `run` is that of a larger picture.
fn write(folder: &TempDir, name: &str, channels: &[(&str, f32)], corner: [i32; 2]) {
    let channel = |(name, value): &(&str, f32)| {
        let mut pixels = vec![0.5; 64];
        pixels[10] = *value;
        AnyChannel::new(*name, FlatSamples::F32(pixels))
    };
    let mut image = Image::from_layer(Layer::new(
        Vec2(8, 8),
        LayerAttributes::default().with_position(Vec2(corner[0], corner[1])),
        Encoding::UNCOMPRESSED,
        AnyChannels::sort(channels.iter().map(channel).collect()),
    ));
    image.attributes.display_window = IntegerBounds::from_dimensions(Vec2(8, 8));
    let run = AttributeValue::Text("size=64x64 crop=0,0,64,64".into());
    image.layer_data.attributes.other.insert("run".into(), run);
    image
        .write()
        .to_file(folder.path().join(name))
        .expect("written");
}

/// Writes a copy of `a.exr` with another value of an attribute that is a window.
fn with_window(folder: &TempDir, name: &str, attribute: &str, window: [i32; 4]) {
    let mut bytes = fs::read(folder.path().join("a.exr")).expect("written");
    let head = [attribute.as_bytes(), b"\0box2i\0\x10\0\0\0"].concat();
    let start = bytes.windows(head.len()).position(|at| at == head);
    let start = start.expect("an attribute") + head.len();
    for (place, side) in window.into_iter().enumerate() {
        bytes[start + 4 * place..][..4].copy_from_slice(&side.to_le_bytes());
    }
    fs::write(folder.path().join(name), bytes).expect("written");
}

/// Checks that a picture is as large as its windows, whatever attributes a program has kept that made it smaller.
#[test]
fn windows_say_how_large_a_target_is() {
    let folder = TempDir::new().expect("a folder");
    let read = |name: &str| {
        let target = Target::read(&folder.path().join(name)).expect("a picture");
        (target.size(), target.crop())
    };
    let grey = [("R", 0.5), ("G", 0.5), ("B", 0.5)];
    write(&folder, "small.exr", &grey, [0, 0]);
    assert_eq!(read("small.exr"), ([8; 2], Crop::whole([8; 2])));
    render(&folder, &["--spp", "1", "--out", "part.exr"]);
    let part = Crop {
        x: 20,
        y: 12,
        width: 24,
        height: 16,
    };
    assert_eq!(read("part.exr"), ([64; 2], part));
}

#[test]
fn bad_targets_and_flags_are_refused_in_one_line() {
    let folder = TempDir::new().expect("a folder");
    let grey = [("R", 0.5), ("G", 0.5), ("B", 0.5)];
    write(&folder, "a.exr", &grey, [0, 0]);
    // More pixels than any memory holds.
    with_window(&folder, "wide.exr", "displayWindow", [0, 0, 1 << 29, 0]);
    with_window(&folder, "vast.exr", "dataWindow", [0, 0, 1 << 29, 7]);
    write(&folder, "y.exr", &[("Y", 0.5)], [0, 0]);
    write(
        &folder,
        "nan.exr",
        &[("R", 0.5), ("G", f32::NAN), ("B", 0.5)],
        [0, 0],
    );
    write(
        &folder,
        "dark.exr",
        &[("R", 0.5), ("G", 0.5), ("B", -1e3)],
        [0, 0],
    );
    write(&folder, "outside.exr", &grey, [3, 0]);
    fs::write(folder.path().join("cut.exr"), b"v/1\x01\x02\0\0\0").expect("written");
    let material = r#"{"model":"chiang","params":{"beta_m":0.3,"beta_n":0.3,"melanin":[1,0]}}"#;
    fs::write(
        folder.path().join("two.json"),
        [material, material].concat(),
    )
    .expect("written");
    fs::write(folder.path().join("one.json"), material).expect("written");
    for (flags, words) in [
        (
            &["--target", "none.exr"][..],
            &["--target none.exr", "cannot read"][..],
        ),
        (
            &["--target", "cut.exr"],
            &["--target cut.exr", "cannot read"],
        ),
        (&["--target", "y.exr"], &["y.exr", "R, G and B", "got Y"]),
        (
            &["--target", "nan.exr"],
            &["nan.exr", "G of the pixel 2,1", "NaN"],
        ),
        (
            &["--target", "dark.exr"],
            &["dark.exr", "mean of B", "above 0"],
        ),
        (
            &["--target", "outside.exr"],
            &["outside.exr", "8 x 8", "from 3 0"],
        ),
        (
            &["--target", "wide.exr"],
            &["wide.exr", "display window", "16384", "got 536870913"],
        ),
        (
            &["--target", "vast.exr"],
            &["vast.exr", "data window", "8 x 8", "got 536870913 x 8"],
        ),
        (&["--model", "phong"], &["phong", "gaussian"]),
        (&["--hair", "green"], &["green", "blond"]),
        (
            &["--fix", "width"],
            &["--fix", "beta", "gaussian", "got width"],
        ),
        (&["--free", "width"], &["--free", "beta", "got width"]),
        (
            &["--material", "one.json", "--fix", "sigma_a"],
            &["--fix", "got sigma_a", "give melanin, which"],
        ),
        (
            &["--material", "one.json", "--free", "color"],
            &["--free", "got color", "give melanin, which"],
        ),
        (&["--depth", "3"], &["--depth", "1 or 2", "got 3"]),
        (&["--spp", "3"], &["--spp", "even", "got 3"]),
        (&["--iterations", "1"], &["--iterations", "got 1"]),
        (&["--exposure", "0"], &["--exposure", "got 0"]),
        (
            &["--material", "two.json"],
            &["--material", "one material", "got 2"],
        ),
        (&["--turn", "nan"], &["--turn", "NaN"]),
        (
            &[
                "--fix", "alpha", "--fix", "beta", "--fix", "gamma_tt", "--fix", "gamma_g",
                "--fix", "i_tt", "--fix", "i_trt",
            ],
            &["a parameter to fit", "--fix"],
        ),
        (&["--out", "two.json"], &["two.json"]),
    ] {
        // Later flags take the place of earlier ones only where clap allows it: the target is given once.
        let target = ["--target", "a.exr"];
        let target = if flags[0] == "--target" {
            &[][..]
        } else {
            &target
        };
        let all = [&["fit", "lamps", "--strands", "300"], target, flags].concat();
        let line = refuse(&folder, &all);
        assert!(
            words.iter().all(|word| line.contains(word)),
            "{flags:?}: {line}"
        );
    }
    // A picture that looks past the hair.
    let away = ["fit", "env", "--target", "past.exr", "--strands", "1"];
    let corner = [
        "render",
        "env",
        "--strands",
        "1",
        "--size",
        "64x64",
        "--crop",
        "0,0,4,4",
    ];
    let light = [
        "--integrator",
        "path",
        "--depth",
        "2",
        "--spp",
        "1",
        "--out",
        "past.exr",
    ];
    succeed(&folder, &[&corner[..], &light].concat());
    let line = refuse(&folder, &away);
    assert!(line.contains("must show the hair"), "{line}");
}
