//! The tables of a comparison, the same for the terminal and for the page.

use super::page::predicted;
use super::{Comparison, distinct, rays};
use crate::agreement::{AgreementResult, Quantity, Region};
use crate::efficiency::{EfficiencyRow, MisRow, SAMPLERS, Technique};
use crate::sampler::Sampler;
use crate::sequence::SequenceKind;
use crate::speed::Op;
use crate::table::{Table, number};
use hairis_variants::{Accuracy, ModelId};

/// How much a set of tables holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// The rows that fit a terminal.
    Summary,
    /// All of it.
    Full,
}

/// The tables of a comparison, by section.
#[derive(Clone, Debug)]
pub struct Tables {
    /// Time a direction.
    pub speed: Vec<Table>,
    /// Errors against the oracle.
    pub agreement: Vec<Table>,
    /// Variance a sample.
    pub efficiency: Vec<Table>,
    /// One ray for many candidates.
    pub rays: Vec<Table>,
}

/// Makes the tables.
#[must_use]
pub fn tables(of: &Comparison, depth: Depth) -> Tables {
    let mut efficiency = vec![reference(of), variance(of)];
    if depth == Depth::Full {
        efficiency.extend([correlated(of), effective(of), samples(of), self::efficiency(of)]);
    }
    efficiency.push(light_sampling(of, depth));
    let speed = ModelId::defaults_of_names().map(|model| speed(of, model, depth)).chain([threads(of)]).collect();
    Tables { speed, agreement: vec![agreement(of, depth)], efficiency, rays: rays::tables(of, depth) }
}

fn speed(of: &Comparison, model: ModelId, depth: Depth) -> Table {
    let title = format!("Time a direction, {} model", model.name());
    let mut table = Table::new(title).texts(["operation", "contender", "instruction set"]);
    table = table.numbers(["ns", "quartiles, ns", "against the faster textbook"]);
    for row in of.speed.rows.iter().filter(|row| row.model == model.name()) {
        if depth == Depth::Summary && matches!(row.op, Op::PointsOf4 | Op::PointsPacked | Op::SampleTails) {
            continue;
        }
        table.push([
            row.op.label().to_owned(),
            row.contender.to_owned(),
            row.level.to_owned(),
            number::plain(row.ns, 3),
            format!("{} to {}", number::plain(row.ns_q1, 3), number::plain(row.ns_q3, 3)),
            number::ratio(row.ratio),
        ]);
    }
    table.note(format!(
        "{}. Medians over rounds in which all contenders run in turn; the ratio is formed within each round. A \
         textbook is the model's formulas in f32, a material's constants formed once: on the libm crate, and on the platform's \
         library by the methods of std. Ratios are to the faster of the two.",
        of.machine.summary()
    ))
}

fn threads(of: &Comparison) -> Table {
    let mut table = Table::new("Slices on several threads").texts(["model", "operation", "instruction set"]);
    table = table.numbers(["threads", "million directions a second", "against one thread", "quartiles"]);
    for row in &of.speed.threads {
        table.push([
            row.model.to_owned(),
            row.op.label().to_owned(),
            row.level.to_owned(),
            row.threads.to_string(),
            number::plain(row.millions, 3),
            number::ratio(row.speedup),
            format!("{} to {}", number::ratio(row.speedup_q1), number::ratio(row.speedup_q3)),
        ]);
    }
    table.note("Chunks of 8064 directions through rayon; the numbers of threads take turns. Logical cores may be halves of one.")
}

fn agreement(of: &Comparison, depth: Depth) -> Table {
    let shown = [Quantity::Pdf, Quantity::Value, Quantity::SamplePdf, Quantity::SampleCdf];
    let table = Table::new("Largest relative error against f64 (99.9th percentile)")
        .texts(["model", "sampler", "path", "instruction set", "region"])
        .numbers(shown.map(Quantity::label));
    let rows = of.agreement.iter().filter(|row| depth == Depth::Full || row.region == Region::General);
    let words = |row: &AgreementResult| {
        let sampler = row.sampler.unwrap_or_default();
        [row.model, sampler, row.path, row.level, row.region.label()].map(str::to_owned).into()
    };
    let cell = |row: &AgreementResult| format!("{:.1e} ({:.1e})", row.worst, row.p999);
    pivot(table, rows, words, &shown, |row| row.quantity, cell).note(format!(
        "Bounds, further than 1e-3 rad from the fibre's axis: {}. The cdf is the distance from the number a sample was drawn \
         with.",
        bounds()
    ))
}

/// The bounds of every model; those that share them are named together.
fn bounds() -> String {
    let mut groups: Vec<(String, Accuracy)> = Vec::new();
    for id in ModelId::ALL {
        let name = id.choice().map_or_else(|| id.name().to_owned(), |(_, word)| format!("{} {word}", id.name()));
        match groups.iter_mut().find(|(_, accuracy)| *accuracy == id.accuracy()) {
            Some((names, _)) => names.extend([", ", name.as_str()]),
            None => groups.push((name, id.accuracy())),
        }
    }
    let line = |(names, a): &(String, Accuracy)| {
        let cdf = if a.cdf > 0.0 { format!(", cdf {:e}", a.cdf) } else { String::new() };
        format!("{names}: density {:e}, S {:e}, density of a sample {:e}{cdf}", a.pdf, a.value, a.sample_pdf)
    };
    groups.iter().map(line).collect::<Vec<_>>().join("; ")
}

fn reference(of: &Comparison) -> Table {
    let mut table = Table::new("V of the default set under constant light").texts(["model", "sampler"]);
    table = table.numbers(["θₒ, °", "V", "quadrature", "recorded", "z"]);
    for row in &of.efficiency.reference_v {
        table.push([
            row.model.name().to_owned(),
            row.sampler.name().to_owned(),
            number::plain(row.theta_o_deg, 3),
            number::estimate(&row.v),
            number::plain(row.quadrature, 4),
            row.recorded.map_or_else(String::new, |v| number::plain(v, 3)),
            format!("{:+.1}", row.z_quadrature),
        ]);
    }
    table.note("V is the variance of one sample over the squared mean; z is its distance from the quadrature in standard errors; recorded, where there is one, is another implementation's.")
}

/// Adds a line for each group of rows that have the same words at its beginning, with the cell of the row of each column.
fn pivot<'a, R: 'a, C: PartialEq>(
    mut table: Table,
    rows: impl Iterator<Item = &'a R>,
    words: impl Fn(&R) -> Vec<String>,
    columns: &[C],
    column: impl Fn(&'a R) -> C,
    cell: impl Fn(&R) -> String,
) -> Table {
    let rows: Vec<(Vec<String>, &R)> = rows.map(|row| (words(row), row)).collect();
    for line in distinct(rows.iter().map(|(words, _)| words)) {
        let cells = columns.iter().map(|wanted| {
            let row = rows.iter().find(|(words, row)| words == line && column(row) == *wanted);
            row.map_or_else(String::new, |(_, row)| cell(row))
        });
        table.push(line.iter().cloned().chain(cells));
    }
    table
}

/// A table with a row for each light, inclination and model, and a column for each sampler.
fn by_light(
    of: &Comparison,
    title: &str,
    sequences: &[SequenceKind],
    cell: impl Fn(&EfficiencyRow) -> String,
) -> Table {
    let mut table = Table::new(title).text("light").number("θₒ, °");
    if sequences.len() > 1 {
        table = table.text("numbers");
    }
    table = table.text("model").numbers(SAMPLERS.map(Sampler::name));
    let lights = &of.efficiency.settings.lights;
    let mut rows: Vec<&EfficiencyRow> = of.efficiency.rows.iter().collect();
    rows.retain(|row| sequences.contains(&row.sequence));
    rows.sort_by_key(|row| {
        let light = lights.iter().position(|light| *light == row.light);
        let sequence = sequences.iter().position(|sequence| *sequence == row.sequence);
        (light, row.theta_o_deg.to_bits(), sequence, row.model.index())
    });
    let words = |row: &EfficiencyRow| {
        let mut words = vec![row.light.clone(), number::plain(row.theta_o_deg, 3)];
        words.extend((sequences.len() > 1).then(|| row.sequence.name().to_owned()));
        words.push(row.model.name().to_owned());
        words
    };
    pivot(table, rows.into_iter(), words, &SAMPLERS, |row| row.sampler, cell)
}

/// The measured figure, or the reference's where too few samples meet the light to measure it.
fn tested_or(row: &EfficiencyRow, measured: String, predict: impl Fn(f64) -> String) -> String {
    if row.tested { measured } else { format!("≈ {}", predict(predicted(row, row.sampler))) }
}

fn variance(of: &Comparison) -> Table {
    by_light(of, "Relative variance of one sample, independent numbers", &[SequenceKind::Independent], |row| {
        tested_or(row, number::estimate(&row.v), |v| number::plain(v, 3))
    })
    .note("± one standard error; ≈ predicted from the reference, where too few samples see the light to measure it. Samples for an error of 1%: 10⁴ V.")
}

fn correlated(of: &Comparison) -> Table {
    let sequences = [SequenceKind::Stratified, SequenceKind::Halton];
    let n = of.efficiency.settings.budget.correlated;
    by_light(of, "Relative variance times the number of samples, stratified and Halton numbers", &sequences, |row| {
        number::estimate(&row.v)
    })
    .note(format!("Of the mean of {n} samples, over independent randomisations; uniform on stratified numbers is the paper's stratified uniform sampling."))
}

fn effective(of: &Comparison) -> Table {
    by_light(of, "Effective samples in 1000", &[SequenceKind::Independent], |row| {
        tested_or(row, number::estimate(&row.ess_per_1000), |v| number::plain(1e3 / (1.0 + v), 3))
    })
    .note("1000 / (1 + V): how many samples without variance in the weights carry as much.")
}

fn samples(of: &Comparison) -> Table {
    by_light(of, "Samples for an error of 1%", &[SequenceKind::Independent], |row| {
        let n = row.samples_for_1_percent;
        let measured = if n.value < 1e5 { number::estimate(&n) } else { number::si(n.value) };
        tested_or(row, measured, |v| number::si(1e4 * v))
    })
    .note("10⁴ V.")
}

fn efficiency(of: &Comparison) -> Table {
    by_light(of, "Efficiency, 1/(V · µs)", &[SequenceKind::Independent], |row| {
        let shown = row.efficiency.filter(|_| row.tested);
        shown.map_or_else(String::new, |e| number::estimate(&e.scale(1e-6)))
    })
    .note(
        "Time of a sample on eight lanes, a sixteenth of the preparation included; lights are not charged. The error is \
         that of V alone. Blank where V could not be measured.",
    )
}

/// The summary leaves out what the table of variances has: each sampler alone.
fn light_sampling(of: &Comparison, depth: Depth) -> Table {
    let is_shown = |row: &&MisRow| depth == Depth::Full || !matches!(row.technique, Technique::Bsdf(_));
    let rows = &of.efficiency.mis_rows;
    let names = distinct(rows.iter().filter(is_shown).map(|row| row.name.as_str()));
    let table = Table::new("Light sampling and multiple importance sampling: relative variance a sample")
        .texts(["model", "light"])
        .number("θₒ, °")
        .numbers(names.iter().copied());
    let words = |row: &MisRow| vec![row.model.name().to_owned(), row.light.clone(), number::plain(row.theta_o_deg, 3)];
    let cell = |row: &MisRow| match row.technique {
        Technique::Bsdf(sampler) if !row.tested => {
            format!("≈ {}", number::plain(row.reference.predicted(sampler)[0], 3))
        }
        _ => number::estimate(&row.v),
    };
    let alone =
        if depth == Depth::Full { " ≈ predicted, as above." } else { " Each sampler alone is in the table above." };
    pivot(table, rows.iter(), words, &names, |row| row.name.as_str(), cell).note(format!(
        "Combined with the power heuristic; every column spends the same number of samples in all.{alone}"
    ))
}
