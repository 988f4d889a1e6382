//! Tests of `stats::spread`.

use hairis_instruments::stats::percentile;

#[test]
fn percentiles_match_type_seven() {
    let s = [1.0, 2.0, 3.0, 4.0];
    for (p, want) in [
        (0.0, 1.0),
        (0.25, 1.75),
        (0.5, 2.5),
        (0.75, 3.25),
        (1.0, 4.0),
        (2.0, 4.0),
        (-1.0, 1.0),
    ] {
        assert_eq!(percentile(&s, p), want, "p {p}");
    }
    assert!(percentile(&[], 0.5).is_nan());
    assert_eq!(percentile(&[7.0], 0.99), 7.0);
    assert_eq!(percentile(&[f64::INFINITY; 3], 0.3), f64::INFINITY);
}
