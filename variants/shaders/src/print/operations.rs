//! Table of operations per language. In a template `$a`, `$b` and `$c` are the operands, and `$p` begins the names of the
//! model's helpers.

use super::Language;
use hairis::simd::trace::Op;

/// Knowledge of the operands.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Form {
    /// Nothing.
    Any,
    /// The operand at this place is a constant from 2^23 on. A sum with it rounds to an integer, which compilers undo that take sums
    /// apart: `magic - (magic + x)` becomes `-x`, and every bell is up to `sqrt(2)` off.
    Rounds(usize),
    /// A comparison with infinity, of which WGSL has none, and which fast arithmetic takes for true.
    BelowInfinity,
    /// The second operand is a constant, and so no NaN.
    Limit,
}

/// Template of an operation.
pub(super) fn template(language: Language, op: Op, form: Form) -> &'static str {
    use Language::{C, Glsl, Hlsl, Msl, Wgsl};
    if language.takes_sums_apart()
        && let Form::Rounds(operand) = form
    {
        match (language, op, operand) {
            (Wgsl, Op::Add, 0) => return "$a + round($b)",
            (Wgsl, Op::Add, 1) => return "round($a) + $b",
            (Wgsl, Op::MulAdd, 2) => return "round($a * $b) + $c",
            (Msl, Op::Add, 0) => return "$a + rint($b)",
            (Msl, Op::Add, 1) => return "rint($a) + $b",
            (Msl, Op::MulAdd, 2) => return "rint($a * $b) + $c",
            _ => {}
        }
    }
    match (language, op) {
        (C, Op::Less) if form == Form::BelowInfinity => "$a <= 3.40282347e+38f",
        (_, Op::Less) if form == Form::BelowInfinity => "$pis_below_infinity($a)",
        (_, Op::Constant(_)) => unreachable!("constants are literals"),
        (_, Op::Add) => "$a + $b",
        (_, Op::Sub) => "$a - $b",
        (_, Op::Mul) => "$a * $b",
        (_, Op::Div) => "$a / $b",
        (_, Op::Neg) => "-$a",
        (C, Op::MulAdd) => "fmaf($a, $b, $c)",
        // That of doubles alone is named fma.
        (Hlsl, Op::MulAdd) => "mad($a, $b, $c)",
        (_, Op::MulAdd) => "fma($a, $b, $c)",
        (C, Op::Exp2) => "exp2f($a)",
        (_, Op::Exp2) => "exp2($a)",
        (C, Op::Log2) => "log2f($a)",
        (_, Op::Log2) => "log2($a)",
        (C, Op::Sqrt) => "sqrtf($a)",
        (Msl, Op::Sqrt) => "precise::sqrt($a)",
        (_, Op::Sqrt) => "sqrt($a)",
        (C, Op::Abs) => "fabsf($a)",
        (_, Op::Abs) => "abs($a)",
        // Never those of the language: which operand they return for NaN is open. A GPU has them as one instruction, which returns
        // the number where the other is NaN, and drivers take it for a choice by a comparison, too.
        (Wgsl, Op::Min) if form == Form::Limit => "select($b, $a, $a < $b)",
        (Wgsl, Op::Max) if form == Form::Limit => "select($b, $a, $a > $b)",
        (Glsl | Hlsl | Msl, Op::Min) if form == Form::Limit => "$a < $b ? $a : $b",
        (Glsl | Hlsl | Msl, Op::Max) if form == Form::Limit => "$a > $b ? $a : $b",
        (_, Op::Min) => "$pmin($a, $b)",
        (_, Op::Max) => "$pmax($a, $b)",
        (_, Op::TimesSign) => "$ptimes_sign($a, $b)",
        (_, Op::NegateIf) => "$pnegate_if($a, $b)",
        (_, Op::ShiftLeft23) => "$pshift_left_23($a)",
        (_, Op::Mantissa) => "$pmantissa($a)",
        (_, Op::Exponent) => "$pexponent($a)",
        (_, Op::Upper) => "$pupper($a)",
        (_, Op::Less) => "$a < $b",
        (_, Op::AtLeast) => "$a >= $b",
        (C | Wgsl, Op::And) => "$a & $b",
        (Glsl | Hlsl | Msl, Op::And) => "$a && $b",
        (C | Wgsl, Op::Or) => "$a | $b",
        (Glsl | Hlsl | Msl, Op::Or) => "$a || $b",
        (_, Op::Not) => "!$a",
        (Wgsl, Op::Select) => "select($c, $b, $a)",
        (_, Op::Select) => "$a ? $b : $c",
    }
}

/// A template with its operands.
pub(super) fn write_template(template: &str, prefix: &str, operands: &[String]) -> String {
    let mut text = template.replace("$p", prefix);
    for (name, operand) in ["$a", "$b", "$c"].iter().zip(operands) {
        text = text.replace(name, operand);
    }
    text
}
