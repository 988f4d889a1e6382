//! Tests of `table::number`.

use hairis_instruments::table::number::{percent, plain, ratio, ratio_with_error, with_error};

#[test]
fn values_have_the_digits_of_their_error() {
    let cases = [
        (0.209, 0.001, "0.2090 ± 0.0010"),
        (0.20912, 0.0234, "0.209 ± 0.023"),
        (123.4, 17.0, "123 ± 17"),
        (0.2091, 0.0044, "0.209 ± 0.004"),
        (-2.5, 0.25, "−2.50 ± 0.25"),
        (0.0, 0.0021, "0.0000 ± 0.0021"),
        (1.5, f64::NAN, "1.500"),
        (f64::NAN, 1.0, "n/a"),
        (0.299_999_999, 1e-12, "0.300000"),
        (1.234e-6, 5.0e-8, "(1.23 ± 0.05)×10⁻⁶"),
    ];
    for (value, error, text) in cases {
        assert_eq!(with_error(value, error), text, "{value} {error}");
    }
}

#[test]
fn numbers_have_their_units() {
    assert_eq!(ratio(13.42), "13.4×", "a ratio");
    assert_eq!(
        ratio_with_error(13.42, 0.21),
        "13.42× ± 0.21",
        "a ratio with an error"
    );
    assert_eq!(percent(0.123_4), "12.3 %", "a share");
    assert_eq!(plain(f64::NEG_INFINITY, 3), "−∞", "infinite");
    assert_eq!(plain(0.000_012_3, 2), "1.2×10⁻⁵", "small");
    assert_eq!(plain(999.96, 4), "1000", "a carry");
    assert_eq!(
        [plain(9.96e-5, 1), plain(9.94e-5, 2)],
        ["1×10⁻⁴", "9.9×10⁻⁵"],
        "a carry into the exponent"
    );
}
