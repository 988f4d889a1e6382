//! Tests of `hairis-render fit`: the files that it writes, and the input that it rejects.

use super::{refuse, run, succeed};
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, ImageAttributes,
    IntegerBounds, Layer, LayerAttributes, Vec2, WritableImage as _,
};
use hairis_instruments::light::{Environment, Light as _};
use hairis_instruments::pixels::LayerFlag;
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

/// Reads a target.
fn target(folder: &TempDir, file: &str, name: Option<&str>) -> Result<Target, String> {
    let flag = "--layer";
    Target::read(&folder.path().join(file), LayerFlag { flag, name })
}

/// Writes parts of 8 x 8 pixels, each a layer with a value and the names of its channels.
fn write_parts(folder: &TempDir, name: &str, parts: &[(&str, &[&str], f32)]) {
    let part = |(name, channels, value): &(&str, &[&str], f32)| {
        let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![*value; 64]));
        let channels = AnyChannels::sort(channels.iter().map(channel).collect());
        let attributes = LayerAttributes::named(*name);
        Layer::new((8, 8), attributes, Encoding::UNCOMPRESSED, channels)
    };
    let parts: Vec<_> = parts.iter().map(part).collect();
    let image = Image::from_layers(ImageAttributes::with_size((8, 8)), parts);
    let path = folder.path().join(name);
    image.write().to_file(path).expect("written");
}

/// Checks that a target is read by the rules of environment maps.
#[test]
fn targets_are_pictures_as_maps_are() {
    let folder = TempDir::new().expect("a folder");
    let half = ("beauty", &["R", "G", "B"][..], 0.5);
    for (parts, layer) in [
        (&[half][..], None),
        (&[("", &["b", "g", "r"], 0.5)], None),
        (&[("", &["Y"], 0.5)], None),
        (
            &[(
                "",
                &[
                    "Hair.Combined.R",
                    "Hair.Combined.G",
                    "Hair.Combined.B",
                    "Hair.Depth.Z",
                ],
                0.5,
            )],
            None,
        ),
        (&[("depth", &["Z"], 9.0), half], None),
        (&[("albedo", &["R", "G", "B"], 9.0), half], Some("beauty")),
        (
            &[
                ("", &["R", "G", "B"], 0.5),
                ("albedo", &["albedo.R", "albedo.G", "albedo.B"], 9.0),
            ],
            None,
        ),
    ] {
        write_parts(&folder, "a.exr", parts);
        let target = target(&folder, "a.exr", layer).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(target.picture().pixels, [[0.5; 3]; 64], "{parts:?}");
        let map = Environment::load_layer(folder.path().join("a.exr"), layer).expect("a map");
        let radiance = map.radiance(glam::DVec3::X);
        assert_eq!(radiance, [0.5; 3], "{parts:?}");
    }
    // Radiance, and the part of the picture within its window.
    let hdr = [
        &b"#?RADIANCE\n\n-Y 8 +X 8\n"[..],
        &[128, 128, 128, 128].repeat(64),
    ]
    .concat();
    fs::write(folder.path().join("a.hdr"), hdr).expect("written");
    let radiance = target(&folder, "a.hdr", None).expect("a picture");
    assert_eq!(radiance.picture().pixels, [[0.5; 3]; 64]);
    write(
        &folder,
        "a.exr",
        &[("R", 0.5), ("G", 0.5), ("B", 0.5)],
        [3, -2],
    );
    let part = target(&folder, "a.exr", None).expect("a picture");
    let crop = Crop {
        x: 3,
        y: 0,
        width: 5,
        height: 6,
    };
    assert_eq!((part.size(), part.crop()), ([8; 2], crop));
}

#[test]
fn a_flag_names_the_layer_of_a_target() {
    let folder = TempDir::new().expect("a folder");
    let rgb = &["R", "G", "B"][..];
    write_parts(
        &folder,
        "a.exr",
        &[("albedo", rgb, 0.5), ("beauty", rgb, 0.25)],
    );
    write_parts(
        &folder,
        "sky.exr",
        &[("day", rgb, 0.5), ("night", rgb, 0.25)],
    );
    let none = "several layers have colour, choose one by";
    for (flags, words) in [
        (
            &["lamps"][..],
            format!("--target a.exr: {none} --layer NAME: albedo (R G B), beauty (R G B)"),
        ),
        (
            &["lamps", "--layer", "sky"],
            "--target a.exr: --layer must be a layer with colour of the file, got sky".to_owned(),
        ),
        (
            &["lamps", "--target-layer", "sky"],
            "--target a.exr: --target-layer must be a layer".to_owned(),
        ),
        (
            &["env", "--env", "sky.exr", "--layer", "day"],
            format!("--target a.exr: {none} --target-layer NAME"),
        ),
        (
            &["env", "--env", "sky.exr", "--target-layer", "beauty"],
            format!("sky.exr: {none} --layer NAME"),
        ),
        (
            &["lamps", "--layer", "albedo", "--target-layer", "beauty"],
            "--layer must be given with --env beside --target-layer, got albedo".to_owned(),
        ),
    ] {
        let line = refuse(
            &folder,
            &[&["fit", "--target", "a.exr", "--strands", "1"], flags].concat(),
        );
        assert!(line.contains(&words), "{line} for {words}");
    }
    let missing = ["render", "env", "--layer", "day"];
    assert!(
        refuse(&folder, &missing).contains("--env"),
        "a layer of no file"
    );
    // The picture has no hair in its 8 x 8 pixels, which is found once all files are read.
    for flags in [
        &["lamps", "--layer", "beauty"][..],
        &["lamps", "--target-layer", "beauty"],
        &[
            "env",
            "--env",
            "sky.exr",
            "--layer",
            "day",
            "--target-layer",
            "beauty",
        ],
    ] {
        let short = [
            "fit",
            "--target",
            "a.exr",
            "--strands",
            "1",
            "--iterations",
            "2",
            "--spp",
            "2",
        ];
        let output = run(&folder, &[&short, flags].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            errors.contains("a.exr: layer beauty"),
            "{flags:?}: {errors}"
        );
    }
}

/// Checks that a picture is as large as its windows, whatever attributes a program has kept that made it smaller.
#[test]
fn windows_say_how_large_a_target_is() {
    let folder = TempDir::new().expect("a folder");
    let read = |name: &str| {
        let target = target(&folder, name, None).expect("a picture");
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
    with_window(&folder, "long.exr", "displayWindow", [0, 0, 16384, 8]);
    with_window(&folder, "vast.exr", "dataWindow", [0, 0, 1 << 29, 7]);
    write(&folder, "z.exr", &[("Z", 0.5)], [0, 0]);
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
    write(&folder, "outside.exr", &grey, [8, 0]);
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
            &["--target cut.exr", "damaged or cut short"],
        ),
        (&["--target", "z.exr"], &["z.exr", "R, G and B", "got Z"]),
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
            &["outside.exr", "8 x 8", "from 8 0"],
        ),
        (
            &["--target", "wide.exr"],
            &[
                "wide.exr",
                "display window",
                "2^28 pixels, got 536870913 x 1",
            ],
        ),
        (
            &["--target", "long.exr"],
            &["long.exr", "display window", "16384 pixels, got 16385"],
        ),
        (
            &["--target", "vast.exr"],
            &["vast.exr", "data window", "2^28 pixels, got 536870913 x 8"],
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
