//! Functions traced from a model: a graph of operations with arguments and results.

use crate::graph::{Graph, Kind, Rounding, Value, apply};
use crate::record::{Field, Record};

/// Argument of a function: a whole record, or a single field.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Argument {
    /// A record, preceded by the name under which it is passed.
    Record(String, Record),
    /// A vector or a number that is passed on its own.
    Field(Field),
}

impl Argument {
    /// Returns the name of the argument in the signature of the function.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Record(name, _) => name,
            Self::Field(field) => &field.name,
        }
    }

    /// Returns the number of numbers that the argument holds.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "no argument is empty")]
    pub fn len(&self) -> usize {
        match self {
            Self::Record(_, record) => record.len(),
            Self::Field(field) => field.len(),
        }
    }

    /// Returns the name of each number of the argument, as every language writes it.
    #[must_use]
    pub fn places(&self) -> Vec<String> {
        match self {
            Self::Record(name, record) => {
                let places = record.places();
                places.map(|place| format!("{name}.{place}")).collect()
            }
            Self::Field(field) => field.places().collect(),
        }
    }
}

/// Function of numbers, traced from a model: named arguments, a record as its result, and the graph that computes it.
#[derive(Clone, Debug)]
pub struct Function {
    name: String,
    arguments: Vec<Argument>,
    output: Record,
    results: Vec<u32>,
    graph: Graph,
}

impl Function {
    /// Makes a function of a graph, and drops the nodes that no result reads.
    pub(crate) fn new(
        name: String,
        arguments: Vec<Argument>,
        output: Record,
        graph: &Graph,
        results: &[u32],
    ) -> Self {
        let is_used = graph.needed(results);
        let (mut kept, mut places) = (Graph::default(), vec![0; is_used.len()]);
        for (node, place) in graph.nodes().iter().zip(0_u32..) {
            if is_used[place as usize] {
                let mut args = [0; 3];
                for (arg, operand) in args.iter_mut().zip(node.operands()) {
                    *arg = places[*operand as usize];
                }
                places[place as usize] = kept.copy(node, args, graph.origin(place));
            }
        }
        let results = results
            .iter()
            .map(|result| places[*result as usize])
            .collect();
        Self {
            name,
            arguments,
            output,
            results,
            graph: kept,
        }
    }

    /// Returns the name of the function without the name of the model, for example `eval_hit`.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the arguments in the order of the signature.
    #[must_use]
    pub fn arguments(&self) -> &[Argument] {
        &self.arguments
    }

    /// Returns the layout of the result, which is also its printed type.
    #[must_use]
    pub const fn output(&self) -> &Record {
        &self.output
    }

    /// Returns the place in the [graph](Self::graph) of each number of the result.
    #[must_use]
    pub fn results(&self) -> &[u32] {
        &self.results
    }

    /// Returns the graph: the operations in the order in which the model computes them.
    #[must_use]
    pub const fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Returns the name of each number that the function takes, argument by argument.
    #[must_use]
    pub fn inputs(&self) -> Vec<String> {
        self.arguments.iter().flat_map(Argument::places).collect()
    }

    /// Returns the function reduced to the fields `names` of its result, without the operations that only other fields need. Returns
    /// `None` if the result lacks one of these fields.
    #[must_use]
    pub fn only(&self, names: &[&str]) -> Option<Self> {
        let (mut fields, mut results) = (Vec::new(), Vec::new());
        for name in names {
            let field = self
                .output
                .fields
                .iter()
                .position(|field| field.name == *name)?;
            let first: usize = self.output.fields[..field].iter().map(Field::len).sum();
            let field = &self.output.fields[field];
            results.extend(&self.results[first..first + field.len()]);
            fields.push(field.clone());
        }
        let name = format!("{}_{}", self.name, names.join("_"));
        let output = Record {
            name: name.clone(),
            fields,
        };
        Some(Self::new(
            name,
            self.arguments.clone(),
            output,
            &self.graph,
            &results,
        ))
    }

    /// Computes the results for the numbers `inputs`, which every translation has to reproduce. [`Rounding`] applies to
    /// [`Op::MulAdd`](hairis::simd::trace::Op::MulAdd), which lanes that fuse record for a product with a sum.
    ///
    /// # Panics
    ///
    /// Panics if there are fewer inputs than the function reads.
    #[must_use]
    pub fn run(&self, inputs: &[f32], rounding: Rounding) -> Vec<f32> {
        let mut values: Vec<Value> = Vec::with_capacity(self.graph.nodes().len());
        for node in self.graph.nodes() {
            values.push(match node.kind {
                Kind::Input(place) => Value::Number(inputs[place as usize]),
                Kind::Mask(mask) => Value::Mask(mask),
                Kind::Op(op) => {
                    let mut operands = [Value::Mask(false); 3];
                    for (operand, place) in operands.iter_mut().zip(node.operands()) {
                        *operand = values[*place as usize];
                    }
                    apply(op, &operands, rounding)
                }
            });
        }
        let number = |result: &u32| values[*result as usize].number();
        self.results.iter().map(number).collect()
    }

    /// Returns the number of operations, without arguments and constants.
    #[must_use]
    pub fn operations(&self) -> usize {
        let nodes = self.graph.nodes().iter();
        nodes.filter(|node| node.is_computed()).count()
    }

    /// Returns the largest number of values that are live at once in the order of [`schedule`](Self::schedule). Arguments and constants
    /// do not count, because they are read where they are used.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.waiting_in(&self.schedule())
    }

    /// Returns the order of the operations: the order of the model, or each operation as late as possible if fewer values are then live
    /// at once.
    #[must_use]
    pub fn schedule(&self) -> Vec<u32> {
        let traced: Vec<u32> = (0_u32..)
            .zip(self.graph.nodes())
            .filter(|(_, node)| node.is_computed())
            .map(|(place, _)| place)
            .collect();
        let late = self.late();
        if self.waiting_in(&late) < self.waiting_in(&traced) {
            late
        } else {
            traced
        }
    }

    /// Returns the order in which each operation comes just before the first operation that reads its result.
    fn late(&self) -> Vec<u32> {
        let mut order = Vec::new();
        let mut is_done = vec![false; self.graph.nodes().len()];
        for result in &self.results {
            let mut stack = vec![(*result, 0)];
            while let Some((place, next)) = stack.pop() {
                let node = self.graph.node(place);
                if is_done[place as usize] || !node.is_computed() {
                    continue;
                }
                if let Some(operand) = node.operands().get(next) {
                    stack.extend([(place, next + 1), (*operand, 0)]);
                } else {
                    is_done[place as usize] = true;
                    order.push(place);
                }
            }
        }
        order
    }

    fn waiting_in(&self, order: &[u32]) -> usize {
        let mut last = vec![0; self.graph.nodes().len()];
        for (step, place) in order.iter().enumerate() {
            for operand in self.graph.node(*place).operands() {
                last[*operand as usize] = step;
            }
        }
        for result in &self.results {
            last[*result as usize] = order.len();
        }
        let (mut waiting, mut most, mut ends) = (0_usize, 0, vec![0; order.len() + 1]);
        for (step, place) in order.iter().enumerate() {
            waiting += 1;
            ends[last[*place as usize]] += 1;
            waiting -= ends[step];
            most = most.max(waiting);
        }
        most
    }
}
