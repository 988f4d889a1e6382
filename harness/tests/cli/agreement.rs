//! Agreement of the code paths, which must give the same answers to the same requests.

use super::{PATHS, eval, numbers, with_xi};
use crate::cases::{Case, Cases, angles};
use hairis_variants::ModelId;
use serde_json::{Value, json};

/// Returns the words for the samplers of both bells in this build.
fn samplers() -> impl Iterator<Item = &'static str> + Clone {
    let of_name = ModelId::ALL.iter().filter(|id| id.name() == "gaussian");
    of_name.filter_map(|id| Some(id.choice()?.1))
}

/// Returns the relative error that the bounds of the kernels allow. All paths get the same rounded input.
///
/// A matched density is made of the model's own bells, so it is allowed as much as S.
fn allowed(sampler: &str, model: &str, quantity: &str) -> f64 {
    match (sampler, model, quantity) {
        (_, "gaussian", "s") => 1e-4,
        (_, "gaussian", "pdf" | "pdf_lobe") if sampler != "published" => 1e-4,
        _ => 1e-5,
    }
}

/// Returns the value below which only an absolute error counts. A Gaussian below about 2^-115 is 0 by design. Below this value, S consists
/// of such bells only, and so does a matched density.
fn floor(sampler: &str, model: &str, quantity: &str) -> f64 {
    match (sampler, model, quantity) {
        (_, "gaussian", "s") => 1e-27,
        (_, "gaussian", _) if sampler != "published" => 1e-20,
        _ => 0.0,
    }
}

/// Returns the request of a case for a sampler.
fn request(sampler: &str, model: &str, case: &Case) -> Value {
    let mut request = super::request(model, case);
    request["sampler"] = json!(sampler);
    request
}

/// Returns models and cases in turn, so that neighbours differ in everything.
fn cases(seed: u64, len: usize) -> Vec<(&'static str, Case)> {
    let mut source = Cases::new(seed);
    (0..len)
        .map(|i| (["gaussian", "cauchy"][i / 5 % 2], source.case(i)))
        .collect()
}

fn assert_close(name: &str, got: &Value, expected: &Value, allowed: f64, floor: f64) {
    let list = |value: &Value| {
        if value.is_array() {
            numbers(value)
        } else {
            vec![value.as_f64().unwrap()]
        }
    };
    for (got, expected) in list(got).into_iter().zip(list(expected)) {
        let error = (got - expected).abs();
        assert!(
            error <= allowed * expected + floor,
            "{name}: {got:e} where {expected:e} was expected, to {allowed:e}"
        );
    }
}

#[test]
fn all_paths_agree_on_directions() {
    samplers().for_each(agree_on_directions);
}

fn agree_on_directions(sampler: &str) {
    let cases = cases(1, 400);
    let requests: Vec<Value> = cases
        .iter()
        .map(|(model, case)| request(sampler, model, case))
        .collect();
    let oracle = eval("f64", &requests).json();
    for path in &PATHS[..3] {
        let run = eval(path, &requests);
        assert_eq!(run.code, Some(0), "{path}: {:?}", run.err);
        for ((answer, expected), (model, case)) in run.json().iter().zip(&oracle).zip(&cases) {
            assert_eq!(keys(answer), keys(expected), "{path}: fields");
            for quantity in ["s", "pdf", "pdf_lobe"] {
                let name = format!("{path} {model} {sampler} {quantity} at {case:?}");
                let (allowed, floor) = (
                    allowed(sampler, model, quantity),
                    floor(sampler, model, quantity),
                );
                assert_close(
                    &name,
                    &answer[quantity],
                    &expected[quantity],
                    allowed,
                    floor,
                );
            }
        }
    }
}

/// Largest change of the numbers that explains a different sample. Far from a narrow lobe, the last bit of a number moves a direction by
/// 1e-4 rad, whatever the code.
const XI_ERROR: f64 = 4.0 / 16_777_216.0;

#[test]
fn all_paths_agree_on_samples() {
    samplers().for_each(agree_on_samples);
}

fn agree_on_samples(sampler: &str) {
    let mut source = Cases::new(2);
    let cases = cases(3, 400);
    let xi: Vec<[f64; 3]> = cases.iter().map(|_| source.xi()).collect();
    let requests = |by: f64| -> Vec<Value> {
        let moved = |xi: [f64; 3]| {
            [
                xi[0],
                (xi[1] + by).clamp(0.0, 1.0 - 1e-12),
                (xi[2] + by).clamp(0.0, 1.0 - 1e-12),
            ]
        };
        cases
            .iter()
            .zip(&xi)
            .map(|((model, case), xi)| with_xi(request(sampler, model, case), moved(*xi)))
            .collect()
    };
    let [below, oracle, above] =
        [-XI_ERROR, 0.0, XI_ERROR].map(|by| eval("f64", &requests(by)).json());
    for path in &PATHS[..3] {
        let run = eval(path, &requests(0.0));
        assert_eq!(run.code, Some(0), "{path}: {:?}", run.err);
        let answers = run.json();
        let (mut kept, mut returned) = (Vec::new(), Vec::new());
        for (i, (answer, (model, case))) in answers.iter().zip(&cases).enumerate() {
            let expected = &oracle[i];
            let name = format!(
                "{path} {model} {sampler} {case:?}: {answer} where {expected} was expected"
            );
            assert_eq!(keys(answer), keys(expected), "{name}");
            if answer["lobe"].is_null() || expected["lobe"].is_null() {
                let other = if answer["lobe"].is_null() {
                    expected
                } else {
                    answer
                };
                assert!(other["lobe"].is_null() || is_edge(other), "{name}");
                continue;
            }
            assert_eq!(answer["lobe"], expected["lobe"], "{name}");
            let slack = 1e-6 + apart(&below[i], expected) + apart(&above[i], expected);
            assert!(apart(answer, expected) <= slack, "{name}, to {slack}");
            let mut at_wi = request(sampler, model, case);
            // The exact direction in single precision. Its shortest digits would be another number in double precision.
            at_wi["wi"] = json!(<[f64; 3]>::from(direction(&answer["wi"]).as_dvec3()));
            kept.push(i);
            returned.push(at_wi);
        }
        assert!(
            kept.len() > 300,
            "{path}: {} samples were not discarded",
            kept.len()
        );
        // S and the pdf of a sample must be those of its direction, up to the rounding of that direction.
        for (i, expected) in kept.into_iter().zip(eval("f64", &returned).json()) {
            let ((model, case), wi) = (&cases[i], direction(&answers[i]["wi"]));
            let case = Case { wi, ..*case };
            let phi = angles(case.wo).1 - angles(wi).1;
            let from_axis = f64::from(wi.y).hypot(f64::from(wi.z));
            if from_axis < 1e-3 || phi.cos().abs() < 1e-6 {
                continue;
            }
            for quantity in ["s", "pdf"] {
                let name = format!("{path} {model} {sampler} {quantity} of a sample at {case:?}");
                let (allowed, floor) = (
                    allowed(sampler, model, quantity),
                    floor(sampler, model, quantity),
                );
                assert_close(
                    &name,
                    &answers[i][quantity],
                    &expected[quantity],
                    allowed,
                    floor,
                );
            }
        }
    }
}

/// Returns a direction of an answer in single precision.
fn direction(wi: &Value) -> glam::Vec3 {
    let wi = numbers(wi);
    glam::DVec3::new(wi[0], wi[1], wi[2]).as_vec3()
}

/// Returns the distance between two sampled directions.
fn apart(a: &Value, b: &Value) -> f64 {
    let (a, b) = (numbers(&a["wi"]), numbers(&b["wi"]));
    a.iter()
        .zip(&b)
        .map(|(a, b)| (a - b) * (a - b))
        .sum::<f64>()
        .sqrt()
}

/// Returns true if the last bit of a number may decide whether the sample is discarded: the sample is within 1e-4 rad of the axis, or no
/// lobe reaches it (`xi_phi` of 0 puts a cosine lobe at |phi| = pi, where the cosine of a rounded pi/2 is just above 0).
fn is_edge(sample: &Value) -> bool {
    let wi = numbers(&sample["wi"]);
    wi[1].hypot(wi[2]) < 1e-4 || sample["pdf"].as_f64().unwrap() < 1e-15
}

#[test]
fn black_hair_scatters_nothing() {
    let (_, mut case) = cases(4, 1)[0];
    case.desc.i_r = [0.0; 3];
    case.desc.i_tt = [0.0; 3];
    case.desc.i_trt = [0.0; 3];
    for (path, sampler) in PATHS
        .into_iter()
        .flat_map(|path| samplers().map(move |sampler| (path, sampler)))
    {
        let request = request(sampler, "gaussian", &case);
        let requests = [request.clone(), with_xi(request, [0.5; 3])];
        let answers = eval(path, &requests).json();
        assert_eq!(
            (numbers(&answers[0]["s"]), answers[0]["pdf"].as_f64()),
            (vec![0.0; 3], Some(0.0)),
            "{path}"
        );
        assert_eq!(
            answers[1]["lobe"],
            Value::Null,
            "{path}: a discarded sample"
        );
        for field in ["wi", "s", "pdf_lobe", "weight"] {
            assert!(
                numbers(&answers[1][field]).iter().all(|x| *x == 0.0),
                "{path}: {field} of {}",
                answers[1]
            );
        }
        assert_eq!(
            answers[1]["pdf"].as_f64(),
            Some(0.0),
            "{path}: pdf of a discarded sample"
        );
    }
}

#[test]
fn lobes_without_energy_are_never_drawn() {
    let mut source = Cases::new(5);
    let mut requests = Vec::new();
    for (model, mut case) in cases(6, 120) {
        case.desc.i_r = [0.0; 3];
        case.desc.i_tt = [0.2; 3];
        case.desc.i_trt = [0.2; 3];
        case.desc.i_g = 0.0;
        requests
            .extend(samplers().map(|sampler| with_xi(request(sampler, model, &case), source.xi())));
    }
    for path in PATHS {
        for answer in eval(path, &requests).json() {
            assert!(
                answer["lobe"] != "r" && answer["lobe"] != "glint",
                "{path}: {answer}"
            );
        }
    }
}

#[test]
fn the_narrowest_hair_gives_finite_answers_everywhere() {
    let mut source = Cases::new(7);
    let mut requests = Vec::new();
    for ((model, case), sampler) in cases(8, 200).into_iter().zip(samplers().cycle()) {
        let mut request = request(sampler, model, &case);
        request["params"]["beta"] = json!([1e-4, 1e-4, 1e-4]);
        request["params"]["gamma_tt"] = json!(1e-4);
        request["params"]["gamma_g"] = json!(1e-4);
        let mut along = request.clone();
        along["wi"] = json!([-1, 0, 0]);
        let mut both = along.clone();
        both["wo"] = json!([1, 0, 0]);
        requests.extend([
            with_xi(request.clone(), source.xi()),
            with_xi(both.clone(), source.xi()),
            request,
            along,
            both,
        ]);
    }
    for path in PATHS {
        let run = eval(path, &requests);
        assert_eq!(run.code, Some(0), "{path}: {:?}", run.err);
        for line in &run.out {
            // A number that is not finite is printed as null, which only the lobe may be.
            let nulls = line.matches("null").count() - line.matches("\"lobe\":null").count();
            assert_eq!(nulls, 0, "{path}: {line}");
        }
    }
}

fn keys(answer: &Value) -> Vec<&String> {
    answer.as_object().unwrap().keys().collect()
}
