//! Names of lights.

use hairis_harness::lights::*;
use hairis_instruments::light::Sky;

#[test]
fn names_are_distinct_and_found() {
    let all = Lights::default().all();
    for (place, light) in all.iter().enumerate() {
        let same = all.iter().position(|other| other.name() == light.name());
        assert_eq!(same, Some(place), "{} is the name of two", light.name());
        assert_eq!(in_words(light.name()), light.words());
    }
    assert_eq!(in_words(Sky::NAME), Sky::WORDS);
    assert_eq!(in_words("a map.hdr"), "a map.hdr");
    let names = ["sun", "a map.hdr", "constant", "moon"].map(str::to_owned);
    assert_eq!(environment(&names), Some(1));
}
