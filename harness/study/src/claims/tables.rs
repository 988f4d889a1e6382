//! Tables of the claims: one for each claim, then one of all claims with their verdicts; and the verdicts in a few lines.

use super::claim::{Claim, Figure, Origin, Role, Side, Threshold, Verdict};
use super::{Claims, Settings};
use hairis_instruments::report::Report;
use hairis_instruments::table::{Table, number};

/// Returns one table per claim, then the summary with all verdicts.
#[must_use]
pub fn tables(of: &Claims) -> Vec<Table> {
    of.claims
        .iter()
        .map(of_claim)
        .chain([summary(of)])
        .collect()
}

/// Returns the verdicts as the head of a report, which has no page of its own: that of a study shows them.
#[must_use]
pub fn report(of: &Claims) -> Report {
    let Settings {
        seed, quick, cells, ..
    } = of.settings;
    let flag = if quick { " --quick" } else { "" };
    let judged = |verdict: Verdict, said: &dyn Fn(&Claim) -> String| {
        let claims = of.claims.iter().filter(|claim| claim.verdict == verdict);
        let claims: Vec<String> = claims.map(said).collect();
        let count = claims.len();
        (count > 0).then(|| {
            let name = format!("{count} {}", verdict.name());
            [name, claims.join("; ") + "."]
        })
    };
    let id = |claim: &Claim| claim.id.to_owned();
    let with_limits = |claim: &Claim| format!("{} ({})", claim.id, claim.threshold.limits);
    let machine = ["Machine".to_owned(), of.machine.in_words() + "."];
    let verdicts = [
        Some(machine),
        judged(Verdict::Holds, &id),
        judged(Verdict::HoldsWithinLimits, &with_limits),
        judged(Verdict::False, &id),
    ];
    Report {
        title: "The paper's claims: which of them hold?".to_owned(),
        subtitle: format!(
            "hairis claims{flag}, seed {seed}: {cells} cells of hair and viewing angle"
        ),
        verdicts: verdicts.into_iter().flatten().collect(),
        ..Report::default()
    }
}

fn of_claim(claim: &Claim) -> Table {
    let Claim {
        id,
        quotation,
        source,
        threshold: Threshold { of, limits, .. },
        ..
    } = claim;
    let mut table = Table::new(format!("{id}: \"{quotation}\" ({source})"));
    table = table
        .texts(["figure"])
        .numbers(["value", "error"])
        .texts(["unit", "from"]);
    for figure in &claim.figures {
        let mark = match figure.role {
            Role::Everywhere => " [1]",
            Role::WithinLimits => " [2]",
            Role::Further => "",
        };
        let [value, error] = shown(figure);
        let [unit, origin] = [figure.unit, figure.origin.name()].map(str::to_owned);
        table.push([format!("{}{mark}", figure.name), value, error, unit, origin]);
    }
    let bound = bound(claim);
    table
        .note(format!(
            "Holds if [1] keeps the threshold, within limits ({limits}) if [2] does: {of}, {bound}."
        ))
        .note(format!("{}: {}", claim.verdict.name(), claim.sentence))
}

/// Returns the bound in words.
fn bound(claim: &Claim) -> String {
    let Threshold { side, bound, .. } = claim.threshold;
    let side = match side {
        Side::AtMost => "at most",
        Side::AtLeast => "at least",
    };
    format!("{side} {}", number::plain(bound, 1))
}

/// Returns value and error of a figure, rounded for tables.
fn shown(figure: &Figure) -> [String; 2] {
    match figure.origin {
        Origin::Counted => [format!("{}", figure.value), String::new()],
        Origin::Quadrature => [
            number::plain(figure.value, 5),
            number::plain(figure.error, 1),
        ],
        Origin::Sampled | Origin::Timed => {
            let text = number::with_error(figure.value, figure.error);
            match text.split_once(" ± ") {
                Some((value, error)) if !value.starts_with('(') => {
                    [value.to_owned(), error.to_owned()]
                }
                _ => [
                    number::plain(figure.value, 4),
                    number::plain(figure.error, 1),
                ],
            }
        }
    }
}

fn summary(of: &Claims) -> Table {
    let mut table = Table::new("The paper's claims")
        .texts(["claim", "source", "threshold"])
        .numbers(["everywhere", "within limits"])
        .texts(["limits", "verdict"]);
    for claim in &of.claims {
        let of_role = |role: Role| {
            let [value, error] = claim
                .figures
                .iter()
                .find(|figure| figure.role == role)
                .map(shown)
                .unwrap_or_default();
            format!("{value} ± {error}")
        };
        let [everywhere, within] = [Role::Everywhere, Role::WithinLimits].map(of_role);
        let [id, source, limits, verdict] = [
            claim.id,
            claim.source,
            claim.threshold.limits,
            claim.verdict.name(),
        ]
        .map(str::to_owned);
        table.push([
            id,
            source,
            bound(claim),
            everywhere,
            within,
            limits,
            verdict,
        ]);
    }
    table.note(format!(
        "{} cells of the parameter grid, seed {}. Errors: standard errors of what is sampled, bound estimates of what is \
         integrated. {}",
        of.settings.cells,
        of.settings.seed,
        of.machine.summary()
    ))
}
