//! The answer in sentences. Every word that judges follows from figures and their errors.

use super::super::equal_time::Sign;
use super::super::rows::Strategy;
use super::view::{Counted, Estimator, MANY, TOLD, View};
use crate::difference::{Summary, Width, albedo_ratio};
use crate::light::in_words;
use crate::sampler::Sampler;
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::table::number;
use std::path::Path;

const GAUSSIAN: ModelKind = ModelKind::Gaussian;
const CAUCHY: ModelKind = ModelKind::Cauchy;

/// The sentences, in the order in which one would ask.
pub(super) fn findings(of: &View<'_>) -> Vec<String> {
    [worth(of), Some(which(of)), Some(looks(of)), Some(cost(of)), where_not(of)].into_iter().flatten().collect()
}

/// `1.39×`, with its standard error if that shows.
fn times(of: Estimate) -> String {
    if of.standard_error > 0.005 * of.value {
        number::ratio_with_error(of.value, of.standard_error)
    } else {
        number::ratio(of.value)
    }
}

/// Names and gains by light, of those with a sign.
fn lights(gains: &[(&str, Estimate)], sign: Sign) -> Option<String> {
    let shown = |(name, gain): &(&str, Estimate)| match sign {
        Sign::Below => format!("{name} ({})", times(Estimate::exact(1.0).ratio(gain))),
        _ => format!("{name} ({})", times(*gain)),
    };
    let words: Vec<String> = gains.iter().filter(|(_, gain)| Sign::of(*gain) == sign).map(shown).collect();
    (!words.is_empty()).then(|| listed(&words))
}

/// A light in a sentence: a file is the map, which the subtitle names.
fn said(light: &str) -> &str {
    if is_file(light) { "the map" } else { light }
}

/// The light that is a file, if there is one.
pub(super) fn map(lights: &[String]) -> Option<&str> {
    lights.iter().map(String::as_str).find(|light| is_file(light))
}

fn is_file(light: &str) -> bool {
    Path::new(light).extension().is_some()
}

/// `a`, `a and b`, `a, b and c`.
fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

/// The gains of the Cauchy model in equal time, by light.
fn cauchy_gains<'a>(of: &View<'a>, sampler: Sampler) -> Vec<(&'a str, Estimate)> {
    let gain = |light| of.equal_time((GAUSSIAN, sampler), (CAUCHY, sampler), light, Counted::Sample);
    of.lights.iter().zip(0..).filter_map(|(name, light)| Some((said(name), gain(light)?))).collect()
}

/// Is the replacement worth it?
fn worth(of: &View<'_>) -> Option<String> {
    let sentence = |sampler: Sampler| {
        let gains = cauchy_gains(of, sampler);
        let [less, more, same] = [Sign::Above, Sign::Below, Sign::Unsure].map(|sign| lights(&gains, sign));
        let parts: Vec<String> =
            [("less variance under", less), ("more under", more), ("as much, within the errors, under", same)]
                .into_iter()
                .filter_map(|(what, lights)| Some(format!("{what} {}", lights?)))
                .collect();
        (!parts.is_empty()).then(|| format!("with `{}` it has {}", sampler.name(), parts.join(", ")))
    };
    let parts: Vec<String> = TOLD.into_iter().filter_map(sentence).collect();
    (!parts.is_empty()).then(|| {
        format!(
            "Is the Cauchy model worth it? Against the Gaussian model in equal time, {MANY} samples per shading point, \
             medians over the grid: {}.",
            parts.join("; ")
        )
    })
}

/// The samplers that are not told from the best of a model under a light, with the best one's gain over `published`.
fn best(of: &View<'_>, model: ModelKind, light: usize, counted: Counted) -> Option<(Vec<Sampler>, Estimate)> {
    let gain = |sampler| {
        let over_published = of.equal_time((model, Sampler::Published), (model, sampler), light, counted)?;
        Some((sampler, if sampler == Sampler::Published { Estimate::exact(1.0) } else { over_published }))
    };
    let mut gains: Vec<(Sampler, Estimate)> = Sampler::ALL.into_iter().filter_map(gain).collect();
    gains.sort_by(|a, b| b.1.value.total_cmp(&a.1.value));
    let (_, most) = *gains.first()?;
    let level: Vec<Sampler> = gains
        .iter()
        .filter(|(_, gain)| Sign::of(most.ratio(gain)) != Sign::Above)
        .map(|(sampler, _)| *sampler)
        .collect();
    Some((Sampler::ALL.into_iter().filter(|sampler| level.contains(sampler)).collect(), most))
}

/// The best samplers of a model with the lights they are best under, in words; only where `told` of the light.
fn best_by_light(
    of: &View<'_>,
    model: ModelKind,
    counted: Counted,
    told: impl Fn(usize, &[Sampler]) -> bool,
) -> Option<String> {
    // Lights with the same best samplers share a part of the sentence.
    let mut groups: Vec<(Vec<Sampler>, Vec<String>)> = Vec::new();
    for (light, name) in of.lights.iter().enumerate() {
        let Some((samplers, gain)) = best(of, model, light, counted) else { continue };
        if !told(light, &samplers) {
            continue;
        }
        let name = said(name);
        let words =
            if samplers.contains(&Sampler::Published) { name.to_owned() } else { format!("{name} ({})", times(gain)) };
        match groups.iter_mut().find(|(group, _)| *group == samplers) {
            Some((_, lights)) => lights.push(words),
            None => groups.push((samplers, vec![words])),
        }
    }
    let part = |(samplers, lights): &(Vec<Sampler>, Vec<String>)| {
        let names: Vec<String> = samplers.iter().map(|sampler| format!("`{}`", sampler.name())).collect();
        format!("{} under {}", names.join(" or "), listed(lights))
    };
    let parts = groups.iter().map(part).collect::<Vec<_>>().join(", ");
    (!groups.is_empty()).then(|| format!("on the {} model {parts}", model.title()))
}

/// Which sampler?
fn which(of: &View<'_>) -> String {
    let words = |parts: Vec<String>| parts.join("; ");
    let all = |model| best_by_light(of, model, Counted::Sample, |_, _| true);
    // Only where the look-up changes the answer.
    let changed = |model: ModelKind| {
        let is_other = |light: usize, samplers: &[Sampler]| {
            best(of, model, light, Counted::Sample).is_none_or(|(alone, _)| alone != samplers)
        };
        best_by_light(of, model, Counted::LookUp, is_other)
    };
    let alone = words(ModelKind::ALL.into_iter().filter_map(all).collect());
    let with: Vec<String> = ModelKind::ALL.into_iter().filter_map(changed).collect();
    let is_timed = (0..of.lights.len()).all(|light| of.look_up(light).is_some());
    let given = if is_timed { "" } else { ", where it was timed" };
    let with = if with.is_empty() { "the same".to_owned() } else { format!("{}; else the same", words(with)) };
    format!(
        "Which sampler? Least variance in equal time, {MANY} samples per shading point (in brackets how many times less than \
         `published`; \"or\": not told apart): {alone}. With a look-up of the light counted in{given}: {with}.{}",
        limit(of).unwrap_or_default()
    )
}

/// A verdict for each light, and one on the looks: the case and the sentence.
pub(super) fn verdicts(of: &View<'_>) -> Vec<[String; 2]> {
    let words = |sampler: Sampler, light: usize| {
        let gain = of.gain((GAUSSIAN, sampler), (CAUCHY, sampler), light)?;
        let less = 1.0 - 1.0 / gain.median.value;
        let change = match Sign::of(gain.median) {
            Sign::Above => format!("{} fewer samples", number::percent(less)),
            Sign::Below if less < -1.0 => format!("{} as many samples", number::ratio(1.0 - less)),
            Sign::Below => format!("{} more samples", number::percent(-less)),
            Sign::Unsure => "as many samples".to_owned(),
        };
        let [fewer, more] = gain.shares.map(|share| format!("{:.0} %", 100.0 * share));
        Some(format!("{change} with `{}` (fewer in {fewer} of the cells, more in {more})", sampler.name()))
    };
    let mut verdicts = Vec::new();
    for (light, name) in of.lights.iter().enumerate() {
        let parts: Vec<String> = TOLD.into_iter().filter_map(|sampler| words(sampler, light)).collect();
        if !parts.is_empty() {
            verdicts.push([format!("Under {}", in_words(said(name))), format!("Cauchy takes {}.", listed(&parts))]);
        }
    }
    let [plain, blurred] =
        [of.difference.summary(Width::Paper, |f| f.plain.l1), of.difference.summary(Width::Paper, |f| f.blurred.l1)];
    let percent = number::percent;
    verdicts.push([
        "Looks".to_owned(),
        format!("Cauchy looks {} different ({} blurred by 10°).", percent(plain.median), percent(blurred.median)),
    ]);
    verdicts
}

/// How far sampling of the hair can go under the environment: V of `published` over that of perfect sampling, and of `matched`.
fn limit(of: &View<'_>) -> Option<String> {
    let light = of.lights.len().checked_sub(1)?;
    let gain = |model, strategy: Strategy| {
        of.gain((model, Sampler::Published), (model, strategy), light).map(|gain| times(gain.median))
    };
    let [perfect, matched] = [Strategy::Perfect, Sampler::Matched.into()].map(|strategy| {
        Some(format!("{} (Gaussian) and {} (Cauchy)", gain(GAUSSIAN, strategy)?, gain(CAUCHY, strategy)?))
    });
    Some(format!(
        " How far can that go? V of `published` over that of perfect sampling, which draws in proportion to S cos θᵢ, blind to \
         the light, is {} under {}; over that of `matched` it is {}.",
        perfect?,
        said(&of.lights[light]),
        matched?
    ))
}

/// Sentences on the change in looks.
fn looks(of: &View<'_>) -> String {
    let d = of.difference;
    let of_figures = |width, figure| d.summary(width, figure);
    let plain = of_figures(Width::Paper, |f| f.plain.l1);
    let blurred = of_figures(Width::Paper, |f| f.blurred.l1);
    let albedo = of_figures(Width::Paper, albedo_ratio);
    let squares = [Width::Paper, Width::BestOfGrid].map(|width| of_figures(width, |f| f.plain.l2).geometric_mean);
    let percent = number::percent;
    format!(
        "What does it change in looks? With the same widths the models differ by {} of the Gaussian one's albedo, summed over \
         all directions (median of L1; worst {}), and by {} after a blur of 10° (worst {}); the Cauchy model's albedo is {} to \
         {} of the Gaussian one's. The one factor on the widths that fits the grid best in L2 is {} (L2 {} against {} for \
         k = 1).",
        percent(plain.median),
        percent(plain.most),
        percent(blurred.median),
        percent(blurred.most),
        percent(albedo.least),
        percent(albedo.most),
        d.factor(Width::BestOfGrid),
        percent(squares[1]),
        percent(squares[0]),
    )
}

/// Sentences on the cost.
fn cost(of: &View<'_>) -> String {
    let ns = |of_one: Estimator| {
        let [many, one] = [MANY, 1].map(|n| of.ns(of_one, n));
        format!("{} ns ({} ns)", number::plain(many.value, 3), number::plain(one.value, 3))
    };
    let part = |sampler: Sampler| {
        let [gaussian, cauchy] = [GAUSSIAN, CAUCHY].map(|model| (model, sampler));
        let ratio = of.ns(gaussian, MANY).ratio(&of.ns(cauchy, MANY));
        let words = match Sign::of(ratio) {
            Sign::Above => format!("the Cauchy model is {} as fast", times(ratio)),
            Sign::Below => {
                format!("the Gaussian model is {} as fast", times(of.ns(cauchy, MANY).ratio(&of.ns(gaussian, MANY))))
            }
            Sign::Unsure => "no difference is seen".to_owned(),
        };
        format!(
            "`{}` {} on the Gaussian model and {} on the Cauchy one: {words}",
            sampler.name(),
            ns(gaussian),
            ns(cauchy)
        )
    };
    let look_ups: Vec<(&str, f64)> =
        of.lights.iter().zip(0..).filter_map(|(name, light)| Some((said(name), of.look_up(light)?.value))).collect();
    let by_time = |a: &&(&str, f64), b: &&(&str, f64)| a.1.total_cmp(&b.1);
    let shown = |(name, ns): &(&str, f64)| format!("{} ns ({name})", number::plain(*ns, 2));
    let ends = look_ups.iter().min_by(by_time).zip(look_ups.iter().max_by(by_time));
    let look_up = ends.map_or_else(String::new, |(least, most)| {
        format!(" A look-up of the light in its direction takes {} to {} more.", shown(least), shown(most))
    });
    format!(
        "What does it cost? Time of a sample on this machine, eight lanes, one thread, at {MANY} (1) samples a gather \
         point: {}.{look_up}",
        TOLD.map(part).join("; ")
    )
}

/// In which conditions not?
fn where_not(of: &View<'_>) -> Option<String> {
    let mut parts = Vec::new();
    for sampler in TOLD {
        let pair = [GAUSSIAN, CAUCHY].map(|model| (model, sampler));
        let mut words = Vec::new();
        for (light, name) in of.lights.iter().enumerate() {
            let worse = of.each_cell().filter(|cell| {
                let [gaussian, cauchy] = pair.map(|of_one| of.v(cell.index, of_one, light));
                Sign::of(gaussian.ratio(&cauchy)) == Sign::Below
            });
            match worse.count() {
                0 => {}
                count => words.push(format!(
                    "{} of the cells under {}",
                    number::percent(count as f64 / of.cells.len() as f64),
                    said(name)
                )),
            }
        }
        if !words.is_empty() {
            parts.push(format!("with `{}` in {}", sampler.name(), listed(&words)));
        }
    }
    let worst = |figure: fn(&crate::difference::Differences) -> f64| {
        let of_width = |beta: f32| {
            let rows = of.difference.of(Width::Paper).filter(move |row| row.cell.beta_r_deg == beta);
            (beta, Summary::of(rows.map(|row| figure(&row.figures))).median)
        };
        of.grid.beta_r_deg.iter().map(|beta| of_width(*beta)).max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (beta, l1) = worst(|f| f.plain.l1)?;
    let looks = format!("the looks change most at β_R = {beta}° (median L1 {})", number::percent(l1));
    Some(if parts.is_empty() {
        format!("Where not? No cell was found in which the Cauchy model needs more samples; {looks}.")
    } else {
        format!(
            "Where not? The Cauchy model needs more samples, beyond two standard errors, {}; {looks}.",
            parts.join("; ")
        )
    })
}
