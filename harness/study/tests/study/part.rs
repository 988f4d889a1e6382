//! Part files: finished cells, and damage.

use hairis_instruments::error::Error;
use hairis_instruments::light::Sky;
use hairis_instruments::shard::Shard;
use hairis_study::study::part::*;
use hairis_study::study::{Plan, Size};
use std::fs;

fn header(seed: u64) -> Header {
    let sky = Sky::default().environment();
    Plan {
        seed,
        size: Size::Quick,
        lights: (&sky).into(),
        materials: &[],
    }
    .header(Shard::WHOLE)
}

fn finished(cell: usize, header: &Header) -> Finished {
    let mut row = [Some(0.1); NUMBERS];
    row[1..8].copy_from_slice(&[
        Some(1e-300),
        None,
        None,
        Some(f64::MAX),
        Some(1.0 / 3.0),
        Some(0.0),
        None,
    ]);
    row[NUMBERS - 1] = None;
    Finished {
        cell,
        rows: vec![row; header.rows()],
    }
}

#[test]
fn cells_come_back_as_they_were() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let header = header(1);
    let (part, before) = Part::open(dir.path(), &header).expect("new");
    assert!(before.is_empty());
    let cells = [finished(3, &header), finished(0, &header)];
    cells
        .iter()
        .for_each(|cell| part.keep(cell).expect("written"));
    let read = read(part.path()).expect("read");
    assert_eq!(
        (read.header, &read.finished[..]),
        (header.clone(), &cells[..])
    );
    assert!(
        cells[0].measured()[0].figures.v.value.is_nan(),
        "what is no number stays none"
    );
    assert_eq!(Finished::of(3, &cells[0].measured()), cells[0]);
    let again = Part::open(dir.path(), &header);
    assert!(
        matches!(&again, Err(Error::Part { problem, .. }) if problem.contains("another process")),
        "{again:?}"
    );
    drop(part);
    let (_, before) = Part::open(dir.path(), &header).expect("free again");
    assert_eq!(before, cells);
}

#[test]
fn a_part_goes_on_from_any_byte() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let header = header(1);
    let keep = |part: &Part, cell| part.keep(&finished(cell, &header)).expect("written");
    let path = {
        let (part, _) = Part::open(dir.path(), &header).expect("new");
        [0, 1].into_iter().for_each(|cell| keep(&part, cell));
        part.path().to_owned()
    };
    let whole = fs::read(&path).expect("read");
    for cut in 0..=whole.len() {
        fs::write(&path, &whole[..cut]).expect("written");
        let (part, before) = Part::open(dir.path(), &header).expect("goes on");
        let lines = whole[..cut].iter().filter(|byte| **byte == b'\n').count();
        assert_eq!(before.len(), lines.saturating_sub(1), "cut at {cut}");
        (before.len()..2).for_each(|cell| keep(&part, cell));
        assert!(fs::read(&path).expect("read") == whole, "cut at {cut}");
    }
}

#[test]
fn headers_tell_runs_apart_but_for_the_shard() {
    let (one, two) = (header(1), header(2));
    assert_eq!(
        one.difference(&two),
        Some(["seed".to_owned(), "1".to_owned(), "2".to_owned()])
    );
    assert_eq!(
        one.difference(&Header {
            shard: "2/3".to_owned(),
            ..one.clone()
        }),
        None
    );
}

#[test]
fn a_changed_byte_is_found() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let header = header(1);
    let path = {
        let (part, _) = Part::open(dir.path(), &header).expect("new");
        [2, 5]
            .into_iter()
            .for_each(|cell| part.keep(&finished(cell, &header)).expect("written"));
        part.path().to_owned()
    };
    let bytes = fs::read(&path).expect("read");
    let mut places = 0;
    // Every digit of the file, header and checksums included, except those of the format's name.
    for place in (40..bytes.len())
        .filter(|place| bytes[*place].is_ascii_digit())
        .step_by(7)
    {
        let mut changed = bytes.clone();
        changed[place] = if changed[place] == b'9' {
            b'8'
        } else {
            changed[place] + 1
        };
        let error = parse(&path, &changed)
            .expect_err(&format!("byte {place}"))
            .to_string();
        let line = 1 + bytes[..place].iter().filter(|byte| **byte == b'\n').count();
        assert!(
            error.contains(&format!(
                "line {line} is damaged: its checksum is wrong; delete the"
            )),
            "{error}"
        );
        places += 1;
    }
    assert!(places > 100, "{places}");
}
