//! Table of operations per language. In a template, `$a`, `$b` and `$c` stand for the operands, and `$p` for the prefix of the names of
//! the model's helpers: in Python the object `o` of a framework.

use super::Language;
use hairis::simd::trace::Op;

/// Form of the operands of an operation, where a language needs another template for it.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Form {
    /// No property of the operands is known.
    Any,
    /// The operand at this place is a constant from 2^23 on, so that a sum with it rounds to an integer. Compilers that reassociate sums
    /// undo the rounding: `magic - (magic + x)` becomes `-x`, and every bell is up to `sqrt(2)` off.
    Rounds(usize),
    /// A comparison with infinity: WGSL has no literal for it, and fast arithmetic takes such a comparison for true.
    BelowInfinity,
    /// The second operand is a constant, and therefore not NaN.
    Limit,
}

/// Returns the template of an operation.
pub(super) fn template(language: Language, op: Op, form: Form) -> &'static str {
    use Language::{C, Glsl, Hlsl, Msl, Python, Slang, Wgsl};
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
            (Slang, Op::Add, 0) => return "$a + no_diff round($b)",
            (Slang, Op::Add, 1) => return "no_diff round($a) + $b",
            (Slang, Op::MulAdd, 2) => return "no_diff round($a * $b) + $c",
            (Python, Op::Add, 0) => return "$prounded($a, $b)",
            (Python, Op::Add, 1) => return "$prounded($b, $a)",
            (Python, Op::MulAdd, 2) => return "$prounded($c, $a * $b)",
            _ => {}
        }
    }
    match (language, op) {
        (Python, Op::Less) => "$a < $b",
        (Python, Op::MulAdd) => "$pfma($a, $b, $c)",
        (Python, Op::Exp2) => "$pexp2($a)",
        (Python, Op::Log2) => "$plog2($a)",
        (Python, Op::Sqrt) => "$psqrt($a)",
        (Python, Op::Abs) => "$pabs($a)",
        (Python, Op::Not) => "~$a",
        (Python, Op::Select) => "$pselect($a, $b, $c)",
        (C, Op::Less) if form == Form::BelowInfinity => "$a <= 3.40282347e+38f",
        (_, Op::Less) if form == Form::BelowInfinity => "$pis_below_infinity($a)",
        (_, Op::Constant(_)) => unreachable!("constants are literals"),
        (_, Op::Add) => "$a + $b",
        (_, Op::Sub) => "$a - $b",
        (_, Op::Mul) => "$a * $b",
        (_, Op::Div) => "$a / $b",
        (_, Op::Neg) => "-$a",
        (C, Op::MulAdd) => "fmaf($a, $b, $c)",
        // Slang's derivative of a root is that at 1e-7 for smaller numbers. Its `?` and `&&` are branches.
        (Slang, Op::Sqrt) => "$psqrt($a)",
        (Slang, Op::Min) if form == Form::Limit => "select($a < $b, $a, $b)",
        (Slang, Op::Max) if form == Form::Limit => "select($a > $b, $a, $b)",
        (Slang, Op::Min) => "select(and($pis_number($b), $a < $b), $a, $b)",
        (Slang, Op::Max) => "select(and($pis_number($b), $a > $b), $a, $b)",
        (Slang, Op::TimesSign) => "select($pis_negative($b), -$a, $a)",
        (Slang, Op::NegateIf) => "select($a, -$b, $b)",
        (Slang, Op::ShiftLeft23) => "no_diff $pshift_left_23($a)",
        // The low half, which is the difference, has the derivative of the whole.
        (Slang, Op::Upper) => "no_diff $pupper($a)",
        (Slang, Op::Exponent) => "no_diff $pexponent($a)",
        (Slang, Op::And) => "and($a, $b)",
        (Slang, Op::Or) => "or($a, $b)",
        (Slang, Op::Select) => "select($a, $b, $c)",
        // HLSL's `fma` takes only doubles.
        (Hlsl | Slang, Op::MulAdd) => "mad($a, $b, $c)",
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
        // Not the functions of the language, which leave open which operand they return for NaN. A GPU has them as one instruction, which
        // returns the other operand if one is NaN. Drivers also use this instruction for a choice by a comparison.
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
        (C | Wgsl | Python, Op::And) => "$a & $b",
        (Glsl | Hlsl | Msl, Op::And) => "$a && $b",
        (C | Wgsl | Python, Op::Or) => "$a | $b",
        (Glsl | Hlsl | Msl, Op::Or) => "$a || $b",
        (_, Op::Not) => "!$a",
        (Wgsl, Op::Select) => "select($c, $b, $a)",
        (_, Op::Select) => "$a ? $b : $c",
    }
}

/// Returns a template filled in with its operands.
pub(super) fn write_template(template: &str, prefix: &str, operands: &[String]) -> String {
    let mut text = template.replace("$p", prefix);
    for (name, operand) in ["$a", "$b", "$c"].iter().zip(operands) {
        text = text.replace(name, operand);
    }
    text
}
