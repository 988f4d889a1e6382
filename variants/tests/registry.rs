//! The list of models: names, parameters as fields, and handles that answer as those of the model's type do.

use crate::support::{Draws, direction, lanes_of, packet};
use glam::Vec3;
use hairis::params::Rule;
use hairis::simd::Level;
use hairis::{
    Conserving, Gaussian, HairParams, Hit, Hit8, Lobe, LobeMask, Matched, Material, Material8,
    ParamError,
};
use hairis_variants::{
    AnyMaterial8, ChiangDesc, ChiangParams, DEonParams, Field, KajiyaKayParams, Kind, ModelId,
    Parameters, Registered, Visitor, WithDiffuseParams,
};

#[test]
fn names_and_choices_are_distinct_and_found() {
    for (place, id) in ModelId::ALL.iter().enumerate() {
        let word = id.choice().map(|(_, word)| word);
        assert_eq!(ModelId::find(id.name(), word), Some(*id), "{id:?}");
        let same = |other: &ModelId| other.name() == id.name() && other.choice() == id.choice();
        assert_eq!(ModelId::ALL.iter().position(same), Some(place), "{id:?}");
    }
    assert_eq!(ModelId::find("phong", None), None, "no such model");
    assert_eq!(
        ModelId::find("gaussian", Some("best")),
        None,
        "no such sampler"
    );
    let names: Vec<&str> = ModelId::defaults_of_names().map(ModelId::name).collect();
    assert_eq!(names[..2], ["gaussian", "cauchy"]);
    let words = [
        Matched::<Gaussian>::CHOICE,
        Matched::<Gaussian, 5>::CHOICE,
        Matched::<Gaussian, 25>::CHOICE,
    ];
    let words = words.map(|choice| choice.map(|(_, word)| word));
    assert_eq!(words, ["matched", "matched-5", "matched-25"].map(Some));
}

/// Every preset comes back from its values, every field has a place, and each refusal leads to its field.
fn fields_hold<P: Parameters>() {
    let numbers: usize = P::FIELDS.iter().map(|field| field.kind.width()).sum();
    assert!(
        numbers <= hairis_variants::Values::MOST && P::FIELDS.len() <= 32,
        "{numbers} numbers"
    );
    for (name, params) in P::PRESETS.iter().chain([&("default", P::default())]) {
        assert_eq!(P::from_values(&params.values()), Ok(*params), "{name}");
    }
    for field in P::FIELDS {
        let replaced = field.instead_of.into_iter();
        let base = replaced.fold(P::default().values(), |values, other| values.without(other));
        if let Kind::Word(words) = field.kind {
            for word in words {
                let values = base.with_word(field.name, word);
                assert_eq!(
                    P::from_values(&values).map(|params| params.values().word(field.name)),
                    Ok(*word),
                    "{}",
                    field.name
                );
            }
            continue;
        }
        for number in 0..field.kind.width() {
            let mut bad = vec![0.5; field.kind.width()];
            bad[number] = f32::NAN;
            let error = P::from_values(&base.with(field.name, &bad)).expect_err(field.name);
            let (found, place) = Field::refused(P::FIELDS, &error).expect("a field of the model");
            assert_eq!(found.name, field.name, "{error}");
            let several = field.kind.width() > 1;
            assert_eq!(place, several.then_some(number), "{error}");
            // The rule that refuses is the one that the field states.
            assert_eq!(Some(error.rule()), field.rule, "{error}");
            assert!(!field.doc.is_empty(), "{}", field.name);
            for end in field.range().expect("a field of numbers") {
                let values = base.with(field.name, &vec![end; field.kind.width()]);
                P::from_values(&values).expect("both ends of a range are accepted");
            }
        }
    }
}

#[test]
fn parameters_are_their_fields() {
    fields_hold::<HairParams>();
    fields_hold::<KajiyaKayParams>();
    fields_hold::<ChiangParams>();
    fields_hold::<DEonParams>();
    fields_hold::<WithDiffuseParams<HairParams>>();
    fields_hold::<WithDiffuseParams<ChiangParams>>();
}

#[test]
fn a_field_takes_the_place_of_another() {
    let melanin = ChiangParams::default()
        .values()
        .with("melanin", &[0.3, 0.0]);
    assert!(!melanin.has("sigma_a"), "one of the group at a time");
    assert_eq!(
        ChiangParams::from_values(&melanin),
        Ok(ChiangParams::blond())
    );
    let refused = ChiangParams::from_values(&melanin.with("melanin", &[0.3, -1.0]));
    let error = ParamError::new("melanin", Some(1), Rule::NotNegative, -1.0);
    assert_eq!(refused, Err(error));
    let amount = melanin.with("melanin_amount", &[0.7, 0.6]);
    assert!(!amount.has("melanin"), "one of the group at a time");
    let desc = ChiangDesc::default().with_melanin_amount(0.7, 0.6);
    assert_eq!(
        ChiangParams::from_values(&amount),
        desc.and_then(|desc| ChiangParams::new(&desc))
    );
}

/// A call chosen at run time and that of the type. Debug shows every bit that matters, and NaN.
macro_rules! same {
    ($chosen:ident, $of_type:ident; $call:ident($($argument:expr)?)) => {
        assert_eq!(
            format!("{:?}", $chosen.$call($($argument)?)),
            format!("{:?}", $of_type.$call($($argument)?)),
            stringify!($call),
        );
    };
}

/// Compares the handles of a type with those chosen at run time, to the bit.
struct Compare;

impl Visitor for Compare {
    type Output = ();

    fn visit<M: Registered>(self) {
        let id = ModelId::of::<M>();
        let mut draws = Draws(91);
        let presets: Vec<_> = M::Params::PRESETS
            .iter()
            .map(|(_, params)| *params)
            .collect();
        let presets: [M::Params; 8] = core::array::from_fn(|i| presets[i % presets.len()]);
        // In the types of `Conserving`, as the list has them and this package has compiled them. The kernels' tests compare two models with
        // their raw types, and `.ci/hosts.sh` compares every model.
        let materials = presets
            .map(|params| -> Material<Conserving<M>> { Material::new(&M::MODEL, &params).into() });
        let any = presets.map(|params| id.material(&params.values()).expect("a preset is legal"));
        let mut some = || direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
        let (wo, wi): ([Vec3; 8], [Vec3; 8]) = (
            core::array::from_fn(|_| some()),
            core::array::from_fn(|_| some()),
        );
        let xi: [[f32; 3]; 8] = core::array::from_fn(|_| draws.xi3());
        let hit = Hit {
            wo: wo[0].into(),
            h: 0.4,
        };
        let (one, chosen) = (materials[0].prepare(hit), any[0].prepare(hit));
        assert_eq!(chosen.model(), id, "the entry it came from");
        let (wi8, xi8) = (packet(&wi), lanes_of(&xi));
        let hits = &Hit8::from(&packet(&wo));
        // The handles forward every call through one reference, so one call of each kind shows that it arrives.
        for lobes in [LobeMask::ALL, LobeMask::of(&[Lobe::slot(0)])] {
            let (one, chosen) = (one.with_lobes(lobes), chosen.with_lobes(lobes));
            same!(chosen, one; eval_pdf(wi[0]));
            same!(chosen, one; lobes(wi[0]));
            same!(chosen, one; sample(xi[0]));
            same!(chosen, one; albedo());
            for level in Level::available() {
                let (one, chosen) = (one.with_level(level), chosen.with_level(level));
                same!(chosen, one; eval_pdf8(&wi8));
                same!(chosen, one; sample8(&xi8));
                same!(chosen, one; lobes8(&wi8));
            }
        }

        let eight = Material8::pack(materials.each_ref()).prepare8(hits);
        let chosen = AnyMaterial8::pack(any.each_ref())
            .expect("of one model")
            .prepare8(hits);
        for level in Level::available() {
            let (eight, chosen) = (eight.with_level(level), chosen.with_level(level));
            same!(chosen, eight; eval_pdf8(&wi8));
            same!(chosen, eight; sample8(&xi8));
            same!(chosen, eight; lobes8(&wi8));
            same!(chosen, eight; albedo8());
        }
        let (lane, chosen_lane) = (eight.lane(3), chosen.lane(3));
        same!(chosen_lane, lane; eval_pdf(wi[3]));
        let (second, any_second) = (&materials[1], &any[1]);
        same!(any_second, second; conserving_scale());

        let conserving = presets.map(|params| Material::new(&Conserving(M::MODEL), &params));
        let any = any.map(|one| one.conserving());
        for (one, chosen) in conserving.iter().zip(&any) {
            same!(chosen, one; integrates());
            let (one, chosen) = (one.prepare(hit), chosen.prepare(hit));
            same!(chosen, one; eval_pdf(wi[0]));
            same!(chosen, one; albedo());
        }
        let eight = Material8::pack(conserving.each_ref()).prepare8(hits);
        let chosen = AnyMaterial8::pack(any.each_ref())
            .expect("of one model")
            .prepare8(hits);
        same!(chosen, eight; eval_pdf8(&wi8));
        same!(chosen, eight; albedo8());
    }
}

#[test]
fn a_model_chosen_at_run_time_is_the_model() {
    for id in ModelId::ALL {
        id.visit(Compare);
    }
}

#[test]
fn different_models_do_not_share_lanes() {
    let [a, b] = [ModelId::Gaussian, ModelId::Cauchy]
        .map(|id| id.material(&id.defaults()).expect("the default is legal"));
    assert!(AnyMaterial8::pack([&a, &a, &a, &b, &a, &a, &a, &a]).is_none());
    assert!(AnyMaterial8::pack([&a; 8]).is_some());
}
