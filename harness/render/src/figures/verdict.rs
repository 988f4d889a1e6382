//! The sentence that follows from the numbers of a scene.

use super::measure::{BySampler, Measured};
use crate::protocol::Errors;
use core::cmp::Ordering;
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

/// The two that say most: what is seen of most pixels, and what the brightest errors add to it.
const HEADLINE: [(&str, Error); 2] = [ERRORS[2], ERRORS[0]];

/// How many times as large an error times time is with a sampler as with the last, at the count that pictures show.
pub(super) fn gain(measured: &Measured, sampler: &BySampler, error: Error) -> Estimate {
    let shown = measured.shown();
    let best = measured.samplers.last().unwrap_or(sampler);
    sampler.runs[shown].ratio(&best.runs[shown], error, true)
}

/// Whether a ratio is above 1 by a gain, is below it by one, or is neither, by what is left of it within two standard errors.
fn side(ratio: &Estimate) -> Ordering {
    let Estimate { value, standard_error, .. } = *ratio;
    if value > GAIN && value - 2.0 * standard_error > 1.0 {
        Ordering::Greater
    } else if value < 1.0 / GAIN && value + 2.0 * standard_error < 1.0 {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

/// Names the samplers that the last one beats, loses to and equals, by the two errors that say most.
fn answer(measured: &Measured) -> String {
    use Ordering::{Equal, Greater, Less};
    let [others @ .., best] = measured.samplers.as_slice() else { return String::new() };
    let sides = |one: &BySampler| HEADLINE.map(|(_, error)| side(&gain(measured, one, error)));
    if others.iter().all(|one| sides(one) == [Equal; 2]) {
        return "The sampler does not matter: samples of the light do the work.".to_owned();
    }
    let of = |before: &str, is: fn([Ordering; 2]) -> bool, behind: &str| {
        let names: Vec<&str> = others.iter().filter(|one| is(sides(one))).map(|one| one.name).collect();
        (!names.is_empty()).then(|| format!("{before} {}{behind}", listed(&names)))
    };
    let parts = [
        of("beats", |sides| sides.contains(&Greater) && !sides.contains(&Less), ""),
        of("loses to", |sides| sides.contains(&Less) && !sides.contains(&Greater), ""),
        of("equals", |sides| sides == [Equal; 2], ""),
        of("against", |sides| sides.contains(&Greater) && sides.contains(&Less), ", it depends on the error"),
    ];
    format!("`{}` {}.", best.name, parts.into_iter().flatten().collect::<Vec<String>>().join("; "))
}

/// "a", "a and b", "a, b and c".
fn listed(names: &[&str]) -> String {
    match names {
        [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => names.concat(),
    }
}

/// The answer, with the two errors that say most in short.
pub(super) fn headline(measured: &Measured) -> String {
    let [others @ .., best] = measured.samplers.as_slice() else { return String::new() };
    let one = |one: &BySampler| {
        let [trimmed, square] = HEADLINE.map(|(_, error)| ratio(gain(measured, one, error).value));
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
