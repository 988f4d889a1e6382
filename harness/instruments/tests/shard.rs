//! Tests of `shard`.

use hairis_instruments::shard::Shard;

#[test]
fn shards_are_read_as_they_are_written() {
    for text in ["1/1", "3/8", "8/8"] {
        assert_eq!(
            text.parse::<Shard>().map(|shard| shard.to_string()),
            Ok(text.to_owned())
        );
    }
    for text in [
        "5/4",
        "0/4",
        "0/0",
        "x",
        "1",
        "/",
        "1/",
        "/2",
        "-1/2",
        "+1/2",
        "1/2/3",
        "1.0/2",
        " 1/2",
        "99999999999999999999/2",
    ] {
        assert!(text.parse::<Shard>().is_err(), "{text} is no shard");
    }
}

#[test]
fn every_cell_belongs_to_one_shard() {
    for of in [1, 3, 7, 60] {
        for cell in 0..48 {
            assert_eq!(
                Shard::all(of).filter(|shard| shard.owns(cell)).count(),
                1,
                "cell {cell} of {of} shards"
            );
        }
    }
}
