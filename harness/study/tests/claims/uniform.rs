//! Uniform sampling.

use hairis_harness::journal::Journal;
use hairis_harness::subject::ModelKind;
use hairis_instruments::light::Sky;
use hairis_study::claims::bounded::Bounded;
use hairis_study::claims::hair_of;
use hairis_study::claims::uniform::*;
use hairis_study::study::{Plan, Size};

#[test]
fn the_example_is_that_of_the_record() {
    let sky = Sky::default().environment();
    let plan = Plan {
        seed: 3,
        size: Size::Quick,
        lights: (&sky).into(),
        materials: &[],
    };
    let cell = example();
    let [uniform, published] = measured(&plan, &cell, &Journal::default()).expect("accepted");
    let exact = hair_of(&cell, ModelKind::Gaussian)
        .expect("accepted")
        .found();
    let near = |of: Bounded, value: f64| (of.value - value).abs() < 1e-3;
    assert!(
        near(exact.uniform, 0.267) && near(exact.published, 0.302),
        "{exact:?}"
    );
    for (got, want) in [(uniform, exact.uniform), (published, exact.published)] {
        assert!(got.z_score(want.value).abs() < 4.0, "{got:?} {want:?}");
    }
}
