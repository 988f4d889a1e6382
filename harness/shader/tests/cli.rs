//! Tests of `hairis shader`: source on standard output, and bad flags that are rejected in one line.

use hairis_program::trial::{self, Run, names};
use serde_json::{Value, json};
use std::fs;
use std::process::Command;

fn command(args: &[&str]) -> Command {
    trial::command(env!("CARGO_BIN_EXE_hairis-shader"), args)
}

fn run(args: &[&str]) -> Run {
    Run::of(&mut command(args), b"").unwrap()
}

/// Returns a material as a request of `hairis eval`.
fn good() -> Value {
    json!({
        "model": "gaussian",
        "params": {
            "alpha": [-0.13, 0.065, 0.2], "beta": [0.13, 0.065, 0.26], "gamma_tt": 0.17, "gamma_g": 0.17, "phi_g": 0.61,
            "i_r": [0.3, 0.3, 0.3], "i_tt": [0.8, 0.6, 0.4], "i_trt": [0.7, 0.5, 0.3], "i_g": 0.5
        },
        "wo": [0.6, 0.8, 0.0],
        "wi": [0.0, 1.0, 0.0]
    })
}

fn print(args: &[&str]) -> String {
    let printed = run(args);
    assert_eq!(printed.code, Some(0), "{:?}", printed.err);
    assert!(printed.err.is_empty(), "{:?}", printed.err);
    printed.out.join("\n")
}

fn refused(args: &[&str]) -> String {
    let refused = run(args);
    assert_eq!(refused.code, Some(2), "{args:?}");
    assert!(refused.out.is_empty(), "{args:?} prints nothing");
    assert_eq!(refused.err.len(), 1, "{:?}", refused.err);
    refused.err[0].clone()
}

#[test]
fn every_language_has_the_functions_that_are_named() {
    for (target, call) in [
        (
            "c",
            "HairisKajiyaKayEval hairis_kajiya_kay_eval_hit(HairisKajiyaKayMaterial material, ",
        ),
        (
            "wgsl",
            "fn hairis_kajiya_kay_eval_hit(material: HairisKajiyaKayMaterial, wo: vec3<f32>",
        ),
        (
            "glsl",
            "HairisKajiyaKayEval hairis_kajiya_kay_eval_hit(HairisKajiyaKayMaterial material, vec3",
        ),
        (
            "hlsl",
            "HairisKajiyaKayEval hairis_kajiya_kay_eval_hit(HairisKajiyaKayMaterial material, float3",
        ),
        (
            "msl",
            "HairisKajiyaKayEval hairis_kajiya_kay_eval_hit(HairisKajiyaKayMaterial material, float3",
        ),
        (
            "slang",
            "[Differentiable]\nHairisKajiyaKayEval hairis_kajiya_kay_eval_hit(HairisKajiyaKayMaterial material, float3",
        ),
        (
            "python",
            "def eval_hit(material: Material, wo: Vector, h: Array, wi: Vector, ",
        ),
    ] {
        let name = |function: &str| match target {
            "python" => format!("{function}("),
            _ => format!("hairis_kajiya_kay_{function}("),
        };
        let all = print(&["--model", "kajiya-kay", "--target", target]);
        assert!(all.contains(call), "{target}");
        assert!(all.contains(&name("material_brown")), "{target}: presets");
        let some = print(&[
            "--model",
            "kajiya-kay",
            "--target",
            target,
            "--call",
            "eval_hit",
            "--gradient",
        ]);
        assert!(
            some.contains(call) && some.contains(&name("eval_hit_gradient")),
            "{target}"
        );
        assert!(
            !some.contains(&name("sample")),
            "{target}: one function is named"
        );
    }
}

#[test]
fn models_samplers_and_fields_are_chosen() {
    let matched = print(&[
        "--model",
        "gaussian",
        "--sampler",
        "matched",
        "--target",
        "wgsl",
        "--call",
        "eval_hit",
    ]);
    assert!(matched.contains("fn hairis_gaussian_matched_eval_hit("));
    let chiang = print(&[
        "--model", "chiang", "--select", "mean", "--target", "wgsl", "--call", "eval",
    ]);
    assert!(chiang.contains("fn hairis_chiang_eval("));
    let whole = ["--model", "gaussian", "--target", "c", "--call", "eval_hit"];
    let value = print(&[&whole[..], &["--only", "value"]].concat());
    assert!(value.contains("HairisGaussianEvalHitValue hairis_gaussian_eval_hit_value("));
    assert!(value.lines().count() < print(&whole).lines().count());
    let fused = print(&[&whole[..], &["--arithmetic", "fused"]].concat());
    assert!(fused.contains("fmaf(") && !print(&whole).contains("fmaf(x"));
}

#[test]
fn materials_of_a_file_are_functions() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("my hair.json");
    let mut request = good();
    request["sampler"] = Value::from("matched");
    fs::write(&file, request.to_string()).unwrap();
    let file = file.to_str().unwrap();
    let text = print(&["--material", file, "--target", "c", "--call", "eval_hit"]);
    assert!(text.contains("hairis_gaussian_matched_material_my_hair(void)"));
    let scaled = print(&[
        "--material",
        file,
        "--target",
        "c",
        "--call",
        "eval_hit",
        "--conserving",
    ]);
    assert_ne!(text, scaled, "its albedo is above 1");
    assert_eq!(text.lines().count(), scaled.lines().count());
    let error = refused(&["--material", file, "--model", "chiang", "--target", "c"]);
    assert!(
        error.contains("--material") && error.contains("chiang"),
        "{error}"
    );
    request["params"]["beta"] = serde_json::json!([0.0, 0.1, 0.1]);
    fs::write(file, request.to_string()).unwrap();
    let error = refused(&["--material", file, "--target", "c"]);
    assert!(error.contains("beta"), "{error}");
}

#[test]
fn names_of_files_that_are_taken_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let file = |name: &str| {
        let path = dir.path().join(name);
        fs::write(&path, good().to_string()).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let flags = ["--target", "c", "--call", "material"];
    for (name, more, words) in [
        (
            "brown.json",
            &[][..],
            "brown.json: material_brown is a preset",
        ),
        (
            "BLOND.json",
            &["--conserving"],
            "material_blond is a preset",
        ),
        (
            "gradient.json",
            &["--gradient"],
            "gradient.json: material_gradient is another function",
        ),
    ] {
        let error = refused(&[&flags[..], &["--material", &file(name)], more].concat());
        assert!(
            error.contains("--material must have a name of its own") && error.contains(words),
            "{error}"
        );
    }
    let free = print(&[&flags[..], &["--material", &file("gradient.json")]].concat());
    assert!(free.contains("hairis_gaussian_material_gradient(void)"));
}

/// A name that is no identifier in some language is rejected for all of them, and never becomes the name of another file.
#[test]
fn names_of_files_that_are_no_identifiers_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = dir.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (one, two) = (good().to_string(), format!("{0}\n{0}", good()));
    let call = ["--call", "material"];
    for stem in [
        "my__hair",
        "_hair",
        "hair_",
        "my - hair",
        "\u{8336}\u{8272}",
        "\u{9ed2}\u{8272}",
        "\u{e9}b\u{e8}ne",
        "\u{ff21}",
        "\u{212a}",
        "red!",
        "red\n",
        "a+b",
        "__",
        "-",
        " ",
        ".hidden",
    ] {
        for text in [&one, &two] {
            let file = write(&format!("{stem}.json"), text);
            for target in ["c", "glsl", "wgsl"] {
                let error =
                    refused(&[&["--material", &file, "--target", target], &call[..]].concat());
                assert!(
                    error.contains("--material")
                        && error.contains("name must be words")
                        && error.contains("rename the file"),
                    "{error}"
                );
            }
        }
    }
    for (stem, function) in [
        ("My hair", "my_hair"),
        ("hair-2.final", "hair_2_final"),
        ("2", "2"),
    ] {
        let file = write(&format!("{stem}.json"), &one);
        let text = print(&[&["--material", &file, "--target", "glsl"], &call[..]].concat());
        assert!(
            text.contains(&format!("hairis_gaussian_material_{function}()")),
            "{stem}"
        );
    }
    let longest = "a".repeat(255);
    print(
        &[
            &["--material", &write(&longest, &one), "--target", "c"],
            &call[..],
        ]
        .concat(),
    );
    refused(
        &[
            &["--material", &write(&longest, &two), "--target", "c"],
            &call[..],
        ]
        .concat(),
    );
}

#[test]
fn outputs_that_are_closed_or_full_are_no_panic() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let flags = ["--model", "kajiya-kay", "--target", "c"];
    for more in [&[][..], &["--out", out]] {
        let args = [&flags[..], more].concat();
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let closed: Run = command(&args).stdout(writer).output().unwrap().into();
        assert_eq!(
            (closed.code, closed.err.len()),
            (Some(0), 0),
            "{args:?}: {:?}",
            closed.err
        );
        if cfg!(target_os = "linux") {
            let full = fs::File::options().write(true).open("/dev/full").unwrap();
            let full: Run = command(&args).stdout(full).output().unwrap().into();
            assert_eq!(
                (full.code, full.err.len()),
                (Some(2), 1),
                "{args:?}: {:?}",
                full.err
            );
        }
    }
}

#[test]
fn a_folder_has_every_model_in_every_language() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("new/folder");
    let to = out.to_str().unwrap();
    let printed = print(&["--out", to]);
    let index = fs::read_to_string(out.join("README.md")).unwrap();
    for model in [
        "gaussian",
        "gaussian_matched",
        "cauchy",
        "cauchy_matched",
        "kajiya_kay",
        "chiang",
    ] {
        for ending in ["h", "wgsl", "glsl", "hlsl", "metal", "slang", "py"] {
            let file = format!("hairis_{model}.{ending}");
            assert!(out.join(&file).is_file(), "{file}");
        }
    }
    let names = names(&out);
    for file in names.iter().filter(|name| *name != "README.md") {
        assert!(
            index.contains(&format!("[`{file}`]({file})"))
                || index.contains(&format!("[{file}]({file})")),
            "{file}"
        );
    }
    let source = names
        .iter()
        .filter(|name| name.starts_with("hairis_"))
        .count();
    assert!(printed.starts_with(&format!("{source} files")), "{printed}");
    assert_eq!(
        fs::read_to_string(out.join("hairis_gaussian.h")).unwrap(),
        print(&["--model", "gaussian", "--target", "c"]) + "\n"
    );
    for word in ["MODEL", "TYPE", "VERSION", "EXPECTED"] {
        for file in ["README.md", "example.c", "example.html", "example.py"] {
            let text = fs::read_to_string(out.join(file)).unwrap();
            assert!(!text.contains(word), "{file}: {word}");
        }
    }
    // A second run replaces the files of the first.
    fs::write(out.join("example.c"), "").unwrap();
    print(&["--out", to]);
    assert_eq!(self::names(&out), names);
    assert!(fs::metadata(out.join("example.c")).unwrap().len() > 0);
}

/// Bits are promised for `exact` alone, and `fused` needs an operation that frameworks lack.
#[test]
fn python_has_its_own_arithmetic_and_an_example() {
    let flags = ["--model", "chiang", "--target", "python"];
    let with = |word: &str| print(&[&flags[..], &["--arithmetic", word]].concat());
    let (native, exact) = (print(&flags), with("exact"));
    assert!(native.contains(" = o.exp2(") && native == with("gpu-native"));
    assert!(!exact.contains(" = o.exp2(") && exact.contains("the bits of one lane"));
    assert!(!native.contains("the bits of one lane") && native != with("gpu"));
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    for more in [&[][..], &["--out", out]] {
        let error = refused(&[&flags[..], &["--arithmetic", "fused"], more].concat());
        assert!(error.contains("--arithmetic must be exact, gpu or gpu-native"));
    }
    print(&[&flags[..], &["--arithmetic", "exact", "--out", out]].concat());
    let files = ["README.md", "example.py", "hairis_chiang.py"];
    assert_eq!(names(dir.path()), files);
    let python = std::env::var("HAIRIS_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut example = Command::new(python);
    example.args(["-B", "example.py"]).current_dir(dir.path());
    let ran: Run = example.output().unwrap().into();
    let index = fs::read_to_string(dir.path().join("README.md")).unwrap();
    if ran.err.iter().any(|line| line.contains("named 'numpy'")) {
        println!("NumPy is not installed: skipped");
    } else {
        assert!(ran.out.len() == 2 && index.contains(&ran.out.join("\n")));
    }
    // A folder of all languages has those that the arithmetic allows.
    let fused = ["--model", "kajiya-kay", "--arithmetic", "fused"];
    print(&[&fused[..], &["--out", out]].concat());
    assert!(dir.path().join("hairis_kajiya_kay.h").exists());
    assert!(!dir.path().join("hairis_kajiya_kay.py").exists());
}

#[test]
fn a_folder_has_what_the_flags_name() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let flags = ["--model", "kajiya-kay", "--target", "c", "--out", out];
    print(&flags);
    let files = ["README.md", "example.c", "hairis_kajiya_kay.h"];
    assert_eq!(names(dir.path()), files);
    let example = fs::read_to_string(dir.path().join("example.c")).unwrap();
    assert!(example.contains("HairisKajiyaKayParams params = hairis_kajiya_kay_params_brown();"));
    // An example needs functions that are missing here.
    let some = dir.path().join("some");
    print(&[&flags[..5], &[some.to_str().unwrap(), "--call", "eval"]].concat());
    assert_eq!(names(&some), ["README.md", "hairis_kajiya_kay.h"]);
}

#[test]
fn folders_of_others_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    fs::write(path("file"), "").unwrap();
    fs::create_dir(path("project")).unwrap();
    for (out, word) in [
        (path("file"), "cannot write"),
        (path("file/folder"), "cannot write"),
        (String::new(), "a value is required"),
    ] {
        let error = refused(&["--model", "chiang", "--target", "c", "--out", &out]);
        assert!(error.contains(word) && error.contains(&out), "{error}");
    }
    let project = path("project");
    let readme = path("project/README.md");
    let flags = ["--model", "kajiya-kay", "--target", "c", "--out", &project];
    for title in [
        "# Mine",
        "# hairis for Python",
        "# hairis notes as source",
        "# hairis 1 of 2 as source",
    ] {
        fs::write(&readme, title).unwrap();
        let error = refused(&flags);
        assert!(error.contains("--out must be a new folder"), "{error}");
        assert_eq!(names(&dir.path().join("project")), ["README.md"], "{title}");
    }
    // A folder of another version is the command's own.
    fs::write(&readme, "# hairis 9.8.7-rc.1 as source\r\n").unwrap();
    print(&flags);
    // If anything is rejected, nothing is written.
    for flags in [&["--sampler", "best"][..], &["--model", "fur"]] {
        let error = refused(&[flags, &["--out", &path("none")]].concat());
        assert!(error.contains("must be one of"), "{error}");
    }
    assert!(!dir.path().join("none").exists());
}

#[test]
fn bad_flags_are_refused() {
    for (args, word) in [
        (&["--target", "c"][..], "--model"),
        (&["--model", "gausian", "--target", "c"], "gaussian, cauchy"),
        (
            &["--model", "gaussian", "--target", "c", "--sampler", "best"],
            "published, matched",
        ),
        (
            &[
                "--model",
                "kajiya-kay",
                "--target",
                "c",
                "--sampler",
                "best",
            ],
            "one sampler",
        ),
        (&["--model", "gaussian"], "--target"),
        (&["--model", "gaussian", "--target", "cobol"], "wgsl"),
        (
            &["--model", "gaussian", "--target", "c", "--call", "evaluate"],
            "eval_hit",
        ),
        (
            &[
                "--model", "gaussian", "--target", "c", "--call", "eval", "--only", "weight",
            ],
            "value, pdf",
        ),
        (
            &["--model", "gaussian", "--target", "c", "--only", "colour"],
            "colour",
        ),
        (
            &["--material", "missing.json", "--target", "c"],
            "missing.json",
        ),
    ] {
        let error = refused(args);
        assert!(error.contains(word), "{args:?}: {error}");
    }
}

#[test]
fn dual_scattering_is_printed_with_the_averages_of_materials() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("red.json");
    fs::write(&file, good().to_string()).unwrap();
    let (file, model) = (
        file.to_str().unwrap(),
        ["--model", "dual-scattering", "--target", "wgsl"],
    );
    let raw = print(&[&model[..], &["--material", file]].concat());
    for part in ["_shade(material: ", "_material_red() -> "] {
        assert!(raw.contains(part), "{part} in {raw}");
    }
    let conserving = print(&[&model[..], &["--material", file, "--conserving"]].concat());
    assert_ne!(raw, conserving, "the hair is so bright that it is scaled");
    let error = refused(&[&model[..], &["--gradient"]].concat());
    assert!(error.contains("--gradient must be left out"), "{error}");
}
