//! Programs: all functions of a model, with the records that they take and return.

pub(crate) mod dual;

use crate::call::Call;
use crate::function::{Argument, Function};
use crate::graph::{Graph, Lane, input, record};
use crate::material::{material, parameters, params};
use crate::name::check_name;
use crate::record::{Field, Record, Shape, numbers};
use hairis::Eval;
use hairis::Hit;
use hairis::model::{Model, SampleLanes};
use hairis::simd::trace::{Op, Target};
use hairis::simd::{LaneStruct, Lanes, Path, Vec3x};
use hairis_variants::{ModelId, Parameters, Registered, Visitor};

/// Functions and records of a model, traced for one target.
#[derive(Clone, Debug)]
pub struct Program {
    name: String,
    target: Target,
    material: Record,
    prepared: Record,
    functions: Vec<Function>,
    /// Functions that return the parameters of a preset, and have no argument.
    presets: Vec<Function>,
    /// Functions that return a material, and have no argument.
    materials: Vec<Function>,
}

impl Program {
    /// Traces a model of the list, or of a longer list, with its presets.
    #[must_use]
    pub fn of<M: Registered>(target: Target) -> Self {
        let mut name = M::NAME.replace('-', "_");
        let word = M::CHOICE.map(|(_, word)| word);
        let is_default = ModelId::find(M::NAME, word).is_none_or(ModelId::is_default);
        if !is_default && let Some((_, word)) = M::CHOICE {
            name = format!("{name}_{}", word.replace('-', "_"));
        }
        let mut program = Self::trace::<M>(&name, target);
        let material = material::<M>(target, &program.material);
        program.functions.insert(0, material);
        let params = params::<M::Params>();
        for (name, preset) in M::Params::PRESETS {
            let name = name.replace('-', "_");
            program.add_material(&name, &numbers(&M::MODEL.material(preset)));
            let name = format!("params_{name}");
            let numbers = parameters(preset);
            program.presets.push(constants(name, &params, &numbers));
        }
        program
    }

    /// Traces a model of the list that is chosen at run time, as [`of`](Self::of) does for a type. Tracing is a large function per model,
    /// so that it is compiled in this crate and not in each crate that calls it.
    #[must_use]
    pub fn of_id(id: ModelId, target: Target) -> Self {
        struct Trace(Target);
        impl Visitor for Trace {
            type Output = Program;
            fn visit<M: Registered>(self) -> Program {
                Program::of::<M>(self.0)
            }
        }
        id.visit(Trace(target))
    }

    /// Traces any model under a name that [`check_name`] accepts. The program has neither [`Call::Material`] nor presets.
    ///
    /// # Panics
    ///
    /// Panics if the name is not accepted.
    #[must_use]
    pub fn trace<M: Model>(name: &str, target: Target) -> Self {
        require_name(name);
        let (_, (material, prepared)) = record(target, || {
            let next = &mut 0;
            let material = lanes::<M::Material<Lane>>(next);
            let prepared = lanes::<M::Prepared<Lane>>(next);
            (
                Record::of("material", &material).0,
                Record::of("prepared", &prepared).0,
            )
        });
        let calls = Call::ALL.into_iter().filter(|call| *call != Call::Material);
        let functions = calls.map(|call| function::<M>(target, call, &material, &prepared));
        let functions = functions.collect();
        Self {
            name: name.to_owned(),
            target,
            material,
            prepared,
            functions,
            presets: Vec::new(),
            materials: Vec::new(),
        }
    }

    /// Returns the name of the model, which begins the names of all printed functions.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the target that the program was traced for.
    #[must_use]
    pub const fn target(&self) -> Target {
        self.target
    }

    /// Returns the layout of a material: the numbers that a host uploads, in their order.
    #[must_use]
    pub const fn material(&self) -> &Record {
        &self.material
    }

    /// Returns the layout of a shading point, which [`Call::Prepare`] returns.
    #[must_use]
    pub const fn prepared(&self) -> &Record {
        &self.prepared
    }

    /// Returns the functions in the order in which they are printed.
    #[must_use]
    pub fn functions(&self) -> &[Function] {
        &self.functions
    }

    /// Returns the function `call` of the program.
    ///
    /// # Panics
    ///
    /// Panics if [`keep`](Self::keep) removed the function, or if it is [`Call::Material`] of a model that is not in the list.
    #[must_use]
    pub fn function(&self, call: Call) -> &Function {
        let is_called = |function: &&Function| function.name() == call.name();
        let function = self.functions.iter().find(is_called);
        function.expect("a program has every call until some are removed")
    }

    /// Replaces the functions of the program, for example by fewer or by their gradients.
    pub fn keep(&mut self, functions: Vec<Function>) {
        self.functions = functions;
    }

    /// Returns the functions of the presets' parameters by name, which have no argument. They are left out without [`Call::Material`],
    /// which reads the parameters.
    #[must_use]
    pub fn presets(&self) -> &[Function] {
        let reads = |function: &Function| function.name() == Call::Material.name();
        if self.functions.iter().any(reads) {
            &self.presets
        } else {
            &[]
        }
    }

    /// Returns the functions of materials by name, which have no argument: the presets, and the materials of
    /// [`add_material`](Self::add_material).
    #[must_use]
    pub fn materials(&self) -> &[Function] {
        &self.materials
    }

    /// Adds a material under a name that [`check_name`] accepts, given by its numbers in the order of [`material`](Self::material). A
    /// material that already has this name is replaced.
    ///
    /// # Panics
    ///
    /// Panics if the name is not accepted, or if the count of the numbers differs from that of a material.
    pub fn add_material(&mut self, name: &str, numbers: &[f32]) {
        require_name(name);
        assert_eq!(numbers.len(), self.material.len(), "numbers of a material");
        let name = format!("material_{name}");
        self.materials.retain(|known| known.name() != name);
        let material = constants(name, &self.material, numbers);
        self.materials.push(material);
    }

    /// Returns the version of the layout: a hash (FNV-1a, 32 bits) of names and order of the numbers of a material and of a shading
    /// point. Code that uploads numbers compares it with the version in the source that it was written for.
    #[must_use]
    pub fn layout(&self) -> u32 {
        let records = [&self.material, &self.prepared];
        let places = records.into_iter().flat_map(Record::places);
        places.fold(0x811c_9dc5, |hash, place| {
            (place.bytes().chain([b'\n'])).fold(hash, |hash, byte| {
                (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
            })
        })
    }
}

/// Panics with the sentence of [`check_name`] if a name is not accepted.
fn require_name(name: &str) {
    if let Err(problem) = check_name(name) {
        panic!("{problem}");
    }
}

/// Makes a function without arguments that returns a record of these numbers.
fn constants(name: String, record: &Record, numbers: &[f32]) -> Function {
    let mut graph = Graph::default();
    let results: Vec<u32> = numbers.iter().map(|x| graph.constant(*x)).collect();
    Function::new(name, Vec::new(), record.clone(), &graph, &results)
}

/// Makes a struct of lanes whose numbers are the next arguments.
fn lanes<S: LaneStruct<Number = Lane>>(next: &mut u32) -> S {
    S::make(&Path::Root, &mut |_| input(next))
}

fn three(next: &mut u32) -> [Lane; 3] {
    [input(next), input(next), input(next)]
}

fn vector(next: &mut u32) -> Vec3x<Lane> {
    let [x, y, z] = three(next);
    Vec3x::new(x, y, z)
}

const EVAL: [(&str, Shape); 2] = [("value", Shape::Vector), ("pdf", Shape::Number)];
const SAMPLE: [(&str, Shape); 5] = [
    ("wi", Shape::Vector),
    ("value", Shape::Vector),
    ("pdf", Shape::Number),
    ("weight", Shape::Vector),
    ("slot", Shape::Number),
];

fn eval(eval: Eval<Lane>) -> Vec<Lane> {
    let [r, g, b] = eval.value;
    vec![r, g, b, eval.pdf]
}

fn sample(sample: SampleLanes<Lane>) -> Vec<Lane> {
    let ([r, g, b], [wr, wg, wb], wi) = (sample.value, sample.weight, sample.wi);
    vec![
        wi.x,
        wi.y,
        wi.z,
        r,
        g,
        b,
        sample.pdf,
        wr,
        wg,
        wb,
        sample.slot,
    ]
}

/// Returns the layout of the result of a call.
fn output<M: Model>(call: Call, prepared: &Record) -> Record {
    let lobes = M::LOBES.len();
    match call {
        Call::Material => unreachable!("it is a function of parameters"),
        Call::Prepare => prepared.clone(),
        Call::Eval | Call::EvalHit => Record::new("eval", &EVAL),
        Call::Sample | Call::SampleHit => Record::new("sample", &SAMPLE),
        Call::Lobes => Record::new(
            "lobes",
            &[
                ("value", Shape::Array(lobes)),
                ("color", Shape::Array(3 * lobes)),
                ("pdf", Shape::Array(lobes)),
            ],
        ),
        Call::EvalSampleHit => {
            let mut fields = Vec::new();
            for (record, of) in [("eval", &EVAL[..]), ("sample", &SAMPLE[..])] {
                let prefixed = of
                    .iter()
                    .map(|(name, shape)| Field::new(format!("{record}_{name}"), *shape));
                fields.extend(prefixed);
            }
            let name = "eval_sample".to_owned();
            Record { name, fields }
        }
    }
}

fn function<M: Model>(
    target: Target,
    call: Call,
    material: &Record,
    prepared: &Record,
) -> Function {
    type Prepared<M> = <M as Model>::Prepared<Lane>;
    let is_prepared = matches!(call, Call::Eval | Call::Sample | Call::Lobes);
    let (has_wi, has_xi) = (
        matches!(
            call,
            Call::Eval | Call::Lobes | Call::EvalHit | Call::EvalSampleHit
        ),
        matches!(call, Call::Sample | Call::SampleHit | Call::EvalSampleHit),
    );
    let vector_argument = |name: &str| Argument::Field(Field::new(name, Shape::Vector));
    let mut arguments = if is_prepared {
        vec![Argument::Record("prepared".to_owned(), prepared.clone())]
    } else {
        let h = Argument::Field(Field::new("h", Shape::Number));
        vec![
            Argument::Record("material".to_owned(), material.clone()),
            vector_argument("wo"),
            h,
        ]
    };
    let (graph, results) = record(target, || {
        let next = &mut 0;
        let point: Prepared<M> = if is_prepared {
            lanes(next)
        } else {
            let material: M::Material<Lane> = lanes(next);
            let wo = vector(next);
            Lane::stage("h, at most 1 from the axis");
            let hit = Hit::new(wo, input(next));
            M::prepare::<Lane, Lane>(&material, hit)
        };
        let mut results = Vec::new();
        if call == Call::Prepare {
            results = numbers(&point);
        }
        if has_wi {
            let wi = vector(next);
            if call == Call::Lobes {
                let lobes = &M::lobes::<Lane, Lane>(&point, wi).0[..M::LOBES.len()];
                results.extend(lobes.iter().map(|lobe| lobe.value));
                results.extend(lobes.iter().flat_map(|lobe| lobe.color));
                results.extend(lobes.iter().map(|lobe| lobe.pdf));
            } else {
                results.extend(eval(M::eval::<Lane, Lane>(&point, wi)));
            }
        }
        if has_xi {
            let xi = three(next);
            results.extend(sample(M::sample::<Lane, Lane>(&point, xi)));
        }
        results.into_iter().map(Lane::name).collect::<Vec<_>>()
    });
    if has_wi {
        arguments.push(vector_argument("wi"));
    }
    if has_xi {
        arguments.push(vector_argument("xi"));
    }
    let output = output::<M>(call, prepared);
    Function::new(call.name().to_owned(), arguments, output, &graph, &results)
}

/// Makes a program whose one function computes each operation alone: `MulAdd` except with [`Target::Exact`], and `Exp2` and `Log2` only
/// with [`Target::GpuNative`].
///
/// Serves tests of printers. Masks are 1 and 0 in the result.
#[doc(hidden)]
#[must_use]
pub fn every_operation(target: Target) -> Program {
    let mut graph = Graph::default();
    let [a, b, c] = [0, 1, 2].map(|place| graph.input(place));
    let [zero, one, infinity] = [0.0, 1.0, f32::INFINITY].map(|x| graph.constant(x));
    let magic = graph.constant(8_388_608.0 + 115.0);
    let [least, most] = [-100.0, 100.0].map(|x| graph.constant(x));
    let mut op = |op: Op, args: [u32; 3]| graph.op(op, args, None);
    // Exponents stay in the range in which adding `magic` gives a biased exponent.
    let near = op(Op::Min, [a, most, 0]);
    let near = op(Op::Max, [near, least, 0]);
    let (m, n) = (op(Op::Less, [a, b, 0]), op(Op::AtLeast, [b, c, 0]));
    let [below, above] = [[a, one, 0], [zero, a, 0]].map(|args| op(Op::Less, args));
    let masks = [
        (Op::Or, [below, above, 0]),
        (Op::And, [m, n, 0]),
        (Op::Or, [m, n, 0]),
        (Op::Not, [m, 0, 0]),
        (Op::Less, [a, infinity, 0]),
        (Op::Less, [infinity, a, 0]),
    ];
    let masks = masks.map(|(name, args)| op(name, args));
    let mut numbers = vec![
        (Op::Add, [a, b, 0]),
        (Op::Add, [near, magic, 0]),
        (Op::Sub, [a, b, 0]),
        (Op::Mul, [a, b, 0]),
        (Op::Div, [a, b, 0]),
        (Op::Neg, [a, 0, 0]),
        (Op::Sqrt, [a, 0, 0]),
        (Op::Abs, [a, 0, 0]),
        (Op::Min, [a, b, 0]),
        (Op::Max, [a, b, 0]),
        (Op::TimesSign, [a, b, 0]),
        (Op::NegateIf, [m, a, 0]),
        (Op::ShiftLeft23, [a, 0, 0]),
        (Op::Mantissa, [a, 0, 0]),
        (Op::Exponent, [a, 0, 0]),
        (Op::Upper, [a, 0, 0]),
        (Op::Select, [m, b, c]),
    ];
    if target != Target::Exact {
        numbers.push((Op::MulAdd, [a, b, c]));
    }
    if target == Target::GpuNative {
        numbers.extend([(Op::Exp2, [a, 0, 0]), (Op::Log2, [a, 0, 0])]);
    }
    let masks = [m, n].into_iter().chain(masks);
    numbers.extend(masks.map(|mask| (Op::Select, [mask, one, zero])));
    let results: Vec<u32> = numbers
        .iter()
        .map(|(name, args)| op(*name, *args))
        .collect();
    let argument = Argument::Field(Field::new("xi", Shape::Vector));
    let output = Record::new("operations", &[("result", Shape::Array(results.len()))]);
    let name = "operations".to_owned();
    let function = Function::new(name, vec![argument], output, &graph, &results);
    Program {
        name: "test".to_owned(),
        target,
        material: Record::new("material", &[]),
        prepared: Record::new("prepared", &[]),
        functions: vec![function],
        presets: Vec::new(),
        materials: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Rounding;

    /// Names are part of the interface: code that uploads numbers by their place has to notice that a number has another meaning.
    #[test]
    fn a_renamed_number_is_another_layout() {
        let program = Program::of::<hairis_variants::KajiyaKay>(Target::Exact);
        let mut renamed = program.clone();
        renamed.material.fields[0].name = "diffuse".to_owned();
        let mut swapped = program.clone();
        swapped.prepared.fields.swap(0, 1);
        assert_ne!(renamed.layout(), program.layout());
        assert_ne!(swapped.layout(), program.layout());
    }

    /// A difference of products recorded for GPUs keeps its digits even if `MulAdd` rounds twice; one recorded for levels that fuse does
    /// not.
    #[test]
    fn differences_of_products_survive_split_fma() {
        fn difference(target: Target, factors: [f32; 4], rounding: Rounding) -> f32 {
            let (graph, result) = record(target, || {
                let next = &mut 0;
                let [a, b, c] = three(next);
                Lane::difference_of_products(a, b, c, input(next)).name()
            });
            let output = Record::new("difference", &[("difference", Shape::Number)]);
            let name = "difference".to_owned();
            Function::new(name, Vec::new(), output, &graph, &[result]).run(&factors, rounding)[0]
        }
        let factors = [1.000_000_2, 1.000_000_4, 1.000_000_5, 1.000_000_1];
        let [a, b, c, d] = factors.map(f64::from);
        let exact = a * b - c * d;
        let error = |got: f32| (f64::from(got) / exact - 1.0).abs();
        assert!(error(difference(Target::Gpu, factors, Rounding::Twice)) < 1e-6);
        assert!(error(difference(Target::Gpu, factors, Rounding::Once)) < 1e-6);
        assert!(error(difference(Target::Fused, factors, Rounding::Once)) < 1e-6);
        assert!(error(difference(Target::Fused, factors, Rounding::Twice)) > 0.1);
    }
}
