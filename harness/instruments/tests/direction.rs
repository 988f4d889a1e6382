//! Tests of `direction`.

use hairis_instruments::direction::uniform_direction;
use hairis_instruments::sequence::Independent;

#[test]
fn directions_are_unit() {
    let mut xi = Independent::new(3, 1);
    for _ in 0..1_000 {
        let length = uniform_direction(&mut xi).length();
        assert!((length - 1.0).abs() < 3e-7, "length {length}");
    }
}
