//! Tests of `part`.

use glam::Vec3;
use hairis_render::film::{Crop, Film};
use hairis_render::part::{Log, MAGIC, Part, record};
use std::fs;
use std::path::PathBuf;

fn part() -> Part {
    part_of(20)
}

/// Returns a part with tiles of this height.
fn part_of(height: u32) -> Part {
    let mut film = Film::new(Crop {
        x: 3,
        y: 0,
        width: 70,
        height,
    });
    for (k, tile) in (0_u16..).zip(&mut film.tiles) {
        tile.samples = 4;
        tile.seconds = 0.5;
        tile.first = vec![
            [0.1, 0.2, 0.3, 1.0, 0.0, 0.0, f32::from(k)];
            if k == 1 { 0 } else { tile.sums.len() }
        ];
        tile.sums
            .iter_mut()
            .for_each(|sums| sums.add(Vec3::splat(1.0 / f32::from(k + 3))));
    }
    Part {
        run: "scene=head seed=1".to_owned(),
        film,
        finished: false,
    }
}

#[test]
fn files_hold_every_bit() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.part");
    // Every length of the file is read: it is short.
    let whole = part_of(2);
    whole.write(&path).expect("written");
    assert_eq!(Part::read(&path).expect("read"), whole);
    let bytes = fs::read(&path).expect("there");
    let header = whole.header().len();
    // Whatever happens to a file, a tile is as it was or not there.
    let tiles = |bytes: &[u8]| {
        let read = Part::from_bytes(bytes)?;
        assert_eq!((&read.run, read.finished), (&whole.run, false));
        assert!(
            read.film
                .tiles
                .iter()
                .all(|tile| whole.film.tiles.contains(tile)),
            "a tile that was never written"
        );
        Some(read.film.tiles.len())
    };
    let mut counts = Vec::new();
    for length in 0..bytes.len() {
        let count = tiles(&bytes[..length]);
        assert_eq!(count.is_none(), length < header, "cut at {length}");
        counts.extend(count);
    }
    assert!(
        counts.is_sorted() && counts.last() == Some(&2),
        "{counts:?}"
    );
    for byte in (0..bytes.len()).step_by(97) {
        let mut damaged = bytes.clone();
        damaged[byte] ^= 4;
        let count = tiles(&damaged);
        assert_eq!(count.is_none(), byte < header, "byte {byte} changed");
        assert!(count.is_none_or(|count| count < 3), "byte {byte} changed");
    }
    let earlier = [b"hairis-render part 3\n", &bytes[MAGIC.len() + 1..]].concat();
    fs::write(&path, earlier).expect("written");
    let message = Part::read(&path).expect_err("refused").to_string();
    assert!(
        message.contains("part 4\", got \"hairis-render part 3\""),
        "{message}"
    );
    assert!(Part::read(&folder.path().join("none")).is_err());
}

#[test]
fn runs_go_on_from_their_own_parts() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.part");
    let fresh = |run: &str| Part {
        run: run.to_owned(),
        film: Film::new(part().film.crop()),
        finished: false,
    };
    let (same, other) = ("scene=head seed=1", "scene=head seed=2");
    let resume = |fresh, samples| {
        Part::resume(&path, fresh, samples)
            .map(|(part, _)| part)
            .map_err(|error| error.to_string())
    };
    assert_eq!(
        resume(fresh(same), Some(8)),
        Ok(fresh(same)),
        "there is no file"
    );
    part().write(&path).expect("written");
    assert_eq!(resume(fresh(same), Some(4)), Ok(part()));
    assert_eq!(resume(fresh(same), None), Ok(part()));
    let refused = |fresh, samples| resume(fresh, samples).expect_err("refused");
    assert!(refused(fresh(other), None).contains("seed=1, expected seed=2"));
    assert!(refused(fresh(same), Some(3)).contains("has 4 samples, more than --spp 3"));
    let mut shard = fresh(same);
    shard.film.tiles.remove(1);
    assert!(refused(shard, None).contains("another shard"));
    Part {
        finished: true,
        ..part()
    }
    .write(&path)
    .expect("written");
    assert_eq!(
        resume(fresh(other), Some(4)),
        Ok(fresh(other)),
        "a finished picture"
    );
    assert_eq!(resume(fresh(same), Some(3)), Ok(fresh(same)));
    assert!(resume(fresh(same), Some(8)).expect("its own").finished);
}

#[test]
fn parts_of_one_run_join_and_others_do_not() {
    let (mut a, mut b) = (part(), part());
    a.film.tiles.truncate(1);
    b.film.tiles.remove(0);
    let named = |name: &str, part: &Part| (PathBuf::from(name), part.clone());
    assert_eq!(
        Part::merge(vec![named("b", &b), named("a", &a)]).expect("whole"),
        part()
    );
    let message = |parts| Part::merge(parts).expect_err("refused").to_string();
    assert!(message(vec![named("a", &a)]).contains("2 of 3 tiles"));
    let mut none = b.clone();
    none.film.tiles.clear();
    assert_eq!(
        Part::merge(vec![named("none", &none), named("b", &b), named("a", &a)]).expect("whole"),
        part()
    );
    let mut more = b.clone();
    more.film.tiles.iter_mut().for_each(|tile| tile.samples = 8);
    let refused = message(vec![named("a", &a), named("more", &more)]);
    assert!(
        refused.contains("more: has 8 samples, expected 4 as in a"),
        "{refused}"
    );
    b.run = "scene=box seed=1".to_owned();
    assert!(
        message(vec![named("a", &a), named("b", &b)]).contains("scene=box, expected scene=head")
    );
}

/// Checks that tiles are appended as they get samples, and that a file that is cut anywhere continues
/// from its whole records.
#[test]
fn logs_hold_what_was_saved_last() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.part");
    let mut growing = Part {
        film: Film::new(part().film.crop()),
        ..part()
    };
    let fresh = growing.clone();
    let mut log = Log::new(&path);
    log.save(&growing).expect("written");
    assert!(Part::read(&path).expect("read").film.tiles.is_empty());
    for (place, samples) in [(1, 4), (0, 4), (2, 4), (1, 8)] {
        let tile = &mut growing.film.tiles[place];
        tile.samples = samples;
        tile.sums
            .iter_mut()
            .for_each(|sums| sums.add(Vec3::splat(1.0)));
        log.save(&growing).expect("written");
        let read = Part::resume(&path, fresh.clone(), None);
        let in_use = read.expect_err("in use").to_string();
        assert!(in_use.contains("another process"), "{in_use}");
    }
    assert_eq!(Part::read(&path).expect("read"), growing);
    drop(log);
    let mixed = Part::merge(vec![(path.clone(), growing.clone())]).expect_err("unfinished");
    assert!(
        mixed.to_string().contains("tiles of 4 to 8 samples"),
        "{mixed}"
    );

    let bytes = fs::read(&path).expect("there");
    let last = record(&growing.film.tiles[1]).len();
    fs::write(&path, &bytes[..bytes.len() - last / 2]).expect("written");
    let (mut again, mut log) = Part::resume(&path, fresh, None).expect("goes on");
    assert_eq!(again.film.samples(), 4);
    assert_eq!(again.film.most_samples(), 4, "its second samples are torn");
    again.film.tiles[1] = growing.film.tiles[1].clone();
    log.save(&again).expect("written");
    drop(log);
    assert_eq!(fs::read(&path).expect("there"), bytes);
}

/// Checks that a file does not grow without end.
#[test]
fn logs_are_written_anew_when_most_of_them_is_out_of_date() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.part");
    let mut growing = part();
    let size = growing.to_bytes().len() as u64;
    let mut log = Log::new(&path);
    let length = || fs::metadata(&path).expect("there").len();
    let mut longest = 0;
    for samples in 5..1000 {
        growing
            .film
            .tiles
            .iter_mut()
            .for_each(|tile| tile.samples = samples);
        log.save(&growing).expect("written");
        longest = longest.max(length());
    }
    drop(log);
    assert!(
        (2 * size..9_000_000 + 4 * size).contains(&longest),
        "{longest}"
    );
    assert!(length() < longest, "written anew");
    assert_eq!(Part::read(&path).expect("read"), growing);
}
