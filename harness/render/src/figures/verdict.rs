//! Sentences that follow from the numbers of a scene.

use super::measure::{BySampler, Measured, RESAMPLED};
use crate::protocol::{Measure, Runs};
use core::cmp::Ordering;
use hairis_instruments::report::literal;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::number::{ratio, ratio_with_error};

/// Least ratio of errors that counts as a gain, if it also differs from 1 by more than two standard errors.
const GAIN: f64 = 1.15;

/// Measures of error that are compared.
pub(super) const MEASURES: [Measure; 3] = [Measure::Mse, Measure::RelMse, Measure::TrimmedRelMse];
/// Two measures that say most: one of what is seen of most pixels, and one of what the brightest errors add to it.
const HEADLINE: [Measure; 2] = [Measure::TrimmedRelMse, Measure::Mse];

/// Mark behind errors that cannot be told from noise of the reference.
pub const BELOW: &str = " (below the reference)";

/// Ratio of two errors, and whether one of them is below the reference.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    /// Ratio of the errors.
    pub ratio: Estimate,
    /// Whether an error cannot be told from noise of the reference.
    pub is_below: bool,
}

impl Gain {
    /// Returns the ratio of the error of `runs` to that of `best`, each multiplied by its time if `with_time` is set.
    pub(super) fn new(runs: &Runs, best: &Runs, measure: Measure, with_time: bool) -> Self {
        let is_below = runs.is_below_reference(measure) || best.is_below_reference(measure);
        Self {
            ratio: runs.ratio(best, measure, with_time),
            is_below,
        }
    }

    /// Formats the ratio with its standard error, and a mark if an error is below the reference.
    #[must_use]
    pub fn text(&self) -> String {
        let mark = if self.is_below { BELOW } else { "" };
        ratio_with_error(self.ratio.value, self.ratio.standard_error) + mark
    }

    /// Returns `Greater` or `Less` if the ratio differs from 1 by a gain and by more than two standard errors, and otherwise `Equal`.
    #[must_use]
    pub fn side(&self) -> Ordering {
        let Estimate {
            value,
            standard_error,
            ..
        } = self.ratio;
        if self.is_below {
            Ordering::Equal
        } else if value > GAIN && value - 2.0 * standard_error > 1.0 {
            Ordering::Greater
        } else if value < 1.0 / GAIN && value + 2.0 * standard_error < 1.0 {
            Ordering::Less
        } else {
            Ordering::Equal
        }
    }

    /// Returns true if the ratio lies between 1 / `GAIN` and `GAIN` with two standard errors to spare: a gain is ruled out, rather than
    /// not found.
    #[must_use]
    pub fn is_none(&self) -> bool {
        let Estimate {
            value,
            standard_error,
            ..
        } = self.ratio;
        let spare = 2.0 * standard_error;
        !self.is_below && value + spare < GAIN && value - spare > 1.0 / GAIN
    }
}

/// Returns the ratio of error times time with a sampler to that with the last one, at the count of samples that pictures show.
pub(super) fn gain(measured: &Measured, sampler: &BySampler, measure: Measure) -> Gain {
    let shown = measured.shown();
    let best = measured.samplers.last().unwrap_or(sampler);
    Gain::new(&sampler.runs[shown], &best.runs[shown], measure, true)
}

fn headline_gains(measured: &Measured, sampler: &BySampler) -> [Gain; 2] {
    HEADLINE.map(|measure| gain(measured, sampler, measure))
}

/// Returns true if it matters how directions are drawn. It does not if both errors times time are those of the last sampler, with every
/// sampler that draws directions. Rays chosen from candidates do not count here, because they are another way to choose rays.
fn matters(measured: &Measured) -> bool {
    let drawn = measured
        .samplers
        .iter()
        .rev()
        .skip(1)
        .filter(|one| one.name != RESAMPLED);
    !drawn
        .flat_map(|one| headline_gains(measured, one))
        .all(|gain| gain.is_none())
}

/// Returns the margin of [`Gain::is_none`] in words.
fn within() -> String {
    format!("within {:.0} % of", 100.0 * (GAIN - 1.0))
}

/// Names the samplers that the last one beats, loses to and equals, by the two errors that say most.
fn answer(measured: &Measured) -> String {
    use Ordering::{Greater, Less};
    let [others @ .., best] = measured.samplers.as_slice() else {
        return String::new();
    };
    let matters = matters(measured);
    let others: Vec<&BySampler> = others
        .iter()
        .filter(|one| matters || one.name == RESAMPLED)
        .collect();
    let of = |before: &str, is: &dyn Fn([Gain; 2]) -> bool, behind: &str| {
        let named: Vec<&str> = others
            .iter()
            .filter(|one| is(headline_gains(measured, one)))
            .map(|one| one.name)
            .collect();
        (!named.is_empty()).then(|| format!("{before} {}{behind}", listed(&named)))
    };
    let has = |gains: [Gain; 2], side: Ordering| gains.iter().any(|gain| gain.side() == side);
    let is_equal = |gains: [Gain; 2]| !has(gains, Greater) && !has(gains, Less);
    let is_none = |gains: [Gain; 2]| gains.iter().all(Gain::is_none);
    let within = format!("is {}", within());
    let parts = [
        of(
            "beats",
            &|gains| has(gains, Greater) && !has(gains, Less),
            "",
        ),
        of(
            "loses to",
            &|gains| has(gains, Less) && !has(gains, Greater),
            "",
        ),
        of(&within, &|gains| is_none(gains), ""),
        of(
            "does not differ measurably from",
            &|gains| is_equal(gains) && !is_none(gains),
            "",
        ),
        of(
            "against",
            &|gains| has(gains, Greater) && has(gains, Less),
            ", it depends on the error",
        ),
    ];
    let compared = format!(
        "`{}` {}.",
        best.name,
        parts
            .into_iter()
            .flatten()
            .collect::<Vec<String>>()
            .join("; ")
    );
    if matters {
        compared
    } else {
        let drawn = measured.samplers.iter().filter(|one| one.name != RESAMPLED);
        let drawn: Vec<&str> = drawn.map(|one| one.name).collect();
        format!(
            "The sampler does not matter: {} directions do equally well. {compared}",
            listed(&drawn)
        )
    }
}

/// Joins names as in "a", "a and b" and "a, b and c".
fn listed(names: &[&str]) -> String {
    match names {
        [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => names.concat(),
    }
}

/// Returns the names of the samplers that others are compared with.
pub(super) fn best(all: &[Measured]) -> String {
    let mut names: Vec<&str> = all.iter().map(Measured::best).collect();
    names.sort_unstable();
    names.dedup();
    names.join(" or ")
}

/// Names the scenes where the sampler does not matter, and states the rule.
pub(super) fn scenes(all: &[Measured]) -> String {
    let (yes, no): (Vec<&Measured>, Vec<&Measured>) =
        all.iter().partition(|measured| matters(measured));
    let names = |scenes: &[&Measured]| {
        let titles: Vec<String> = scenes
            .iter()
            .map(|measured| format!("`{}`", literal(&measured.title())))
            .collect();
        listed(&titles.iter().map(String::as_str).collect::<Vec<&str>>())
    };
    let rule = format!(
        "Rule: with every sampler but {RESAMPLED}, error × time is {} that with {}, by MSE and by trimmed relMSE, with two standard \
         errors to spare.",
        within(),
        best(all)
    );
    match (no.as_slice(), yes.as_slice()) {
        ([], _) => format!("In none of these scenes. {rule}"),
        (no, []) => format!("In all of these scenes: {}. {rule}", names(no)),
        (no, yes) => format!("In {}. It matters in {}. {rule}", names(no), names(yes)),
    }
}

/// Returns the answer, followed by the two errors that say most.
pub(super) fn headline(measured: &Measured) -> String {
    let [others @ .., best] = measured.samplers.as_slice() else {
        return String::new();
    };
    let one = |one: &BySampler| {
        let gains = headline_gains(measured, one);
        let [trimmed, square] = gains.map(|gain| ratio(gain.ratio.value));
        let mark = if gains.iter().any(|gain| gain.is_below) {
            BELOW
        } else {
            ""
        };
        format!("{} {trimmed} ({square}){mark}", one.name)
    };
    let list = others.iter().map(one).collect::<Vec<String>>().join(", ");
    format!(
        "{} Trimmed relMSE × time (MSE × time), relative to `{}`: {list}.",
        answer(measured),
        best.name
    )
}

/// Returns the answer, followed by all errors with their standard errors.
pub(super) fn sentence(measured: &Measured) -> String {
    let samples = measured.samplers[0].runs[measured.shown()].samples;
    let [others @ .., best] = measured.samplers.as_slice() else {
        return String::new();
    };
    let list = |measure: Measure| {
        let one =
            |one: &BySampler| format!("{} with {}", gain(measured, one, measure).text(), one.name);
        format!(
            "{} {}",
            measure.name(),
            others.iter().map(one).collect::<Vec<String>>().join(", ")
        )
    };
    let numbers = format!(
        "At {samples} samples, error × time relative to `{}`: {}. Trimmed: without the worst 0.1 % of the pixels.",
        best.name,
        MEASURES.map(list).join("; ")
    );
    format!("{} {numbers}", answer(measured))
}

/// States the share of rays towards lights that reach them.
pub(super) fn visible(measured: &Measured) -> String {
    format!(
        "{:.0} % of the rays towards lights reach them.",
        100.0 * measured.visible
    )
}
