//! Files that are written as a whole, through links, and with long names.

use hairis_program::files::{LONGEST_NAME, whole, writable};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};

#[test]
fn a_file_is_whole_or_as_it_was() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let path = dir.path().join("figures.json");
    let names = || fs::read_dir(dir.path()).expect("read").count();
    writable(&path).expect("a new file");
    assert_eq!(names(), 0, "asking leaves nothing");
    whole(&path, |out| out.write_all(b"before")).expect("written");
    writable(&path).expect("an old file");
    let full = |out: &mut BufWriter<File>| {
        out.write_all(b"half of it")?;
        Err(io::Error::from(io::ErrorKind::StorageFull))
    };
    let error = whole(&path, full).expect_err("full").to_string();
    assert!(
        error.contains("figures.json") && !error.contains(".new"),
        "{error}"
    );
    assert_eq!(
        (fs::read(&path).expect("read"), names()),
        (b"before".to_vec(), 1)
    );
    assert!(writable(dir.path()).is_err(), "a folder");
    assert!(
        writable(&dir.path().join("none/file")).is_err(),
        "no folder"
    );
}

#[cfg(unix)]
#[test]
fn links_stay_and_their_files_are_written() {
    use std::os::unix::fs::symlink;
    let dir = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| dir.path().join(name);
    fs::create_dir(at("far")).expect("made");
    symlink("far/second", at("first")).expect("linked");
    symlink("../file", at("far/second")).expect("linked");
    // The file does not exist in the first pass, and exists in the second.
    for text in [b"one", b"two"] {
        writable(&at("first")).expect("writable");
        whole(&at("first"), |out| out.write_all(text)).expect("written");
        assert_eq!(fs::read(at("file")).expect("read"), text);
    }
    for link in ["first", "far/second"] {
        let link = fs::symlink_metadata(at(link)).expect("there");
        assert!(link.is_symlink(), "{link:?}");
    }
    assert_eq!(fs::read_dir(dir.path()).expect("read").count(), 3);
    symlink("loop", at("loop")).expect("linked");
    let error = whole(&at("loop"), |_| Ok(()))
        .expect_err("a loop")
        .to_string();
    assert!(error.contains("too many symbolic links"), "{error}");
    symlink("/dev/null", at("null")).expect("linked");
    writable(&at("null")).expect("a device");
    whole(&at("null"), |out| out.write_all(b"gone")).expect("a device");
    let null = fs::metadata("/dev/null").expect("there");
    assert!(!null.is_file() && !null.is_dir(), "the device is still one");
}

#[test]
fn the_longest_names_are_written() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let path = dir.path().join("a".repeat(LONGEST_NAME));
    writable(&path).expect("writable");
    whole(&path, |out| out.write_all(b"text")).expect("written");
    assert_eq!(fs::read(&path).expect("read"), b"text");
}
