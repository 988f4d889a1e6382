//! Derivatives in reverse mode: one function returns the results and the gradient of their weighted sum by every argument.

use crate::function::{Argument, Function};
use crate::graph::{Graph, Kind};
use crate::record::{Field, Record};
use core::f32::consts::{LN_2, LOG2_E};
use hairis::simd::trace::Op;

/// Relative distance beyond the bound of a clamp within which rounding may have carried a number that ends there.
const ROUNDING: f32 = 4.0 * f32::EPSILON;
/// Distance of a direction from the axis, relative to its length, up to which it has no azimuth.
const AXIS: f32 = 1e-18;

/// Part of a derivative.
#[derive(Clone, Copy)]
enum Part {
    /// Sum of the finite terms.
    Finite,
    /// Factor on the slope of a root at 0. If the factor is not 0, the derivative is infinite.
    Infinite,
}

/// Reverse pass: the graph with the nodes added so far, and both parts of the derivative by each node so far, where `None` stands for 0.
struct Pass {
    graph: Graph,
    adjoints: Vec<[Option<u32>; 2]>,
    /// Part of the derivative that is passed on.
    part: Part,
    /// True for nodes that read a number with an end, such as the offset or a width. A direction has none besides the axis.
    has_ends: Vec<bool>,
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
        let part = self.part as usize;
        let sum = match self.adjoints[to as usize][part] {
            None => term,
            Some(before) => self.sum(before, term),
        };
        self.adjoints[to as usize][part] = Some(sum);
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
        match self.part {
            Part::Finite => node.is_computed() || matches!(node.kind, Kind::Input(_)),
            Part::Infinite => self.has_ends[place as usize],
        }
    }

    /// Returns true if the node at a place is a sum of squares, whose derivative is 0 where the sum is.
    fn is_sum_of_squares(&self, place: u32) -> bool {
        let node = self.graph.node(place);
        match (node.kind, node.operands()) {
            (Kind::Op(Op::Mul), [a, b]) => a == b,
            (Kind::Op(Op::MulAdd), [a, b, c]) => a == b && self.is_sum_of_squares(*c),
            (Kind::Op(Op::Add), sum) => sum.iter().all(|term| self.is_sum_of_squares(*term)),
            _ => false,
        }
    }

    /// Returns true if the node at a place has a bound above 0.
    fn is_above_0(&self, place: u32) -> bool {
        let node = self.graph.node(place);
        let mut bounds = node.operands().iter().filter_map(|x| self.graph.number(*x));
        node.kind == Kind::Op(Op::Max) && bounds.any(|bound| bound > 0.0)
    }

    /// Returns true if the node at a place has one of two constants.
    fn is_choice_of_constants(&self, place: u32) -> bool {
        let node = self.graph.node(place);
        node.kind == Kind::Op(Op::Select)
            && (node.operands()[1..].iter()).all(|side| self.graph.number(*side).is_some())
    }

    /// Passes the derivative on to the operand that a minimum or a maximum returns.
    ///
    /// Operands that are equal may be a number at the end of its range. The number then has the derivative, as it has within the range,
    /// and the bound has none. Of two numbers, a minimum prefers the first and a maximum the second, so that sorted pairs have both.
    fn pass_on_extremum(&mut self, is_min: bool, [a, b]: [u32; 2], adjoint: u32) {
        let is_bound = |place| self.graph.number(place).is_some();
        let prefers_first = if is_min {
            !is_bound(a) && !self.is_choice_of_constants(b)
        } else {
            is_bound(b)
        };
        let [preferred, other] = if prefers_first { [a, b] } else { [b, a] };
        let bound = match self.graph.number(other) {
            Some(bound) if is_min && bound > 0.0 => self.graph.constant(bound * (1.0 + ROUNDING)),
            _ => other,
        };
        let is_other = if is_min {
            [bound, preferred]
        } else {
            [preferred, bound]
        };
        let mask = self.op(Op::Less, is_other);
        self.give_either(mask, [other, preferred], adjoint);
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
                let [zero, half] = [0.0, 0.5].map(|x| self.graph.constant(x));
                let slope = self.op(Op::Div, [half, this]);
                if self.is_above_0(a) {
                    return self.give_product(a, slope, adjoint);
                }
                let is_inside = self.op(Op::Less, [zero, this]);
                let slope = self.op(Op::Select, [is_inside, slope, zero]);
                self.give_product(a, slope, adjoint);
                if self.has_ends[a as usize] && !self.is_sum_of_squares(a) {
                    let factor = self.op(Op::Select, [is_inside, zero, adjoint]);
                    let part = core::mem::replace(&mut self.part, Part::Infinite);
                    self.give(a, factor);
                    self.part = part;
                }
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
                let term = self.times_sign(adjoint, a);
                self.give(a, term);
            }
            Op::Min | Op::Max => self.pass_on_extremum(op == Op::Min, [a, b], adjoint),
            Op::TimesSign => {
                let term = self.times_sign(adjoint, b);
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
            Op::Select => {
                let mask = self.continued(a, [b, c]);
                self.give_either(mask, [b, c], adjoint);
            }
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

    /// Returns a derivative with the sign of the number at a place, where -0 counts as 0, as it does for comparisons.
    fn times_sign(&mut self, adjoint: u32, of: u32) -> u32 {
        let zero = self.graph.constant(0.0);
        let is_negative = self.op(Op::Less, [of, zero]);
        self.op(Op::NegateIf, [is_negative, adjoint])
    }

    /// Returns the mask of a choice, extended to where a number that is kept or replaced by 0 is 0 already: at the end of its range.
    fn continued(&mut self, mask: u32, [yes, no]: [u32; 2]) -> u32 {
        if self.graph.number(no).map(f32::to_bits) != Some(0) || !self.has_ends[yes as usize] {
            return mask;
        }
        let magnitude = self.op(Op::Abs, [yes]);
        let least = self.graph.constant(f32::MIN_POSITIVE);
        let is_0 = self.op(Op::Less, [magnitude, least]);
        self.op(Op::Or, [mask, is_0])
    }

    /// Joins both parts of a derivative.
    fn joined(&mut self, [finite, infinite]: [Option<u32>; 2]) -> u32 {
        let zero = self.graph.constant(0.0);
        let (finite, Some(factor)) = (finite.unwrap_or(zero), infinite) else {
            return finite.unwrap_or(zero);
        };
        let factor = self.op(Op::Abs, [factor]);
        let is_infinite = self.op(Op::Less, [zero, factor]);
        self.op(Op::Select, [is_infinite, zero, finite])
    }

    /// Clears the derivatives by a direction where it is along the axis, because its azimuth jumps there. Its components are the inputs
    /// from `first` on.
    fn clear_on_axis(&mut self, derivatives: &mut [u32], first: usize) {
        let place = u32::try_from(first).expect("a function has less than 2^32 arguments");
        let [u, v, w] = [0, 1, 2].map(|k| {
            let component = self.graph.input(place + k);
            self.op(Op::Abs, [component])
        });
        let [across, axis] = [self.op(Op::Max, [v, w]), self.graph.constant(AXIS)];
        let least = self.op(Op::Mul, [u, axis]);
        let (is_off, zero) = (self.op(Op::Less, [least, across]), self.graph.constant(0.0));
        for derivative in &mut derivatives[first..first + 3] {
            *derivative = self.op(Op::Select, [is_off, *derivative, zero]);
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
    /// Derivatives are finite. At the end of an argument's range they are the limit from within, or 0 where that is infinite, for example
    /// by an offset of 1. They are 0 as well where they are undefined, for example by a direction along the fibre. Choices are taken as
    /// constant: the derivative is that of the branch. `wo` and `wi` of unit length, within 1e-5, are not normalised, so the derivative is
    /// right along the sphere, and arbitrary across it.
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

    /// Returns the place among the inputs of the first component of a direction, if the function has this argument.
    fn direction(&self, name: &str) -> Option<usize> {
        let mut arguments = self.arguments().iter();
        let at = arguments.position(|argument| argument.name() == name)?;
        Some(self.arguments()[..at].iter().map(Argument::len).sum())
    }

    /// Returns, for each node, whether it reads a number with an end.
    fn has_ends(&self) -> Vec<bool> {
        let directions = ["wo", "wi"].map(|name| self.direction(name));
        let is_direction = |input: usize| {
            let mut all = directions.iter().flatten();
            all.any(|first| (*first..first + 3).contains(&input))
        };
        let mut has_ends: Vec<bool> = Vec::new();
        for node in self.graph().nodes() {
            let mut operands = node.operands().iter();
            has_ends.push(match node.kind {
                Kind::Input(input) => !is_direction(input as usize),
                _ => operands.any(|place| has_ends[*place as usize]),
            });
        }
        has_ends
    }

    fn differentiate(&self, fuses: bool) -> Self {
        let inputs = self.inputs().len();
        let mut pass = Pass {
            fuses,
            graph: self.graph().clone(),
            adjoints: vec![[None; 2]; self.graph().nodes().len()],
            part: Part::Finite,
            has_ends: self.has_ends(),
        };
        pass.graph
            .set_stage("derivatives, from the results back to the arguments");
        for (result, place) in self.results().iter().zip(inputs..) {
            let place = u32::try_from(place).expect("a function has less than 2^32 arguments");
            let weight = pass.graph.input(place);
            pass.give(*result, weight);
        }
        let mut derivatives = vec![[None; 2]; inputs];
        for place in (0..pass.adjoints.len()).rev() {
            let this = u32::try_from(place).expect("a graph has less than 2^32 nodes");
            let node = *pass.graph.node(this);
            let mut args = [0; 3];
            args[..node.operands().len()].copy_from_slice(node.operands());
            if let Kind::Input(input) = node.kind {
                derivatives[input as usize] = pass.adjoints[place];
            }
            let Kind::Op(op) = node.kind else { continue };
            for part in [Part::Finite, Part::Infinite] {
                pass.part = part;
                if let Some(adjoint) = pass.adjoints[place][part as usize] {
                    pass.pass_on(op, this, args, adjoint);
                }
            }
        }
        let mut derivatives: Vec<u32> = derivatives
            .iter()
            .map(|parts| pass.joined(*parts))
            .collect();
        if let Some(wo) = self.direction("wo") {
            pass.clear_on_axis(&mut derivatives, wo);
        }
        let mut results = self.results().to_vec();
        let [zero, infinity] = [0.0, f32::INFINITY].map(|x| pass.graph.constant(x));
        for derivative in derivatives {
            let magnitude = pass.op(Op::Abs, [derivative]);
            let is_finite = pass.op(Op::Less, [magnitude, infinity]);
            results.push(pass.op(Op::Select, [is_finite, derivative, zero]));
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
