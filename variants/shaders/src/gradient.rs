//! Derivatives in reverse mode: one function returns the results and the gradient of their weighted sum by every argument.

use crate::function::{Argument, Function};
use crate::graph::{Graph, Kind};
use crate::record::{Field, Record};
use core::f32::consts::{LN_2, LOG2_E};
use hairis::simd::trace::Op;

/// Least root that a derivative divides by, so that the derivative of the root of 0 is finite.
const LEAST_ROOT: f32 = 1e-18;

/// Reverse pass: the graph with the nodes added so far, and the derivative by each node so far, where `None` stands for 0.
struct Pass {
    graph: Graph,
    adjoints: Vec<Option<u32>>,
    /// True if a product is added to a derivative in one fused operation.
    fuses: bool,
}

impl Pass {
    fn op<const N: usize>(&mut self, op: Op, operands: [u32; N]) -> u32 {
        let mut args = [0; 3];
        args[..N].copy_from_slice(&operands);
        self.graph.op(op, args, None)
    }

    /// Adds `term` to the derivative by the node at `to`.
    fn give(&mut self, to: u32, term: u32) {
        if !self.reads_arguments(to) {
            return;
        }
        let sum = match self.adjoints[to as usize] {
            None => term,
            Some(before) => self.sum(before, term),
        };
        self.adjoints[to as usize] = Some(sum);
    }

    /// Adds two derivatives, either of which may be a product.
    fn sum(&mut self, before: u32, term: u32) -> u32 {
        let product = |place: u32| {
            let node = self.graph.node(place);
            (self.fuses && node.kind == Kind::Op(Op::Mul))
                .then(|| [0, 1].map(|i| node.operands()[i]))
        };
        match (product(term), product(before)) {
            (Some([a, b]), _) => self.op(Op::MulAdd, [a, b, before]),
            (None, Some([a, b])) => self.op(Op::MulAdd, [a, b, term]),
            (None, None) => self.op(Op::Add, [before, term]),
        }
    }

    fn reads_arguments(&self, place: u32) -> bool {
        let node = self.graph.node(place);
        node.is_computed() || matches!(node.kind, Kind::Input(_))
    }

    fn give_product(&mut self, to: u32, by: u32, adjoint: u32) {
        if self.reads_arguments(to) {
            let term = self.op(Op::Mul, [adjoint, by]);
            self.give(to, term);
        }
    }

    /// Passes the derivative by the operation at `this` on to its operands.
    ///
    /// Three rules differ from those of a textbook. A sum that rounds to an integer is a step. The mantissa of `x` is `x` over a power of
    /// two that is constant around it. The upper half of a number has the derivative of the number, so that the remaining bits have none.
    fn pass_on(&mut self, op: Op, this: u32, args: [u32; 3], adjoint: u32) {
        let [a, b, c] = args;
        match op {
            Op::Add if self.graph.rounds(a) || self.graph.rounds(b) => {}
            Op::MulAdd if self.graph.rounds(c) => {}
            Op::Add => {
                self.give(a, adjoint);
                self.give(b, adjoint);
            }
            Op::Sub => {
                self.give(a, adjoint);
                let minus = self.op(Op::Neg, [adjoint]);
                self.give(b, minus);
            }
            Op::Mul | Op::MulAdd => {
                self.give_product(a, b, adjoint);
                self.give_product(b, a, adjoint);
                if op == Op::MulAdd {
                    self.give(c, adjoint);
                }
            }
            Op::Div => {
                let by = self.op(Op::Div, [adjoint, b]);
                self.give(a, by);
                let minus = self.op(Op::Neg, [this]);
                self.give_product(b, minus, by);
            }
            Op::Neg => {
                let minus = self.op(Op::Neg, [adjoint]);
                self.give(a, minus);
            }
            Op::Sqrt => {
                let (half, least) = (self.graph.constant(0.5), self.graph.constant(LEAST_ROOT));
                let root = self.op(Op::Max, [this, least]);
                let slope = self.op(Op::Div, [half, root]);
                self.give_product(a, slope, adjoint);
            }
            Op::Exp2 => {
                let ln_2 = self.graph.constant(LN_2);
                let slope = self.op(Op::Mul, [this, ln_2]);
                self.give_product(a, slope, adjoint);
            }
            Op::Log2 => {
                let log2_e = self.graph.constant(LOG2_E);
                let slope = self.op(Op::Div, [log2_e, a]);
                self.give_product(a, slope, adjoint);
            }
            Op::Abs => {
                let term = self.op(Op::TimesSign, [adjoint, a]);
                self.give(a, term);
            }
            Op::Min | Op::Max => {
                let [low, high] = if op == Op::Min { [a, b] } else { [b, a] };
                let mask = self.op(Op::Less, [low, high]);
                self.give_either(mask, [a, b], adjoint);
            }
            Op::TimesSign => {
                let term = self.op(Op::TimesSign, [adjoint, b]);
                self.give(a, term);
            }
            Op::NegateIf => {
                let term = self.op(Op::NegateIf, [a, adjoint]);
                self.give(b, term);
            }
            Op::Mantissa => {
                let slope = self.op(Op::Div, [this, a]);
                self.give_product(a, slope, adjoint);
            }
            Op::Upper => self.give(a, adjoint),
            Op::Select => self.give_either(a, [b, c], adjoint),
            Op::Constant(_)
            | Op::ShiftLeft23
            | Op::Exponent
            | Op::Less
            | Op::AtLeast
            | Op::And
            | Op::Or
            | Op::Not => {}
        }
    }

    /// Passes the derivative to the first operand where the mask is set, and to the second elsewhere.
    fn give_either(&mut self, mask: u32, [yes, no]: [u32; 2], adjoint: u32) {
        let zero = self.graph.constant(0.0);
        let to_yes = self.op(Op::Select, [mask, adjoint, zero]);
        let to_no = self.op(Op::Select, [mask, zero, adjoint]);
        self.give(yes, to_yes);
        self.give(no, to_no);
    }
}

impl Function {
    /// Returns the function extended by its gradient, which takes one weight per number of the result.
    ///
    /// - Arguments: the arguments of the function, and `weights`, which has the fields of the result.
    /// - Result: the fields of the result, and for each number of the arguments the derivative of the sum of `weight * result` by that
    ///   number, in fields named `d_material_...`, `d_wo`, `d_h`.
    ///
    /// Derivatives are finite: they are 0 where they would be infinite or undefined, for example along the fibre, where the model
    /// evaluates to zero. Choices are taken as constant: the derivative is that of the branch. `wo` and `wi` of unit length, within 1e-5,
    /// are not normalised, so the derivative is right along the sphere, and arbitrary across it.
    ///
    /// # Panics
    ///
    /// Panics if the graph would have 2^32 nodes.
    #[must_use]
    pub fn gradient(&self) -> Self {
        self.differentiate(false)
    }

    /// Returns the same as [`gradient`](Self::gradient) with fewer operations, because products are added to derivatives in one fused
    /// operation. The target must round that operation once. GPUs may split it, so this gradient is not for them.
    ///
    /// # Panics
    ///
    /// Panics if the graph would have 2^32 nodes.
    #[must_use]
    pub fn fused_gradient(&self) -> Self {
        self.differentiate(true)
    }

    fn differentiate(&self, fuses: bool) -> Self {
        let inputs = self.inputs().len();
        let mut pass = Pass {
            fuses,
            graph: self.graph().clone(),
            adjoints: vec![None; self.graph().nodes().len()],
        };
        pass.graph
            .set_stage("derivatives, from the results back to the arguments");
        for (result, place) in self.results().iter().zip(inputs..) {
            let place = u32::try_from(place).expect("a function has less than 2^32 arguments");
            let weight = pass.graph.input(place);
            pass.give(*result, weight);
        }
        let mut derivatives = vec![None; inputs];
        for place in (0..pass.adjoints.len()).rev() {
            let Some(adjoint) = pass.adjoints[place] else {
                continue;
            };
            let this = u32::try_from(place).expect("a graph has less than 2^32 nodes");
            let node = *pass.graph.node(this);
            let mut args = [0; 3];
            args[..node.operands().len()].copy_from_slice(node.operands());
            match node.kind {
                Kind::Input(input) => derivatives[input as usize] = Some(adjoint),
                Kind::Mask(_) => {}
                Kind::Op(op) => pass.pass_on(op, this, args, adjoint),
            }
        }
        let zero = pass.graph.constant(0.0);
        let mut results = self.results().to_vec();
        let infinity = pass.graph.constant(f32::INFINITY);
        for derivative in derivatives {
            results.push(derivative.map_or(zero, |place| {
                let magnitude = pass.op(Op::Abs, [place]);
                let is_finite = pass.op(Op::Less, [magnitude, infinity]);
                pass.op(Op::Select, [is_finite, place, zero])
            }));
        }

        let name = format!("{}_gradient", self.name());
        let mut output = Record {
            name: name.clone(),
            fields: self.output().fields.clone(),
        };
        for argument in self.arguments() {
            match argument {
                Argument::Field(field) => {
                    let name = format!("d_{}", field.name);
                    output.fields.push(Field::new(name, field.shape));
                }
                Argument::Record(name, record) => {
                    output.fields.extend(
                        record.fields.iter().map(|field| {
                            Field::new(format!("d_{name}_{}", field.name), field.shape)
                        }),
                    );
                }
            }
        }
        let mut arguments = self.arguments().to_vec();
        arguments.push(Argument::Record(
            "weights".to_owned(),
            self.output().clone(),
        ));
        Self::new(name, arguments, output, &pass.graph, &results)
    }
}
