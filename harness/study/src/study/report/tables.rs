//! Tables of a study that only the report has.

use super::super::estimator::{name, on_each_model, published, samplers, strategies};
use super::super::finished::Study;
use super::super::summary::shown;
use super::super::view::{mean_of, mean_v};
use hairis_harness::times::PER_POINT;
use hairis_instruments::table::{Table, number};
use serde_json::Value;

/// Returns tables of the quality and the times of every sampler, and of the times of look-ups.
pub(super) fn all(of: &Study) -> [Table; 3] {
    let headers = [
        "V",
        "effective samples in 1000",
        "divergence, nats",
        "largest contribution, means",
    ];
    let title = "Every sampler under every light, over the grid";
    let quality = of.table(
        title,
        headers,
        on_each_model(strategies()),
        &|one, light| {
            let rows = || of.rows_of(one, light);
            // If V is 0 in every cell, it has no geometric mean.
            let is_even = rows().all(|row| row.v().value == 0.0);
            let v = if is_even {
                "0".to_owned()
            } else {
                mean_v(rows()).map_or_else(String::new, shown)
            };
            let means = [
                mean_of(rows(), &|measured| measured.figures.v.effective_per_1000()),
                mean_of(rows(), &|measured| measured.figures.kl),
            ]
            .map(shown);
            let most = rows()
                .map(|row| row.measured.max_contribution)
                .fold(0.0, f64::max);
            [vec![v], means.into(), vec![number::plain(most, 3)]].concat()
        },
    );
    let times = Table::new("Time of a sample, ns").texts(["model", "sampler"]);
    let mut times = times.numbers(PER_POINT.map(|n| format!("{n} per shading point")));
    for one in on_each_model(samplers()) {
        let keys = [one.0.name(), name(one.1)].map(str::to_owned);
        times.push(keys.into_iter().chain(PER_POINT.map(|n| {
            let [ns, base] = [one, published(one)].map(|one| of.ns(one, n));
            format!("{} ({})", shown(ns), number::ratio(ns.value / base.value))
        })));
    }
    let mut look_ups = Table::new("Time of a look-up of the light in a direction, ns")
        .texts(["light"])
        .numbers(["ns"]);
    for (light, name) in of.lights().iter().enumerate() {
        let ns = of.look_up(light);
        look_ups.push([
            name.clone(),
            if ns.value.is_finite() {
                shown(ns)
            } else {
                "not timed".to_owned()
            },
        ]);
    }
    [
        quality.note(
            "V: geometric mean. Effective samples and divergence (Kullback-Leibler, of the sampler's density from the \
             normalised integrand): means. Largest contribution: of any cell, in units of its mean. ±: one standard error.",
        ),
        times.note(
            "Set-up included, the default hair, eight lanes, one thread, medians; ±: one standard error. In brackets: over \
             that of the published sampler. A sampler pays in equal time while that is below V of the published sampler over \
             its own V.",
        ),
        look_ups.note(
            "Radiance and the light's density in 65536 directions of the published sampler, many shading points in turn; \
             eight lanes, one thread, medians; ±: one standard error.",
        ),
    ]
}

/// Returns the table of the verdicts in a `claims.json`; `None` if it holds none.
#[must_use]
pub fn claims(of: &Value) -> Option<Table> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let mut table =
        Table::new("Each claim, and what is left of it").texts(["claim", "verdict", "found"]);
    for claim in of.get("claims")?.as_array()? {
        let words = format!(
            "\u{201c}{}\u{201d} ({})",
            text(&claim["quotation"]),
            text(&claim["source"])
        );
        table.push([words, text(&claim["verdict"]), text(&claim["sentence"])]);
    }
    let commit = text(&of["machine"]["commit"]);
    let quick = of["settings"]["quick"].as_bool() == Some(true);
    let command = if quick {
        "hairis claims --quick"
    } else {
        "hairis claims"
    };
    (!table.is_empty()).then(|| {
        table.note(format!(
            "From claims.json, written by {command} of commit {commit}; verdicts follow from figures alone."
        ))
    })
}
