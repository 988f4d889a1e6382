//! Tests of `figures::store`.

use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::stats::Estimate;
use hairis_render::figures::store::{Films, Store, parse};
use hairis_render::film::Picture;
use hairis_render::part::build;
use hairis_render::protocol::{Errors, Runs};
use std::fs;
use std::path::{Path, PathBuf};

fn runs() -> Runs {
    let errors = [1.0, 3.0].map(|x| Errors {
        values: [x, 0.7 * x, 0.5 * x, 0.25 * x],
        own: [1e-9; 4],
    });
    let pixels = (0..12_u8)
        .map(|k| [1.0, 0.1, 1.0 / 3.0].map(|x| x * f64::from(k)))
        .collect();
    Runs {
        samples: 16,
        seconds: 0.75,
        errors: errors.to_vec(),
        variance: Estimate {
            value: 2.0,
            standard_error: 0.25,
        },
        picture: Picture {
            size: [4, 3],
            pixels,
        },
        bias: vec![-0.125; 12],
        squares: vec![0.1; 12],
    }
}

fn new(out: &Path) -> Result<Store, Error> {
    Store::new(out, Interrupt::default())
}

fn only_file(store: &Store) -> PathBuf {
    let mut files = fs::read_dir(store.folder()).expect("a folder");
    files.next().expect("a file").expect("read").path()
}

#[test]
fn settings_that_differ_share_nothing() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let store = new(folder.path()).expect("a folder");
    let get = |store: &Store, settings: &str| {
        let mut made = false;
        let make = |_: &Films<'_>| {
            made = true;
            Ok(runs())
        };
        assert_eq!(store.get("area", settings, make).expect("written"), runs());
        made
    };
    assert!(get(&store, "seed=1"));
    assert!(
        !get(&store, "seed=1") && store.resumed() == 0,
        "the same run"
    );
    let again = new(folder.path()).expect("a folder");
    assert!(
        !get(&again, "seed=1") && again.resumed() == 1,
        "the next run"
    );
    assert!(get(&again, "seed=2"), "another seed");
    let other = new(folder.path())
        .expect("a folder")
        .with_build("commit=other".to_owned());
    assert!(get(&other, "seed=1"), "another build");
    other.remove();
    again.remove();
    assert!(
        !folder.path().join("unfinished").exists(),
        "both have left nothing"
    );
}

#[test]
fn other_formats_are_refused_by_name() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let store = new(folder.path()).expect("a folder");
    store
        .get("area", "seed=1", |_| Ok(runs()))
        .expect("written");
    new(folder.path()).expect("the same format");
    let path = store.folder().join("box-uniform-4-0123.part");
    fs::write(&path, "hairis-render measurement 1\nscene=box\n\u{0}").expect("written");
    let message = new(folder.path()).expect_err("refused").to_string();
    assert!(
        message.contains("box-uniform-4-0123.part") && message.contains("measurement 1\""),
        "{message}"
    );
}

#[test]
fn damaged_files_are_measured_again() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let store = new(folder.path()).expect("a folder");
    store
        .get("area", "seed=1", |_| Ok(runs()))
        .expect("written");
    let path = only_file(&store);
    let (good, key) = (
        fs::read(&path).expect("there"),
        format!("seed=1 {}", build()),
    );
    assert_eq!(parse(&good, &key), Some(runs()));
    for byte in 0..good.len() {
        let mut bad = good.clone();
        bad[byte] ^= 4;
        assert_eq!(parse(&bad, &key), None, "byte {byte} changed");
        assert_eq!(parse(&good[..byte], &key), None, "cut at {byte}");
    }
    fs::write(&path, &good[..99]).expect("written");
    let mut made = false;
    let make = |_: &Films<'_>| {
        made = true;
        Ok(runs())
    };
    store.get("area", "seed=1", make).expect("written");
    assert!(
        made && fs::read(&path).expect("there") == good,
        "whole again"
    );
}
