//! Tests of `light::rectangle`.

use hairis_instruments::light::{Light as _, Rectangle};

#[test]
fn corners_come_from_the_corners_of_the_square() {
    let r = Rectangle;
    let last = 1.0 - f64::EPSILON / 2.0;
    for (xi, want) in [
        ([0.0, 0.0], [-2.0, -0.5]),
        ([last, last], [2.0, 0.5]),
        ([0.5, 0.5], [0.0, 0.0]),
    ] {
        let dir = r.sample(xi).dir;
        let got = [dir.x / dir.y, dir.z / dir.y];
        assert!(
            (got[0] - want[0]).abs() < 1e-12 && (got[1] - want[1]).abs() < 1e-12,
            "{xi:?}: {got:?}"
        );
    }
}
