//! Tables of a comparison. Terminal and page have the same tables, with more rows on the page.

use super::query::{Depth, predicted};
use super::{Comparison, distinct, rays};
use crate::agreement::{AgreementResult, Quantity, Region};
use crate::efficiency::{EfficiencyRow, MisRow, SAMPLERS, Technique};
use crate::sampler::Sampler;
use crate::speed::TimedOp;
use hairis_instruments::sequence::SequenceKind;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::{Table, number};
use hairis_variants::ModelId;

/// Returns the tables that are printed on the terminal, with the rows that fit it.
#[must_use]
pub fn summary(of: &Comparison) -> Vec<Table> {
    let depth = Depth::Summary;
    [
        speed(of, depth),
        vec![agreement(of, depth)],
        efficiency(of, depth),
        rays::tables(of, depth),
        of.material_table().into_iter().collect(),
    ]
    .concat()
}

/// Returns the tables of time per direction.
pub(super) fn speed(of: &Comparison, depth: Depth) -> Vec<Table> {
    let quartiles = |[low, high]: [f64; 2], shown: fn(f64) -> String| {
        format!("{} to {}", shown(low), shown(high))
    };
    let ns = |ns| number::plain(ns, 3);
    let is_shown = |op| {
        depth == Depth::Full
            || !matches!(
                op,
                TimedOp::PointsOf4 | TimedOp::PointsPacked | TimedOp::SampleTails
            )
    };
    let of_model = |model: ModelId| {
        let rows = of
            .speed
            .rows
            .iter()
            .filter(|row| row.model == model.name() && is_shown(row.op))
            .map(|row| {
                let keys = [row.op.label(), row.contender, row.level].map(str::to_owned);
                keys.into_iter().chain([
                    ns(row.ns),
                    quartiles([row.ns_q1, row.ns_q3], ns),
                    number::ratio(row.ratio),
                ])
            });
        Table::new(format!("Time a direction, {} model", model.name()))
            .texts(["operation", "contender", "instruction set"])
            .numbers(["ns", "quartiles, ns", "against the faster reference"])
            .rows(rows)
            .note(format!(
                "{}. Medians over rounds in which all contenders run in turn; the ratio is formed within each round. The \
                 reference is the model's formulas in f32, a material's constants formed once: on the libm crate, and on the \
                 platform's library by the methods of std. Ratios are to the faster of the two. Kernels at a prepared hit \
                 are called behind handles of any model, whose choice takes 1 to 2 ns of each call. Some of the 8 hairs, which are \
                 drawn from all that is legal, may have lobes that `Conserving` integrates at every hit.",
                of.machine.summary()
            ))
    };
    let rows = of.speed.threads.iter().map(|row| {
        let keys = [row.model, row.op.label(), row.level].map(str::to_owned);
        let speedup = quartiles([row.speedup_q1, row.speedup_q3], number::ratio);
        keys.into_iter().chain([
            row.threads.to_string(),
            ns(row.millions),
            number::ratio(row.speedup),
            speedup,
        ])
    });
    let threads = Table::new("Slices on several threads")
        .texts(["model", "operation", "instruction set"])
        .numbers(["threads", "million directions a second", "against one thread", "quartiles"])
        .rows(rows)
        .note("Chunks of 8064 directions through rayon; the numbers of threads take turns. Logical cores may be halves of one.");
    ModelId::defaults_of_names()
        .map(of_model)
        .chain([threads])
        .collect()
}

/// Returns the table of errors against double precision.
pub(super) fn agreement(of: &Comparison, depth: Depth) -> Table {
    let shown = [
        Quantity::Pdf,
        Quantity::Value,
        Quantity::SamplePdf,
        Quantity::SampleCdf,
    ];
    let table = Table::new("Largest relative error against f64 (99.9th percentile) and its bound")
        .texts(["model", "sampler", "path", "instruction set", "region"])
        .numbers(shown.map(Quantity::label));
    let rows = of
        .agreement
        .iter()
        .filter(|row| depth == Depth::Full || row.region == Region::General);
    let words = |row: &AgreementResult| {
        [
            row.model,
            row.sampler.unwrap_or_default(),
            row.path,
            row.level,
            row.region.label(),
        ]
        .map(str::to_owned)
        .into()
    };
    let cell = |row: &AgreementResult| {
        let sign = if row.worst <= row.bound { '≤' } else { '>' };
        format!(
            "{:.1e} ({:.1e}) {sign} {:.0e}",
            row.worst, row.p999, row.bound
        )
    };
    pivot(table, rows, &words, &shown, |row| row.quantity, &cell)
        .note("The error of the cdf is the distance from the number that a sample was drawn with.")
}

/// Returns the tables of variances per sample, and of the figures that follow from them.
pub(super) fn efficiency(of: &Comparison, depth: Depth) -> Vec<Table> {
    let is_full = depth == Depth::Full;
    let n = of.efficiency.settings.budget.correlated;
    let v = |row: &EfficiencyRow| tested_or(row, &row.v, |v| v);
    let mut tables = vec![
        reference(of),
        by_light(of, "Relative variance V per sample", is_full, &v).note(format!(
            "± one standard error; ≈ predicted from the reference, where too few samples see the light to measure it. \
             Stratified and Halton: of the mean of {n} samples, times {n}, over independent randomisations; uniform on \
             stratified numbers is the paper's stratified uniform sampling."
        )),
    ];
    if is_full {
        let samples = |row: &EfficiencyRow| {
            let effective = tested_or(row, &row.ess_per_1000, |v| 1e3 / (1.0 + v));
            format!(
                "{effective}; {}",
                tested_or(row, &row.samples_for_1_percent, |v| 1e4 * v)
            )
        };
        let efficiency = |row: &EfficiencyRow| {
            let shown = row.efficiency.filter(|_| row.tested);
            shown.map_or_else(String::new, |efficiency| {
                number::estimate(&efficiency.scale(1e-6))
            })
        };
        let title = "Effective samples in 1000; samples for an error of 1%";
        tables.push(by_light(of, title, false, &samples).note("1000 / (1 + V); 10⁴ V."));
        tables.push(by_light(of, "Efficiency, 1/(V · µs)", false, &efficiency).note(
            "Time of a sample on eight lanes, a sixteenth of the preparation included; lights are not charged. The error is \
             that of V alone. Blank where V could not be measured.",
        ));
    }
    tables.push(light_sampling(of, depth));
    tables
}

fn reference(of: &Comparison) -> Table {
    let rows = of.efficiency.reference_v.iter().map(|row| {
        [
            row.model.name().to_owned(),
            row.sampler.name().to_owned(),
            number::plain(row.theta_o_deg, 3),
            number::estimate(&row.v),
            number::plain(row.quadrature, 4),
            row.recorded
                .map_or_else(String::new, |v| number::plain(v, 3)),
            format!("{:+.1}", row.z_quadrature),
        ]
    });
    Table::new("V of the default set under constant light")
        .texts(["model", "sampler"])
        .numbers(["θₒ, °", "V", "quadrature", "recorded", "z"])
        .rows(rows)
        .note("V is the variance of one sample over the squared mean; z is its distance from the quadrature in standard errors; recorded, where there is one, is another implementation's.")
}

/// Adds a line for each group of rows with the same leading words; each column has the cell of its row.
fn pivot<'a, R: 'a, C: PartialEq>(
    mut table: Table,
    rows: impl Iterator<Item = &'a R>,
    words: &dyn Fn(&R) -> Vec<String>,
    columns: &[C],
    column: fn(&'a R) -> C,
    cell: &dyn Fn(&R) -> String,
) -> Table {
    let rows: Vec<(Vec<String>, &R)> = rows.map(|row| (words(row), row)).collect();
    for line in distinct(rows.iter().map(|(words, _)| words)) {
        let cells = columns.iter().map(|wanted| {
            let row = rows
                .iter()
                .find(|(words, row)| words == line && column(row) == *wanted);
            row.map_or_else(String::new, |(_, row)| cell(row))
        });
        table.push(line.iter().cloned().chain(cells));
    }
    table
}

/// Returns a table with a column for each sampler, of independent numbers or of every kind.
fn by_light(
    of: &Comparison,
    title: &str,
    every_kind: bool,
    cell: &dyn Fn(&EfficiencyRow) -> String,
) -> Table {
    let table = Table::new(title)
        .texts(["model", "light"])
        .numbers(["θₒ, °"])
        .texts(["numbers"]);
    let table = table.numbers(SAMPLERS.map(Sampler::name));
    let rows = of
        .efficiency
        .rows
        .iter()
        .filter(|row| every_kind || row.sequence == SequenceKind::Independent);
    let words = |row: &EfficiencyRow| {
        let theta_o = number::plain(row.theta_o_deg, 3);
        [row.model.name(), &row.light, &theta_o, row.sequence.name()]
            .map(str::to_owned)
            .into()
    };
    pivot(table, rows, &words, &SAMPLERS, |row| row.sampler, cell)
}

/// Returns the measured figure or, if too few samples hit the light to measure it, the figure that follows from the V of the reference.
fn tested_or(row: &EfficiencyRow, measured: &Estimate, of_v: fn(f64) -> f64) -> String {
    if row.tested || row.sequence != SequenceKind::Independent {
        return number::estimate(measured);
    }
    format!("≈ {}", number::plain(of_v(predicted(row, row.sampler)), 3))
}

/// Returns the table of light sampling. The summary leaves out each sampler alone, which the table of variances has.
fn light_sampling(of: &Comparison, depth: Depth) -> Table {
    let is_shown =
        |row: &&MisRow| depth == Depth::Full || !matches!(row.technique, Technique::Bsdf(_));
    let rows = &of.efficiency.mis_rows;
    let names = distinct(rows.iter().filter(is_shown).map(|row| row.name.as_str()));
    let table =
        Table::new("Light sampling and multiple importance sampling: relative variance a sample")
            .texts(["model", "light"])
            .numbers(["θₒ, °"])
            .numbers(names.iter().copied());
    let words = |row: &MisRow| {
        vec![
            row.model.name().to_owned(),
            row.light.clone(),
            number::plain(row.theta_o_deg, 3),
        ]
    };
    let cell = |row: &MisRow| match row.technique {
        Technique::Bsdf(sampler) if !row.tested => {
            format!(
                "≈ {}",
                number::plain(row.reference.predicted(sampler)[0], 3)
            )
        }
        _ => number::estimate(&row.v),
    };
    let alone = if depth == Depth::Full {
        " ≈ predicted, as above."
    } else {
        " Each sampler alone is in the table above."
    };
    pivot(table, rows.iter(), &words, &names, |row| row.name.as_str(), &cell).note(format!(
        "Combined with the power heuristic; every column spends the same number of samples in all.{alone}"
    ))
}
