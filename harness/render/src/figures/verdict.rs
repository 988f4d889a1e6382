//! The sentence that follows from the numbers of a scene.

use super::measure::{BySampler, Measured};
use hairis_harness::stats::Estimate;
use hairis_harness::table::number::ratio_with_error;

/// A gain below this, or within two standard errors of 1, is none.
const GAIN: f64 = 1.15;

/// How many times as large relMSE times time is with a sampler as with the last, at the count that pictures show.
pub(super) fn gain(measured: &Measured, sampler: &BySampler) -> Estimate {
    let shown = measured.shown();
    let best = measured.samplers.last().unwrap_or(sampler);
    sampler.runs[shown].ratio(&best.runs[shown], |errors| errors.relative, true)
}

/// The same without the pixels of the largest errors.
pub(super) fn trimmed_gain(measured: &Measured, sampler: &BySampler) -> Estimate {
    let shown = measured.shown();
    let best = measured.samplers.last().unwrap_or(sampler);
    sampler.runs[shown].ratio(&best.runs[shown], |errors| errors.trimmed, true)
}

/// Whether a ratio is a gain or a loss, by what is left of it within two standard errors.
fn matters(ratio: &Estimate) -> bool {
    let Estimate { value, standard_error, .. } = *ratio;
    (value > GAIN && value - 2.0 * standard_error > 1.0) || (value < 1.0 / GAIN && value + 2.0 * standard_error < 1.0)
}

/// The sentence.
pub(super) fn sentence(measured: &Measured) -> String {
    let samples = measured.samplers[0].runs[measured.shown()].samples;
    let [others @ .., best] = measured.samplers.as_slice() else { return String::new() };
    let list = |gain: fn(&Measured, &BySampler) -> Estimate| {
        let one = |one: &BySampler| {
            let gain = gain(measured, one);
            format!("{} with {}", ratio_with_error(gain.value, gain.standard_error), one.name)
        };
        others.iter().map(one).collect::<Vec<String>>().join(", ")
    };
    let numbers = format!(
        "At {samples} samples, relMSE × time is {}, relative to `{}`; without the worst 0.1 % of the pixels, {}.",
        list(gain),
        best.name,
        list(trimmed_gain)
    );
    let any = others.iter().any(|one| matters(&gain(measured, one)) || matters(&trimmed_gain(measured, one)));
    let answer = if any {
        "Does the sampler matter? Yes."
    } else {
        "Does the sampler matter? No: samples of the light do the work."
    };
    format!("{answer} {numbers}")
}
