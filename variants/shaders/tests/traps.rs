//! Traps of translated arithmetic, and for each the test that would fail.
//!
//! | trap | test |
//! |---|---|
//! | compilers take sums apart, and a bell is up to 41% off | `text_avoids_what_compilers_do`, `plain_shaders_have_the_accuracy_of_one_lane` (WGSL), `fast_math_is_refused` (C) |
//! | XLA takes sums apart, and frameworks pass derivatives through a step | `text_avoids_what_compilers_do`, `.ci/frameworks.py` |
//! | reverse mode multiplies the infinite slope of a branch that is not taken by 0 | hostile hits of `.ci/frameworks.py` |
//! | Slang's derivative of a root is wrong below 1e-7, and bits have none | `derivatives_of_slang_are_those_of_differences` |
//! | Slang passes `precise` on to WGSL, which has no such word | `slang_compiles_to_every_language` |
//! | NumPy 1 takes numbers of Python for double, NumPy reads text | `arguments_of_python_broadcast_and_bad_ones_are_named` |
//! | a product with 0 is taken for 0, and NaN is lost | `plain_shaders_have_the_accuracy_of_one_lane` |
//! | a GPU's `min` loses NaN, and drivers take a choice by a comparison for it; they take `h < 1 or -1 < h` for true | `text_avoids_what_compilers_do`, and on a GPU `plain_shaders_have_the_accuracy_of_one_lane` |
//! | a GPU divides and takes roots with errors, and flushes denormals | `spirv_keeps_the_order_of_arithmetic`, and on a GPU `shaders_that_keep_their_order_have_the_bits_of_one_lane` |
//! | nvcc contracts, and warns of functions that nobody calls | `cuda_has_the_bits_of_one_lane` |
//! | `fma` rounds twice | `differences_of_products_survive_split_fma`, `shaders_that_keep_their_order_have_the_bits_of_one_lane` |
//! | products and sums are contracted | `contraction_is_found`, `clang_keeps_products_and_sums_apart`, `spirv_keeps_the_order_of_arithmetic` |
//! | WGSL has no infinity, and leaves the operand open that `min` and `max` return for NaN | `text_avoids_what_compilers_do`, `every_operation_is_right_on_a_driver` |
//! | Metal, CUDA and `OpenCL` need flags | `compilers_with_flags_are_named` |
//! | a host needs Rust for a material | `the_example_of_the_readme_runs`, `single_precision_has_the_constants_of_the_library` |
//! | names are an interface | `the_layout_has_a_version`, `a_renamed_number_is_another_layout` |
//! | the whole is large | `fewer_results_take_fewer_operations`, `operations_are_those_recorded` |
//! | loops are unrolled | `functions_are_straight_lines`, `operations_are_those_recorded` |
//! | Tint reads no decimal above the largest float | `literals_are_exact` |

use crate::languages::with_gradients;
use crate::support::every_model;
use hairis_shaders::{Function, Language, Program, Target, print};
use hairis_variants::{KajiyaKay, Registered};

fn check_straight_line<M: Registered>() {
    let program = with_gradients::<M>(Target::Gpu);
    for language in Language::ALL {
        let text = print(&program, language);
        for word in ["for (", "for(", "while", "if (", "goto", "switch"] {
            let mut lines = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            let line = lines.find(|line| line.contains(word));
            assert_eq!(line, None, "{} in {language:?}", program.name());
        }
    }
}

/// Functions have no branch and no loop, so that the lanes of a GPU stay together and a compiler vectorises a loop over a function.
#[test]
fn functions_are_straight_lines() {
    every_model!(check_straight_line);
}

/// The file itself names the flags of compilers that contract or reorder arithmetic by default.
#[test]
fn compilers_with_flags_are_named() {
    let program = Program::of::<KajiyaKay>(Target::Exact);
    for (language, words) in [
        (
            Language::C,
            &[
                "nvcc -fmad=false",
                "-cl-fp32-correctly-rounded-divide-sqrt",
                "#pragma OPENCL FP_CONTRACT OFF",
                "#pragma STDC FP_CONTRACT OFF",
                "#pragma fp_contract(off)",
            ][..],
        ),
        (Language::Msl, &["-fno-fast-math", "precise::sqrt("]),
    ] {
        let text = print(&program, language);
        for word in words {
            assert!(text.contains(word), "{language:?}: {word}");
        }
    }
}

/// A function of fewer results never has more operations than the whole.
#[test]
fn every_field_alone_takes_fewer_operations() {
    let program = Program::of::<KajiyaKay>(Target::Gpu);
    for function in program.functions() {
        for field in &function.output().fields {
            let alone = function.only(&[&field.name]);
            let count = alone.as_ref().map_or(usize::MAX, Function::operations);
            assert!(
                count <= function.operations(),
                "{} {}",
                function.name(),
                field.name
            );
        }
    }
}
