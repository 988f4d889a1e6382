//! Tests of `hair`.

use hairis_render::hair::{Choice, Energy, GLOSSY, UNIFORM, samplers};
use hairis_variants::ModelId;

#[test]
fn every_model_sampler_and_preset_is_found() {
    for id in ModelId::ALL {
        let mut words = samplers(id.name());
        words.sort_unstable();
        assert!(
            words.windows(2).all(|pair| pair[0] != pair[1]),
            "each word once: {words:?}"
        );
        for sampler in words {
            for (preset, values) in id.presets() {
                let choice = Choice::find(id.name(), sampler, preset).expect("listed");
                assert_eq!(choice.id.name(), id.name());
                for field in values.fields() {
                    assert_eq!(
                        choice.values.numbers(field.name),
                        values.numbers(field.name)
                    );
                }
                choice.hair(Energy::Scaled).expect("in range");
            }
        }
    }
    assert!(Choice::find("cauchy", "matched", GLOSSY).is_ok());
}

#[test]
fn what_there_is_not_is_named() {
    let message = |model, sampler, preset| {
        Choice::find(model, sampler, preset)
            .expect_err("refused")
            .to_string()
    };
    assert!(
        message("phong", UNIFORM, "blond").contains("kajiya-kay")
            && message("phong", UNIFORM, "blond").contains("phong")
    );
    assert!(message("gaussian", "best", "blond").contains("published, matched"));
    assert!(message("gaussian", UNIFORM, "green").contains("glossy"));
    assert!(
        !message("chiang", UNIFORM, "glossy").contains("black, glossy"),
        "chiang has no glossy preset"
    );
}
