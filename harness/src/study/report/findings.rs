//! The answer in sentences. Every word that judges follows from figures and their errors.

use super::super::equal_time::Sign;
use super::super::rows::{Estimator, Strategy, name, published, samplers};
use super::super::summary::on_gaussian;
use super::super::view::{Counted, MANY, TOLD, View};
use crate::difference::{Difference, Differences, Summary, Width, albedo_ratio};
use crate::light::in_words;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::table::number::{self, percent};
use std::path::Path;

/// The sentences, in the order in which one would ask.
pub(super) fn findings(of: &View<'_>, difference: &Difference) -> Vec<String> {
    let all = [worth(of), Some(which(of)), Some(looks(difference)), Some(cost(of)), where_not(of, difference)];
    all.into_iter().flatten().collect()
}

/// `1.39×`, with its standard error if that shows.
fn times(of: Estimate) -> String {
    if of.standard_error > 0.005 * of.value {
        number::ratio_with_error(of.value, of.standard_error)
    } else {
        number::ratio(of.value)
    }
}

/// A light in a sentence: a file is the map, which the subtitle names.
fn said(light: &str) -> &str {
    if is_file(light) { "the map" } else { light }
}

/// The light that is a file, if there is one.
pub(super) fn map(lights: &[String]) -> Option<&String> {
    lights.iter().find(|light| is_file(light))
}

fn is_file(light: &str) -> bool {
    Path::new(light).extension().is_some()
}

/// `a`, `a and b`, `a, b and c`; `None` for no words.
fn listed(words: &[String]) -> Option<String> {
    let (last, rest) = words.split_last()?;
    Some(if rest.is_empty() { last.clone() } else { format!("{} and {last}", rest.join(", ")) })
}

/// Calls `words` with the place and the name of each light, and lists the results.
fn by_light(of: &View<'_>, words: impl Fn(usize, &str) -> Option<String>) -> Option<String> {
    let words: Vec<String> =
        of.lights().iter().enumerate().filter_map(|(light, name)| words(light, said(name))).collect();
    listed(&words)
}

/// Calls `words` with the name of each sampler of [`TOLD`], and with the sampler on the Cauchy model.
fn of_told(words: impl Fn(&str, Estimator) -> Option<String>) -> Vec<String> {
    TOLD.into_iter().filter_map(|sampler| words(sampler.name(), (ModelKind::Cauchy, Some(sampler)))).collect()
}

/// Is the replacement worth it?
fn worth(of: &View<'_>) -> Option<String> {
    const SIGNS: [(Sign, &str); 3] = [
        (Sign::Above, "less variance under"),
        (Sign::Below, "more under"),
        (Sign::Unsure, "as much, within the errors, under"),
    ];
    let parts = of_told(|sampler, cauchy| {
        let of_sign = |(sign, what): (Sign, &str)| {
            let lights = by_light(of, |light, name| {
                let gain = of.equal_time([on_gaussian(cauchy), cauchy], light, Counted::Sample)?;
                let shown = if sign == Sign::Below { Estimate::exact(1.0).ratio(&gain) } else { gain };
                (Sign::of(gain) == sign).then(|| format!("{name} ({})", times(shown)))
            });
            Some(format!("{what} {}", lights?))
        };
        let parts: Vec<String> = SIGNS.into_iter().filter_map(of_sign).collect();
        (!parts.is_empty()).then(|| format!("with `{sampler}` it has {}", parts.join(", ")))
    });
    (!parts.is_empty()).then(|| {
        format!(
            "Is the Cauchy model worth it? Against the Gaussian model in equal time, {MANY} samples per shading point, \
             medians over the grid: {}.",
            parts.join("; ")
        )
    })
}

/// The samplers that are not told from the best of a model under a light, with the best one's gain over `published`.
fn best(of: &View<'_>, model: ModelKind, light: usize, counted: Counted) -> Option<(Vec<Estimator>, Estimate)> {
    let gain = |other: Estimator| {
        let over_published = of.equal_time([published(other), other], light, counted)?;
        Some((other, if other == published(other) { Estimate::exact(1.0) } else { over_published }))
    };
    let gains: Vec<_> = samplers().filter_map(|strategy| gain((model, strategy))).collect();
    let most = gains.iter().map(|(_, gain)| *gain).max_by(|a, b| a.value.total_cmp(&b.value))?;
    let level = gains.iter().filter(|(_, gain)| Sign::of(most.ratio(gain)) != Sign::Above);
    Some((level.map(|(sampler, _)| *sampler).collect(), most))
}

/// The best samplers of each model with the lights they are best under, in words; with a look-up only where it changes the
/// answer.
fn best_by_light(of: &View<'_>, counted: Counted) -> String {
    let of_model = |model: ModelKind| {
        // Lights with the same best samplers share a part of the sentence.
        let mut groups: Vec<(Vec<Estimator>, Vec<String>)> = Vec::new();
        for (light, name) in of.lights().iter().enumerate() {
            let Some((samplers, gain)) = best(of, model, light, counted) else { continue };
            let is_same = |(alone, _): (Vec<Estimator>, _)| alone == samplers;
            if counted == Counted::LookUp && best(of, model, light, Counted::Sample).is_some_and(is_same) {
                continue;
            }
            let with_gain = || format!("{} ({})", said(name), times(gain));
            let words = if samplers.contains(&published(samplers[0])) { said(name).to_owned() } else { with_gain() };
            match groups.iter_mut().find(|(group, _)| *group == samplers) {
                Some((_, lights)) => lights.push(words),
                None => groups.push((samplers, vec![words])),
            }
        }
        let part = |(samplers, lights): &(Vec<Estimator>, Vec<String>)| {
            let names: Vec<String> = samplers.iter().map(|(_, strategy)| format!("`{}`", name(*strategy))).collect();
            Some(format!("{} under {}", names.join(" or "), listed(lights)?))
        };
        let parts: Vec<String> = groups.iter().filter_map(part).collect();
        (!parts.is_empty()).then(|| format!("on the {} model {}", model.title(), parts.join(", ")))
    };
    ModelKind::ALL.into_iter().filter_map(of_model).collect::<Vec<_>>().join("; ")
}

/// Which sampler?
fn which(of: &View<'_>) -> String {
    let [alone, with] = [Counted::Sample, Counted::LookUp].map(|counted| best_by_light(of, counted));
    let is_timed = (0..of.lights().len()).all(|light| of.look_up(light).value.is_finite());
    let given = if is_timed { "" } else { ", where it was timed" };
    let with = if with.is_empty() { "the same".to_owned() } else { format!("{with}; else the same") };
    format!(
        "Which sampler? Least variance in equal time, {MANY} samples per shading point (in brackets how many times less than \
         `published`; \"or\": not told apart): {alone}. With a look-up of the light counted in{given}: {with}.{}",
        limit(of).unwrap_or_default()
    )
}

/// A verdict for each light, and one on the looks: the case and the sentence.
pub(super) fn verdicts(of: &View<'_>, difference: &Difference) -> Vec<[String; 2]> {
    let mut verdicts = Vec::new();
    for (light, name) in of.lights().iter().enumerate() {
        let parts = of_told(|sampler, cauchy| {
            let gain = of.gain(on_gaussian(cauchy), cauchy, light)?;
            let less = 1.0 - 1.0 / gain.median.value;
            let change = match Sign::of(gain.median) {
                Sign::Above => format!("{} fewer samples", percent(less)),
                Sign::Below if less < -1.0 => format!("{} as many samples", number::ratio(1.0 - less)),
                Sign::Below => format!("{} more samples", percent(-less)),
                Sign::Unsure => "as many samples".to_owned(),
            };
            let [fewer, more] = gain.shares.map(|share| format!("{:.0} %", 100.0 * share));
            Some(format!("{change} with `{sampler}` (fewer in {fewer} of the cells, more in {more})"))
        });
        if let Some(parts) = listed(&parts) {
            verdicts.push([format!("Under {}", in_words(said(name))), format!("Cauchy takes {parts}.")]);
        }
    }
    let [plain, blurred] = l1(difference).map(|of| percent(of.median));
    verdicts.push(["Looks".to_owned(), format!("Cauchy looks {plain} different ({blurred} blurred by 10°).")]);
    verdicts
}

/// L1 with the same widths, as it is and after the blur.
fn l1(difference: &Difference) -> [Summary; 2] {
    let figures: [fn(&Differences) -> f64; 2] = [|f| f.plain.l1, |f| f.blurred.l1];
    figures.map(|figure| difference.summary(Width::Paper, figure))
}

/// How far sampling of the hair can go under the environment: V of `published` over that of perfect sampling, and of `matched`.
fn limit(of: &View<'_>) -> Option<String> {
    let (light, name) = of.lights().iter().enumerate().next_back()?;
    let gains = |strategy: Strategy| {
        let gain = |model| Some(times(of.gain(published((model, None)), (model, strategy), light)?.median));
        Some(format!("{} (Gaussian) and {} (Cauchy)", gain(ModelKind::Gaussian)?, gain(ModelKind::Cauchy)?))
    };
    Some(format!(
        " How far can that go? V of `published` over that of perfect sampling, which draws in proportion to S cos θᵢ, blind to \
         the light, is {} under {}; over that of `matched` it is {}.",
        gains(None)?,
        said(name),
        gains(Some(Sampler::Matched))?
    ))
}

/// Sentences on the change in looks.
fn looks(difference: &Difference) -> String {
    let [plain, blurred] = l1(difference).map(|of| [of.median, of.most].map(percent));
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

/// Sentences on the cost.
fn cost(of: &View<'_>) -> String {
    let parts = of_told(|sampler, cauchy| {
        let pair = [on_gaussian(cauchy), cauchy];
        let [gaussian, cauchy] = pair.map(|of_one| of.ns(of_one, MANY));
        let words = match Sign::of(gaussian.ratio(&cauchy)) {
            Sign::Above => format!("the Cauchy model is {} as fast", times(gaussian.ratio(&cauchy))),
            Sign::Below => format!("the Gaussian model is {} as fast", times(cauchy.ratio(&gaussian))),
            Sign::Unsure => "no difference is seen".to_owned(),
        };
        let [gaussian, cauchy] = pair.map(|of_one| {
            let [many, one] = [MANY, 1].map(|n| number::plain(of.ns(of_one, n).value, 3));
            format!("{many} ns ({one} ns)")
        });
        Some(format!("`{sampler}` {gaussian} on the Gaussian model and {cauchy} on the Cauchy one: {words}"))
    });
    let mut look_ups: Vec<(f64, &str)> =
        of.lights().iter().zip(0..).map(|(name, light)| (of.look_up(light).value, said(name))).collect();
    look_ups.retain(|(ns, _)| ns.is_finite());
    look_ups.sort_by(|a, b| a.0.total_cmp(&b.0));
    let shown = |(ns, name): &(f64, &str)| format!("{} ns ({name})", number::plain(*ns, 2));
    let ends = look_ups.first().zip(look_ups.last());
    let look_up = ends.map_or_else(String::new, |(least, most)| {
        format!(" A look-up of the light in its direction takes {} to {} more.", shown(least), shown(most))
    });
    format!(
        "What does it cost? Time of a sample on this machine, eight lanes, one thread, at {MANY} (1) samples a gather \
         point: {}.{look_up}",
        parts.join("; ")
    )
}

/// In which conditions not?
fn where_not(of: &View<'_>, difference: &Difference) -> Option<String> {
    let parts = of_told(|sampler, cauchy| {
        let words = by_light(of, |light, name| {
            let is_worse = |[gaussian, cauchy]: &[Estimate; 2]| Sign::of(gaussian.ratio(cauchy)) == Sign::Below;
            let worse = of.pairs(on_gaussian(cauchy), cauchy, light).filter(is_worse).count();
            let share = percent(worse as f64 / of.cells.len() as f64);
            (worse > 0).then(|| format!("{share} of the cells under {name}"))
        });
        Some(format!("with `{sampler}` in {}", words?))
    });
    let l1 = |beta: &f32| {
        let rows = difference.of(Width::Paper).filter(|row| row.cell.beta_r_deg == *beta);
        (*beta, Summary::of(rows.map(|row| row.figures.plain.l1)).median)
    };
    let (beta, l1) = of.grid().beta_r_deg.iter().map(l1).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let looks = format!("the looks change most at β_R = {beta}° (median L1 {})", percent(l1));
    Some(if parts.is_empty() {
        format!("Where not? No cell was found in which the Cauchy model needs more samples; {looks}.")
    } else {
        let parts = parts.join("; ");
        format!("Where not? The Cauchy model needs more samples, beyond two standard errors, {parts}; {looks}.")
    })
}
