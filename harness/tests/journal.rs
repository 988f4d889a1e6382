//! Figures that a killed run leaves.

use hairis_harness::journal::*;
use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::interrupt::Signal;
use std::fs;
use std::path::PathBuf;

const ODD: [f64; 4] = [-0.0, f64::NAN, f64::INFINITY, 0.1 + 0.2];

fn open(dir: &tempfile::TempDir, seed: u64) -> Journal {
    Journal::open(dir.path(), "claims", &seed, Interrupt::default()).expect("a file")
}

/// Returns the numbers, and whether `find` was called.
fn get(journal: &Journal, key: &str) -> ([u64; 4], bool) {
    let mut is_new = false;
    let find = || {
        is_new = true;
        Ok::<_, Error>(ODD)
    };
    let numbers = journal.numbers(key, find).expect("kept");
    (numbers.map(f64::to_bits), is_new)
}

fn only_file(dir: &tempfile::TempDir) -> PathBuf {
    let mut files = fs::read_dir(dir.path()).expect("a folder");
    files.next().expect("a file").expect("read").path()
}

#[test]
fn numbers_come_back_bit_for_bit_from_any_byte() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let bits = ODD.map(f64::to_bits);
    let journal = open(&dir, 1);
    assert_eq!([get(&journal, "a"), get(&journal, "b")], [(bits, true); 2]);
    let other = open(&dir, 2);
    assert_eq!(get(&other, "a"), (bits, true), "other settings");
    other.remove();
    drop(journal);
    let (path, whole) = (only_file(&dir), fs::read(only_file(&dir)).expect("read"));
    let lines: Vec<&[u8]> = whole.split_inclusive(|byte| *byte == b'\n').collect();
    for cut in 0..=whole.len() {
        fs::write(&path, &whole[..cut]).expect("written");
        let journal = open(&dir, 1);
        let first = lines[0].len() + lines[1].len();
        assert_eq!(get(&journal, "a"), (bits, cut < first), "cut at {cut}");
        assert_eq!(
            get(&journal, "b"),
            (bits, cut < whole.len()),
            "cut at {cut}"
        );
        drop(journal);
        assert!(fs::read(&path).expect("read") == whole, "cut at {cut}");
    }
    let mut damaged = whole.clone();
    damaged[lines[0].len() + 20] ^= 1;
    fs::write(&path, &damaged).expect("written");
    let journal = open(&dir, 1);
    assert_eq!([get(&journal, "a").1, get(&journal, "b").1], [true, false]);
    journal.remove();
    assert!(!path.exists());
}

#[test]
fn a_signal_ends_the_run_and_what_it_found_stays() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let interrupt = Interrupt::default();
    let journal = Journal::open(dir.path(), "claims", &1, interrupt.clone()).expect("a file");
    get(&journal, "a");
    interrupt.raise(Signal::Interrupt);
    let find = || -> Result<[f64; 1], Error> { unreachable!("no further figure is begun") };
    let error = journal.numbers("b", find).expect_err("a signal");
    assert_eq!(error.exit_code(), 130);
    assert!(error.to_string().contains("claims-"), "{error}");
    drop(journal);
    assert!(!get(&open(&dir, 1), "a").1);
}
