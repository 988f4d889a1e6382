//! Text before the functions of a program: comments, and helpers for the operations that a language lacks.

use super::{Language, prefix};
use crate::program::Program;
use hairis::simd::trace::Target;

/// Names of types and functions that differ between the languages that look like C.
const C: &str = "\
#ifndef HAIRIS_OPERATIONS
#define HAIRIS_OPERATIONS
#if defined(__FAST_MATH__) || defined(__FAST_RELAXED_MATH__) || defined(_M_FP_FAST) || \\
    defined(__ASSOCIATIVE_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error \"hairis: compile without fast math (-ffast-math, /fp:fast), with which results are up to 41 percent off\"
#endif
#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
#define HAIRIS_OPENCL
#pragma OPENCL FP_CONTRACT OFF
#define sqrtf sqrt
#define fabsf fabs
#define fmaf fma
#define exp2f exp2
#define log2f log2
#define HAIRIS_UINT uint
#define HAIRIS_BITS as_uint
#define HAIRIS_NUMBER as_float
#else
#include <math.h>
#include <stdint.h>
#include <string.h>
#define HAIRIS_UINT uint32_t
#define HAIRIS_BITS hairis_bits
#define HAIRIS_NUMBER hairis_number
#endif
// Products and sums round apart. GCC reads no pragma: -ffp-contract=off, or -std=c99.
#if defined(__clang__) && !defined(HAIRIS_OPENCL)
#pragma STDC FP_CONTRACT OFF
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif
// Loops over a function are vectorised where it is inlined.
#if defined(__CUDACC__) && defined(__GNUC__)
#define HAIRIS_FN static __host__ __device__ __forceinline__ __attribute__((unused))
#elif defined(__CUDACC__)
#define HAIRIS_FN static __host__ __device__ __forceinline__
#elif defined(__GNUC__)
#define HAIRIS_FN static inline __attribute__((always_inline, unused))
#elif defined(_MSC_VER)
#define HAIRIS_FN static __forceinline
#else
#define HAIRIS_FN static inline
#endif
#define HAIRIS_MASK int
#if !defined(HAIRIS_OPENCL)
HAIRIS_FN uint32_t hairis_bits(float a) { uint32_t b; memcpy(&b, &a, sizeof b); return b; }
HAIRIS_FN float hairis_number(uint32_t b) { float a; memcpy(&a, &b, sizeof a); return a; }
#endif
typedef struct HairisVec3 { float x, y, z; } HairisVec3;
HAIRIS_FN HairisVec3 hairis_vec3(float x, float y, float z) { HairisVec3 a; a.x = x; a.y = y; a.z = z; return a; }
#endif
";
const GLSL: &str = "\
#ifndef HAIRIS_OPERATIONS
#define HAIRIS_OPERATIONS
// Fragment shaders of ES have no precision for float, and 16 bits for uint.
#ifdef GL_ES
precision highp float;
precision highp int;
#endif
#define HAIRIS_FN
#define HAIRIS_MASK bool
#define HAIRIS_UINT uint
#define HAIRIS_BITS floatBitsToUint
#define HAIRIS_NUMBER uintBitsToFloat
#endif
";
const HLSL: &str = "\
#ifndef HAIRIS_OPERATIONS
#define HAIRIS_OPERATIONS
#define HAIRIS_FN
#define HAIRIS_MASK bool
#define HAIRIS_UINT uint
#define HAIRIS_BITS asuint
#define HAIRIS_NUMBER asfloat
#endif
";
const MSL: &str = "\
#ifndef HAIRIS_OPERATIONS
#define HAIRIS_OPERATIONS
#include <metal_stdlib>
using namespace metal;
#define HAIRIS_FN static inline
#define HAIRIS_MASK bool
#define HAIRIS_UINT uint
#define HAIRIS_BITS as_type<uint>
#define HAIRIS_NUMBER as_type<float>
#endif
";
const SLANG: &str = "\
#ifndef HAIRIS_OPERATIONS
#define HAIRIS_OPERATIONS
#define HAIRIS_FN
#define HAIRIS_MASK bool
#define HAIRIS_UINT uint
#define HAIRIS_BITS asuint
#define HAIRIS_NUMBER asfloat
#ifndef HAIRIS_PRECISE
#define HAIRIS_PRECISE
#endif
#endif
";

/// Choices of C, whose compilers preserve NaN.
const CHOICES_C: &str = "\
// The second operand where either is NaN.
HAIRIS_FN float $pmin(float a, float b) { return a < b ? a : b; }
HAIRIS_FN float $pmax(float a, float b) { return a > b ? a : b; }
";
/// Choices for languages whose drivers may take a comparison with NaN for true, and turn a choice by a comparison into an instruction
/// that loses NaN.
const CHOICES: &str = "\
HAIRIS_FN HAIRIS_MASK $pis_number(float a) { return (HAIRIS_BITS(a) & 0x7fffffffu) <= 0x7f800000u; }
// The second operand where either is NaN.
HAIRIS_FN float $pmin(float a, float b) { return $pis_number(b) ? (a < b ? a : b) : b; }
HAIRIS_FN float $pmax(float a, float b) { return $pis_number(b) ? (a > b ? a : b) : b; }
";

/// Operations of languages that look like C, in terms of the names above.
const LIKE_C: &str = "\
HAIRIS_FN float $ptimes_sign(float a, float b) {
    return HAIRIS_NUMBER(HAIRIS_BITS(a) ^ (HAIRIS_BITS(b) & 0x80000000u));
}
HAIRIS_FN float $pnegate_if(HAIRIS_MASK m, float a) { return m ? -a : a; }
// A power of two from an integer in the low bits, biased as an exponent is.
HAIRIS_FN float $pshift_left_23(float a) { return HAIRIS_NUMBER(HAIRIS_BITS(a) << 23); }
HAIRIS_FN float $pupper(float a) { return HAIRIS_NUMBER(HAIRIS_BITS(a) & 0xfffff000u); }
// Mantissa from sqrt(1/2) to sqrt(2), and exponent.
HAIRIS_FN HAIRIS_UINT $pexponent_bits(float a) { return (HAIRIS_BITS(a) + 0x004afb0du) >> 23; }
HAIRIS_FN float $pmantissa(float a) {
    return HAIRIS_NUMBER(HAIRIS_BITS(a) + 0x3f800000u - ($pexponent_bits(a) << 23));
}
HAIRIS_FN float $pexponent(float a) { return HAIRIS_NUMBER($pexponent_bits(a) | 0x4b000000u) - 8388735.0f; }
HAIRIS_FN float $pnumber(HAIRIS_UINT bits) { return HAIRIS_NUMBER(bits); }
HAIRIS_FN HAIRIS_MASK $pis_below_infinity(float a) {
    return (HAIRIS_BITS(a) & 0x7fffffffu) < 0x7f800000u || HAIRIS_BITS(a) == 0xff800000u;
}

";

/// Operations whose derivatives Slang's compiler does not find: of bits, of roots, and of numbers that are not finite.
const DERIVATIVES: &str = "\
#ifndef HAIRIS_DERIVATIVE
// Derivatives of `f` in both modes, from `f_by`, which returns the derivative by a number, given that by the result.
#define HAIRIS_DERIVATIVE(f) \\
    [ForwardDerivativeOf(f)] DifferentialPair<float> f##_forward(DifferentialPair<float> a) { return diffPair(f(a.p), f##_by(a.p, a.d)); } \\
    [BackwardDerivativeOf(f)] void f##_backward(inout DifferentialPair<float> a, float d) { a = diffPair(a.p, f##_by(a.p, d)); }
#endif
bool $pis_negative(float a) { return (asuint(a) & 0x80000000u) != 0u; }
float $pmantissa_by(float a, float d) {
    return a > 0.0f && $pis_below_infinity(a) ? d * ($pmantissa(a) / a) : 0.0f;
}
HAIRIS_DERIVATIVE($pmantissa)
float $psqrt(float a) { return sqrt(a); }
float $psqrt_by(float a, float d) { return a < 1e-36f ? 0.0f : d * (0.5f / sqrt(a)); }
HAIRIS_DERIVATIVE($psqrt)
// An argument: the derivative is 0 where it would be infinite or undefined.
float $pfinite(float a) { return a; }
float $pfinite_by(float a, float d) { return (asuint(d) & 0x7fffffffu) < 0x7f800000u ? d : 0.0f; }
HAIRIS_DERIVATIVE($pfinite)

";

const WGSL: &str = "\
fn $pis_number(a: f32) -> bool { return (bitcast<u32>(a) & 0x7fffffffu) <= 0x7f800000u; }
// The second operand where either is NaN, which the instruction of a GPU loses.
fn $pmin(a: f32, b: f32) -> f32 { return select(b, select(b, a, a < b), $pis_number(b)); }
fn $pmax(a: f32, b: f32) -> f32 { return select(b, select(b, a, a > b), $pis_number(b)); }
fn $ptimes_sign(a: f32, b: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(a) ^ (bitcast<u32>(b) & 0x80000000u));
}
fn $pnegate_if(m: bool, a: f32) -> f32 { return select(a, -a, m); }
// A power of two from an integer in the low bits, biased as an exponent is.
fn $pshift_left_23(a: f32) -> f32 { return bitcast<f32>(bitcast<u32>(a) << 23u); }
fn $pupper(a: f32) -> f32 { return bitcast<f32>(bitcast<u32>(a) & 0xfffff000u); }
// Mantissa from sqrt(1/2) to sqrt(2), and exponent.
fn $pexponent_bits(a: f32) -> u32 { return (bitcast<u32>(a) + 0x004afb0du) >> 23u; }
fn $pmantissa(a: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(a) + 0x3f800000u - ($pexponent_bits(a) << 23u));
}
fn $pexponent(a: f32) -> f32 { return bitcast<f32>($pexponent_bits(a) | 0x4b000000u) - 8388735.0; }
fn $pnumber(bits: u32) -> f32 { return bitcast<f32>(bits); }
fn $pis_below_infinity(a: f32) -> bool {
    return (bitcast<u32>(a) & 0x7fffffffu) < 0x7f800000u || bitcast<u32>(a) == 0xff800000u;
}

";

/// Directions, offsets, radiance and weights, which every file states.
pub(super) const CONVENTIONS: [&str; 4] = [
    "Directions are unit vectors in the frame of the fibre and point away from it: x along it from root to tip, y and z across.",
    "wo is towards the viewer, wi towards the light; h is the offset of the hit across the fibre, from -1 to 1.",
    "Outgoing radiance is the integral of value * cos theta_i * incoming radiance over wi, cos theta_i = sqrt(wi.y^2 + wi.z^2).",
    "weight is value * cos theta_i / pdf. Colours are linear RGB.",
];

/// Returns the sentence on the digits of the results.
pub(super) fn bits(language: Language, target: Target) -> &'static str {
    match target {
        Target::Exact if language == Language::Python => {
            "In NumPy, results have the bits of one lane of the Rust library; elsewhere the last digits may differ."
        }
        Target::Exact => {
            "Compiled so that arithmetic keeps its order, results have the bits of one lane of the Rust library."
        }
        Target::Fused => {
            "Compiled so that arithmetic keeps its order, results have the bits of the Rust library's levels that fuse."
        }
        Target::Gpu => {
            "Results differ from those of the Rust library in the last digits: products and sums may fuse."
        }
        Target::GpuNative => {
            "Results differ from those of the Rust library in the last digits: products and sums may fuse, and exp2 and \
             log2 are the target's."
        }
    }
}

/// Returns the comments on the language and the target.
fn notes(language: Language, target: Target) -> String {
    let bits = bits(language, target);
    let language = match language {
        Language::C => {
            "C99, C++, CUDA (for bits: nvcc -fmad=false) and OpenCL C (for bits: -cl-fp32-correctly-rounded-divide-sqrt)."
        }
        Language::Wgsl => "WGSL.",
        Language::Glsl => "GLSL from version 4.00 or 3.20 ES: put it after #version.",
        Language::Hlsl => "HLSL from shader model 5.",
        Language::Msl => {
            "Metal. Compile without fast math (-fno-fast-math, MTLMathModeSafe), or NaN and infinity are not handled."
        }
        Language::Slang => {
            "Slang. For bits: -DHAIRIS_PRECISE=precise, and for SPIR-V -emit-spirv-via-glsl."
        }
        Language::Python => unreachable!("a module of Python has its own head"),
    };
    format!("// {language}\n// {bits}\n")
}

/// Returns the text before the functions: comments, and the operations that the language lacks.
pub(super) fn head(program: &Program, language: Language) -> String {
    let prefix = prefix(program);
    let (name, layout) = (program.name(), program.layout());
    let upper = prefix.to_uppercase();
    let material = program.material().len();
    let mut text = format!(
        "// Generated by hairis {} from its model {name}. Do not edit.\n{}\
         //\n// {}\n//\n\
         // Comments in functions say what the operations below them compute.\n\n",
        env!("CARGO_PKG_VERSION"),
        notes(language, program.target()),
        CONVENTIONS.join("\n// "),
    );
    let constants = match language {
        Language::Wgsl => format!(
            "// Version of the layout of materials and shading points, and floats in a material.\n\
             const {upper}LAYOUT: u32 = 0x{layout:08x}u;\nconst {upper}MATERIAL_FLOATS: u32 = {material}u;\n\n"
        ),
        Language::Slang => format!(
            "// Version of the layout of materials and shading points, and floats in a material.\n\
             static const uint {upper}LAYOUT = 0x{layout:08x}u;\nstatic const uint {upper}MATERIAL_FLOATS = {material}u;\n\n"
        ),
        _ => format!(
            "// Version of the layout of materials and shading points, and floats in a material.\n\
             #define {upper}LAYOUT 0x{layout:08x}u\n#define {upper}MATERIAL_FLOATS {material}\n\n"
        ),
    };
    if language == Language::C {
        text += &format!("#ifndef {upper}H\n#define {upper}H\n");
    }
    text += match language {
        Language::C => C,
        Language::Wgsl => "",
        Language::Glsl => GLSL,
        Language::Hlsl => HLSL,
        Language::Msl => MSL,
        Language::Slang => SLANG,
        Language::Python => unreachable!("a module of Python has its own head"),
    };
    text += &constants;
    let operations = match language {
        Language::C => [CHOICES_C, LIKE_C, ""],
        Language::Wgsl => [WGSL, "", ""],
        Language::Slang => [CHOICES, LIKE_C, DERIVATIVES],
        _ => [CHOICES, LIKE_C, ""],
    };
    text + &operations.concat().replace("$p", &prefix)
}
