//! Paths of any bytes that the system allows.
#![cfg(unix)]

use super::{SMALL, run};
use exr::prelude::{AttributeValue, Text, read_all_flat_layers_from_file};
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Returns the attribute `command` of a picture.
fn command(path: &Path) -> String {
    let file = read_all_flat_layers_from_file(path).expect("a picture");
    let attributes = &file.layer_data[0].attributes.other;
    match attributes.get(&Text::from("command")) {
        Some(AttributeValue::Text(text)) => text.to_string(),
        other => panic!("{other:?}"),
    }
}

/// Returns a file of hair in the format of cyHair: one strand of one segment.
fn hair() -> Vec<u8> {
    let mut bytes = b"HAIR".to_vec();
    for number in [1_u32, 2, 2, 1] {
        bytes.extend(number.to_le_bytes());
    }
    for number in [0.1_f32, 0.0, 1.0, 1.0, 1.0] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.resize(128, 0);
    for number in [0.0_f32, 0.0, 0.0, 0.0, 5.0, 0.0] {
        bytes.extend(number.to_le_bytes());
    }
    bytes
}

/// Map of a sky of one colour.
const SKY: &[u8] = b"#?RGBE\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81";

#[test]
fn any_path_works_everywhere() {
    let program = env!("CARGO_BIN_EXE_hairis-render");
    for stem in [
        "日本".as_bytes(),
        b"\xff\xfe",
        b"a b'c\"d\\e$(f)",
        b"line\nline\x07",
        b"",
    ] {
        let folder = TempDir::new().expect("a folder");
        let name = |end: &str| {
            let mut name = OsStr::from_bytes(stem).to_owned();
            name.push(end);
            name
        };
        // The program lies in such a folder, too.
        let inside = folder.path().join(name("-folder"));
        fs::create_dir(&inside).expect("made");
        let at = |end: &str| inside.join(name(end)).into_os_string();
        let link = at("-program");
        symlink(program, &link).expect("linked");
        fs::write(at("x.hair"), hair()).expect("written");
        fs::write(at("x.hdr"), SKY).expect("written");
        let call = |flags: &[OsString]| {
            let output = Command::new(&link).args(flags).output().expect("it starts");
            let errors = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success(), "{stem:?}: {errors}");
            errors
        };
        let mut flags: Vec<OsString> = ["render", "env", "--spp", "1"].map(OsString::from).into();
        flags.extend(SMALL.map(OsString::from));
        for (flag, end) in [
            ("--import", "x.hair"),
            ("--env", "x.hdr"),
            ("--export", "x.txt"),
            ("--out", "x.exr"),
        ] {
            flags.extend([flag.into(), at(end)]);
        }
        let errors = call(&flags);
        // One remark to a line, whatever the path is.
        assert!(!errors.contains('\x07'), "{errors:?}");
        assert!(
            errors.contains("is not 2:1") || errors.contains("albedo of the hair"),
            "{errors}"
        );
        let words = command(Path::new(&at("x.exr")));
        assert!(words.is_ascii() && !words.contains('\n'), "{words}");
        // Bash reads it as it was given.
        let printed = Command::new("bash")
            .args(["-c", &format!("printf '%s\\0' {words}")])
            .output()
            .expect("bash");
        let given: Vec<&[u8]> = printed.stdout.split(|byte| *byte == 0).collect();
        assert_eq!(given[0], link.as_bytes());
        let flags_given = given[1..].iter().zip(&flags);
        assert_eq!(given.len(), flags.len() + 2);
        assert!(
            flags_given
                .into_iter()
                .all(|(given, flag)| *given == flag.as_bytes())
        );
        // As a shard, joined.
        flags.extend(["--shard".into(), "1/1".into()]);
        call(&flags);
        call(&["merge".into(), at("joined.exr"), at("x.1-of-1.part")]);
        assert!(
            command(Path::new(&at("joined.exr"))).contains(" merge "),
            "joined"
        );
    }
}

#[test]
fn a_link_to_a_picture_stays() {
    let folder = TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("far")).expect("made");
    symlink("far/real.exr", at("link.exr")).expect("linked");
    let flags = [
        &["render", "head", "--spp", "1", "--out", "link.exr"][..],
        &SMALL,
    ]
    .concat();
    // The picture is not there yet, then it is.
    for _ in 0..2 {
        assert!(run(&folder, &flags).status.success());
        assert!(
            fs::symlink_metadata(at("link.exr"))
                .expect("there")
                .is_symlink()
        );
        assert!(
            !fs::symlink_metadata(at("far/real.exr"))
                .expect("there")
                .is_symlink()
        );
        fs::remove_file(at("link.part")).expect("there");
    }
}
