//! Tests that failures print code that fails again: the files of `pasted` are what failures print, and are compiled here.

use crate::Broken;
use crate::broken::{
    Fiber, MASK_LEAKS, NAN_AT_THE_POLE, NOT_RECIPROCAL, Params, SOUND, WRONG_PACK,
};
use hairis_conformance::proptest::prelude::BoxedStrategy;
use hairis_conformance::{
    AnyMaterial, ErasedSubject, Materials, Outcome, Subject, bounds, is_full, lanes, lobes,
    totality,
};

/// Returns true if the cases are those of which the files of `pasted` have the worst: of the usual seed, in CI's size.
fn is_of_the_files() -> bool {
    std::env::var_os("HAIRIS_SEED").is_none() && is_full()
}

/// Checks that a property fails on a broken model and prints `text`, and that the case fails again
/// when `pasted`, but not on the sound model. With other seeds and sizes, cases differ.
#[track_caller]
fn assert_fails_again(
    property: fn(&dyn ErasedSubject) -> Outcome,
    fault: u32,
    text: &str,
    pasted: fn(Broken) -> Outcome,
    why: &str,
) {
    let failure = property(&Broken(fault)).expect_err("the model breaks the property");
    let code = failure.case.expect("a property of random cases");
    if is_of_the_files() {
        assert_eq!(code, text, "printed, and pasted:\n{code}");
    }
    let again = pasted(Broken(fault)).expect_err("the pasted case fails again");
    assert!(again.message.contains(why), "{again}");
    pasted(Broken(SOUND)).expect("the sound model passes the case");
}

#[test]
fn a_density_that_is_no_number() {
    assert_fails_again(
        totality::results_are_finite,
        NAN_AT_THE_POLE,
        include_str!("pasted/nan_at_the_pole.rs"),
        |subject| include!("pasted/nan_at_the_pole.rs"),
        "density",
    );
}

#[test]
fn a_lane_of_another_material() {
    assert_fails_again(
        lanes::lanes_permute,
        WRONG_PACK,
        include_str!("pasted/wrong_pack.rs"),
        |subject| include!("pasted/wrong_pack.rs"),
        "moved",
    );
}

#[test]
fn a_value_that_is_not_reciprocal() {
    assert_fails_again(
        bounds::eval_is_reciprocal,
        NOT_RECIPROCAL,
        include_str!("pasted/not_reciprocal.rs"),
        |subject| include!("pasted/not_reciprocal.rs"),
        "exchanged",
    );
}

/// Sound fibre that leaks masks only in materials without a name.
struct LeaksUnnamed;

impl Subject for LeaksUnnamed {
    type Model = Fiber;

    fn model(&self) -> Fiber {
        Fiber
    }

    fn materials(&self) -> Materials<Self> {
        Broken(SOUND).materials()
    }

    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<Params>>> {
        Broken(MASK_LEAKS).any_material()
    }
}

#[test]
fn a_material_by_its_fields() {
    let subject = LeaksUnnamed;
    let failure = lobes::masks_select_lobes(&subject).expect_err("masks leak");
    let code = failure.case.expect("a property of random cases");
    if is_of_the_files() {
        assert_eq!(
            code,
            include_str!("pasted/mask_leaks.rs"),
            "printed, and pasted:\n{code}"
        );
    }
    let pasted: Outcome = include!("pasted/mask_leaks.rs");
    let again = pasted.expect_err("the pasted case fails again");
    assert!(again.message.contains("masked lobes scatter"), "{again}");
}
