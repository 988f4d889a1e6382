//! Conversion of cases to code.

use super::case::{Case, Choice, Row};
use crate::probe::Direction;
use core::fmt::Write;
use hairis::{Hit, Lobe, LobeMask};

/// Returns a number as code that has its exact bits.
fn number(x: f32) -> String {
    if x.is_finite() {
        format!("{x:?}")
    } else if x.is_nan() {
        format!("f32::from_bits({:#x})", x.to_bits())
    } else {
        let name = if x > 0.0 { "INFINITY" } else { "NEG_INFINITY" };
        format!("f32::{name}")
    }
}

fn three(x: [f32; 3]) -> String {
    x.map(number).join(", ")
}

fn vector(v: Direction) -> String {
    format!("Vec3::new({})", three(v.to_array()))
}

fn hit(hit: &Hit) -> String {
    let (wo, h) = (vector(hit.wo.into()), number(hit.h));
    if Hit::new(hit.wo, hit.h).h.to_bits() == hit.h.to_bits() {
        format!("Hit::new({wo}, {h})")
    } else {
        format!("Hit {{ wo: {wo}.into(), h: {h} }}")
    }
}

fn row(row: &Row<Choice>) -> String {
    let Row {
        material,
        hit: at,
        wi,
        xi,
        tolerances,
    } = row;
    let fields = [
        format!("material: {}", material.code()),
        format!("hit: {}", hit(at)),
        format!("wi: {}", vector(*wi)),
        format!("xi: [{}]", three(*xi)),
        format!("tolerances: {tolerances}"),
    ];
    format!("Row {{\n        {},\n    }}", fields.join(",\n        "))
}

/// Writes a block whose value is the outcome of the property for the case; `subject` is the subject of the test.
pub(super) fn write(case: &Case<Choice>, path: &str) -> String {
    let rows = case.rows.each_ref().map(row);
    let count = |row: &String| rows.iter().filter(|other| *other == row).count();
    // The first of the most frequent rows.
    let (common, _) = rows.iter().fold((&rows[0], 0), |best, row| {
        if count(row) > best.1 {
            (row, count(row))
        } else {
            best
        }
    });
    let mut body = format!("    let mut case = Case::new(|| {common});\n");
    let changed = |body: &mut String, field: &str, value: &str| {
        let _ = writeln!(body, "    case.{field} = {value};");
    };
    for (lane, row) in rows.iter().enumerate().filter(|(_, row)| *row != common) {
        changed(&mut body, &format!("rows[{lane}]"), row);
    }
    if case.lobes != LobeMask::ALL {
        let lobes = Lobe::ALL
            .into_iter()
            .filter(|lobe| case.lobes.contains(*lobe));
        let slots: Vec<_> = lobes
            .map(|lobe| format!("Lobe::slot({})", lobe.index()))
            .collect();
        changed(
            &mut body,
            "lobes",
            &format!("LobeMask::of(&[{}])", slots.join(", ")),
        );
    }
    if case.order != [0, 1, 2, 3, 4, 5, 6, 7] {
        changed(&mut body, "order", &format!("{:?}", case.order));
    }
    if !body.contains("    case.") {
        body = body.replace("let mut case", "let case");
    }
    let names = ["Hit", "Lobe", "LobeMask"].into_iter();
    let names: Vec<_> = names
        .filter(|name| body.contains(&format!("{name}::")) || body.contains(&format!("{name} {{")))
        .collect();
    let names = match &names[..] {
        [name] => (*name).to_owned(),
        names => format!("{{{}}}", names.join(", ")),
    };
    let module = path.split("::").next().unwrap_or(path);
    format!(
        "{{\n    use glam::Vec3;\n    use hairis::{names};\n    \
         use hairis_conformance::{{Case, Replay, Row, {module}}};\n{body}    \
         {path}(&Replay::pasted(&subject, case))\n}}\n"
    )
}
