//! Parameters of materials: words, fields that may be missing, and fields of which one is given.

use hairis_materials::MaterialSpec;
use hairis_variants::color::ColorOf;
use hairis_variants::{ChiangParams, KajiyaKayParams, ModelId, Parameters};

/// Reads a material of these parameters, and returns them or the refusal.
fn params<P: Parameters>(model: &str, text: &str) -> Result<P, String> {
    let all = MaterialSpec::parse_all(&format!(r#"{{"model":"{model}","params":{text}}}"#))?;
    P::from_values(&all[0].values).map_err(|error| error.to_string())
}

#[test]
fn words_and_fields_that_may_be_missing() {
    let read = params::<KajiyaKayParams>(
        "kajiya-kay",
        r#"{"kd":[0.1,0.2,0.3],"ks":[0,0,0],"exponent":9,"form":"published"}"#,
    );
    let read = read.expect("legal").values();
    assert_eq!(
        (read.word("form"), read.numbers("exponent")),
        ("published", &[9.0][..])
    );
    let read = params::<KajiyaKayParams>(
        "kajiya-kay",
        r#"{"kd":[0.1,0.2,0.3],"ks":[0,0,0],"exponent":9}"#,
    )
    .expect("legal");
    assert_eq!(read.values().word("form"), "reciprocal");
    for (text, problem) in [
        (r#"{"ks":[0,0,0],"exponent":9}"#, "params.kd: missing"),
        (
            r#"{"kd":[0,0,0],"ks":[0,0,0],"exponent":9,"form":"new"}"#,
            "params.form: must be \"reciprocal\" or \"published\", got \"new\"",
        ),
        (
            r#"{"kd":[0,-1,0],"ks":[0,0,0],"exponent":9}"#,
            "params.kd[1]: must be finite and at least 0, got -1",
        ),
        (
            r#"{"kd":[0,0,0],"ks":[0,0,0],"exponent":0.1}"#,
            "params.exponent: must be in [1, 10000], got 0.1",
        ),
    ] {
        assert_eq!(
            params::<KajiyaKayParams>("kajiya-kay", text),
            Err(problem.to_owned()),
            "{text}"
        );
    }
}

#[test]
fn one_field_of_a_group() {
    let read = |rest: &str| {
        params::<ChiangParams>("chiang", &format!(r#"{{"beta_m":0.3,"beta_n":0.3{rest}}}"#))
    };
    assert_eq!(read(r#","melanin":[0.3,0]"#), Ok(ChiangParams::blond()));
    assert_eq!(
        read(r#","tilt":0,"eta":1.5,"sigma_a":[0,1,2]"#).map(|read| read.desc().sigma_a),
        Ok([0.0, 1.0, 2.0])
    );
    assert!(read(r#","color":[0.5,0.4,0.3]"#).is_ok(), "a colour");
    let level = read(r#","sigma_a":[0,1,2],"cuticle_angle":0.5"#);
    assert_eq!(level.map(|read| read.desc().tilt), Ok(0.0));
    for (rest, problem) in [
        (
            "",
            "params.sigma_a: missing; give one of sigma_a, melanin, melanin_amount, color",
        ),
        (
            r#","melanin":[0,0],"color":[0,0,0]"#,
            "params.melanin: given together with color; give one of them",
        ),
        (
            r#","melanin":[0,-1]"#,
            "params.melanin[1]: must be finite and at least 0, got -1",
        ),
        (
            r#","color":[0,1.5,0]"#,
            "params.color[1]: must be in [0, 1], got 1.5",
        ),
        (
            r#","sigma_a":[0,0,0],"tilt":0,"cuticle_angle":0.5"#,
            "params.tilt: given together with cuticle_angle; give one of them",
        ),
        (
            r#","sigma_a":[0,0,0],"eumelanin":"brown""#,
            r#"params.eumelanin: must be "d-eon" or "cycles" or "d-eon-acescg" or "cycles-acescg", got "brown""#,
        ),
        (
            r#","sigma_a":[0,0,0],"tint_r":"cycles""#,
            "params.tint_r: must be an array of 3 numbers, got \"cycles\"",
        ),
        (
            r#","sigma_a":[0,0,0],"eta":0.5"#,
            "params.eta: must be in [1, 4], got 0.5",
        ),
    ] {
        assert_eq!(read(rest), Err(problem.to_owned()), "{rest}");
    }
}

/// A name stands for the decimals of its pigment, in double precision too.
#[test]
fn numbers_by_name() {
    let read = |eumelanin: &str| {
        let params =
            format!(r#"{{"beta_m":0.3,"beta_n":0.3,"melanin":[1,0],"eumelanin":{eumelanin}}}"#);
        let text = format!(r#"{{"model":"chiang","params":{params}}}"#);
        let [material] = MaterialSpec::parse_all(&text).expect("legal")[..] else {
            panic!("one")
        };
        material
    };
    let (named, given) = (read(r#""cycles""#), read("[0.506, 0.841, 1.653]"));
    assert_eq!(named.values, given.values);
    assert_eq!(named.exact, given.exact);
    assert_eq!(
        read(r#""d-eon""#).exact.numbers("pheomelanin"),
        [0.187, 0.4, 1.05]
    );
    let params = ChiangParams::from_values(&named.values).expect("legal");
    assert_eq!(params.desc().sigma_a, [0.506, 0.841, 1.653]);
}

/// Parameters of another renderer, under its names.
#[test]
fn like_another_renderer() {
    let read = |like: &str, params: &str| {
        let text = format!(r#"{{"model":"chiang","like":"{like}","params":{params}}}"#);
        let all = MaterialSpec::parse_all(&text)?;
        ChiangParams::from_values(&all[0].values).map_err(|error| error.to_string())
    };
    let cycles = read(
        "cycles",
        r#"{"roughness":0.2,"melanin":0.5,"melanin_redness":0.2,"coat":1}"#,
    );
    let refused = "params: width_m[0] must be in [0.1, 10], got 0.0040905676";
    assert_eq!(
        cycles,
        Err(refused.to_owned()),
        "a perfect coat is beyond the range"
    );
    let pbrt = read("pbrt", r#"{"eumelanin":0.3,"beta_m":0.4,"alpha":-3}"#).expect("legal");
    let desc = pbrt.desc();
    assert_eq!(
        (desc.beta_m, desc.sigma_a),
        (0.4, ChiangParams::blond().desc().sigma_a)
    );
    assert!((desc.tilt - 3.0_f32.to_radians()).abs() < 1e-7);
    for (like, params, problem) in [
        (
            "arnold",
            "{}",
            r#"like: must be "cycles" or "materialx" or "osl" or "pbrt" or "mitsuba" or "rtxcr", got "arnold""#,
        ),
        (
            "osl",
            r#"{"lroughness":0.3,"troughness":0.3}"#,
            "params.aroughness: missing",
        ),
        (
            "osl",
            r#"{"lroughness":0.3,"troughness":0.3,"aroughness":0.3,"absorption":[0,0,0],"scattering":1.5}"#,
            "params.scattering: must be in [0, 1], got 1.5",
        ),
        (
            "cycles",
            r#"{"melanin":0.5,"color":[1,1,1]}"#,
            "params.melanin: given together with color; give one of them",
        ),
    ] {
        assert_eq!(
            read(like, params),
            Err(problem.to_owned()),
            "{like} {params}"
        );
    }
}

/// Colours by the subject that shows them.
#[test]
fn a_colour_decides_the_absorption() {
    let read = |model: &str, color: &str, params: &str| {
        let text = format!(r#"{{"model":"{model}",{color},"params":{params}}}"#);
        MaterialSpec::parse_all(&text).map(|all| all[0])
    };
    let fibre = r#""color":[0.5,0.3,0.1],"color_of":"fibre""#;
    let material = read("d-eon", fibre, r#"{"roughness":0.3}"#).expect("legal");
    let shown = ModelId::DEon.shown_color(&material.values, ColorOf::Fibre);
    let shown = shown.expect("a colour");
    assert!((shown[0] - 0.5).abs() < 1e-5 && (shown[2] - 0.1).abs() < 1e-5);
    let [exact]: [f64; 1] = [material.exact.numbers("sigma_a")[0]];
    assert_eq!(exact, f64::from(material.values.numbers("sigma_a")[0]));
    let rough = r#"{"beta_m":0.3,"beta_n":0.3}"#;
    for (model, color, params, problem) in [
        (
            "d-eon",
            r#""color":[1,1,1]"#,
            r#"{"roughness":0.3}"#,
            "color_of: missing",
        ),
        (
            "d-eon",
            r#""color_of":"mass""#,
            r#"{"roughness":0.3}"#,
            "color: missing",
        ),
        (
            "chiang",
            r#""color":[1,1,1],"color_of":"head""#,
            rough,
            r#"color_of: must be "chiang" or "fibre" or "mass", got "head""#,
        ),
        (
            "chiang",
            r#""color":[1,-1,1],"color_of":"mass""#,
            rough,
            "color[1]: must be finite and at least 0, got -1",
        ),
        (
            "d-eon",
            fibre,
            r#"{"roughness":0.3,"melanin":[1,0]}"#,
            "color: given together with params.melanin; give one of them",
        ),
        (
            "d-eon",
            r#""color":[1,1,1],"color_of":"chiang""#,
            r#"{"roughness":0.3}"#,
            r#"color_of: must be a sense that d-eon has, got "chiang""#,
        ),
        ("kajiya-kay", fibre, "{}", "color: unknown"),
    ] {
        let refused = read(model, color, params).expect_err(model);
        assert!(refused.starts_with(problem), "{refused} for {problem}");
    }
}
