//! The claims as tables: one each, then all of them with their verdicts.

use super::Claims;
use super::claim::{Claim, Figure, Origin, Role, Side};
use crate::table::{Table, number};

/// The tables.
#[must_use]
pub fn tables(of: &Claims) -> Vec<Table> {
    of.claims.iter().map(of_claim).chain([summary(of)]).collect()
}

fn of_claim(claim: &Claim) -> Table {
    let title = format!("{}: \"{}\" ({})", claim.id, claim.quotation, claim.source);
    let mut table = Table::new(title).text("figure").numbers(["value", "error"]).texts(["unit", "from"]);
    for figure in &claim.figures {
        let mark = match figure.role {
            Role::Everywhere => " [1]",
            Role::WithinLimits => " [2]",
            Role::Further => "",
        };
        let [value, error] = shown(figure);
        table.push([
            format!("{}{mark}", figure.name),
            value,
            error,
            figure.unit.to_owned(),
            figure.origin.name().to_owned(),
        ]);
    }
    table.note(threshold(claim)).note(format!("{}: {}", claim.verdict.name(), claim.sentence))
}

/// The threshold in words.
fn threshold(claim: &Claim) -> String {
    let of = &claim.threshold;
    format!(
        "Holds if [1] keeps the threshold, within limits ({}) if [2] does: {}, {} {}.",
        of.limits,
        of.of,
        side(of.side),
        number::plain(of.bound, 1),
    )
}

const fn side(of: Side) -> &'static str {
    match of {
        Side::AtMost => "at most",
        Side::AtLeast => "at least",
    }
}

/// Value and error.
fn shown(figure: &Figure) -> [String; 2] {
    match figure.origin {
        Origin::Counted => [format!("{}", figure.value), String::new()],
        Origin::Quadrature => [number::plain(figure.value, 5), number::plain(figure.error, 1)],
        Origin::Sampled | Origin::Timed => {
            let text = number::with_error(figure.value, figure.error);
            match text.split_once(" ± ") {
                Some((value, error)) if !value.starts_with('(') => [value.to_owned(), error.to_owned()],
                _ => [number::plain(figure.value, 4), number::plain(figure.error, 1)],
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
            let [value, error] = claim.figures.iter().find(|figure| figure.role == role).map(shown).unwrap_or_default();
            format!("{value} ± {error}")
        };
        let threshold = format!("{} {}", side(claim.threshold.side), number::plain(claim.threshold.bound, 1));
        table.push([
            claim.id.clone(),
            claim.source.to_owned(),
            threshold,
            of_role(Role::Everywhere),
            of_role(Role::WithinLimits),
            claim.threshold.limits.to_owned(),
            claim.verdict.name().to_owned(),
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
