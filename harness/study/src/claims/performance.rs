//! All-Cauchy model against the Gaussian one, each under the published sampler, light by light, measured as the study measures.

use super::claim::{Claim, Figure, Origin, Side, Statement};
use crate::study::output::Times;
use crate::study::{Cell, Plan, gain, variances};
use hairis::ParamError;
use hairis_harness::journal::Journal;
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_instruments::error::Error;
use hairis_instruments::light::{Constant, Rectangle, Sky, Smooth, Sun};
use hairis_instruments::progress::Progress;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::number;

/// Light that a claim is made for.
#[derive(Clone, Copy)]
pub(super) struct ClaimedLight {
    /// Name of the light in the study.
    name: &'static str,
    /// Name of the claim, for scripts.
    id: &'static str,
    /// Name of the light in sentences.
    pub(super) words: &'static str,
}

/// Lights of the claims, in the order of reports. Other lights have no claim.
pub(super) const LIGHTS: [ClaimedLight; 5] = [
    ClaimedLight {
        name: Constant::NAME,
        id: "cauchy-samples-better-constant",
        words: "constant light",
    },
    ClaimedLight {
        name: Smooth::NAME,
        id: "cauchy-samples-better-smooth",
        words: "smooth light",
    },
    ClaimedLight {
        name: Sun::NAME,
        id: "cauchy-samples-better-sun",
        words: "a 5° sun",
    },
    ClaimedLight {
        name: Rectangle::NAME,
        id: "cauchy-samples-better-area",
        words: "a large area light along the fibre",
    },
    ClaimedLight {
        name: Sky::NAME,
        id: "cauchy-samples-better-sky",
        words: "the procedural sky",
    },
];

/// Statement for one light. Each light fills in its own `id`.
const STATEMENT: Statement = Statement {
    id: "",
    quotation: "This new bsdf model introduces some very minor visual differences, but it is able to achieve a \
                better sampling performance.",
    source: "section 3.3",
    of: "V on the Gaussian model over V on the Cauchy model, published sampler",
    side: Side::AtLeast,
    bound: 1.0,
    limits: "the geometric mean over the grid",
};

const IN_EQUAL_TIME: Statement = Statement {
    id: "cauchy-samples-better-in-equal-time",
    of: "V times time, Gaussian over Cauchy, geometric mean over the grid",
    limits: "the light under which the Cauchy model gains most",
    ..STATEMENT
};

/// Samples of a shading point that share its set-up in the comparison of times.
const PER_POINT: usize = 16;

/// V on both models in a cell, under each of [`LIGHTS`].
type Pairs = [[Estimate; 2]; LIGHTS.len()];

/// Count of a cell's numbers in the journal: for each model and light, V and its error.
const NUMBERS: usize = 2 * 2 * LIGHTS.len();

/// Measures V in every cell, unless the journal has it.
fn measure(
    plan: &Plan<'_>,
    journal: &Journal,
    progress: &Progress<'_>,
) -> Result<Vec<Pairs>, Error> {
    let cells: Vec<Cell> = plan.grid().cells().collect();
    let pairs = |cell: &Cell| {
        let find = || {
            let found = variances(plan, plan.budget(), cell, &[Sampler::Published])?;
            let mut numbers = [f64::NAN; NUMBERS];
            let places = ModelKind::ALL.map(|model| LIGHTS.map(|light| (model, light.name)));
            for ([value, error], key) in numbers
                .as_chunks_mut()
                .0
                .iter_mut()
                .zip(places.as_flattened())
            {
                let row = found.iter().find(|of| (of.model, &*of.light) == *key);
                let v = row.map_or(Estimate::UNKNOWN, |of| of.v);
                (*value, *error) = (v.value, v.standard_error);
            }
            Ok::<_, ParamError>(numbers)
        };
        let numbers = journal.numbers(&format!("V in cell {}", cell.index), find)?;
        let of = |place: usize| Estimate {
            value: numbers[2 * place],
            standard_error: numbers[2 * place + 1],
        };
        Ok(core::array::from_fn(|light| {
            [of(light), of(LIGHTS.len() + light)]
        }))
    };
    progress.map(&cells, pairs).into_iter().collect()
}

/// Judges the claims: one per light, then one for all lights in equal time.
pub(super) fn claims(
    plan: &Plan<'_>,
    journal: &Journal,
    progress: &Progress<'_>,
) -> Result<Vec<Claim>, Error> {
    let (mut claims, means) = by_light(plan, journal, progress)?;
    claims.push(in_time(plan, &means));
    Ok(claims)
}

/// Judges the claims under each light, and returns the geometric means of their ratios as well.
pub(super) fn by_light(
    plan: &Plan<'_>,
    journal: &Journal,
    progress: &Progress<'_>,
) -> Result<(Vec<Claim>, Vec<Estimate>), Error> {
    let cells = measure(plan, journal, progress)?;
    let mut claims = Vec::new();
    let mut means = Vec::new();
    for (
        light,
        ClaimedLight {
            id, words: name, ..
        },
    ) in LIGHTS.into_iter().enumerate()
    {
        let pairs = || cells.iter().map(move |cell| cell[light]);
        let ([mean, least, most], unsure) = gain(pairs())
            .map_or(([Estimate::UNKNOWN; 3], cells.len()), |gain| {
                ([gain.geometric_mean, gain.least, gain.most], gain.unsure)
            });
        let is_worse = |ratio: Estimate| ratio.value + 2.0 * ratio.standard_error < 1.0;
        let worse = pairs()
            .filter(|[gaussian, cauchy]| is_worse(gaussian.ratio(cauchy)))
            .count();
        let sentence = format!(
            "Under {name} the published sampler needs {} times as many samples on the Gaussian model as on the Cauchy \
             model ({} to {} over {} cells, surely below 1 in {worse}).",
            number::plain(mean.value, 3),
            number::plain(least.value, 2),
            number::plain(most.value, 2),
            cells.len() - unsure,
        );
        let figure = |which: &str, of: Estimate| {
            Figure::new(
                format!("V on Gaussian over V on Cauchy, {name}, {which}"),
                Origin::Sampled,
                of,
            )
        };
        let figures = vec![
            figure("least of the grid", least),
            figure("geometric mean", mean),
            figure("most of the grid", most),
            Figure::cells(
                "cells where the Gaussian model needs fewer samples, by two standard errors",
                worse,
            ),
            Figure::cells("cells left out: error of V above a quarter", unsure),
        ];
        claims.push(Statement { id, ..STATEMENT }.judge(figures, sentence));
        means.push(mean);
    }
    Ok((claims, means))
}

/// Judges the claim in equal time.
fn in_time(plan: &Plan<'_>, means: &[Estimate]) -> Claim {
    let times = Times::measure(plan.seed, plan.size.rounds(), None);
    let [gaussian, cauchy] =
        ModelKind::ALL.map(|model| times.ns(model, Sampler::Published, PER_POINT));
    let faster = gaussian.ratio(&cauchy);
    let gains: Vec<Estimate> = means.iter().map(|mean| mean.times(&faster)).collect();
    let timed = |name: String, of: Estimate| Figure::new(name, Origin::Timed, of);
    let by_value = |a: &usize, b: &usize| gains[*a].value.total_cmp(&gains[*b].value);
    let known = || (0..gains.len()).filter(|light| gains[*light].value.is_finite());
    let (least, most) = (
        known().min_by(by_value).unwrap_or(0),
        known().max_by(by_value).unwrap_or(0),
    );
    let sentence = format!(
        "A sample of the Cauchy model takes {:.2} times less time here; in equal time its variance is lower by {:.2} under \
         {} and by {:.2} under {}.",
        faster.value,
        gains[most].value,
        LIGHTS[most].words,
        gains[least].value,
        LIGHTS[least].words,
    );
    let mut figures = vec![
        timed(
            "gain in equal time, least of the lights".to_owned(),
            gains[least],
        ),
        timed(
            "gain in equal time, most of the lights".to_owned(),
            gains[most],
        ),
    ];
    figures.extend(
        gains
            .iter()
            .zip(LIGHTS)
            .map(|(gain, light)| timed(format!("gain in equal time, {}", light.words), *gain)),
    );
    for (model, ns) in ModelKind::ALL.into_iter().zip([gaussian, cauchy]) {
        figures.push(Figure {
            unit: "ns",
            ..timed(format!("time of a sample, {}", model.title()), ns)
        });
    }
    IN_EQUAL_TIME.judge(figures, sentence)
}
