//! Report of a comparison: its verdicts, findings and sections.

use super::query::{Depth, predicted, v_gain};
use super::{CompareSettings, Comparison, charts, distinct, rays, tables};
use crate::efficiency::EfficiencyRow;
use crate::lights::in_words;
use crate::sampler::Sampler;
use crate::speed::TimedOp;
use crate::subject::ModelKind;
use hairis_instruments::report::{Report, Section, literal};
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

/// Returns a verdict for each use case: the case and the sentence.
fn verdicts(of: &Comparison) -> Vec<[String; 2]> {
    let level = of.speed.detected_level;
    let mut verdicts = Vec::new();
    let ratio = |op| speed_ratio(of, op, ModelKind::Gaussian);
    if let (Some(eval), Some(sample)) = (ratio(TimedOp::EvalPdf), ratio(TimedOp::Sample)) {
        let sentence = format!(
            "Eight lanes on {level} evaluate {eval} and sample {sample} as fast as the scalar formulas."
        );
        verdicts.push(["Speed".to_owned(), sentence]);
    }
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

/// Returns the words for a ratio of variances, as a change in the number of samples.
fn change(ratio: f64) -> String {
    match ratio {
        ratio if ratio >= 2.0 => format!("{} fewer", number::ratio(ratio)),
        ratio if ratio >= 1.0 => format!("{} fewer", number::percent(1.0 - 1.0 / ratio)),
        ratio if ratio > 0.5 => format!("{} more", number::percent(1.0 / ratio - 1.0)),
        ratio => format!("{} as many", number::ratio(1.0 / ratio)),
    }
}

/// Returns findings beyond the verdicts, in sentences with figures.
fn findings(of: &Comparison) -> Vec<String> {
    [
        under_constant_light(of),
        worse_than_uniform(of),
        rays::finding(of),
        more_speed(of),
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
