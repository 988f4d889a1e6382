//! Prints the derivatives of every model of the list as Rust over lanes.
//!
//! Each model is traced, its graph is differentiated, and each operation of the result becomes a line. Levels that fuse have a graph of
//! their own. Each model has a file, and the library includes the files of the models in its list.

mod chunks;

use chunks::Chunks;
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
/// Numbers that are read for each hit: the arguments, and a weight per result. A packet keeps them first.
const INPUTS: usize = ARGUMENTS + RESULTS;
/// Numbers that are written for each hit: the results, and a derivative per argument. A packet keeps them second.
const OUTPUTS: usize = RESULTS + ARGUMENTS;
/// Lints take minutes for a hundred thousand generated lines, and report nothing that could be fixed by hand.
const LINTED: &str = "#[cfg(not(clippy))]";

fn main() {
    println!("cargo::rerun-if-changed=build");
    let dir = env::var("OUT_DIR").expect("cargo names a folder");
    let mut bodies = Vec::new();
    for id in ModelId::ALL {
        let text = id.visit(Print(*id, &mut bodies));
        let path = Path::new(&dir).join(format!("{id:?}.rs"));
        fs::write(path, text).expect("cargo's folder is written to");
    }
}

/// Printer of the derivatives of a model. Models that differ only in their sampler share the body for the value with the models printed
/// so far.
struct Print<'a>(ModelId, &'a mut Vec<String>);

impl Visitor for Print<'_> {
    type Output = String;

    fn visit<M: Registered>(self) -> String {
        let Self(id, bodies) = self;
        let mut text = String::new();
        let [exact, fused] = [Target::Exact, Target::Fused].map(Program::of::<M>);
        let names: Vec<String> = exact.material().places().collect();
        let mut module = format!(
            "pub(crate) mod {id:?} {{\nuse super::*;\npub(crate) const MATERIAL: &[&str] = &{names:?};\n"
        );
        for (call, fields) in [("Value", &["value"][..]), ("ValuePdf", &["value", "pdf"])] {
            let [exact, fused] = [&exact, &fused].map(|program| {
                let eval = program.function(Call::EvalHit).only(fields);
                eval.expect("fields of an evaluation")
            });
            let (exact, fused) = (exact.gradient(), fused.fused_gradient());
            let results: usize = if call == "Value" { 3 } else { RESULTS };
            let read = read(&[&exact, &fused], names.len());
            let mut slots = Slots::default();
            let inputs = Inputs {
                numbers: names.len(),
                read: &read,
            };
            let [(fused, kept), (exact, also_kept)] =
                [&fused, &exact].map(|gradient| loops(gradient, results, &inputs, &mut slots));
            let kept = kept.max(also_kept);
            let body = body(&fused, &exact);
            let place = bodies.iter().position(|known| *known == body);
            let place = place.unwrap_or_else(|| {
                let place = bodies.len();
                let (n, s) = (read.len(), slots.kinds.len());
                let numbers = slots.text();
                let _ = writeln!(
                    text,
                    "#[derive(Debug)]\npub(crate) enum Body{place} {{}}\nimpl Body{place} {{\n\
                     pub(crate) const S: usize = {s};\npub(crate) const N: usize = {n};\npub(crate) const K: usize = {kept};\n}}\n\
                     impl Rows<{s}, {n}, {kept}> for Body{place} {{\n\
                     const SLOTS: &[Slot; {s}] = &[{numbers}];\n#[inline(always)]\n\
                     fn rows<L: Lanes<Stored = f32x8>>(c: &[f32x8; {s}], packets: &mut [[f32x8; {kept}]], sums: &mut [f32x8; {n}], \
                     finite: &mut f32x8) {{\n{LINTED}\n{{\n\
                     type C = [f32x8; {s}];\ntype P = [[f32x8; {kept}]];\ntype S = [f32x8; {n}];\n{body}}}\n}}\n}}"
                );
                bodies.push(body);
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
        text + &module + "}\n"
    }
}

/// Prints the derivatives by parameters of the weighted sum of a material's numbers, in one lane.
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
    let mut slots = Slots {
        is_one_lane: true,
        ..Slots::default()
    };
    let lines = statements(
        &gradient,
        &gradient.schedule(),
        gradient.results(),
        |place| operation(&gradient, place, &inputs, &mut slots) + ";",
    );
    let rows = gradient.results().iter();
    let rows: Vec<_> = rows
        .map(|row| operand(&gradient, *row, &inputs, &mut slots))
        .collect();
    format!(
        "pub(crate) const PARAMETERS: usize = {count};\npub(crate) fn by_parameters(m: &[f32; {count}], v: &[f32; {numbers}]) \
         -> [f32; {count}] {{\n#[cfg(clippy)]\nreturn [0.0; {count}];\n{LINTED}\n{{\ntype L = f32;\n\
         {lines}return [{}];\n}};\n}}\n",
        rows.join(", "),
    )
}

/// Returns the places of the numbers of a material that at least one of the functions reads.
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

/// Prints the loops of both graphs, each as a function that is inlined, and their calls. Compilers check one function of ten thousand
/// operations three times as long.
fn body(fused: &[String], exact: &[String]) -> String {
    let mut out = String::new();
    let [fused, exact] = [("fused", fused), ("exact", exact)].map(|(name, loops)| {
        let mut calls = String::new();
        for (number, text) in loops.iter().enumerate() {
            let _ = writeln!(
                out,
                "#[inline(always)]\nfn {name}{number}<L: Lanes<Stored = f32x8>>(c: &C, packets: &mut P, sums: &mut S, finite: &mut f32x8) \
                 {{\n{text}}}"
            );
            let _ = writeln!(calls, "{name}{number}::<L>(c, packets, sums, finite);");
        }
        calls
    });
    let _ = writeln!(
        out,
        "if const {{ L::FUSES.expect(\"lanes that compute\") }} {{\n{fused}}} else {{\n{exact}}}"
    );
    out
}

/// Returns the loops of a derivative, and the count of the numbers that a packet keeps: its inputs, its outputs, and the results that a
/// later chunk reads. Each chunk is a loop over packets, whose operations do not wait for those of another packet, so that a CPU works on
/// two of them at once. The sums of derivatives by the material grow from packet to packet.
fn loops(
    gradient: &Function,
    results: usize,
    inputs: &Inputs<'_>,
    slots: &mut Slots,
) -> (Vec<String>, usize) {
    let graph = gradient.graph();
    let rows = gradient.results().iter();
    let rows: Vec<u32> = rows.map(|row| unchecked(gradient, *row)).collect();
    let (values, derivatives) = rows.split_at(results);
    let (by_material, by_hit) = derivatives.split_at(inputs.numbers);
    let by_hit = &by_hit[..ARGUMENTS];
    let sums = by_material
        .iter()
        .zip(0_usize..)
        .filter_map(|(row, place)| {
            let place = inputs.read.binary_search(&place).ok()?;
            Some((
                *row,
                format!("sums[{place}] = (at::<L, _>(sums, {place}) + $x).store();\n"),
            ))
        });
    let outputs = values.iter().zip(INPUTS..);
    let outputs = outputs.chain(by_hit.iter().zip(INPUTS + RESULTS..));
    let outputs = outputs.map(|(row, place)| (*row, format!("k[{place}] = $x.store();\n")));
    // Uses of rows: at once, or at the end for rows that no operation computes.
    let uses: Vec<(u32, String)> = sums.chain(outputs).collect();
    let mut chunks = Chunks::new(graph, &rows, INPUTS + OUTPUTS);
    let mut out = Vec::new();
    while let Some(places) = chunks.next_chunk() {
        let mut text = String::new();
        for place in places {
            for (operand, slot) in chunks.loaded(place) {
                let kept = format!("at::<L, _>(k, {slot})");
                let kept = if graph.node(operand).is_mask() {
                    format!("L::splat(0.0).lt({kept})")
                } else {
                    kept
                };
                let _ = writeln!(text, "let x{operand} = {kept};");
            }
            let operation = operation(gradient, place, inputs, slots);
            let _ = writeln!(text, "let x{place} = {operation};");
            for (_, line) in uses.iter().filter(|(row, _)| *row == place) {
                text += &line.replace("$x", &format!("x{place}"));
            }
            if by_hit.contains(&place) {
                let _ = writeln!(text, "check = x{place}.mul_add(L::splat(0.0), check);");
            }
            if let Some(slot) = chunks.kept(place) {
                let kept = if graph.node(place).is_mask() {
                    format!("L::select(x{place}, L::splat(1.0), L::splat(0.0))")
                } else {
                    format!("x{place}")
                };
                let _ = writeln!(text, "k[{slot}] = {kept}.store();");
            }
        }
        if text.contains("check = ") {
            text = format!(
                "let mut check = L::load(finite);\nfor k in packets.iter_mut() {{\n{text}}}\n*finite = check.store();\n"
            );
        } else {
            text = format!("for k in packets.iter_mut() {{\n{text}}}\n");
        }
        out.push(text);
    }
    let mut last = String::from("for k in packets.iter_mut() {\n");
    for (row, line) in &uses {
        if !graph.node(*row).is_computed() {
            last += &line.replace("$x", &operand(gradient, *row, inputs, slots));
        }
    }
    for place in results..RESULTS {
        let _ = writeln!(last, "k[{}] = L::splat(0.0).store();", INPUTS + place);
    }
    out.push(last + "}\n");
    (out, chunks.len())
}

/// Prints the statements in groups. In a debugger, the scope of each name is nested in the scope of the name before. Compilers support a
/// thousand nested scopes, but not ten thousand.
fn statements(
    function: &Function,
    order: &[u32],
    returned: &[u32],
    mut operation: impl FnMut(u32) -> String,
) -> String {
    const GROUP: usize = 64;
    let mut last = vec![0; function.graph().nodes().len()];
    for (group, places) in order.chunks(GROUP).enumerate() {
        for place in places {
            for operand in function.graph().node(*place).operands() {
                last[*operand as usize] = group;
            }
        }
    }
    for place in returned {
        last[*place as usize] = order.len();
    }
    let mut out = String::new();
    for (group, places) in order.chunks(GROUP).enumerate() {
        let kept = places.iter().filter(|place| last[**place as usize] > group);
        let kept: String = kept.map(|place| format!("x{place},")).collect();
        let _ = writeln!(out, "let ({kept}) = {{");
        for place in places {
            let _ = writeln!(out, "let x{place} = {}", operation(*place));
        }
        let _ = writeln!(out, "({kept})\n}};");
    }
    out
}

/// Returns the derivative itself for a row that replaces a derivative that is not finite by 0, because callers check it.
fn unchecked(gradient: &Function, row: u32) -> u32 {
    let graph = gradient.graph();
    let node = graph.node(row);
    if node.kind == Kind::Op(Op::Select)
        && let [mask, yes, no] = *node.operands()
        && graph.number(no).map(f32::to_bits) == Some(0)
        && graph.node(mask).kind == Kind::Op(Op::Less)
        && let [magnitude, infinity] = *graph.node(mask).operands()
        && graph.number(infinity) == Some(f32::INFINITY)
        && graph.node(magnitude).kind == Kind::Op(Op::Abs)
        && graph.node(magnitude).operands() == [yes]
    {
        return yes;
    }
    row
}

/// Numbers that all lanes share, from a material or constant, which are operands in memory.
#[derive(Default)]
struct Slots {
    kinds: Vec<Kind>,
    /// True for one lane, in which no numbers are shared.
    is_one_lane: bool,
}

impl Slots {
    fn load(&mut self, kind: Kind) -> String {
        match kind {
            Kind::Input(place) if self.is_one_lane => return format!("m[{place}]"),
            Kind::Op(Op::Constant(bits)) if self.is_one_lane => {
                return format!("f32::from_bits(0x{bits:08x})");
            }
            _ => {}
        }
        let place = self
            .kinds
            .iter()
            .position(|known| *known == kind)
            .unwrap_or_else(|| {
                self.kinds.push(kind);
                self.kinds.len() - 1
            });
        format!("at::<L, _>(c, {place})")
    }

    /// Returns the expression that reads an argument of a hit.
    fn argument(&self, place: usize) -> String {
        if self.is_one_lane {
            format!("v[{place}]")
        } else {
            format!("at::<L, _>(k, {place})")
        }
    }

    fn text(&self) -> String {
        let slots = self.kinds.iter().map(|kind| match kind {
            Kind::Input(place) => format!("Slot::Number({place}),"),
            Kind::Op(Op::Constant(bits)) => format!("Slot::Constant(0x{bits:08x}),"),
            _ => unreachable!("no number"),
        });
        slots.collect()
    }
}

/// Count of the numbers of a material, and the places of those that are read.
struct Inputs<'a> {
    numbers: usize,
    read: &'a [usize],
}

/// Returns the expression of an operand: a name, or a constant.
fn operand(function: &Function, place: u32, inputs: &Inputs<'_>, slots: &mut Slots) -> String {
    let graph = function.graph();
    match graph.node(place).kind {
        Kind::Input(input) => match (input as usize).checked_sub(inputs.numbers) {
            Some(place) => slots.argument(place),
            None => slots.load(graph.node(place).kind),
        },
        Kind::Mask(mask) => {
            let [low, high] = if mask { [0, 1] } else { [1, 0] };
            format!("L::splat({low}.0).lt(L::splat({high}.0))")
        }
        Kind::Op(_) => match graph.number(place) {
            Some(0.0) => format!("L::splat({:?})", graph.number(place).expect("a constant")),
            Some(_) => slots.load(graph.node(place).kind),
            None => format!("x{place}"),
        },
    }
}

/// Returns the expression of an operation in terms of the methods of [`hairis::simd::Lanes`].
fn operation(function: &Function, place: u32, inputs: &Inputs<'_>, slots: &mut Slots) -> String {
    let node = function.graph().node(place);
    let Kind::Op(op) = node.kind else {
        unreachable!("what is scheduled is computed")
    };
    let template = match op {
        Op::Add => "$a + $b",
        Op::Sub => "$a - $b",
        Op::Mul => "$a * $b",
        Op::Div => "L::quotient($a, $b)",
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
        // Constants are operands, exponentials belong to targets that have them, and the remaining operations to samplers.
        Op::Constant(_) | Op::Exp2 | Op::Log2 | Op::AtLeast | Op::Not => {
            panic!("no line is printed for {op:?}, which no evaluation of the list has had")
        }
    };
    let mut text = template.to_owned();
    for (name, place) in ["$a", "$b", "$c"].iter().zip(node.operands()) {
        text = text.replace(name, &operand(function, *place, inputs, slots));
    }
    text
}
