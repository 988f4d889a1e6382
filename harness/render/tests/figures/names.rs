//! Tests of `figures::names`.

use hairis_render::figures::names::{of_files, of_pictures};
use std::path::PathBuf;

fn names(paths: &[&str]) -> Vec<String> {
    let paths: Vec<PathBuf> = paths.iter().map(PathBuf::from).collect();
    of_files(&paths).expect("different")
}

#[test]
fn names_of_maps_are_as_short_as_they_can_be() {
    assert_eq!(names(&["/a/b/sky.exr"]), ["sky.exr"]);
    assert_eq!(
        names(&["m1/map.exr", "./m2/map.exr", "other.exr"]),
        ["m1/map.exr", "m2/map.exr", "other.exr"]
    );
    assert_eq!(
        names(&["map.exr", "m1/map.exr", "x/m1/map.exr"]),
        ["map.exr", "m1/map.exr", "x/m1/map.exr"]
    );
    assert_eq!(names(&["/map.exr", "map.exr"]), ["/map.exr", "map.exr"]);
    let twice = ["a.exr", "./a.exr"].map(PathBuf::from);
    let error = of_files(&twice).expect_err("the same").to_string();
    assert!(
        error.contains("--env") && error.contains("a.exr twice"),
        "{error}"
    );
}

#[cfg(unix)]
#[test]
fn names_that_are_no_text_stay_apart() {
    use std::os::unix::ffi::OsStrExt as _;
    let paths = [&b"\xfe.exr"[..], b"\xff.exr"]
        .map(|name| PathBuf::from(std::ffi::OsStr::from_bytes(name)));
    let names = of_files(&paths).expect("different");
    assert_ne!(names[0], names[1]);
}

#[test]
fn pictures_of_scenes_stay_apart() {
    let titles = ["env (a/b.exr)", "env (a-b.exr)", "env (A b.exr)", "area"].map(str::to_owned);
    assert_eq!(
        of_pictures(&titles),
        [
            "env--a-b-exr-",
            "env--a-b-exr--2",
            "env--A-b-exr--3",
            "area"
        ]
    );
}
