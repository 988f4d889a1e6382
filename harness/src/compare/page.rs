//! The report of a comparison.

use super::{Comparison, Depth, charts, distinct, rays, tables};
use crate::efficiency::EfficiencyRow;
use crate::light::in_words;
use crate::report::{Report, Section};
use crate::sampler::Sampler;
use crate::sequence::SequenceKind;
use crate::speed::Op;
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::table::number;

/// The page.
#[must_use]
pub fn report(of: &Comparison) -> Report {
    let tables = tables(of, Depth::Full);
    let command = format!("hairis compare{}", if of.settings.quick { " --quick" } else { "" });
    let (seed, environment) = (of.settings.seed, &of.settings.environment);
    let mut page = Report::new("Hair scattering: eight lanes, and Cauchy for Gaussian")
        .subtitle(format!("{command}, seed {seed}, environment: {environment}"))
        .summary(charts::summary(of));
    for [case, sentence] in verdicts(of) {
        page = page.verdict(case, sentence);
    }
    for finding in findings(of) {
        page = page.finding(finding);
    }

    let speed = Section::new("Speed").figures(charts::speeds(of)).tables(tables.speed);
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
        .tables(tables.efficiency);
    let chosen = Section::new("One ray for many candidates")
        .paragraph(
            "Directions are drawn from the BSDF and from the light, weighed by the light that they would bring, and a few are \
             traced (`hairis::resample`). One-sample MIS traces each direction that it draws.",
        )
        .figures(rays::chart(of))
        .tables(tables.rays);
    let models = Section::new("The two models")
        .paragraph(
            "The published model is made of Gaussians of unit peak. The all-Cauchy variant replaces each by a Cauchy bell \
             of the same width, which is what the published sampler draws from.",
        )
        .figures(charts::models())
        .figure(charts::distributions(of));
    let agreement = Section::new("Agreement")
        .paragraph(
            "Scalar and eight lanes against the paper's formulas in double precision, on random hair (widths of 1° to \
             30°, all lanes different), by region.",
        )
        .tables(tables.agreement);

    let check = &of.efficiency.check;
    let (tests, bound) = (check.tests, check.bound);
    page = [speed, efficiency, chosen, models, agreement].into_iter().fold(page, Report::section);
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
        .fact("command", command)
        .fact("seed", seed.to_string())
        .fact("environment", environment)
        .fact("CPU", &of.machine.cpu)
        .fact("eight lanes run on", of.speed.detected_level)
        .fact("the program was compiled for", of.speed.compiled_level)
        .fact("machine", of.machine.summary());
    of.settings.environment_notes.iter().fold(page, |page, note| page.fact("environment note", note))
}

/// How many times as fast as the textbook eight lanes are.
fn speed_ratio(of: &Comparison, op: Op, model: ModelKind) -> Option<String> {
    let row = of.speed.row(op, model.name(), "eight lanes", of.speed.detected_level)?;
    Some(number::ratio(row.ratio))
}

/// The largest error of any path, as a share of its bound.
fn largest_error(of: &Comparison) -> String {
    number::percent(of.agreement.iter().map(|row| row.worst / row.bound).fold(0.0, f64::max))
}

/// A verdict for each use case: the case and the sentence.
fn verdicts(of: &Comparison) -> Vec<[String; 2]> {
    let level = of.speed.detected_level;
    let mut verdicts = Vec::new();
    let ratio = |op| speed_ratio(of, op, ModelKind::Gaussian);
    if let (Some(eval), Some(sample)) = (ratio(Op::EvalPdf), ratio(Op::Sample)) {
        let sentence =
            format!("Eight lanes on {level} evaluate {eval} and sample {sample} as fast as the scalar formulas.");
        verdicts.push(["Speed".to_owned(), sentence]);
    }
    for light in &of.efficiency.settings.lights {
        let change = |other| v_gain(of, light, other).map_or("an unknown number of".to_owned(), change);
        let cauchy = change((ModelKind::Cauchy, Sampler::Published));
        let matched = change((ModelKind::Gaussian, Sampler::Matched));
        let sentence = format!("Cauchy takes {cauchy} samples; `matched` in place of `published` takes {matched}.");
        verdicts.push([format!("Under {}", in_words(light)), sentence]);
    }
    let checks = match of.failures().len() {
        0 => "all checks pass".to_owned(),
        failed => format!("{failed} checks failed"),
    };
    let sentence = format!("Largest error: {} of its bound; {checks}.", largest_error(of));
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

/// V of the published sampler on the Gaussian model over V of another estimator, seen from [`THETA_O_DEG`]: as measured where
/// it can be, else as predicted.
pub(super) fn v_gain(of: &Comparison, light: &str, other: (ModelKind, Sampler)) -> Option<f64> {
    let v = |estimator| {
        let row = of.efficiency.rows.iter().find(|row| {
            (row.model, row.sampler) == estimator
                && (row.sequence, row.theta_o_deg) == (SequenceKind::Independent, THETA_O_DEG)
                && row.light == light
        })?;
        Some(if row.tested { row.v.value } else { predicted(row, row.sampler) })
    };
    Some(v((ModelKind::Gaussian, Sampler::Published))? / v(other)?)
}

/// V of a sampler as the reference of a row predicts it.
pub(super) fn predicted(row: &EfficiencyRow, sampler: Sampler) -> f64 {
    row.reference.predicted(sampler)[0]
}

/// Where a sampler of the BSDF does worse than uniform directions.
fn worse_than_uniform(of: &Comparison) -> Option<String> {
    let is_worse = |row: &&EfficiencyRow| predicted(row, row.sampler) > 1.05 * predicted(row, Sampler::Uniform);
    let lights = distinct(of.efficiency.rows.iter().filter(is_worse).map(|row| row.light.as_str()));
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
        let mut rows = of.efficiency.reference_v.iter();
        Some(rows.find(|row| (row.model, row.sampler, row.theta_o_deg) == (model, sampler, 0.0))?.v)
    };
    if let (Some(uniform), Some(published), Some(cauchy), Some(matched), Some(cauchy_matched)) = (
        v(ModelKind::Gaussian, Sampler::Uniform),
        v(ModelKind::Gaussian, Sampler::Published),
        v(ModelKind::Cauchy, Sampler::Published),
        v(ModelKind::Gaussian, Sampler::Matched),
        v(ModelKind::Cauchy, Sampler::Matched),
    ) {
        let shown = |v: &Estimate| number::estimate(v);
        let gain = |from: &Estimate, to: &Estimate| number::estimate(&from.ratio(to));
        findings.push(format!(
            "Under constant light, seen from the side, the published sampler needs {} times fewer samples than \
             uniform sampling on the Gaussian model (V {} against {}).",
            gain(&uniform, &published),
            shown(&published),
            shown(&uniform),
        ));
        findings.push(format!(
            "The all-Cauchy model needs {} times fewer samples still with the same sampler (V {}).",
            gain(&published, &cauchy),
            shown(&cauchy),
        ));
        findings.push(format!(
            "The matched sampler needs {} times fewer samples than the published one on the Gaussian model (V {}), and {} \
             times fewer on the Cauchy model (V {}).",
            gain(&published, &matched),
            shown(&matched),
            gain(&cauchy, &cauchy_matched),
            shown(&cauchy_matched),
        ));
    }
    findings.extend(worse_than_uniform(of));
    findings.extend(rays::finding(of));
    if let (Some(eval), Some(cauchy), Some(sample), Some(points)) = (
        speed_ratio(of, Op::EvalPdf, ModelKind::Gaussian),
        speed_ratio(of, Op::EvalPdf, ModelKind::Cauchy),
        speed_ratio(of, Op::Sample, ModelKind::Gaussian),
        speed_ratio(of, Op::PointsMixed, ModelKind::Gaussian),
    ) {
        findings.push(format!(
            "Eight lanes on {} evaluate the Gaussian model {eval} and the Cauchy model {cauchy} as fast as the paper's \
             formulas in scalar f32, and sample {sample} as fast; on eight different shading points, preparation included, \
             {points}.",
            of.speed.detected_level
        ));
    }
    findings
        .push(format!("The largest error of any path against double precision is {} of its bound.", largest_error(of)));
    findings.push(match of.failures().len() {
        0 => format!("All {} estimates agree with their references.", of.efficiency.check.tests + of.rays.check.tests),
        n => format!("{n} checks failed; they are listed on the terminal and in compare.json."),
    });
    findings
}
