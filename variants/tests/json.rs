//! Parameters as JSON: the fields of files, with the checks of parameters.

use hairis::HairParams;
use hairis::params::HairDesc;
use hairis_variants::chiang::{ScatteringParams, Shifts};
use hairis_variants::{ChiangParams, KajiyaKayParams, Parameters, WithDiffuseParams};
use serde_json::Value;

/// Parameters come back from their JSON, whose keys are those of the fields that are given.
fn round_trips<P>()
where
    P: Parameters + serde::Serialize + serde::de::DeserializeOwned,
{
    for (name, params) in P::PRESETS {
        let json = serde_json::to_value(params).unwrap();
        let back: P = serde_json::from_value(json.clone()).unwrap();
        assert_eq!(back, *params, "{name}");
        let values = params.values();
        let given = P::FIELDS.iter().filter(|field| values.has(field.name));
        let mut names: Vec<&str> = given.map(|field| field.name).collect();
        let mut keys: Vec<&str> = json
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        names.sort_unstable();
        keys.sort_unstable();
        assert_eq!(keys, names, "{name}");
    }
}

#[test]
fn parameters_come_back_from_json() {
    round_trips::<HairParams>();
    round_trips::<KajiyaKayParams>();
    round_trips::<ChiangParams>();
}

#[test]
fn parameters_with_a_diffuse_part_come_back_from_json() {
    for (name, params) in WithDiffuseParams::<ChiangParams>::PRESETS {
        let json = serde_json::to_value(params).unwrap();
        let back: WithDiffuseParams<ChiangParams> = serde_json::from_value(json.clone()).unwrap();
        assert_eq!(back, *params, "{name}");
        for (key, value) in [("diffuse", 1.5.into()), ("share", 0.5.into())] {
            let mut wrong = json.clone();
            wrong[key] = value;
            serde_json::from_value::<WithDiffuseParams<ChiangParams>>(wrong).unwrap_err();
        }
    }
}

#[test]
fn a_fibre_with_scattering_comes_back_from_json() {
    for (name, params) in ScatteringParams::PRESETS {
        let json = serde_json::to_value(params).unwrap();
        let back: ScatteringParams = serde_json::from_value(json.clone()).unwrap();
        assert_eq!(back, *params, "{name}");
        let mut wrong = json;
        wrong["scattering"] = (-0.5).into();
        serde_json::from_value::<ScatteringParams>(wrong).unwrap_err();
    }
}

#[test]
fn json_is_checked() {
    let with = |key: &str, value: Value| {
        let mut json = serde_json::to_value(HairParams::brown()).unwrap();
        json[key] = value;
        serde_json::from_value::<HairParams>(json).map_err(|error| error.to_string())
    };
    assert_eq!(
        with("beta", [0.1, 0.0, 0.2].into()),
        Err("beta[1] must be a width in [1e-4, pi] rad, got 0".to_owned())
    );
    for (key, value, message) in [
        ("gamma", 0.1.into(), "unknown field"),
        ("i_r", [0.1, 0.2].into(), "invalid length 2"),
        ("phi_g", "wide".into(), "invalid type"),
    ] {
        let refused = with(key, value).unwrap_err();
        assert!(refused.contains(message), "{key}: {refused}");
    }
    let missing = serde_json::from_str::<HairParams>("{}").unwrap_err();
    assert!(missing.to_string().contains("missing field"), "{missing}");
}

#[test]
fn double_precision_and_words_are_read() {
    let mut json = serde_json::to_value(HairParams::brown()).unwrap();
    json["phi_g"] = 0.6.into();
    let desc: HairDesc<f64> = serde_json::from_value(json).unwrap();
    assert_eq!(desc.phi_g.to_bits(), 0.6_f64.to_bits());
    let mut json = serde_json::to_value(ChiangParams::red()).unwrap();
    json["shifts"] = "small-angle".into();
    let params: ChiangParams = serde_json::from_value(json).unwrap();
    assert_eq!(params.desc().shifts, Shifts::SmallAngle);
}
