//! Report of a comparison: its verdicts, findings and sections.

use super::query::{Depth, most_efficient, predicted, v_gain, v_gain_with_light};
use super::{CompareSettings, Comparison, charts, distinct, rays, tables};
use crate::efficiency::EfficiencyRow;
use crate::lights::in_words;
use crate::sampler::Sampler;
use crate::speed::{SpeedResult, TimedOp};
use crate::subject::ModelKind;
use hairis_instruments::report::{Report, Section, literal};
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::number;

/// Returns the page with all verdicts, plots and tables of the comparison.
#[must_use]
pub fn report(of: &Comparison) -> Report {
    let speed = Section::new("Speed")
        .figures(charts::speeds(of))
        .tables(tables::speed(of, Depth::Full));
    let efficiency = Section::new("Sample efficiency")
        .paragraph(
            "V is the variance of one sample over the squared mean: an error of 1% takes 10⁴ V samples. Directions are drawn \
             uniformly, by the published sampler (`published`) and by the one that is matched to the model (`matched`, with nine \
             bands, as by default). Estimates are tested against quadrature; a bias beyond its bound fails the run.",
        )
        .heading("Against the width of the highlights")
        .figures(charts::widths(of))
        .heading("Against the number of samples")
        .figures(charts::convergence(of))
        .tables(tables::efficiency(of, Depth::Full));
    let chosen = Section::new("One ray for many candidates")
        .paragraph(
            "Directions are drawn from the BSDF and from the light, weighed by the light that they would bring, and a few are \
             traced (`hairis::resample`). One-sample MIS traces each direction that it draws.",
        )
        .figures(rays::chart(of))
        .tables(rays::tables(of, Depth::Full));
    let materials = of.material_table();
    let materials = materials.map(|table| Section::new("Other materials").tables([table]));
    let models = Section::new("The two models")
        .paragraph(
            "The published model is made of Gaussians of unit peak. The all-Cauchy variant replaces each by a Cauchy bell \
             of the same width, which is what the published sampler draws from.",
        )
        .figures(charts::models(of));
    let agreement = Section::new("Agreement")
        .paragraph(
            "Scalar and eight lanes against the paper's formulas in double precision, on random hair (widths of 1° to \
             30°, all lanes different), by region.",
        )
        .tables([tables::agreement(of, Depth::Full)]);
    let check = &of.efficiency.check;
    let machine = of.machine.summary();
    let notes = of.settings.environment_notes.iter();
    let notes: Vec<_> = notes.map(|note| literal(note)).collect();
    let mut facts = vec![
        ["eight lanes run on", of.speed.detected_level],
        ["the program was compiled for", of.speed.compiled_level],
        ["machine", &machine],
    ];
    facts.extend(notes.iter().map(|note| ["environment note", note]));
    let method = Section::new("Method and machine")
        .paragraph(
            "Every estimate is of the reflected radiance, the mean of red, green and blue, on a fibre along the world's \
             x axis, y up. Random numbers come from ChaCha8 with a stream for each cell, so that results depend on the seed \
             alone; Halton numbers are scrambled after Owen.",
        )
        .paragraph(format!(
            "{} estimates were tested against their references; with so many, |z| up to {:.2} is chance (false alarm {}), \
             and the largest was {:.2}.",
            check.tests,
            check.bound,
            number::percent(check.false_alarm),
            check.largest_z
        ))
        .facts(&facts);
    let CompareSettings {
        seed,
        quick,
        environment,
        ..
    } = &of.settings;
    let environment = literal(environment);
    let quick = if *quick { " --quick" } else { "" };
    Report {
        title: "Hair scattering: eight lanes, and Cauchy for Gaussian".to_owned(),
        subtitle: format!("hairis compare{quick}, seed {seed}, environment: {environment}"),
        verdicts: verdicts(of),
        summary: Some(charts::summary(of)),
        findings: findings(of),
        sections: [
            vec![speed, efficiency, chosen],
            materials.into_iter().collect(),
            vec![models, agreement, method],
        ]
        .concat(),
    }
}

/// Returns the speed-up of eight lanes over the reference, in words.
fn speed_ratio(of: &Comparison, op: TimedOp, model: ModelKind) -> Option<String> {
    let row = of
        .speed
        .row(op, model.name(), "eight lanes", of.speed.detected_level)?;
    Some(number::ratio(row.ratio))
}

/// Returns a verdict for each question: the question in a word or two, and the sentence.
fn verdicts(of: &Comparison) -> Vec<[String; 2]> {
    let Comparison { machine, speed, .. } = of;
    let mut verdicts = vec![[
        "Machine".to_owned(),
        format!(
            "{}; eight lanes on {}, compiled for {}.",
            machine.in_words(),
            speed.detected_level,
            speed.compiled_level
        ),
    ]];
    let speeds = ModelKind::ALL.map(|model| {
        let sentence = in_times_of_a_port(of, model)?;
        Some([format!("Speed, {}", model.title()), sentence])
    });
    verdicts.extend(speeds.into_iter().flatten());
    for light in &of.efficiency.settings.lights {
        let change =
            |other| v_gain(of, light, other).map_or("an unknown number of".to_owned(), change);
        let cauchy = change((ModelKind::Cauchy, Sampler::Published));
        let matched = change((ModelKind::Gaussian, Sampler::Matched));
        let sentence = format!(
            "Cauchy takes {cauchy} samples; `matched` in place of `published` takes {matched}."
        );
        verdicts.push([format!("Under {}", in_words(light)), sentence]);
    }
    verdicts.extend(which_sampler(of).map(|sentence| ["Sampler".to_owned(), sentence]));
    if !of.materials.is_empty() {
        let sentence = format!(
            "{} materials and views of the flags were measured; the page and `--tables` show them.",
            of.materials.len()
        );
        verdicts.push(["Materials".to_owned(), sentence]);
    }
    let largest = number::percent(
        of.agreement
            .iter()
            .map(|row| row.worst / row.bound)
            .fold(0.0, f64::max),
    );
    let checks = match of.failures().len() {
        0 => "all checks pass".to_owned(),
        failed => format!("{failed} checks failed; they are in compare.json and on the terminal"),
    };
    verdicts.push([
        "Accuracy".to_owned(),
        format!("Largest error: {largest} of its bound; {checks}."),
    ]);
    verdicts
}

/// Says how much faster than a direct port of the formulas each way of calling the kernel is, where every direction has a shading point of
/// its own.
fn in_times_of_a_port(of: &Comparison, model: ModelKind) -> Option<String> {
    let level = of.speed.detected_level;
    let ways = |op| {
        let row = |(name, level)| of.speed.row(op, model.name(), name, level);
        let ways = [
            ("one lane", "scalar", "one lane"),
            ("eight lanes", level, "eight lanes"),
            ("slices of hits", level, "slices"),
            (
                "slices of hits, Conserving",
                level,
                "slices that conserve energy",
            ),
        ];
        let said = ways.into_iter().filter_map(|(name, level, words)| {
            Some(format!(
                "{words} {}",
                number::ratio(row((name, level))?.ratio)
            ))
        });
        Some(said.collect::<Vec<_>>().join(", ")).filter(|said| !said.is_empty())
    };
    Some(format!(
        "Times as fast as a direct port: to evaluate, {}; to sample, {}.",
        ways(TimedOp::PointsEval)?,
        ways(TimedOp::PointsShared)?
    ))
}

/// Names the sampler of each model that leaves the least variance after a given time, by light.
fn which_sampler(of: &Comparison) -> Option<String> {
    let of_model = |model: ModelKind| {
        let mut chosen: Vec<(Sampler, Vec<&str>)> = Vec::new();
        for light in &of.efficiency.settings.lights {
            let sampler = most_efficient(of, light, model)?;
            match chosen.iter_mut().find(|(known, _)| *known == sampler) {
                Some((_, lights)) => lights.push(in_words(light)),
                None => chosen.push((sampler, vec![in_words(light)])),
            }
        }
        let said = match &chosen[..] {
            [(sampler, _)] => format!("`{}` under every light", sampler.name()),
            many => many
                .iter()
                .map(|(sampler, lights)| {
                    format!("`{}` under {}", sampler.name(), lights.join(", "))
                })
                .collect::<Vec<_>>()
                .join("; "),
        };
        Some(format!("{} model: {said}", model.title()))
    };
    let [gaussian, cauchy] = ModelKind::ALL.map(of_model);
    let combined = v_gain_with_light(of).map(|gain| {
        format!(
            " Combined with light sampling, as in a path tracer, `matched` in place of `published` takes {} samples on the Gaussian \
             model, in the mean over the lights.",
            change(gain)
        )
    });
    Some(format!(
        "Least variance in equal time where the BSDF alone is sampled, {}. {}.{}",
        gaussian?,
        cauchy?,
        combined.unwrap_or_default()
    ))
}

/// Returns the words for a ratio of variances, as a change in the number of samples with its standard error.
fn change(ratio: Estimate) -> String {
    let Estimate {
        value,
        standard_error,
    } = ratio;
    let times = |ratio: f64, error| number::ratio_with_error(ratio, error);
    let percent =
        |share: f64, error: f64| format!("{} %", number::with_error(100.0 * share, 100.0 * error));
    // The error of 1 / ratio.
    let inverse = standard_error / (value * value);
    match value {
        value if value >= 2.0 => format!("{} fewer", times(value, standard_error)),
        value if value >= 1.0 => format!("{} fewer", percent(1.0 - 1.0 / value, inverse)),
        value if value > 0.5 => format!("{} more", percent(1.0 / value - 1.0, inverse)),
        value => format!("{} as many", times(1.0 / value, inverse)),
    }
}

/// Returns findings beyond the verdicts, in sentences with figures.
fn findings(of: &Comparison) -> Vec<String> {
    [
        under_constant_light(of),
        worse_than_uniform(of),
        rays::finding(of),
        more_speed(of),
        slower_than_a_port(of),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn under_constant_light(of: &Comparison) -> Option<String> {
    use ModelKind::{Cauchy, Gaussian};
    use Sampler::{Matched, Published, Uniform};
    let v = |key| {
        let mut rows = of
            .efficiency
            .reference_v
            .iter()
            .filter(|row| row.theta_o_deg == 0.0);
        rows.find(|row| (row.model, row.sampler) == key)
            .map(|row| row.v)
    };
    let gain = |from, to| Some(number::estimate(&v(from)?.ratio(&v(to)?)));
    Some(format!(
        "Under constant light, seen from the side, uniform sampling of the Gaussian model takes {} times as many samples as \
         `published`, and that {} times as many as on the Cauchy model. `published` takes {} times as many as `matched` on \
         the Gaussian model, and {} times as many on the Cauchy model.",
        gain((Gaussian, Uniform), (Gaussian, Published))?,
        gain((Gaussian, Published), (Cauchy, Published))?,
        gain((Gaussian, Published), (Gaussian, Matched))?,
        gain((Cauchy, Published), (Cauchy, Matched))?,
    ))
}

/// Lists the lights under which a sampler of the BSDF does worse than uniform directions.
fn worse_than_uniform(of: &Comparison) -> Option<String> {
    let is_worse = |row: &&EfficiencyRow| {
        predicted(row, row.sampler) > 1.05 * predicted(row, Sampler::Uniform)
    };
    let lights = distinct(
        of.efficiency
            .rows
            .iter()
            .filter(is_worse)
            .map(|row| row.light.as_str()),
    );
    (!lights.is_empty()).then(|| {
        format!(
            "Sampling the BSDF alone can do worse than uniform directions where a small light lies off the highlights: \
             it does under {}, from some sides. The table of light sampling shows what combining the two gives.",
            lights.join(" and ")
        )
    })
}

fn more_speed(of: &Comparison) -> Option<String> {
    Some(format!(
        "Eight lanes on {} evaluate the Cauchy model {} as fast as the paper's formulas in scalar f32, and sample the Gaussian \
         model on eight different shading points, preparation included, {} as fast.",
        of.speed.detected_level,
        speed_ratio(of, TimedOp::EvalPdf, ModelKind::Cauchy)?,
        speed_ratio(of, TimedOp::PointsMixed, ModelKind::Gaussian)?
    ))
}

/// Lists the calls on one lane that take longer than the formulas, and says why they may.
fn slower_than_a_port(of: &Comparison) -> Option<String> {
    let is_slower = |row: &&SpeedResult| row.contender == "one lane" && row.ratio_q3 < 1.0;
    let named = of.speed.rows.iter().filter(is_slower).map(|row| {
        let ratio = number::ratio(row.ratio);
        format!("{} of {} ({ratio})", row.op.label(), row.model)
    });
    let named: Vec<_> = named.collect();
    (!named.is_empty()).then(|| {
        format!(
            "Where is one lane slower than the formulas? In {}. A call on one lane has no branches, so that it has the bits of \
             eight lanes: it computes every lobe's direction where the formulas follow the lobe that was drawn, and its \
             elementary functions are those of all platforms.",
            named.join(", ")
        )
    })
}
