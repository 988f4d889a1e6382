//! Tables that only the report has.

use super::super::rows::Strategy;
use super::super::summary::shown;
use super::super::times::PER_POINT;
use super::view::{View, ess};
use crate::sampler::Sampler;
use crate::subject::ModelKind;
use crate::table::{Table, number};
use serde_json::Value;

/// V, effective samples, divergence and largest weight of every sampler under every light.
pub(super) fn quality(of: &View<'_>) -> Table {
    let mut table = Table::new("Every sampler under every light, over the grid")
        .texts(["model", "sampler", "light"])
        .numbers(["V", "effective samples in 1000", "divergence, nats", "largest contribution, means"]);
    for model in ModelKind::ALL {
        for strategy in Strategy::ALL {
            for (light, name) in of.lights.iter().enumerate() {
                let one = (model, strategy);
                let most = (0..of.cells.len()).map(|index| of.measured(index, one, light).max_contribution);
                table.push([
                    model.name().to_owned(),
                    strategy.name().to_owned(),
                    name.clone(),
                    mean_v(of, one, light),
                    shown(of.mean_of(one, light, ess)),
                    shown(of.mean_of(one, light, |measured| measured.figures.kl)),
                    number::plain(most.fold(0.0, f64::max), 3),
                ]);
            }
        }
    }
    table.note(
        "V: geometric mean. Effective samples and divergence (Kullback-Leibler, of the sampler's density from the \
         normalised integrand): means. Largest contribution: of any cell, in units of its mean. ±: one standard error.",
    )
}

/// The mean of V in words: 0 where it is 0 in every cell, which has no geometric mean.
fn mean_v(of: &View<'_>, one: (ModelKind, Strategy), light: usize) -> String {
    if (0..of.cells.len()).all(|index| of.v(index, one, light).value == 0.0) {
        return "0".to_owned();
    }
    of.mean_v(one, light, |_| true).map_or_else(String::new, shown)
}

/// Times of a look-up.
pub(super) fn look_ups(of: &View<'_>) -> Table {
    let mut table = Table::new("Time of a look-up of the light in a direction, ns").text("light").number("ns");
    for (light, name) in of.lights.iter().enumerate() {
        table.push([name.clone(), of.look_up(light).map_or_else(|| "not timed".to_owned(), shown)]);
    }
    table.note(
        "Radiance and the light's density in 65536 directions of the published sampler, many shading points in turn; eight \
         lanes, one thread, medians; ±: one standard error.",
    )
}

/// Times of a sample.
pub(super) fn times(of: &View<'_>) -> Table {
    let table = Table::new("Time of a sample, ns").texts(["model", "sampler"]);
    let mut table = table.numbers(PER_POINT.map(|n| format!("{n} per shading point")));
    for model in ModelKind::ALL {
        for sampler in Sampler::ALL {
            let mut cells = vec![model.name().to_owned(), sampler.name().to_owned()];
            cells.extend(PER_POINT.map(|n| {
                let [ns, published] = [sampler, Sampler::Published].map(|sampler| of.ns((model, sampler), n));
                format!("{} ({})", shown(ns), number::ratio(ns.value / published.value))
            }));
            table.push(cells);
        }
    }
    table.note(
        "Set-up included, the default hair, eight lanes, one thread, medians; ±: one standard error. In brackets: over that \
         of the published sampler. A sampler pays in equal time while that is below V of the published sampler over its \
         own V.",
    )
}

/// The verdicts in a `claims.json`; `None` if it holds none.
pub(super) fn claims(of: &Value) -> Option<Table> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let mut table = Table::new("Each claim, and what is left of it").texts(["claim", "verdict", "found"]);
    for claim in of.get("claims")?.as_array()? {
        let words = format!("\u{201c}{}\u{201d} ({})", text(&claim["quotation"]), text(&claim["source"]));
        table.push([words, text(&claim["verdict"]), text(&claim["sentence"])]);
    }
    let commit = text(&of["machine"]["commit"]);
    let quick = of["settings"]["quick"].as_bool() == Some(true);
    let command = if quick { "hairis claims --quick" } else { "hairis claims" };
    (!table.is_empty()).then(|| {
        table.note(format!(
            "From claims.json, written by {command} of commit {commit}; verdicts follow from figures alone."
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn claims_are_shown_with_their_verdicts_or_not_at_all() {
        let claim = json!({ "quotation": "always", "source": "5", "verdict": "false", "sentence": "not here" });
        let table = claims(&json!({ "claims": [claim], "machine": { "commit": "abc" } })).expect("one claim");
        let text = table.to_plain();
        assert!(
            ["always", "(5)", "false", "not here", "commit abc"].iter().all(|words| text.contains(words)),
            "{text}"
        );
        for nothing in [json!({}), json!([]), json!({ "claims": [] }), json!({ "claims": 7 })] {
            assert_eq!(claims(&nothing), None, "{nothing}");
        }
    }
}
