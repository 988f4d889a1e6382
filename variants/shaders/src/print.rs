//! Source text of a program in other languages: one visitor for all, and a table of operations per language.

mod driver;
mod operations;
mod python;
mod syntax;

use crate::call::purpose;
use crate::function::{Argument, Function};
use crate::graph::{Kind, Origin};
use crate::program::Program;
use crate::record::{Field, Record, Shape};
use core::fmt::Write as _;
pub use driver::driver;
use hairis::simd::trace::{Op, Target};
use operations::{Form, template, write_template};
use std::collections::HashSet;
use syntax::head;

/// Language in which programs are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// C99, C++, CUDA and `OpenCL` C, in one header.
    C,
    /// WGSL, the shading language of WebGPU.
    Wgsl,
    /// GLSL from version 4.00 or 3.20 ES.
    Glsl,
    /// HLSL from shader model 5.
    Hlsl,
    /// Metal shading language.
    Msl,
    /// Slang, whose compiler differentiates the functions.
    Slang,
    /// Python over arrays of `NumPy`, JAX, `PyTorch` or Dr.Jit.
    Python,
}

impl Language {
    /// Every language in which programs are printed.
    pub const ALL: [Self; 7] = [
        Self::C,
        Self::Wgsl,
        Self::Glsl,
        Self::Hlsl,
        Self::Msl,
        Self::Slang,
        Self::Python,
    ];

    /// Returns true if compilers may reassociate sums, and the language has no keyword that forbids it.
    const fn takes_sums_apart(self) -> bool {
        matches!(self, Self::Wgsl | Self::Msl | Self::Slang | Self::Python)
    }

    /// Returns the type of a form of field, and the text that follows the field's name.
    fn shape(self, shape: Shape) -> (String, String) {
        match (self, shape) {
            (Self::Wgsl, Shape::Number) => ("f32".to_owned(), String::new()),
            (Self::Wgsl, Shape::Array(len)) => (format!("array<f32, {len}>"), String::new()),
            (Self::Python, Shape::Number) => ("Array".to_owned(), String::new()),
            (Self::Python, Shape::Array(_)) => (self.vector().to_owned(), String::new()),
            (_, Shape::Number) => ("float".to_owned(), String::new()),
            (_, Shape::Array(len)) => ("float".to_owned(), format!("[{len}]")),
            (_, Shape::Vector) => (self.vector().to_owned(), String::new()),
        }
    }

    const fn vector(self) -> &'static str {
        match self {
            Self::C => "HairisVec3",
            Self::Wgsl => "vec3<f32>",
            Self::Glsl => "vec3",
            Self::Hlsl | Self::Msl | Self::Slang => "float3",
            Self::Python => "Vector",
        }
    }

    /// Returns the beginning of a declaration of a number or a mask that is not assigned again.
    fn binding(self, is_mask: bool) -> &'static str {
        match (self, is_mask) {
            (Self::Wgsl, _) => "let",
            (Self::C, true) => "const int",
            (Self::C | Self::Msl, false) => "const float",
            (Self::Msl, true) => "const bool",
            // Compilers keep the order of arithmetic whose results are declared precise.
            (Self::Glsl | Self::Hlsl, false) => "precise float",
            // Slang passes the word on to WGSL, Metal and CUDA, which lack it, so that a macro is the word or empty.
            (Self::Slang, false) => "HAIRIS_PRECISE float",
            (Self::Glsl | Self::Hlsl | Self::Slang, true) => "bool",
            (Self::Python, _) => "",
        }
    }

    /// Returns a number as a literal that every compiler reads as exactly this float. Infinity and NaN have no literal in any language,
    /// so that a helper makes them from their bits, or Python's `math` has their names.
    fn literal(self, x: f32, prefix: &str) -> String {
        if !x.is_finite() && self == Self::Python {
            return format!("{x}").to_lowercase();
        }
        if !x.is_finite() {
            return format!("{prefix}number(0x{:08x}u)", x.to_bits());
        }
        let short = format!("{x:?}");
        let is_exact = short.parse::<f64>() == Ok(f64::from(x));
        if self == Self::Python {
            // Its numbers are double, and double keeps nine digits apart.
            if is_exact { short } else { format!("{x:.8e}") }
        } else if is_exact && !short.contains('e') {
            format!("{short}f")
        } else if self == Self::Wgsl {
            // WGSL rejects decimal literals above the largest float, even if they round to it.
            hexadecimal(x)
        } else {
            // Fewer than nine digits could be rounded twice.
            format!("{x:.8e}f")
        }
    }
}

/// Returns a hexadecimal literal of a finite number.
fn hexadecimal(x: f32) -> String {
    let (sign, bits) = (if x < 0.0 { "-" } else { "" }, x.abs().to_bits());
    if bits >> 23 == 0 {
        return format!("{sign}0x{:x}p-149f", bits);
    }
    let fraction = format!("{:06x}", (bits & 0x7f_ffff) << 1);
    let fraction = fraction.trim_end_matches('0');
    let dot = if fraction.is_empty() { "" } else { "." };
    let exponent = i64::from(bits >> 23) - 127;
    format!("{sign}0x1{dot}{fraction}p{exponent:+}f")
}

/// Returns the beginning of all names of the model: `hairis_gaussian_`.
fn prefix(program: &Program) -> String {
    format!("hairis_{}_", program.name())
}

/// Returns the name of the type of a record: `HairisGaussianMaterial`.
fn type_name(program: &Program, record: &Record) -> String {
    capitals(&format!("hairis_{}_{}", program.name(), record.name))
}

/// Returns a name of words as a name of a type: `KajiyaKay`.
fn capitals(name: &str) -> String {
    let capital = |word: &str| {
        let (first, rest) = word.split_at(word.len().min(1));
        first.to_uppercase() + rest
    };
    name.split('_').map(capital).collect()
}

/// Prints a program as source text: its types, materials and functions, which need no other file.
///
/// # Panics
///
/// Panics for Python if the program was traced for [`Target::Fused`], because array frameworks have no operation that rounds once.
#[must_use]
pub fn print(program: &Program, language: Language) -> String {
    if language == Language::Python {
        assert_ne!(
            program.target(),
            Target::Fused,
            "array frameworks have no fma that rounds once"
        );
        return python::print(program);
    }
    let mut out = head(program, language);
    each(program, |function, records| {
        for record in records {
            declare(&mut out, program, language, record);
        }
        Body::new(program, language, function).print(&mut out);
    });
    if language == Language::C {
        out.push_str("#endif\n");
    }
    out
}

/// Visits the functions in the order of their text, each with the records that no function before it has.
fn each<'a>(program: &'a Program, mut visit: impl FnMut(&'a Function, Vec<&'a Record>)) {
    let mut known = Vec::new();
    let constants = program.presets().iter().chain(program.materials());
    for function in constants.chain(program.functions()) {
        let records = (function.arguments().iter()).filter_map(|argument| match argument {
            Argument::Record(_, record) => Some(record),
            Argument::Field(_) => None,
        });
        let mut new = Vec::new();
        for record in records.chain([function.output()]) {
            if !known.contains(&record) {
                known.push(record);
                new.push(record);
            }
        }
        visit(function, new);
    }
}

fn declare(out: &mut String, program: &Program, language: Language, record: &Record) {
    let name = type_name(program, record);
    if record
        .fields
        .iter()
        .all(|field| field.shape != Shape::Vector)
    {
        let numbers = record.len();
        out.push_str(&format!("// {numbers} floats in a row.\n"));
    }
    let (open, close) = match language {
        Language::C => (format!("typedef struct {name} {{"), format!("}} {name};")),
        Language::Wgsl => (format!("struct {name} {{"), "}".to_owned()),
        Language::Slang => (
            format!("struct {name} : IDifferentiable {{"),
            "};".to_owned(),
        ),
        _ => (format!("struct {name} {{"), "};".to_owned()),
    };
    out.push_str(&open);
    out.push('\n');
    for Field { name, shape, doc } in &record.fields {
        let (of, after) = language.shape(*shape);
        if !doc.is_empty() {
            let _ = writeln!(out, "    // {doc}");
        }
        out.push_str(&match language {
            Language::Wgsl => format!("    {name}: {of},\n"),
            _ => format!("    {of} {name}{after};\n"),
        });
    }
    out.push_str(&close);
    out.push_str("\n\n");
}

/// Returns the comment on an operation: its stage, or the file of the model, such as `hair/view.rs`. Vectors and choices have none,
/// because they belong to the operations around them.
fn comment(origin: Origin) -> Option<String> {
    if let Some(stage) = origin.stage {
        return Some(stage.to_owned());
    }
    let file = origin.line?.file().replace('\\', "/");
    let file = file
        .rsplit_once("/src/")
        .map_or(file.as_str(), |(_, file)| file);
    let is_part = file.starts_with("simd/") || file == "frame.rs";
    (!is_part).then(|| file.to_owned())
}

/// Function that is being printed.
struct Body<'a> {
    program: &'a Program,
    language: Language,
    function: &'a Function,
    inputs: Vec<String>,
    prefix: String,
}

impl<'a> Body<'a> {
    fn new(program: &'a Program, language: Language, function: &'a Function) -> Self {
        Self {
            program,
            language,
            function,
            inputs: match language {
                Language::Python => python::inputs(function),
                Language::Slang => (0..function.inputs().len())
                    .map(|i| format!("i{i}"))
                    .collect(),
                _ => function.inputs(),
            },
            prefix: match language {
                Language::Python => "o.".to_owned(),
                _ => prefix(program),
            },
        }
    }

    fn print(&self, out: &mut String) {
        self.signature(out);
        if self.language == Language::Slang {
            self.finite_inputs(out);
        }
        self.statements(
            |comment| format!("    // {comment}\n"),
            out,
            |binding, name, value| format!("    {binding} {name} = {value};\n"),
        );
        let results = self.function.results();
        for (place, result) in self.function.output().places().zip(results) {
            let _ = writeln!(out, "    result.{place} = {};", self.name(*result));
        }
        out.push_str("    return result;\n}\n\n");
    }

    /// Prints the numbers that the function reads, each by a function whose derivative is finite.
    fn finite_inputs(&self, out: &mut String) {
        let (inputs, prefix) = (self.function.inputs(), &self.prefix);
        for node in self.function.graph().nodes() {
            if let Kind::Input(place) = node.kind {
                let input = &inputs[place as usize];
                let _ = writeln!(out, "    float i{place} = {prefix}finite({input});");
            }
        }
    }

    /// Prints the operations in their order, below comments on their stages.
    fn statements(
        &self,
        comment_line: impl Fn(&str) -> String,
        out: &mut String,
        line: impl Fn(&str, &str, &str) -> String,
    ) {
        let (mut last, schedule) = (None, self.function.schedule());
        let operands = schedule.iter().flat_map(|place| self.operands(*place));
        let read: HashSet<u32> = operands
            .chain(self.function.results().iter().copied())
            .collect();
        for place in schedule.into_iter().filter(|place| read.contains(place)) {
            let now = comment(self.function.graph().origin(place));
            if now.is_some() && now != last {
                *out += &comment_line(now.as_deref().unwrap_or_default());
                last = now;
            }
            let (binding, name) = (self.binding(place), self.name(place));
            *out += &line(binding, &name, &self.value(place));
        }
    }

    fn signature(&self, out: &mut String) {
        if let Some(purpose) = purpose(self.function.name()) {
            let _ = writeln!(out, "// {purpose}");
        }
        let of = type_name(self.program, self.function.output());
        let argument = |argument: &Argument| {
            let of = match argument {
                Argument::Record(_, record) => type_name(self.program, record),
                Argument::Field(field) => self.language.shape(field.shape).0,
            };
            match self.language {
                Language::Wgsl => format!("{}: {of}", argument.name()),
                _ => format!("{of} {}", argument.name()),
            }
        };
        let arguments: Vec<_> = self.function.arguments().iter().map(argument).collect();
        let (name, mut arguments) = (self.function.name(), arguments.join(", "));
        let prefix = &self.prefix;
        let (signature, result) = match self.language {
            Language::Wgsl => (
                format!("fn {prefix}{name}({arguments}) -> {of} {{"),
                format!("var result: {of};"),
            ),
            language => {
                if language == Language::C && arguments.is_empty() {
                    arguments.push_str("void");
                }
                let before = match language {
                    Language::Slang => "[Differentiable]\n",
                    _ => "HAIRIS_FN ",
                };
                (
                    format!("{before}{of} {prefix}{name}({arguments}) {{"),
                    format!("{of} result;"),
                )
            }
        };
        let _ = writeln!(out, "{signature}\n    {result}");
        if self.language == Language::C {
            for argument in self.unused() {
                let _ = writeln!(out, "    (void){argument};");
            }
        }
    }

    /// Returns the arguments that the function does not read: a model of the far field does not read `h`.
    fn unused(&self) -> Vec<&str> {
        let nodes = self.function.graph().nodes();
        let mut unused = Vec::new();
        let mut first = 0;
        for argument in self.function.arguments() {
            let here = first..first + argument.len();
            let is_read =
                |kind: Kind| matches!(kind, Kind::Input(i) if here.contains(&(i as usize)));
            if !nodes.iter().any(|node| is_read(node.kind)) {
                unused.push(argument.name());
            }
            first = here.end;
        }
        unused
    }

    /// Returns the number that the mask at a place tests for NaN, in languages whose drivers ignore NaN in comparisons.
    fn tested(&self, place: u32) -> Option<u32> {
        let tested = self.function.graph().tested_number(place);
        tested.filter(|_| !matches!(self.language, Language::C | Language::Python))
    }

    /// Returns the places of the numbers and masks that the text of a value reads.
    fn operands(&self, place: u32) -> Vec<u32> {
        match self.tested(place) {
            Some(tested) => vec![tested],
            None => self.function.graph().node(place).operands().to_vec(),
        }
    }

    fn binding(&self, place: u32) -> &'static str {
        let is_mask = self.function.graph().node(place).is_mask();
        self.language.binding(is_mask)
    }

    fn name(&self, place: u32) -> String {
        let node = self.function.graph().node(place);
        match node.kind {
            Kind::Op(Op::Constant(bits)) => {
                self.language.literal(f32::from_bits(bits), &self.prefix)
            }
            Kind::Mask(mask) if self.language == Language::C => i32::from(mask).to_string(),
            Kind::Mask(mask) if self.language == Language::Python => {
                if mask { "True" } else { "False" }.to_owned()
            }
            Kind::Mask(mask) => mask.to_string(),
            Kind::Input(input) => self.inputs[input as usize].clone(),
            Kind::Op(_) => format!("{}{place}", if node.is_mask() { 'm' } else { 'x' }),
        }
    }

    fn value(&self, place: u32) -> String {
        let graph = self.function.graph();
        let node = graph.node(place);
        let Kind::Op(op) = node.kind else {
            unreachable!("what is scheduled is computed")
        };
        let operands = node.operands();
        let form = if let Some(tested) = self.tested(place) {
            return format!("{}is_number({})", self.prefix, self.name(tested));
        } else if let Some(place) = operands.iter().position(|operand| graph.rounds(*operand)) {
            Form::Rounds(place)
        } else {
            match (op, operands) {
                (Op::Less, [_, b]) if graph.number(*b) == Some(f32::INFINITY) => {
                    Form::BelowInfinity
                }
                (Op::Min | Op::Max, [_, b]) if graph.number(*b).is_some() => Form::Limit,
                _ => Form::Any,
            }
        };
        let template = template(self.language, op, form);
        let names: Vec<_> = operands.iter().map(|operand| self.name(*operand)).collect();
        write_template(template, &self.prefix, &names)
    }
}
