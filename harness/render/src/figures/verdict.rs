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

/// The sentence.
pub(super) fn sentence(measured: &Measured) -> String {
    let samples = measured.samplers[0].runs[measured.shown()].samples;
    let [others @ .., best] = measured.samplers.as_slice() else { return String::new() };
    let gains: Vec<(&str, Estimate)> = others.iter().map(|one| (one.name, gain(measured, one))).collect();
    let matters = |gain: &Estimate| gain.value > GAIN && gain.value - 2.0 * gain.standard_error > 1.0;
    let list = |gains: &[(&str, Estimate)]| {
        let one = |(name, gain): &(&str, Estimate)| {
            format!("{} of {name}", ratio_with_error(gain.value, gain.standard_error))
        };
        gains.iter().map(one).collect::<Vec<String>>().join(" and ")
    };
    if gains.iter().any(|(_, gain)| matters(gain)) {
        format!(
            "at {samples} samples the relative error times time is {} with respect to `{}`: the sampler matters here.",
            list(&gains),
            best.name
        )
    } else {
        format!(
            "the sampler does not matter here: at {samples} samples the relative error times time is {} with respect to \
             `{}`; samples of the light do the work.",
            list(&gains),
            best.name
        )
    }
}
