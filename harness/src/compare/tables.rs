//! The tables of a comparison, the same for the terminal and for the page.

use super::{Comparison, rays};
use crate::agreement::{Quantity, Region};
use crate::efficiency::{EfficiencyRow, MisRow, SAMPLERS, Technique};
use crate::sampler::Sampler;
use crate::sequence::SequenceKind;
use crate::speed::Op;
use crate::subject::ModelKind;
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
        efficiency.push(correlated(of));
        efficiency.extend([effective(of), samples(of), self::efficiency(of)]);
    }
    efficiency.push(light_sampling(of, depth));
    let mut speed: Vec<Table> = ModelId::defaults_of_names().map(|model| speed(of, model, depth)).collect();
    speed.push(threads(of));
    Tables { speed, agreement: vec![agreement(of, depth)], efficiency, rays: rays::tables(of, depth) }
}

fn speed(of: &Comparison, model: ModelId, depth: Depth) -> Table {
    let title = format!("Time a direction, {} model", model.name());
    let mut table = Table::new(title).texts(["operation", "contender", "instruction set"]).numbers([
        "ns",
        "quartiles, ns",
        "against the faster textbook",
    ]);
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
    let mut table = Table::new("Slices on several threads").texts(["model", "operation", "instruction set"]).numbers([
        "threads",
        "million directions a second",
        "against one thread",
        "quartiles",
    ]);
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
    let mut table = Table::new("Largest relative error against f64 (99.9th percentile)").texts([
        "model",
        "sampler",
        "path",
        "instruction set",
        "region",
    ]);
    table = table.numbers(shown.map(Quantity::label));
    let mut seen = Vec::new();
    for first in &of.agreement {
        let key = (first.model, first.sampler, first.path, first.level, first.region);
        if seen.contains(&key) || (depth == Depth::Summary && first.region != Region::General) {
            continue;
        }
        seen.push(key);
        let same = |row: &&_| -> bool {
            let row: &crate::agreement::AgreementResult = row;
            (row.model, row.sampler, row.path, row.level, row.region) == key
        };
        let (model, sampler, path, level, region) = key;
        let mut cells: Vec<String> =
            [model, sampler.unwrap_or_default(), path, level, region.label()].map(str::to_owned).into();
        for quantity in shown {
            let row = of.agreement.iter().filter(same).find(|row| row.quantity == quantity);
            cells.push(row.map_or_else(String::new, |row| format!("{:.1e} ({:.1e})", row.worst, row.p999)));
        }
        table.push(cells);
    }
    table.note(format!(
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
    let mut table = Table::new("V of the default set under constant light").texts(["model", "sampler"]).numbers([
        "θₒ, °",
        "V",
        "quadrature",
        "recorded",
        "z",
    ]);
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
    let rows = &of.efficiency.rows;
    for light in &of.efficiency.settings.lights {
        for theta_o in of.efficiency.settings.theta_o_deg {
            for sequence in sequences {
                for model in ModelKind::ALL {
                    let mut cells = vec![light.clone(), number::plain(theta_o, 3)];
                    if sequences.len() > 1 {
                        cells.push(sequence.name().to_owned());
                    }
                    cells.push(model.name().to_owned());
                    for sampler in SAMPLERS {
                        let row = rows.iter().find(|row| {
                            (row.model, row.sampler, row.sequence) == (model, sampler, *sequence)
                                && row.light == *light
                                && row.theta_o_deg == theta_o
                        });
                        cells.push(row.map_or_else(String::new, &cell));
                    }
                    table.push(cells);
                }
            }
        }
    }
    table
}

fn variance(of: &Comparison) -> Table {
    by_light(of, "Relative variance of one sample, independent numbers", &[SequenceKind::Independent], |row| {
        if row.tested { number::estimate(&row.v) } else { format!("≈ {}", number::plain(predicted(row), 3)) }
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
        if row.tested {
            number::estimate(&row.ess_per_1000)
        } else {
            format!("≈ {}", number::plain(1e3 / (1.0 + predicted(row)), 3))
        }
    })
    .note("1000 / (1 + V): how many samples without variance in the weights carry as much.")
}

fn samples(of: &Comparison) -> Table {
    by_light(of, "Samples for an error of 1%", &[SequenceKind::Independent], |row| {
        if !row.tested {
            return format!("≈ {}", number::si(1e4 * predicted(row), ""));
        }
        let n = row.samples_for_1_percent;
        if n.value < 1e5 { number::estimate(&n) } else { number::si(n.value, "") }
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
    let shown = |row: &&MisRow| -> bool { depth == Depth::Full || !matches!(row.technique, Technique::Bsdf(_)) };
    let mut names: Vec<&str> = Vec::new();
    for row in of.efficiency.mis_rows.iter().filter(shown) {
        if !names.contains(&row.name.as_str()) {
            names.push(&row.name);
        }
    }
    let mut table = Table::new("Light sampling and multiple importance sampling: relative variance a sample")
        .texts(["model", "light"])
        .number("θₒ, °");
    table = table.numbers(names.iter().copied());
    let mut seen = Vec::new();
    for first in &of.efficiency.mis_rows {
        let key = (first.model, &first.light, first.theta_o_deg.to_bits());
        if seen.contains(&key) {
            continue;
        }
        seen.push(key);
        let mut cells = vec![first.model.name().to_owned(), first.light.clone(), number::plain(first.theta_o_deg, 3)];
        for name in &names {
            let row = of
                .efficiency
                .mis_rows
                .iter()
                .find(|row| (row.model, &row.light, row.theta_o_deg.to_bits()) == key && row.name == *name);
            cells.push(row.map_or_else(String::new, |row| match row.technique {
                Technique::Bsdf(sampler) if !row.tested => {
                    format!("≈ {}", number::plain(row.reference.predicted(sampler)[0], 3))
                }
                _ => number::estimate(&row.v),
            }));
        }
        table.push(cells);
    }
    let alone =
        if depth == Depth::Full { " ≈ predicted, as above." } else { " Each sampler alone is in the table above." };
    table.note(format!(
        "Combined with the power heuristic; every column spends the same number of samples in all.{alone}"
    ))
}

/// V of a row as the reference predicts it.
fn predicted(row: &EfficiencyRow) -> f64 {
    let [v, _] = row.reference.predicted(row.sampler);
    v
}
