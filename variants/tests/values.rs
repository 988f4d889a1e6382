//! Values of fields as a host sets them, by name and by index.

use hairis::HairParams;
use hairis_variants::{
    ChiangParams, DEonParams, FieldError, KajiyaKayParams, ModelId, Parameters, Values,
};

#[test]
fn a_wrong_name_count_or_word_is_an_error() {
    let mut values = KajiyaKayParams::default().values();
    let before = values;
    assert_eq!(values.set("kx", &[0.1]), Err(FieldError::Name));
    assert_eq!(values.set("kd", &[0.1]), Err(FieldError::Count(3)));
    assert_eq!(values.set_at(99, &[0.1]), Err(FieldError::Name));
    assert_eq!(values.set_word("kd", "red"), Err(FieldError::Word(&[])));
    let words = &["reciprocal", "published"];
    assert_eq!(values.set_word("form", "new"), Err(FieldError::Word(words)));
    assert_eq!(values.set_word("forms", "new"), Err(FieldError::Name));
    assert_eq!(values, before, "a refusal changes nothing");
    assert_eq!(
        FieldError::Word(words).to_string(),
        r#"the field must be one of ["reciprocal", "published"]"#
    );
    assert_eq!(values.set("kd", &[0.1, 0.2, 0.3]), Ok(()));
    assert_eq!(values.set_word("form", "published"), Ok(()));
    assert_eq!(
        (values.numbers("kd"), values.word("form")),
        (&[0.1, 0.2, 0.3][..], words[1])
    );
}

#[test]
fn an_index_finds_what_a_name_does() {
    for id in ModelId::ALL {
        for (_, values) in id.presets() {
            for (index, field) in id.fields().iter().enumerate() {
                assert_eq!(values.index(field.name), Some(index));
                assert_eq!(values.numbers_at(index), values.numbers(field.name));
                assert_eq!(values.has_at(index), values.has(field.name));
            }
        }
    }
}

#[test]
fn a_field_takes_the_others_of_its_group_away() {
    let group = ["sigma_a", "melanin", "melanin_amount", "color"];
    let mut values: Values = ChiangParams::default().values();
    for name in group.into_iter().chain(group) {
        let count = values.numbers(name).len();
        values.set(name, &vec![0.5; count]).unwrap();
        let given: Vec<&str> = group.into_iter().filter(|name| values.has(name)).collect();
        assert_eq!(given, [name]);
    }
    assert!(
        values.has("beta_m") && values.has("shifts"),
        "the rest stays"
    );
}

#[test]
fn every_model_is_scaled() {
    fn twice<P: Parameters>(fields: &[&str]) {
        // The last preset is not the default.
        let params = P::PRESETS[P::PRESETS.len() - 1].1;
        let (before, after) = (params.values(), params.scaled(0.5).unwrap().values());
        for field in P::FIELDS {
            let by = if fields.contains(&field.name) {
                0.5
            } else {
                1.0
            };
            let expected: Vec<f32> = before.numbers(field.name).iter().map(|x| x * by).collect();
            assert_eq!(after.numbers(field.name), expected, "{}", field.name);
        }
        for factor in [-1.0, f32::NAN, f32::INFINITY] {
            let refused = params.scaled(factor).unwrap_err();
            assert_eq!(refused.field(), "factor");
        }
    }
    twice::<HairParams>(&["i_r", "i_tt", "i_trt"]);
    twice::<KajiyaKayParams>(&["kd", "ks"]);
    twice::<ChiangParams>(&[]);
    twice::<DEonParams>(&[]);
}

#[test]
fn values_with_equal_fields_are_equal() {
    let color = [0.5, 0.4, 0.3];
    let fresh = Values::none(ChiangParams::FIELDS).with("color", &color);
    let replaced = Values::none(ChiangParams::FIELDS).with("sigma_a", &[1.0; 3]);
    assert_eq!(replaced.with("color", &color), fresh);
    assert_ne!(replaced.with("color", &[0.5, 0.4, 0.2]), fresh);
    assert_ne!(fresh.without("color"), fresh);
    assert_ne!(
        Values::<f32>::none(KajiyaKayParams::FIELDS),
        Values::none(ChiangParams::FIELDS)
    );
}

/// Ranges of random numbers are those that their declarations say, in the unit of the declaration.
#[test]
fn random_tilts_are_in_degrees() {
    let tilt = ChiangParams::FIELDS[2];
    assert_eq!((tilt.name, tilt.unit), ("tilt", "rad"));
    let draw = tilt.draw.unwrap();
    assert_eq!([draw.least, draw.most], [-5.0, 5.0]);
    assert!((draw.unit - 1.0_f32.to_radians()).abs() < 1e-9);
}
