//! Numbers as people read them, formatted in this single module for the terminal, the report and the plots.

use crate::stats::Estimate;

/// Formats `value` with as many digits as its standard error deserves. The error has two digits, or one digit if its leading digit is 4
/// to 9; the value has at most six.
///
/// ```
/// use hairis_instruments::table::number::with_error;
/// assert_eq!(with_error(0.20912, 0.0011), "0.2091 ± 0.0011");
/// assert_eq!(with_error(13.42, 0.0), "13.42");
/// ```
#[must_use]
pub fn with_error(value: f64, error: f64) -> String {
    if !(error > 0.0 && error.is_finite() && value.is_finite()) {
        return plain(value, 4);
    }
    let size = value.abs().max(error);
    let (unit, power) = unit(size, 6);
    let places = error_places(error / unit);
    if places > self::places(size / unit, 6) {
        // The error is below the last digit of the value that is shown.
        return plain(value, 6);
    }
    let text = minus(&format!(
        "{:.places$} ± {:.places$}",
        value / unit,
        error / unit
    ));
    if power.is_empty() {
        text
    } else {
        format!("({text}){power}")
    }
}

/// Formats an estimate as [`with_error`] does.
#[must_use]
pub fn estimate(of: &Estimate) -> String {
    with_error(of.value, of.standard_error)
}

/// Formats `value` with `digits` significant digits, and with a power of ten outside 10^-4 .. 10^6.
#[must_use]
pub fn plain(value: f64, digits: usize) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if value.is_nan() => "n/a".to_owned(),
        value if value.is_infinite() => minus(&value.to_string()).replace("inf", "∞"),
        value => {
            let (unit, power) = unit(value, digits);
            let places = places(value / unit, digits);
            minus(&format!("{:.places$}{power}", value / unit))
        }
    }
}

/// Formats a ratio with three significant digits: `13.4×`.
#[must_use]
pub fn ratio(value: f64) -> String {
    format!("{}×", plain(value, 3))
}

/// Formats a ratio with its standard error: `13.4× ± 0.2`.
#[must_use]
pub fn ratio_with_error(value: f64, error: f64) -> String {
    let text = with_error(value, error);
    match text.split_once(" ± ") {
        Some((value, error)) if !value.starts_with('(') => format!("{value}× ± {error}"),
        _ => format!("{text}×"),
    }
}

/// Formats a share as a percentage with three significant digits.
#[must_use]
pub fn percent(share: f64) -> String {
    format!("{} %", plain(share * 100.0, 3))
}

/// Formats a label of a linear axis whose labels are `step` apart.
pub(crate) fn tick(value: f64, step: f64) -> String {
    let (unit, power) = unit(value, 17);
    let places = places(step / unit, 1).min(9);
    minus(&format!("{:.places$}{power}", value / unit))
}

/// Formats a label of a logarithmic axis: `digit` times ten to the `exponent`.
pub(crate) fn power(digit: i32, exponent: f64) -> String {
    if (-3.0..=3.0).contains(&exponent) {
        return plain(f64::from(digit) * 10.0_f64.powf(exponent), 1);
    }
    let power = power_of_ten(exponent);
    if digit == 1 {
        power
    } else {
        format!("{digit}×{power}")
    }
}

/// Returns the number of decimal places that a standard error deserves, because rounding to one digit is too coarse for 1 to 3.
fn error_places(error: f64) -> usize {
    let lead = error / 10.0_f64.powf(error.log10().floor());
    places(error, if lead < 3.55 { 2 } else { 1 })
}

/// Returns the number of decimal places that show `digits` significant digits of `value`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0 .. 17 before the cast"
)]
fn places(value: f64, digits: usize) -> usize {
    let digits = digits as f64;
    // Rounding may carry into one more digit: 0.0996 to two digits is 0.10.
    let exponent = (value.abs() * (1.0 + 0.5 * 10.0_f64.powf(-digits)))
        .log10()
        .floor();
    let places = digits - 1.0 - exponent;
    if places.is_finite() {
        places.clamp(0.0, 17.0) as usize
    } else {
        0
    }
}

fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// Returns the unit in which a number is written to `digits` digits, with its text: 1, or a power of ten outside 10^-4 .. 10^6.
fn unit(value: f64, digits: usize) -> (f64, String) {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e6).contains(&size) {
        return (1.0, String::new());
    }
    // Rounding may carry into one more digit: 9.96e-5 to one digit is 10^-4.
    let half = 0.5 * 10.0_f64.powf(-(digits as f64));
    let exponent = (size / (1.0 - half)).log10().floor();
    (
        10.0_f64.powf(exponent),
        format!("×{}", power_of_ten(exponent)),
    )
}

/// Formats a power of ten with raised digits.
fn power_of_ten(exponent: f64) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '0'..='9' => {
            ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][usize::from(c as u8 - b'0')]
        }
        other => other,
    };
    format!(
        "10{}",
        format!("{exponent:.0}")
            .chars()
            .map(raised)
            .collect::<String>()
    )
}
