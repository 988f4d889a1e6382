//! The report of a comparison.

use super::{Comparison, Depth, charts, rays, tables};
use crate::efficiency::EfficiencyRow;
use crate::light::in_words;
use crate::report::{Report, Section};
use crate::sampler::Sampler;
use crate::sequence::SequenceKind;
use crate::speed::Op;
use crate::subject::ModelKind;
use crate::table::number;

/// The page.
#[must_use]
pub fn report(of: &Comparison) -> Report {
    let tables = tables(of, Depth::Full);
    let mut page = Report::new("Hair scattering: eight lanes, and Cauchy for Gaussian").subtitle(format!(
        "hairis compare{}, seed {}, environment: {}",
        if of.settings.quick { " --quick" } else { "" },
        of.settings.seed,
        of.settings.environment
    ));
    for [case, sentence] in verdicts(of) {
        page = page.verdict(case, sentence);
    }
    page = page.summary(charts::summary(of));
    for finding in findings(of) {
        page = page.finding(finding);
    }

    let mut models = Section::new("The two models").paragraph(
        "The published model is made of Gaussians of unit peak. The all-Cauchy variant replaces each by a Cauchy bell \
         of the same width, which is what the published sampler draws from.",
    );
    for figure in charts::models() {
        models = models.figure(figure);
    }
    models = models.figure(charts::distributions(of));

    let mut efficiency = Section::new("Sample efficiency").paragraph(
        "V is the variance of one sample over the squared mean: an error of 1% takes 10⁴ V samples. Directions are drawn \
         uniformly, by the published sampler (`published`) and by the one that is matched to the model (`matched`, with nine bands, \
         as by default). Estimates are tested against quadrature; a bias beyond its bound fails the run.",
    );
    efficiency = efficiency.heading("Against the width of the highlights");
    for figure in charts::widths(of) {
        efficiency = efficiency.figure(figure);
    }
    efficiency = efficiency.heading("Against the number of samples");
    for figure in charts::convergence(of) {
        efficiency = efficiency.figure(figure);
    }
    for table in tables.efficiency {
        efficiency = efficiency.table(table);
    }

    let mut chosen = Section::new("One ray for many candidates").paragraph(
        "Directions are drawn from the BSDF and from the light, weighed by the light that they would bring, and a few are traced \
         (`hairis::resample`). One-sample MIS traces each direction that it draws.",
    );
    if let Some(figure) = rays::chart(of) {
        chosen = chosen.figure(figure);
    }
    for table in tables.rays {
        chosen = chosen.table(table);
    }

    let mut speed = charts::speeds(of).into_iter().fold(Section::new("Speed"), Section::figure);
    for table in tables.speed {
        speed = speed.table(table);
    }
    let mut agreement = Section::new("Agreement").paragraph(
        "Scalar and eight lanes against the paper's formulas in double precision, on random hair (widths of 1° to \
         30°, all lanes different), by region.",
    );
    for table in tables.agreement {
        agreement = agreement.table(table);
    }

    page = page.section(speed).section(efficiency).section(chosen).section(models).section(agreement);
    let check = &of.efficiency.check;
    let (tests, bound) = (check.tests, check.bound);
    page = page
        .method(
            "Every estimate is of the reflected radiance, the mean of red, green and blue, on a fibre along the world's \
             x axis, y up. Random numbers come from ChaCha8 with a stream for each cell, so that results depend on the seed \
             alone; Halton numbers are scrambled after Owen.",
        )
        .method(format!(
            "{tests} estimates were tested against their references; with so many, |z| up to {bound:.2} is chance \
             (false alarm {}), and the largest was {:.2}.",
            number::percent(check.false_alarm),
            check.largest_z
        ))
        .fact("command", format!("hairis compare{}", if of.settings.quick { " --quick" } else { "" }))
        .fact("seed", of.settings.seed.to_string())
        .fact("environment", of.settings.environment.clone())
        .fact("CPU", of.machine.cpu.clone())
        .fact("eight lanes run on", of.speed.detected_level)
        .fact("the program was compiled for", of.speed.compiled_level)
        .fact("machine", of.machine.summary());
    for note in &of.settings.environment_notes {
        page = page.fact("environment note", note.clone());
    }
    page
}

/// A verdict for each use case: the case and the sentence.
fn verdicts(of: &Comparison) -> Vec<[String; 2]> {
    let level = of.speed.detected_level;
    let ratio = |op, model: ModelKind| of.speed.row(op, model.name(), "eight lanes", level).map(|row| row.ratio);
    let mut verdicts = Vec::new();
    let speeds = [ratio(Op::EvalPdf, ModelKind::Gaussian), ratio(Op::Sample, ModelKind::Gaussian)];
    if let [Some(eval), Some(sample)] = speeds.map(|ratio| ratio.map(number::ratio)) {
        let sentence =
            format!("Eight lanes on {level} evaluate {eval} and sample {sample} as fast as the scalar formulas.");
        verdicts.push(["Speed".to_owned(), sentence]);
    }
    for light in &of.efficiency.settings.lights {
        let change = |ratio: Option<f64>| ratio.map_or("an unknown number of".to_owned(), change);
        let cauchy =
            v_ratio(of, light, (ModelKind::Gaussian, Sampler::Published), (ModelKind::Cauchy, Sampler::Published));
        let matched =
            v_ratio(of, light, (ModelKind::Gaussian, Sampler::Published), (ModelKind::Gaussian, Sampler::Matched));
        verdicts.push([
            format!("Under {}", in_words(light)),
            format!(
                "Cauchy takes {} samples; `matched` in place of `published` takes {}.",
                change(cauchy),
                change(matched)
            ),
        ]);
    }
    let worst = of.agreement.iter().map(|row| row.worst / row.bound).fold(0.0, f64::max);
    let failed = of.failures().len();
    let checks = if failed == 0 { "all checks pass".to_owned() } else { format!("{failed} checks failed") };
    let sentence = format!("Largest error: {} of its bound; {checks}.", number::percent(worst));
    verdicts.push(["Accuracy".to_owned(), sentence]);
    verdicts
}

/// Words for a ratio of variances, as a change in the number of samples.
fn change(ratio: f64) -> String {
    match ratio {
        ratio if ratio >= 2.0 => format!("{} fewer", number::ratio(ratio)),
        ratio if ratio >= 1.0 => format!("{} fewer", number::percent(1.0 - 1.0 / ratio)),
        ratio if ratio > 0.5 => format!("{} more", number::percent(1.0 / ratio - 1.0)),
        ratio => format!("{} as many", number::ratio(1.0 / ratio)),
    }
}

/// Inclination of the viewer in the verdicts, degrees.
pub(super) const THETA_O_DEG: f64 = 45.0;

/// V of one estimator over V of another, seen from [`THETA_O_DEG`]: as measured where it can be, else as predicted.
pub(super) fn v_ratio(
    of: &Comparison,
    light: &str,
    base: (ModelKind, Sampler),
    other: (ModelKind, Sampler),
) -> Option<f64> {
    let v = |estimator| {
        let is = |row: &&EfficiencyRow| {
            (row.model, row.sampler) == estimator
                && (row.sequence, row.theta_o_deg) == (SequenceKind::Independent, THETA_O_DEG)
                && row.light == light
        };
        let row = of.efficiency.rows.iter().find(is)?;
        Some(if row.tested { row.v.value } else { row.reference.predicted(row.sampler)[0] })
    };
    Some(v(base)? / v(other)?)
}

/// Where a sampler of the BSDF does worse than uniform directions.
fn worse_than_uniform(of: &Comparison) -> Option<String> {
    let mut lights: Vec<&str> = Vec::new();
    for row in &of.efficiency.rows {
        let [v, uniform] = [row.sampler, Sampler::Uniform].map(|sampler| row.reference.predicted(sampler)[0]);
        if v > 1.05 * uniform && !lights.contains(&row.light.as_str()) {
            lights.push(&row.light);
        }
    }
    (!lights.is_empty()).then(|| {
        format!(
            "Sampling the BSDF alone can do worse than uniform directions where a small light lies off the highlights: \
             it does under {}, from some sides. The table of light sampling shows what combining the two gives.",
            lights.join(" and ")
        )
    })
}

/// The answer first, in sentences with figures.
fn findings(of: &Comparison) -> Vec<String> {
    let mut findings = Vec::new();
    let v = |model, sampler| {
        let rows = &of.efficiency.reference_v;
        rows.iter().find(|row| (row.model, row.sampler) == (model, sampler) && row.theta_o_deg == 0.0).map(|row| row.v)
    };
    if let (Some(uniform), Some(published), Some(cauchy), Some(matched), Some(cauchy_matched)) = (
        v(ModelKind::Gaussian, Sampler::Uniform),
        v(ModelKind::Gaussian, Sampler::Published),
        v(ModelKind::Cauchy, Sampler::Published),
        v(ModelKind::Gaussian, Sampler::Matched),
        v(ModelKind::Cauchy, Sampler::Matched),
    ) {
        let gain = uniform.ratio(&published);
        findings.push(format!(
            "Under constant light, seen from the side, the published sampler needs {} times fewer samples than \
             uniform sampling on the Gaussian model (V {} against {}).",
            number::estimate(&gain),
            number::estimate(&published),
            number::estimate(&uniform),
        ));
        let gain = published.ratio(&cauchy);
        findings.push(format!(
            "The all-Cauchy model needs {} times fewer samples still with the same sampler (V {}).",
            number::estimate(&gain),
            number::estimate(&cauchy),
        ));
        let [gain, on_cauchy] = [published.ratio(&matched), cauchy.ratio(&cauchy_matched)];
        findings.push(format!(
            "The matched sampler needs {} times fewer samples than the published one on the Gaussian model (V {}), and {} \
             times fewer on the Cauchy model (V {}).",
            number::estimate(&gain),
            number::estimate(&matched),
            number::estimate(&on_cauchy),
            number::estimate(&cauchy_matched),
        ));
    }
    findings.extend(worse_than_uniform(of));
    findings.extend(rays::finding(of));
    let level = of.speed.detected_level;
    let ratio = |op, model: ModelKind| of.speed.row(op, model.name(), "eight lanes", level).map(|row| row.ratio);
    if let (Some(eval), Some(cauchy), Some(sample), Some(points)) = (
        ratio(Op::EvalPdf, ModelKind::Gaussian),
        ratio(Op::EvalPdf, ModelKind::Cauchy),
        ratio(Op::Sample, ModelKind::Gaussian),
        ratio(Op::PointsMixed, ModelKind::Gaussian),
    ) {
        findings.push(format!(
            "Eight lanes on {level} evaluate the Gaussian model {} and the Cauchy model {} as fast as the paper's \
             formulas in scalar f32, and sample {} as fast; on eight different shading points, preparation included, \
             {}.",
            number::ratio(eval),
            number::ratio(cauchy),
            number::ratio(sample),
            number::ratio(points),
        ));
    }
    let worst = of.agreement.iter().map(|row| row.worst / row.bound).fold(0.0, f64::max);
    findings.push(format!(
        "The largest error of any path against double precision is {} of its bound.",
        number::percent(worst)
    ));
    findings.push(match of.failures().len() {
        0 => format!("All {} estimates agree with their references.", of.efficiency.check.tests + of.rays.check.tests),
        n => format!("{n} checks failed; they are listed on the terminal and in compare.json."),
    });
    findings
}
