//! Numbers as people read them, formatted in this one place for the terminal, the report and the plots.

use crate::stats::Estimate;

/// `value` with as many digits as its standard error deserves: two of the error, or one if it is 4 to 9, and no more
/// than six of the value.
///
/// ```
/// use hairis_harness::table::number::with_error;
/// assert_eq!(with_error(0.20912, 0.0011), "0.2091 ± 0.0011");
/// assert_eq!(with_error(13.42, 0.0), "13.42");
/// ```
#[must_use]
pub fn with_error(value: f64, error: f64) -> String {
    if !(error > 0.0 && error.is_finite() && value.is_finite()) {
        return plain(value, 4);
    }
    let size = value.abs().max(error);
    if !(1e-4..1e6).contains(&size) {
        let exponent = size.log10().floor();
        let unit = 10.0_f64.powf(exponent);
        let places = error_places(error / unit).min(5);
        let value = format!("({:.places$} ± {:.places$})", value / unit, error / unit);
        return minus(&format!("{value}×10{}", superscript(exponent)));
    }
    let places = error_places(error);
    if places > self::places(size, 6) {
        // The error is below the last digit shown.
        return plain(value, 6);
    }
    minus(&format!("{value:.places$} ± {error:.places$}"))
}

/// [`with_error`] of an estimate.
#[must_use]
pub fn estimate(of: &Estimate) -> String {
    with_error(of.value, of.standard_error)
}

/// `value` to `digits` significant digits; powers of ten outside of 10^-4 .. 10^6.
#[must_use]
pub fn plain(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return odd(value);
    }
    if !(1e-4..1e6).contains(&value.abs()) {
        // Rounding may carry into one more digit: 9.96e-5 to one digit is 10^-4.
        let half = 0.5 * 10.0_f64.powf(-f64::from(u32::try_from(digits).unwrap_or(17)));
        let exponent = (value.abs() / (1.0 - half)).log10().floor();
        let places = digits.saturating_sub(1);
        return minus(&format!("{:.places$}×10{}", value / 10.0_f64.powf(exponent), superscript(exponent)));
    }
    let places = places(value, digits);
    minus(&format!("{value:.places$}"))
}

/// A ratio: `13.4×`.
#[must_use]
pub fn ratio(value: f64) -> String {
    format!("{}×", plain(value, 3))
}

/// A ratio with its standard error: `13.4× ± 0.2`.
#[must_use]
pub fn ratio_with_error(value: f64, error: f64) -> String {
    let text = with_error(value, error);
    match text.split_once(" ± ") {
        Some((value, error)) if !value.starts_with('(') => format!("{value}× ± {error}"),
        _ => format!("{text}×"),
    }
}

/// A big count to three digits with an SI prefix: `12.3 M`, and `12.3 Msamples/s` with the unit `samples/s`.
#[must_use]
pub fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 5] = [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, "")];
    // 999.5 and above would round to 1000 of the smaller unit.
    let large = PREFIXES.into_iter().find(|(size, _)| value.abs() >= size * 0.9995);
    let (size, prefix) = large.unwrap_or((1.0, ""));
    let text = if value.fract() == 0.0 && value.abs() < 1e3 { plain(value, 3) } else { plain(value / size, 3) };
    let text = if value.fract() == 0.0 && size == 1.0 { minus(&format!("{value}")) } else { text };
    if prefix.is_empty() && unit.is_empty() { text } else { format!("{text} {prefix}{unit}") }
}

/// A share as a percentage to three digits.
#[must_use]
pub fn percent(share: f64) -> String {
    format!("{} %", plain(share * 100.0, 3))
}

/// A time in seconds, in the unit that suits it: `8.31 ns`.
#[must_use]
pub fn seconds(value: f64) -> String {
    const UNITS: [(f64, &str); 4] = [(1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")];
    let unit = UNITS.into_iter().find(|(size, _)| value.abs() >= size * 0.9995);
    let (size, name) = unit.unwrap_or(if value == 0.0 { (1.0, "s") } else { (1e-9, "ns") });
    format!("{} {name}", plain(value / size, 3))
}

/// A label of a linear axis whose labels are `step` apart.
pub(crate) fn tick(value: f64, step: f64) -> String {
    if value != 0.0 && !(1e-4..1e6).contains(&value.abs()) {
        let exponent = value.abs().log10().floor();
        let unit = 10.0_f64.powf(exponent);
        let places = places(step / unit, 1).min(6);
        return minus(&format!("{:.places$}×10{}", value / unit, superscript(exponent)));
    }
    let places = places(step, 1).min(9);
    minus(&format!("{value:.places$}"))
}

/// A label of a logarithmic axis: `digit` times ten to the `exponent`.
pub(crate) fn power(digit: f64, exponent: f64) -> String {
    if (-3.0..=3.0).contains(&exponent) {
        return plain(digit * 10.0_f64.powf(exponent), 1);
    }
    let ten = format!("10{}", superscript(exponent));
    if digit == 1.0 { ten } else { format!("{digit}×{ten}") }
}

/// Decimal places that a standard error deserves: rounding to one digit is too coarse for 1 to 3.
fn error_places(error: f64) -> usize {
    let lead = error / 10.0_f64.powf(error.log10().floor());
    places(error, if lead < 3.55 { 2 } else { 1 })
}

/// Decimal places that show `digits` significant digits of `value`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0 .. 17 before the cast")]
fn places(value: f64, digits: usize) -> usize {
    let digits = f64::from(u32::try_from(digits).unwrap_or(17));
    // Rounding may carry into one more digit: 0.0996 to two digits is 0.10.
    let exponent = (value.abs() * (1.0 + 0.5 * 10.0_f64.powf(-digits))).log10().floor();
    let places = digits - 1.0 - exponent;
    if places.is_finite() { places.clamp(0.0, 17.0) as usize } else { 0 }
}

fn odd(value: f64) -> String {
    match value {
        v if v.is_nan() => "n/a".to_owned(),
        v if v > 0.0 => "∞".to_owned(),
        _ => "−∞".to_owned(),
    }
}

fn minus(text: &str) -> String {
    text.replace('-', "−")
}

fn superscript(exponent: f64) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '0'..='9' => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][usize::from(c as u8 - b'0')],
        other => other,
    };
    format!("{exponent:.0}").chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(ratio_with_error(13.42, 0.21), "13.42× ± 0.21", "a ratio with an error");
        assert_eq!(si(123.0, "samples"), "123 samples", "a small count is exact");
        assert_eq!(si(12_345_678.0, "samples/s"), "12.3 Msamples/s", "a large one is not");
        assert_eq!(si(999_999.0, ""), "1.00 M", "no 1000 k");
        assert_eq!(seconds(8.312e-9), "8.31 ns", "a time");
        assert_eq!(seconds(0.0), "0 s", "no time");
        assert_eq!(percent(0.123_4), "12.3 %", "a share");
        assert_eq!(plain(f64::NEG_INFINITY, 3), "−∞", "infinite");
        assert_eq!(plain(0.000_012_3, 2), "1.2×10⁻⁵", "small");
        assert_eq!(plain(999.96, 4), "1000", "a carry");
        assert_eq!([plain(9.96e-5, 1), plain(9.94e-5, 2)], ["1×10⁻⁴", "9.9×10⁻⁵"], "a carry into the exponent");
    }
}
