//! The sentence that follows from the numbers of a scene.

use super::measure::{BySampler, Measured};
use crate::protocol::Errors;
use hairis_harness::stats::Estimate;
use hairis_harness::table::number::{ratio, ratio_with_error};

/// A gain below this, or within two standard errors of 1, is none.
const GAIN: f64 = 1.15;

/// An error of pictures.
pub(super) type Error = fn(&Errors) -> f64;

/// The errors that are compared, by name: the last without the pixels of the largest.
pub(super) const ERRORS: [(&str, Error); 3] = [
    ("MSE", |errors| errors.square),
    ("relMSE", |errors| errors.relative),
    ("trimmed relMSE", |errors| errors.trimmed),
];

/// How many times as large an error times time is with a sampler as with the last, at the count that pictures show.
pub(super) fn gain(measured: &Measured, sampler: &BySampler, error: Error) -> Estimate {
    let shown = measured.shown();
    let best = measured.samplers.last().unwrap_or(sampler);
    sampler.runs[shown].ratio(&best.runs[shown], error, true)
}

/// Whether a ratio is a gain or a loss, by what is left of it within two standard errors.
fn matters(ratio: &Estimate) -> bool {
    let Estimate { value, standard_error, .. } = *ratio;
    (value > GAIN && value - 2.0 * standard_error > 1.0) || (value < 1.0 / GAIN && value + 2.0 * standard_error < 1.0)
}

/// Whether the sampler matters.
fn answer(measured: &Measured) -> &'static str {
    let [others @ .., _] = measured.samplers.as_slice() else { return "" };
    // Relative errors are what is seen.
    let any = others.iter().any(|one| ERRORS[1..].iter().any(|(_, error)| matters(&gain(measured, one, *error))));
    if any { "The sampler matters." } else { "The sampler does not matter: samples of the light do the work." }
}

/// The answer, with the two errors that say most in short.
pub(super) fn headline(measured: &Measured) -> String {
    let [others @ .., best] = measured.samplers.as_slice() else { return String::new() };
    let [(_, square), _, (_, trimmed)] = ERRORS;
    let one = |one: &BySampler| {
        let [trimmed, square] = [trimmed, square].map(|error| ratio(gain(measured, one, error).value));
        format!("{} {trimmed} ({square})", one.name)
    };
    let list = others.iter().map(one).collect::<Vec<String>>().join(", ");
    format!("{} Trimmed relMSE × time (MSE × time), relative to `{}`: {list}.", answer(measured), best.name)
}

/// All errors, with their standard errors.
pub(super) fn sentence(measured: &Measured) -> String {
    let samples = measured.samplers[0].runs[measured.shown()].samples;
    let [others @ .., best] = measured.samplers.as_slice() else { return String::new() };
    let list = |(name, error): &(&str, Error)| {
        let one = |one: &BySampler| {
            let gain = gain(measured, one, *error);
            format!("{} with {}", ratio_with_error(gain.value, gain.standard_error), one.name)
        };
        format!("{name} {}", others.iter().map(one).collect::<Vec<String>>().join(", "))
    };
    let numbers = format!(
        "At {samples} samples, error × time relative to `{}`: {}. Trimmed: without the worst 0.1 % of the pixels.",
        best.name,
        ERRORS.iter().map(list).collect::<Vec<String>>().join("; ")
    );
    format!("{} {numbers}", answer(measured))
}

/// How many rays see a light.
pub(super) fn visible(measured: &Measured) -> String {
    format!("{:.0} % of the rays towards lights reach them.", 100.0 * measured.visible)
}
