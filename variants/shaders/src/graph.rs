//! Graph recorded while a model is traced: operations in the order of their computation, each recorded once.

use core::cell::{Cell, RefCell};
use core::panic::Location;
use hairis::simd::trace::{Op, Recorder, Target, Traced};
use std::collections::HashMap;

/// Kind of a node: an argument, an operation, or a constant mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// An argument of the function, given by its place among the inputs.
    Input(u32),
    /// An operation on the results of earlier nodes, or a constant number.
    Op(Op),
    /// A mask that is the same for all inputs.
    Mask(bool),
}

/// Node of a graph, with the places of the nodes that it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Node {
    /// Kind of the node, which determines how many operands are read.
    pub kind: Kind,
    /// Operands, of which the first are used: as many as the operation reads.
    args: [u32; 3],
}

impl Node {
    /// Returns the places in the graph of the operands; arguments and constants have none.
    #[must_use]
    pub fn operands(&self) -> &[u32] {
        match self.kind {
            Kind::Op(op) => &self.args[..op.arity()],
            Kind::Input(_) | Kind::Mask(_) => &[],
        }
    }

    /// Returns true if the node is computed, which means that it is neither an argument nor a constant.
    #[must_use]
    pub fn is_computed(&self) -> bool {
        !self.operands().is_empty()
    }

    /// Returns true if the value of the node is a mask.
    #[must_use]
    pub fn is_mask(&self) -> bool {
        match self.kind {
            Kind::Op(op) => op.is_mask(),
            Kind::Mask(_) => true,
            Kind::Input(_) => false,
        }
    }
}

/// Value of a node: a number or a mask.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value {
    Number(f32),
    Mask(bool),
}

impl Value {
    pub(crate) fn number(self) -> f32 {
        match self {
            Self::Number(x) => x,
            Self::Mask(_) => unreachable!("a number was recorded here"),
        }
    }
    fn mask(self) -> bool {
        match self {
            Self::Mask(x) => x,
            Self::Number(_) => unreachable!("a mask was recorded here"),
        }
    }
}

/// Rounding of [`Op::MulAdd`], which targets may compute in one or two steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// Rounds once, because the operation fuses.
    Once,
    /// Rounds twice, because the target may split the operation.
    Twice,
}

/// Computes the result of an operation, with the bits of one lane.
pub(crate) fn apply(op: Op, v: &[Value], rounding: Rounding) -> Value {
    let a = || v[0].number();
    let b = || v[1].number();
    let number = Value::Number;
    let bits = |x: u32| number(f32::from_bits(x));
    match op {
        Op::Constant(x) => bits(x),
        Op::Add => number(a() + b()),
        Op::Sub => number(a() - b()),
        Op::Mul => number(a() * b()),
        Op::Div => number(a() / b()),
        Op::Neg => number(-a()),
        Op::MulAdd => number(match rounding {
            Rounding::Once => a().mul_add(b(), v[2].number()),
            Rounding::Twice => a() * b() + v[2].number(),
        }),
        Op::Exp2 => number(a().exp2()),
        Op::Log2 => number(a().log2()),
        Op::Sqrt => number(a().sqrt()),
        Op::Abs => number(a().abs()),
        Op::Min => number(if a() < b() { a() } else { b() }),
        Op::Max => number(if a() > b() { a() } else { b() }),
        Op::TimesSign => bits(a().to_bits() ^ (b().to_bits() & (1 << 31))),
        Op::NegateIf => bits(b().to_bits() ^ (u32::from(v[0].mask()) << 31)),
        Op::ShiftLeft23 | Op::Mantissa | Op::Exponent | Op::Upper => number(
            op.of_bits(a().to_bits())
                .expect("the operation takes bits apart"),
        ),
        Op::Less => Value::Mask(a() < b()),
        Op::AtLeast => Value::Mask(a() >= b()),
        Op::And => Value::Mask(v[0].mask() & v[1].mask()),
        Op::Or => Value::Mask(v[0].mask() | v[1].mask()),
        Op::Not => Value::Mask(!v[0].mask()),
        Op::Select => v[if v[0].mask() { 1 } else { 2 }],
    }
}

/// Place in the model that an operation was recorded at.
#[derive(Clone, Copy, Debug, Default)]
pub struct Origin {
    /// Purpose, as the model states it for this operation and the ones that follow.
    pub stage: Option<&'static str>,
    /// Line of the source that first requested the operation; `None` for inputs, constants and derivatives.
    pub line: Option<&'static Location<'static>>,
}

/// Graph of nodes, none of which occurs twice. Operands come before the nodes that read them.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    origins: Vec<Origin>,
    /// Stage that is recorded with the operations that are added next.
    stage: Option<&'static str>,
    known: HashMap<Node, u32>,
}

impl Graph {
    /// Returns all nodes in the order in which they are computed.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Returns the node at a place, as [`Node::operands`] and [`Function::results`](crate::Function::results) give it.
    #[must_use]
    pub fn node(&self, place: u32) -> &Node {
        &self.nodes[place as usize]
    }

    /// Returns the stage and the line of the model that recorded the node at a place.
    #[must_use]
    pub fn origin(&self, place: u32) -> Origin {
        self.origins[place as usize]
    }

    /// Returns, for each node, whether the node is at one of these places or is read on the way to one of them.
    ///
    /// # Panics
    ///
    /// Panics if the graph has no node at one of these places.
    #[must_use]
    pub fn needed(&self, places: &[u32]) -> Vec<bool> {
        let mut is_needed = vec![false; self.nodes.len()];
        for place in places {
            is_needed[*place as usize] = true;
        }
        for (place, node) in self.nodes.iter().enumerate().rev() {
            if is_needed[place] {
                for operand in node.operands() {
                    is_needed[*operand as usize] = true;
                }
            }
        }
        is_needed
    }

    /// Sets the stage that is recorded with the operations that are added next.
    pub(crate) fn set_stage(&mut self, sentence: &'static str) {
        self.stage = Some(sentence);
    }

    /// Returns the number at a place if the node is a constant number.
    #[must_use]
    pub fn number(&self, place: u32) -> Option<f32> {
        match self.node(place).kind {
            Kind::Op(Op::Constant(bits)) => Some(f32::from_bits(bits)),
            _ => None,
        }
    }

    /// Returns true if adding the node at a place rounds to an integer: it is a constant from 2^23 up to, but below, 2^24.
    #[must_use]
    pub fn rounds(&self, place: u32) -> bool {
        let integers = 8_388_608.0..16_777_216.0;
        self.number(place).is_some_and(|x| integers.contains(&x))
    }

    /// Returns the place of the number that the mask at a place tests for NaN. Such a mask is set for every number except NaN: it is the
    /// disjunction of "below one constant" and "above a smaller constant".
    #[must_use]
    pub fn tested_number(&self, place: u32) -> Option<u32> {
        let less = |place: u32| {
            let node = &self.nodes[place as usize];
            (node.kind == Kind::Op(Op::Less)).then_some(&node.args)
        };
        let node = self.node(place);
        if node.kind != Kind::Op(Op::Or) {
            return None;
        }
        let [one, other] = [less(node.args[0])?, less(node.args[1])?];
        let ways = [[one, other], [other, one]];
        ways.into_iter()
            .find_map(|[[below, high, _], [low, above, _]]| {
                let is_any = self.number(*low)? < self.number(*high)?;
                (below == above && is_any).then_some(*below)
            })
    }

    fn mask(&self, place: u32) -> Option<bool> {
        match self.node(place).kind {
            Kind::Mask(mask) => Some(mask),
            _ => None,
        }
    }

    /// Returns the place of an equal node, or adds the node.
    fn push(&mut self, node: Node, origin: Origin) -> u32 {
        if let Some(known) = self.known.get(&node) {
            return *known;
        }
        let place = u32::try_from(self.nodes.len()).expect("a graph has less than 2^32 nodes");
        self.nodes.push(node);
        self.origins.push(origin);
        self.known.insert(node, place);
        place
    }

    /// Adds the argument at `place` of a function.
    pub(crate) fn input(&mut self, place: u32) -> u32 {
        let kind = Kind::Input(place);
        self.push(Node { kind, args: [0; 3] }, Origin::default())
    }

    /// Adds a constant number.
    pub(crate) fn constant(&mut self, x: f32) -> u32 {
        let kind = Kind::Op(Op::Constant(x.to_bits()));
        self.push(Node { kind, args: [0; 3] }, Origin::default())
    }

    fn constant_mask(&mut self, mask: bool) -> u32 {
        let kind = Kind::Mask(mask);
        self.push(Node { kind, args: [0; 3] }, Origin::default())
    }

    /// Adds a node of another graph, whose operands are at `args` in this one.
    pub(crate) fn copy(&mut self, node: &Node, args: [u32; 3], origin: Origin) -> u32 {
        let kind = node.kind;
        self.push(Node { kind, args }, origin)
    }

    /// Adds an operation. Constant results are computed, and operations that change no bit of a number are left out. NaN stays NaN.
    pub(crate) fn op(
        &mut self,
        op: Op,
        args: [u32; 3],
        line: Option<&'static Location<'static>>,
    ) -> u32 {
        if let Op::Constant(bits) = op {
            return self.constant(f32::from_bits(bits));
        }
        let mut node = Node {
            kind: Kind::Op(op),
            args: [0; 3],
        };
        node.args[..op.arity()].copy_from_slice(&args[..op.arity()]);
        if let Some(values) = self.constants(node.operands()) {
            return match apply(op, &values, Rounding::Once) {
                Value::Number(x) => self.constant(x),
                Value::Mask(x) => self.constant_mask(x),
            };
        }
        if let Some(place) = self.folded(op, node.args) {
            return place;
        }
        if matches!(op, Op::Add | Op::Mul | Op::MulAdd | Op::And | Op::Or) {
            node.args[..2].sort_unstable();
        }
        let stage = self.stage;
        self.push(node, Origin { stage, line })
    }

    fn constants(&self, places: &[u32]) -> Option<Vec<Value>> {
        let constant = |place: &u32| {
            let number = self.number(*place).map(Value::Number);
            number.or_else(|| self.mask(*place).map(Value::Mask))
        };
        places.iter().map(constant).collect()
    }

    /// Returns the node that already has the value of an operation.
    fn folded(&mut self, op: Op, [a, b, c]: [u32; 3]) -> Option<u32> {
        let is = |graph: &Self, place: u32, x: f32| {
            graph.number(place).map(f32::to_bits) == Some(x.to_bits())
        };
        let twice = |graph: &Self| graph.node(a).kind == Kind::Op(op);
        match op {
            Op::Mul if is(self, a, 1.0) => Some(b),
            Op::Mul | Op::Div if is(self, b, 1.0) => Some(a),
            Op::Sub if is(self, b, 0.0) => Some(a),
            Op::Add if is(self, b, -0.0) => Some(a),
            Op::Add if is(self, a, -0.0) => Some(b),
            // Comparisons with NaN are false.
            Op::AtLeast | Op::Less
                if [a, b]
                    .iter()
                    .any(|x| self.number(*x).is_some_and(f32::is_nan)) =>
            {
                Some(self.constant_mask(false))
            }
            Op::Neg | Op::Not if twice(self) => Some(self.node(a).operands()[0]),
            Op::Select if b == c => Some(b),
            Op::Select => self.mask(a).map(|mask| if mask { b } else { c }),
            Op::And | Op::Or if a == b => Some(a),
            Op::And | Op::Or => {
                let decides = op == Op::Or;
                match (self.mask(a), self.mask(b)) {
                    (Some(mask), _) => Some(if mask == decides { a } else { b }),
                    (_, Some(mask)) => Some(if mask == decides { b } else { a }),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

thread_local! {
    static GRAPH: RefCell<Graph> = RefCell::default();
    static TARGET: Cell<Target> = const { Cell::new(Target::Exact) };
}

/// Recorder of operations into the graph of this thread.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Tape {}

impl Recorder for Tape {
    fn target() -> Target {
        TARGET.get()
    }
    fn record(op: Op, args: [u32; 3], at: &'static Location<'static>) -> u32 {
        GRAPH.with_borrow_mut(|graph| graph.op(op, args, Some(at)))
    }
    fn stage(sentence: &'static str) {
        GRAPH.with_borrow_mut(|graph| graph.set_stage(sentence));
    }
}

/// Lane that records operations for the target of [`record`].
pub(crate) type Lane = Traced<Tape>;

/// Adds the next argument of the function that is being recorded.
pub(crate) fn input(next: &mut u32) -> Lane {
    let place = *next;
    *next += 1;
    Lane::named(GRAPH.with_borrow_mut(|graph| graph.input(place)))
}

/// Records the operations of `body` for a target. Returns the graph, and the result of `body`.
pub(crate) fn record<T>(target: Target, body: impl FnOnce() -> T) -> (Graph, T) {
    TARGET.set(target);
    GRAPH.set(Graph::default());
    let result = body();
    (GRAPH.take(), result)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph() -> (Graph, [u32; 4]) {
        let mut graph = Graph::default();
        let inputs = [0, 1].map(|place| graph.input(place));
        let masks =
            [[0, 1], [1, 0]].map(|[a, b]| graph.op(Op::Less, [inputs[a], inputs[b], 0], None));
        (graph, [inputs[0], inputs[1], masks[0], masks[1]])
    }

    #[test]
    fn equal_operations_are_one() {
        let (mut graph, [x, y, ..]) = graph();
        let sum = graph.op(Op::Add, [x, y, 0], None);
        assert_eq!(graph.op(Op::Add, [y, x, 9], None), sum, "sums commute");
        let difference = graph.op(Op::Sub, [x, y, 0], None);
        assert_ne!(graph.op(Op::Sub, [y, x, 0], None), difference);
    }

    #[test]
    fn folding_changes_no_bit() {
        let (mut graph, [x, y, m, n]) = graph();
        let [zero, minus_zero, one, nan] =
            [0.0, -0.0, 1.0, f32::NAN].map(|number| graph.constant(number));
        let [yes, no] = [true, false].map(|mask| graph.constant_mask(mask));
        for (op, args, folded) in [
            (Op::Mul, [one, x, 0], x),
            (Op::Mul, [x, one, 0], x),
            (Op::Div, [x, one, 0], x),
            (Op::Sub, [x, zero, 0], x),
            (Op::Add, [x, minus_zero, 0], x),
            (Op::Select, [m, y, y], y),
            (Op::Select, [yes, x, y], x),
            (Op::Select, [no, x, y], y),
            (Op::AtLeast, [x, nan, 0], no),
            (Op::And, [m, yes, 0], m),
            (Op::And, [m, no, 0], no),
            (Op::Or, [m, yes, 0], yes),
            (Op::Or, [no, m, 0], m),
            (Op::And, [n, n, 0], n),
        ] {
            assert_eq!(graph.op(op, args, None), folded, "{op:?} {args:?}");
        }
        // These operations change bits: -0 + 0 is 0, 0 - x is not -x, and NaN * 0 is NaN.
        for (op, args) in [
            (Op::Add, [x, zero, 0]),
            (Op::Sub, [x, minus_zero, 0]),
            (Op::Sub, [zero, x, 0]),
            (Op::Mul, [x, zero, 0]),
        ] {
            let place = graph.op(op, args, None);
            assert_eq!(graph.node(place).kind, Kind::Op(op), "{args:?} is computed");
        }
    }
}
