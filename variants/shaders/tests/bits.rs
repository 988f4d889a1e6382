//! Tests that the graph has the bits of the model.

use crate::support::{Case, differing, every_model, fusing_level};
use hairis_conformance::cases;
use hairis_shaders::{Call, Program, Rounding, Target};
use hairis_variants::{ModelId, Registered, Visitor};

fn check_one_lane<M: Registered>() {
    let program = Program::of::<M>(Target::Exact);
    let cases = Case::<M>::many(cases(2048), 39);
    for call in Call::ALL {
        let function = program.function(call);
        let (mut got, mut expected) = (Vec::new(), Vec::new());
        for case in &cases {
            got.extend(function.run(&case.arguments(call), Rounding::Once));
            expected.push(case.results(call));
        }
        if call == Call::EvalHit {
            let black = expected
                .iter()
                .filter(|results| **results == [0.0; 4])
                .count();
            let share = 16 * black / cases.len();
            assert!(
                (1..10).contains(&share),
                "{black} of {} cases are black",
                cases.len()
            );
        }
        let count = differing(function, &got, &expected);
        let name = function.name();
        assert_eq!(count, 0, "{} {name}: cases that differ", program.name());
    }
}

#[test]
fn graphs_have_the_bits_of_one_lane() {
    every_model!(check_one_lane);
}

fn check_fusing_level<M: Registered>() {
    let Some(level) = fusing_level() else {
        return println!("this CPU has no level that fuses");
    };
    let program = Program::of::<M>(Target::Fused);
    let cases = Case::<M>::many(cases(2048), 40);
    let function = program.function(Call::EvalSampleHit);
    let (eights, _) = cases.as_chunks::<8>();
    let (mut got, mut expected) = (Vec::new(), Vec::new());
    for eight in eights {
        expected.extend(Case::results8(eight, level));
        for case in eight {
            let arguments = case.arguments(Call::EvalSampleHit);
            got.extend(function.run(&arguments, Rounding::Once));
        }
    }
    let count = differing(function, &got, &expected);
    assert_eq!(count, 0, "{}: cases that differ", program.name());
}

#[test]
fn fused_graphs_have_the_bits_of_a_level_that_fuses() {
    every_model!(check_fusing_level);
}

/// `Function::only` keeps the bits of the remaining fields, and takes fewer operations.
#[test]
fn fewer_results_take_fewer_operations() {
    let id = ModelId::find("gaussian", Some("matched")).expect("a model of the list");
    struct Value;
    impl Visitor for Value {
        type Output = ();
        fn visit<M: Registered>(self) {
            let program = Program::of::<M>(Target::Exact);
            let whole = program.function(Call::EvalHit);
            let value = whole.only(&["value"]).expect("a field of the result");
            assert_eq!(value.name(), "eval_hit_value");
            assert!(
                2 * value.operations() < whole.operations(),
                "the sampler is left out"
            );
            for case in Case::<M>::many(64, 41) {
                let arguments = case.arguments(Call::EvalHit);
                let all = whole.run(&arguments, Rounding::Once);
                let some = value.run(&arguments, Rounding::Once);
                assert_eq!(some, all[..3], "the same value");
            }
            assert!(whole.only(&["weight"]).is_none(), "no field of the result");
        }
    }
    id.visit(Value);
}
