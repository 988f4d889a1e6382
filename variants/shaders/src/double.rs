//! Interpreter of functions in double precision, for difference quotients and for errors of single precision.

use crate::function::Function;
use crate::graph::Kind;
use hairis::simd::trace::Op;

impl Function {
    /// Computes the results in double precision, together with the choices on the way: masks, operands of minima, signs, and integers
    /// that numbers are rounded to. If two sets of inputs give the same choices, the function is smooth between them.
    ///
    /// # Panics
    ///
    /// Panics if there are fewer inputs than the function reads.
    #[must_use]
    pub fn run_double(&self, inputs: &[f64]) -> (Vec<f64>, Vec<i64>) {
        let (graph, mut choices) = (self.graph(), Vec::new());
        let mut values: Vec<f64> = Vec::with_capacity(graph.nodes().len());
        for node in graph.nodes() {
            let value = match node.kind {
                Kind::Input(place) => inputs[place as usize],
                Kind::Mask(mask) => truth(mask),
                Kind::Op(op) => {
                    let mut v = [0.0; 3];
                    for (operand, place) in v.iter_mut().zip(node.operands()) {
                        *operand = values[*place as usize];
                    }
                    // Sums with a large constant, which round the other operand to an integer.
                    if matches!(op, Op::Add | Op::MulAdd)
                        && let Some(rounds) = node
                            .operands()
                            .iter()
                            .position(|place| graph.rounds(*place))
                    {
                        let number = match (op, rounds) {
                            (Op::MulAdd, 2) => v[0] * v[1],
                            (Op::Add, rounds) => v[1 - rounds],
                            _ => unreachable!("no factor is as large"),
                        };
                        v[rounds] + number.round_ties_even()
                    } else {
                        apply(op, v)
                    }
                }
            };
            choices.extend(choice(node.kind, value, |i| {
                values[node.operands()[i] as usize]
            }));
            values.push(value);
        }
        let results = self.results().iter().map(|place| values[*place as usize]);
        (results.collect(), choices)
    }
}

fn truth(mask: bool) -> f64 {
    f64::from(u8::from(mask))
}

#[expect(clippy::cast_possible_truncation, reason = "integers")]
fn choice(kind: Kind, value: f64, operand: impl Fn(usize) -> f64) -> Option<i64> {
    let Kind::Op(op) = kind else { return None };
    Some(match op {
        Op::Min | Op::Max => i64::from(operand(0) < operand(1)),
        Op::Abs => i64::from(operand(0) < 0.0),
        Op::TimesSign => i64::from(operand(1).is_sign_negative()),
        Op::ShiftLeft23 => operand(0) as i64,
        Op::Exponent => value as i64,
        op if op.is_mask() => i64::from(value != 0.0),
        _ => return None,
    })
}

/// Returns the exponent of the largest power of two that is at most `sqrt(2)` times the magnitude of the number.
fn exponent(x: f64) -> f64 {
    (x.abs() * core::f64::consts::SQRT_2).log2().floor()
}

fn apply(op: Op, [a, b, c]: [f64; 3]) -> f64 {
    let select = |mask: bool, yes: f64, no: f64| if mask { yes } else { no };
    match op {
        Op::Constant(bits) => f64::from(f32::from_bits(bits)),
        Op::Add => a + b,
        Op::Sub => a - b,
        Op::Mul => a * b,
        Op::Div => a / b,
        Op::Neg => -a,
        Op::MulAdd => a * b + c,
        Op::Exp2 => a.exp2(),
        Op::Log2 => a.log2(),
        Op::Sqrt => a.sqrt(),
        Op::Abs => a.abs(),
        Op::Min => select(a < b, a, b),
        Op::Max => select(a > b, a, b),
        Op::TimesSign => select(b.is_sign_negative(), -a, a),
        Op::NegateIf => select(a != 0.0, -b, b),
        // The argument holds an integer in the low bits of a number from 2^23 on: it is read as a biased exponent.
        Op::ShiftLeft23 => {
            let biased = a - 8_388_608.0;
            select(biased < 0.5, 0.0, (biased - 127.0).exp2())
        }
        Op::Mantissa => a / exponent(a).exp2(),
        Op::Exponent => exponent(a),
        Op::Upper => a,
        Op::Less => truth(a < b),
        Op::AtLeast => truth(a >= b),
        Op::And => a * b,
        Op::Or => a.max(b),
        Op::Not => 1.0 - a,
        Op::Select => select(a != 0.0, b, c),
    }
}
