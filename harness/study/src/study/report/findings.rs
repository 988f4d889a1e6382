//! Findings of a study in sentences. Every word that judges follows from figures and their errors.

use super::super::equal_time::Sign;
use super::super::estimator::{Estimator, Strategy, TOLD, name, published, samplers};
use super::super::finished::Study;
use super::super::refit::saved;
use super::super::view::{Counted, MANY};
use crate::difference::{Difference, Differences, Summary, Width, albedo_ratio};
use hairis_harness::lights::{environment, in_words};
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_instruments::machine;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::number::{self, percent};
use std::path::Path;

/// Returns the sentences, in the order in which a reader would ask.
pub(super) fn findings(of: &Study, difference: &Difference) -> Vec<String> {
    let all = [
        Some(worth(of)),
        limit(of).map(|sentence| sentence.trim_start().to_owned()),
        Some(looks(difference)),
        Some(refitted(of, difference)),
        Some(cost(of)),
        Some(where_not(difference)),
    ];
    all.into_iter().flatten().collect()
}

/// Returns a ratio such as `1.39×`, with its standard error if that is large enough to show.
fn times(of: Estimate) -> String {
    if of.standard_error > 0.005 * of.value {
        number::ratio_with_error(of.value, of.standard_error)
    } else {
        number::ratio(of.value)
    }
}

/// Returns a light's name in a sentence. A file is called the map, and the subtitle names it.
fn said(light: &str) -> &str {
    if is_file(light) { "the map" } else { light }
}

/// Returns the light that is a file, if there is one.
pub(super) fn map(lights: &[String]) -> Option<&String> {
    lights.iter().find(|light| is_file(light))
}

fn is_file(light: &str) -> bool {
    Path::new(light).extension().is_some()
}

/// Joins words as `a`, `a and b`, `a, b and c`; returns "nothing" for no words.
fn listed(words: &[String]) -> String {
    match words {
        [] => "nothing".to_owned(),
        [word] => word.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

/// Calls `words` with the index and the name of each light, and lists the results.
fn by_light(of: &Study, words: &dyn Fn(usize, &str) -> Option<String>) -> String {
    let lights = of.lights().iter().enumerate();
    listed(
        &lights
            .filter_map(|(light, name)| words(light, said(name)))
            .collect::<Vec<_>>(),
    )
}

/// Calls `words` with the name of each sampler of [`TOLD`], and with the sampler on either model, the Gaussian one first.
fn of_told(words: &dyn Fn(&str, [Estimator; 2]) -> Option<String>) -> Vec<String> {
    let pair = |sampler| ModelKind::ALL.map(|model| (model, Some(sampler)));
    TOLD.into_iter()
        .filter_map(|sampler| words(sampler.name(), pair(sampler)))
        .collect()
}

/// Answers whether the replacement is worth it.
fn worth(of: &Study) -> String {
    let parts = of_told(&|sampler, pair| {
        let lights = by_light(of, &|light, name| {
            let gain = of.equal_time(pair, light, Counted::Sample)?;
            let unsure = if Sign::of(gain) == Sign::Unsure {
                ", no difference within the errors"
            } else {
                ""
            };
            Some(format!("{} under {name}{unsure}", times(gain)))
        });
        Some(format!("with `{sampler}` {lights}"))
    });
    format!(
        "Is the Cauchy model worth it? Variance on the Gaussian model over that on the Cauchy model in equal time, {MANY} \
         samples per shading point, medians over the grid: {}.",
        parts.join("; ")
    )
}

/// Returns the samplers that do not differ significantly from the best of a model under a light, with the best one's gain over `published`.
/// A look-up of the light is counted if it was timed.
fn best(of: &Study, model: ModelKind, light: usize) -> Option<(Vec<Strategy>, Estimate)> {
    let counted = if of.look_up(light).value.is_finite() {
        Counted::LookUp
    } else {
        Counted::Sample
    };
    let gain = |strategy: Strategy| {
        let other = (model, strategy);
        let over_published = of.equal_time([published(other), other], light, counted)?;
        Some((
            strategy,
            if other == published(other) {
                Estimate::exact(1.0)
            } else {
                over_published
            },
        ))
    };
    let gains: Vec<_> = samplers().filter_map(gain).collect();
    let most = gains
        .iter()
        .map(|(_, gain)| *gain)
        .max_by(|a, b| a.value.total_cmp(&b.value))?;
    let level = gains
        .iter()
        .filter(|(_, gain)| Sign::of(most.ratio(gain)) != Sign::Above);
    Some((level.map(|(strategy, _)| *strategy).collect(), most))
}

/// Says which sampler is best.
fn which(of: &Study) -> String {
    let parts = ModelKind::ALL.map(|model| {
        let lights = by_light(of, &|light, light_name| {
            let (samplers, gain) = best(of, model, light)?;
            let names: Vec<String> = samplers
                .iter()
                .map(|strategy| format!("`{}`", name(*strategy)))
                .collect();
            Some(format!(
                "{} under {light_name} ({})",
                names.join(" or "),
                times(gain)
            ))
        });
        format!("on the {} model {lights}", model.title())
    });
    format!(
        "Least variance in equal time, with a look-up of the light where it was timed (in brackets the gain over `published`; \
         \"or\": not told apart): {}.",
        parts.join("; ")
    )
}

/// Returns a verdict for each question: the question in a word or two, and the sentence.
pub(super) fn verdicts(of: &Study, difference: &Difference) -> Vec<[String; 2]> {
    let machine = format!("Times are of {}.", machine!().in_words());
    let mut verdicts = vec![["Machine".to_owned(), machine]];
    for (light, name) in of.lights().iter().enumerate() {
        let parts = of_told(&|sampler, pair| {
            let gain = of.gain(pair, light)?;
            let less = 1.0 - 1.0 / gain.median.value;
            let change = match Sign::of(gain.median) {
                Sign::Above => format!("{} fewer", percent(less)),
                Sign::Below if less < -1.0 => format!("{} as many", number::ratio(1.0 - less)),
                Sign::Below => format!("{} more", percent(-less)),
                Sign::Unsure => "as many".to_owned(),
            };
            let [fewer, more] = gain.shares.map(|share| format!("{:.0} %", 100.0 * share));
            Some(format!(
                "`{sampler}` {change} ({fewer} of cells fewer, {more} more)"
            ))
        });
        if !parts.is_empty() {
            verdicts.push([
                format!("Under {}", in_words(said(name))),
                format!("Samples for Cauchy: {}.", parts.join("; ")),
            ]);
        }
    }
    verdicts.push(["Sampler".to_owned(), which(of)]);
    let [plain, blurred] = l1(difference, Width::Paper).map(|of| percent(of.median));
    let [refitted, _] = l1(difference, Width::Refitted).map(|of| percent(of.median));
    verdicts.push([
        "Looks".to_owned(),
        format!("Cauchy looks {plain} different ({blurred} blurred by 10°), and {refitted} once refitted."),
    ]);
    let checks = match of.failures().len() {
        0 => "All checks pass.".to_owned(),
        failed => format!("{failed} checks failed; the terminal names them."),
    };
    verdicts.push(["Accuracy".to_owned(), checks]);
    verdicts
}

/// Returns L1 with a choice of widths, as it is and after the blur.
fn l1(difference: &Difference, width: Width) -> [Summary; 2] {
    let figures: [fn(&Differences) -> f64; 2] = [|f| f.plain.l1, |f| f.blurred.l1];
    figures.map(|figure| difference.summary(width, figure))
}

/// Returns the limit of sampling the hair alone under the environment: V of `published` over that of perfect sampling, and over that of
/// `matched`.
pub(super) fn limit(of: &Study) -> Option<String> {
    let light = environment(of.lights())?;
    let name = &of.lights()[light];
    let gains = |strategy: Strategy| {
        let gain = |model| {
            Some(times(
                of.gain([published((model, None)), (model, strategy)], light)?
                    .median,
            ))
        };
        Some(format!(
            "{} (Gaussian) and {} (Cauchy)",
            gain(ModelKind::Gaussian)?,
            gain(ModelKind::Cauchy)?
        ))
    };
    Some(format!(
        " How far can that go? V of `published` over that of perfect sampling, which draws in proportion to S cos θᵢ, blind to \
         the light, is {} under {}; over that of `matched` it is {}.",
        gains(None)?,
        said(name),
        gains(Some(Sampler::Matched))?
    ))
}

/// Describes the change in looks.
fn looks(difference: &Difference) -> String {
    let [plain, blurred] = l1(difference, Width::Paper).map(|of| [of.median, of.most].map(percent));
    let albedo = difference.summary(Width::Paper, albedo_ratio);
    let [paper, best] = [Width::Paper, Width::BestOfGrid]
        .map(|width| percent(difference.summary(width, |f| f.plain.l2).geometric_mean));
    format!(
        "What does it change in looks? With the same widths the models differ by {} of the Gaussian one's albedo, summed over \
         all directions (median of L1; worst {}), and by {} after a blur of 10° (worst {}); the Cauchy model's albedo is {} to \
         {} of the Gaussian one's. The one factor on the widths that fits the grid best in L2 is {} (L2 {best} against {paper} \
         for k = 1).",
        plain[0],
        plain[1],
        blurred[0],
        blurred[1],
        percent(albedo.least),
        percent(albedo.most),
        difference.factor(Width::BestOfGrid),
    )
}

/// Describes the Cauchy model whose parameters are fitted.
fn refitted(of: &Study, difference: &Difference) -> String {
    let [equal, fitted] = [Width::Paper, Width::Refitted]
        .map(|width| l1(difference, width).map(|of| [of.median, of.most].map(percent)));
    let parts = TOLD.into_iter().enumerate().map(|(place, sampler)| {
        let lights = by_light(of, &|light, name| {
            let gain = of.gain_of_refit(place, light)?;
            Some(format!("{} under {name}", saved(gain.median)))
        });
        format!("with `{}` {lights}", sampler.name())
    });
    let parts: Vec<String> = parts.collect();
    format!(
        "And once it is refitted? With all parameters of the Cauchy model fitted to the look of each hair, the models differ by \
         {} (median of L1; worst {}) in place of {} (worst {}), and by {} after the blur (worst {}). It then saves of the samples \
         on the Gaussian model, medians over the grid: {}.",
        fitted[0][0],
        fitted[0][1],
        equal[0][0],
        equal[0][1],
        fitted[1][0],
        fitted[1][1],
        parts.join("; ")
    )
}

/// Describes the cost of a sample.
fn cost(of: &Study) -> String {
    let parts = of_told(&|sampler, pair| {
        let [gaussian, cauchy] = pair.map(|one| of.ns(one, MANY));
        let words = match Sign::of(gaussian.ratio(&cauchy)) {
            Sign::Above => format!(
                "the Cauchy model is {} as fast",
                times(gaussian.ratio(&cauchy))
            ),
            Sign::Below => format!(
                "the Gaussian model is {} as fast",
                times(cauchy.ratio(&gaussian))
            ),
            Sign::Unsure => "no difference is seen".to_owned(),
        };
        let [gaussian, cauchy] = pair.map(|one| {
            let [many, one] = [MANY, 1].map(|n| number::plain(of.ns(one, n).value, 3));
            format!("{many} ns ({one} ns)")
        });
        Some(format!(
            "`{sampler}` {gaussian} on the Gaussian model and {cauchy} on the Cauchy one: {words}"
        ))
    });
    let look_ups = by_light(of, &|light, name| {
        let ns = of.look_up(light).value;
        ns.is_finite()
            .then(|| format!("{} ns ({name})", number::plain(ns, 2)))
    });
    format!(
        "What does it cost? Time of a sample on this machine, eight lanes, one thread, at {MANY} (1) samples per shading \
         point: {}. A look-up of the light in its direction takes {look_ups} more.",
        parts.join("; ")
    )
}

/// Answers under which conditions the replacement is not worth it.
fn where_not(difference: &Difference) -> String {
    let mut found = difference.along(difference.grid.widths(), Width::Paper, |f| f.plain.l1);
    found.sort_by(|(_, a), (_, b)| a.median.total_cmp(&b.median));
    let most = found
        .last()
        .map(|(beta, l1)| format!("β_R = {beta}° (median L1 {})", percent(l1.median)));
    format!(
        "Where not? In the cells that need more samples, by two standard errors: their shares are given above. The looks \
         change most at {}.",
        most.unwrap_or_default()
    )
}
