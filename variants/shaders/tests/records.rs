//! Tests of the recorded numbers of operations and of live values per function, which make the growth of a model visible.

use crate::support::every_model;
use hairis::{Gaussian, Published};
use hairis_shaders::{Call, Function, Program, Target};
use hairis_variants::chiang::ScatteringChiang;
use hairis_variants::{Chiang, ModelId, Registered, Visitor, WithDiffuse};
use std::fs;

const RECORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/records/operations.csv");

struct Rows;

impl Visitor for &Rows {
    type Output = String;

    fn visit<M: Registered>(self) -> String {
        let mut rows = String::new();
        for (word, target) in [
            ("exact", Target::Exact),
            ("gpu", Target::Gpu),
            ("gpu-native", Target::GpuNative),
        ] {
            let program = Program::of::<M>(target);
            let hit = program.function(Call::EvalHit);
            let mut functions: Vec<Function> = program.functions().to_vec();
            functions.extend(hit.only(&["value"]));
            functions.push(hit.gradient());
            for function in functions {
                let (name, call) = (program.name(), function.name());
                let (operations, waiting) = (function.operations(), function.waiting());
                let layout = program.layout();
                rows += &format!("{name},{word},{call},{operations},{waiting},{layout:08x}\n");
            }
        }
        rows
    }
}

/// Compares the counts with the record, or writes the record if `HAIRIS_RECORD=write` is in the environment.
#[test]
fn operations_are_those_recorded() {
    let mut text = "model,arithmetic,function,operations,waiting,layout\n".to_owned();
    for id in ModelId::ALL {
        text += &id.visit(&Rows);
    }
    if ModelId::find("chiang-diffuse", None).is_none() {
        text += &(&Rows).visit::<WithDiffuse<Published<Gaussian>>>();
        text += &(&Rows).visit::<WithDiffuse<Chiang>>();
        text += &(&Rows).visit::<ScatteringChiang>();
    }
    if std::env::var("HAIRIS_RECORD").is_ok_and(|word| word == "write") {
        fs::write(RECORD, &text).expect("the folder is ours");
    }
    let recorded = fs::read_to_string(RECORD).expect("the record is here");
    for (now, recorded) in text.lines().zip(recorded.lines()) {
        assert_eq!(
            now, recorded,
            "write the record: HAIRIS_RECORD=write cargo test -p hairis-shaders --features spirv operations"
        );
    }
    assert_eq!(text.lines().count(), recorded.lines().count());
}

fn check_shared<M: Registered>() {
    for target in [Target::Exact, Target::Gpu] {
        let program = Program::of::<M>(target);
        let count = |call| program.function(call).operations();
        let (prepare, eval) = (count(Call::Prepare), count(Call::Eval));
        assert!(count(Call::EvalHit) <= prepare + eval, "no operation twice");
        let both = count(Call::EvalSampleHit);
        assert!(
            both < count(Call::EvalHit) + count(Call::SampleHit),
            "the hit is shared"
        );
    }
}

#[test]
fn fused_calls_share_operations() {
    every_model!(check_shared);
}
