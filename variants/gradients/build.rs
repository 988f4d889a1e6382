//! Prints the derivatives of every model of the list as Rust over lanes.
//!
//! Each model is traced, its graph is differentiated, and each operation of the result becomes a line. Levels that fuse have a
//! graph of their own.

use core::fmt::Write as _;
use hairis::simd::trace::Op;
use hairis_shaders::{Call, Function, Kind, Program, Target};
use hairis_variants::{ModelId, Registered, Visitor};
use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::Path;

/// Numbers of an evaluation: red, green, blue, and the density.
const RESULTS: usize = 4;
/// Numbers of a hit and a direction: `wo`, `h`, `wi`.
const ARGUMENTS: usize = 7;
/// Lints take minutes for a hundred thousand generated lines, and find nothing that somebody could mend.
const LINTED: &str = "#[cfg(not(clippy))]";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let mut source = Source::default();
    for id in ModelId::ALL {
        id.visit(Print(*id, &mut source));
    }
    let dir = env::var("OUT_DIR").expect("cargo names a folder");
    let path = Path::new(&dir).join("models.rs");
    fs::write(path, source.text).expect("cargo's folder is written to");
}

/// Printed text, and the bodies so far: models that differ in their sampler share that of the value.
#[derive(Default)]
struct Source {
    text: String,
    bodies: Vec<String>,
}

/// Prints the derivatives of a model.
struct Print<'a>(ModelId, &'a mut Source);

impl Visitor for Print<'_> {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Self(id, source) = self;
        let [exact, fused] = [Target::Exact, Target::Fused].map(Program::of::<M>);
        let names: Vec<String> = exact.material().places().collect();
        let mut module = format!(
            "pub(crate) mod {id:?} {{\nuse super::*;\npub(crate) const MATERIAL: &[&str] = &{names:?};\n"
        );
        for (call, fields) in [("Value", &["value"][..]), ("ValuePdf", &["value", "pdf"])] {
            let [exact, fused] = [&exact, &fused].map(|program| {
                let eval = program.function(Call::EvalHit).only(fields);
                eval.expect("fields of an evaluation").gradient()
            });
            let results: usize = if call == "Value" { 3 } else { RESULTS };
            let read = read(&[&exact, &fused], names.len());
            let body = format!(
                "if const {{ L::FUSES }} {{\n{}}} else {{\n{}}}",
                body(&fused, results, names.len(), &read),
                body(&exact, results, names.len(), &read),
            );
            let place = source.bodies.iter().position(|known| *known == body);
            let place = place.unwrap_or_else(|| {
                let place = source.bodies.len();
                let (n, r) = (read.len(), RESULTS + read.len() + ARGUMENTS);
                let has_pdf = call == "ValuePdf";
                let _ = writeln!(
                    source.text,
                    "#[derive(Debug)]\npub(crate) enum Body{place} {{}}\nimpl Body{place} {{\n\
                     pub(crate) const N: usize = {n};\npub(crate) const R: usize = {r};\n}}\n\
                     impl Rows<{n}, {r}> for Body{place} {{\nconst HAS_PDF: bool = {has_pdf};\n#[inline(always)]\n\
                     fn rows<L: Lanes<Stored = f32x8>>(m: &[f32; {n}], v: &[f32x8; INPUTS], out: &mut [f32x8; {r}]) \
                     {{\n{LINTED}\n{{\n{body}\n}}\n}}\n}}"
                );
                source.bodies.push(body);
                place
            });
            let _ = writeln!(
                module,
                "pub(crate) type {call} = Body{place};\npub(crate) const {}: &[usize] = &{read:?};",
                if call == "Value" {
                    "VALUE"
                } else {
                    "VALUE_PDF"
                }
            );
        }
        module.push_str(&parameters(&exact));
        source.text.push_str(&module);
        source.text.push_str("}\n");
    }
}

/// The derivatives by parameters of the weighted sum of a material's numbers, in one lane.
fn parameters(program: &Program) -> String {
    let gradient = program.function(Call::Material).gradient();
    let fields = gradient.output().fields[program.material().fields.len()..].iter();
    let fields: Vec<_> = fields.map(|field| field.name.as_str()).collect();
    let gradient = gradient.only(&fields).expect("fields of the result");
    let (numbers, count) = (program.material().len(), gradient.results().len());
    let read: Vec<usize> = (0..count).collect();
    let inputs = Inputs {
        numbers: count,
        read: &read,
    };
    let mut out = format!(
        "pub(crate) const PARAMETERS: usize = {count};\npub(crate) fn by_parameters(m: &[f32; {count}], v: &[f32; {numbers}]) \
         -> [f32; {count}] {{\n#[cfg(clippy)]\nreturn [0.0; {count}];\n{LINTED}\n{{\ntype L = f32;\n"
    );
    for place in gradient.schedule() {
        let operation = operation(&gradient, place, &inputs);
        let _ = writeln!(out, "let x{place} = {operation};");
    }
    let rows = gradient.results().iter();
    let rows: Vec<_> = rows.map(|row| operand(&gradient, *row, &inputs)).collect();
    let _ = writeln!(out, "return [{}];\n}};\n}}", rows.join(", "));
    out
}

/// Places of the numbers of a material that any of the functions reads.
fn read(functions: &[&Function], numbers: usize) -> Vec<usize> {
    let nodes = functions
        .iter()
        .flat_map(|function| function.graph().nodes());
    let read: BTreeSet<usize> = nodes
        .filter_map(|node| match node.kind {
            Kind::Input(place) if (place as usize) < numbers => Some(place as usize),
            _ => None,
        })
        .collect();
    read.into_iter().collect()
}

/// Statements of a derivative: rows of the results, of the numbers of a material that are read, and of the arguments.
fn body(gradient: &Function, results: usize, numbers: usize, read: &[usize]) -> String {
    let inputs = Inputs { numbers, read };
    let row = |place: usize| {
        let Some(derivative) = place.checked_sub(results) else {
            return Some(place);
        };
        match derivative.checked_sub(numbers) {
            Some(argument) => Some(RESULTS + read.len() + argument),
            None => read
                .binary_search(&derivative)
                .ok()
                .map(|place| RESULTS + place),
        }
    };
    let rows = gradient.results().iter().copied().zip(0..);
    let rows: Vec<(u32, usize)> = rows
        .filter_map(|(result, place)| Some((result, row(place)?)))
        .collect();
    let mut out = String::new();
    let mut store = |text: &str| {
        out.push_str(text);
        out.push('\n');
    };
    for place in gradient.schedule() {
        store(&format!(
            "let x{place} = {};",
            operation(gradient, place, &inputs)
        ));
        for (_, row) in rows.iter().filter(|(result, _)| *result == place) {
            store(&format!("out[{row}] = x{place}.store();"));
        }
    }
    for (result, row) in &rows {
        if !gradient.graph().node(*result).is_computed() {
            let value = operand(gradient, *result, &inputs);
            store(&format!("out[{row}] = {value}.store();"));
        }
    }
    for row in results..RESULTS {
        store(&format!("out[{row}] = L::splat(0.0).store();"));
    }
    out
}

/// Numbers of a material, and those of them that are read.
struct Inputs<'a> {
    numbers: usize,
    read: &'a [usize],
}

/// An operand: a name, or a constant.
fn operand(function: &Function, place: u32, inputs: &Inputs<'_>) -> String {
    let graph = function.graph();
    match graph.node(place).kind {
        Kind::Input(input) => match (input as usize).checked_sub(inputs.numbers) {
            Some(place) => format!("L::load(&v[{place}])"),
            None => {
                let place = inputs.read.binary_search(&(input as usize));
                format!("L::splat(m[{}])", place.expect("a number that is read"))
            }
        },
        Kind::Mask(mask) => {
            let [low, high] = if mask { [0, 1] } else { [1, 0] };
            format!("L::splat({low}.0).lt(L::splat({high}.0))")
        }
        Kind::Op(_) => match graph.number(place) {
            Some(x) => format!("L::splat(f32::from_bits(0x{:08x}))", x.to_bits()),
            None => format!("x{place}"),
        },
    }
}

/// An operation, as [`hairis::simd::Lanes`] has it.
fn operation(function: &Function, place: u32, inputs: &Inputs<'_>) -> String {
    let node = function.graph().node(place);
    let Kind::Op(op) = node.kind else {
        unreachable!("what is scheduled is computed")
    };
    let template = match op {
        Op::Add => "$a + $b",
        Op::Sub => "$a - $b",
        Op::Mul => "$a * $b",
        Op::Div => "$a / $b",
        Op::Neg => "-$a",
        Op::MulAdd => "$a.mul_add($b, $c)",
        Op::Sqrt => "$a.sqrt()",
        Op::Abs => "$a.abs()",
        Op::Min => "$a.min($b)",
        Op::Max => "$a.max($b)",
        Op::TimesSign => "$a.times_sign($b)",
        Op::NegateIf => "L::negate($a, $b)",
        Op::ShiftLeft23 => "$a.bits_shl_23()",
        Op::Mantissa => "$a.split_exponent().0",
        Op::Exponent => "$a.split_exponent().1",
        Op::Upper => "upper($a)",
        Op::Less => "$a.lt($b)",
        Op::And => "L::and($a, $b)",
        Op::Or => "L::or($a, $b)",
        Op::Select => "L::select($a, $b, $c)",
        // Constants are operands, powers are of targets that have them, and the rest is of samplers.
        Op::Constant(_) | Op::Exp2 | Op::Log2 | Op::AtLeast | Op::Not => {
            panic!("no line is printed for {op:?}, which no evaluation of the list has had")
        }
    };
    let mut text = template.to_owned();
    for (name, place) in ["$a", "$b", "$c"].iter().zip(node.operands()) {
        text = text.replace(name, &operand(function, *place, inputs));
    }
    text
}
