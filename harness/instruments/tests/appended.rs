//! Tests of `appended`.

use hairis_instruments::appended::Appended;
use std::fs;
use std::path::Path;

#[test]
fn records_follow_the_whole_ones() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let path = dir.path().join("a");
    fs::write(&path, "one\ntwo\nthr").expect("written");
    let file = Appended::open(&path).expect("free");
    let again = Appended::open(&path).expect_err("in use").to_string();
    assert!(again.contains("another process"), "{again}");
    file.cut(8).expect("cut");
    file.cut(100).expect("nothing to cut");
    file.append(b"three\n").expect("written");
    drop(file);
    assert_eq!(fs::read(&path).expect("read"), b"one\ntwo\nthree\n");
    Appended::open(&path).expect("free again");
}

#[test]
#[cfg(target_os = "linux")]
fn nothing_follows_a_record_that_could_not_be_written() {
    let path = Path::new("/dev/full");
    let file = Appended::open(path).expect("Linux has it");
    file.cut(0).expect("nothing to cut");
    // Any of several threads may be the one whose error is reported, so all of them name the cause.
    for _ in 0..3 {
        let error = file.append(b"one\n").expect_err("full").to_string();
        assert!(
            error.starts_with("cannot write /dev/full: No space left"),
            "{error}"
        );
    }
    let error = file.cut(0).expect_err("nothing is done after that");
    assert!(error.to_string().contains("No space left"), "{error}");
}
