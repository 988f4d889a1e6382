//! Cases: shading points and directions with the value, the density and the lobes of a model in double precision.

use crate::answers::Numbers;
use crate::args::Vectors;
use crate::draws::even;
use core::f64::consts::{PI, TAU};
use hairis_materials::material::{find_model, find_sampler, values_json};
use hairis_program::error::Error;
use hairis_reference::{Reference, reference};
use hairis_variants::{ModelId, Values};
use serde_json::{Map, Value, json};

/// Density of directions that are uniform over the sphere, per steradian.
const UNIFORM: f64 = 1.0 / (4.0 * PI);
/// Shading point of a preset.
struct Scene {
    values: Values,
    wo: [f64; 3],
    h: f64,
    point: Box<dyn Reference<f64>>,
}

impl Scene {
    fn new(model: ModelId, seed: u64, n: u32) -> Result<Self, Error> {
        let presets: Vec<_> = model.presets().collect();
        let (_, values) = presets[n as usize % presets.len()];
        let [a, b, c] = even(seed, n);
        let wo = direction(1.98 * a - 0.99, b);
        let h = if model.is_near_field() {
            1.96 * c - 0.98
        } else {
            0.0
        };
        let point = reference(model, &values, wo, h).map_err(Error::Params)?;
        Ok(Self {
            values,
            wo,
            h,
            point,
        })
    }

    /// Returns direction `n`, drawn evenly over the sphere or by the model's sampler, with the density of both together.
    fn direction(&self, seed: u64, n: u32) -> ([f64; 3], f64) {
        let xi = even(seed, n / 2);
        let drawn = self.point.sample(xi);
        let wi = if n.is_multiple_of(2) && drawn.lobe.is_some() {
            drawn.wi
        } else {
            direction(2.0 * xi[1] - 1.0, xi[2])
        };
        (wi, 0.5 * (self.point.pdf(wi) + UNIFORM))
    }
}

/// Returns the unit direction with this sine of the inclination, and this share of a turn of azimuth.
fn direction(sin: f64, turn: f64) -> [f64; 3] {
    let (cos, (sin_phi, cos_phi)) = ((1.0 - sin * sin).max(0.0).sqrt(), (TAU * turn).sin_cos());
    [sin, cos * cos_phi, cos * sin_phi]
}

/// Value of S, density and contributions of the lobes to S, as the fields of a case.
///
/// The contribution of a lobe is linear RGB per steradian, and the lobes sum to S.
#[must_use]
pub fn expected(model: ModelId, point: &dyn Reference<f64>, wi: [f64; 3]) -> Value {
    let Numbers {
        value, pdf, lobes, ..
    } = Numbers::of(model, point, wi);
    json!({ "value": value, "pdf": pdf, "lobes": by_name(model, lobes) })
}

/// Colours by the names of their lobes.
fn by_name(model: ModelId, lobes: Vec<Option<[f64; 3]>>) -> Map<String, Value> {
    (model.lobes().iter().zip(lobes))
        .map(|(name, rgb)| ((*name).to_owned(), json!(rgb)))
        .collect()
}

/// Returns the cases that the flags ask for, as lines of JSON or as a table.
///
/// # Errors
///
/// Returns [`Error::Usage`] if there is no such model or sampler.
pub fn text(flags: &Vectors) -> Result<String, Error> {
    let model = model(flags)?;
    let mut lines = String::new();
    for scene in 0..flags.scenes {
        let place = Scene::new(model, flags.seed, scene)?;
        let params = values_json(&place.values);
        let albedo = by_name(model, Numbers::albedos(model, &*place.point));
        // Directions of their own for each shading point.
        let seed = flags.seed.wrapping_add(1 + u64::from(scene));
        for n in 0..flags.directions {
            let (wi, density) = place.direction(seed, n);
            let mut case = json!({
                "case": u64::from(scene) * u64::from(flags.directions) + u64::from(n),
                "scene": scene,
                "model": model.name(),
                "params": params,
                "wo": place.wo,
                "wi": wi,
                "drawn_with": density,
                "expected": expected(model, &*place.point, wi),
            });
            case["expected"]["albedo"] = json!(albedo);
            if let Some((field, word)) = model.choice() {
                case[field] = json!(word);
            }
            if model.is_near_field() {
                case["h"] = json!(place.h);
            }
            if flags.csv {
                let (mut names, mut row) = (Vec::new(), Vec::new());
                flatten("", &case, &mut |name, value| {
                    names.push(name.to_owned());
                    row.push(value);
                });
                if lines.is_empty() {
                    lines = names.join(",") + "\n";
                }
                lines += &row.join(",");
            } else {
                lines += &case.to_string();
            }
            lines.push('\n');
        }
    }
    Ok(lines)
}

fn model(flags: &Vectors) -> Result<ModelId, Error> {
    let refuse = |flag: &'static str| move |problem| Error::Usage(format!("{flag} {problem}"));
    let first = find_model(&flags.model).map_err(refuse("--model"))?;
    match &flags.sampler {
        Some(word) => find_sampler(first, word).map_err(refuse("--sampler")),
        None => Ok(first),
    }
}

/// Calls `see` with the path and the text of each number or word in a value. The names are those of columns: `wo[1]`, `lobes.tt[0]`.
fn flatten(path: &str, value: &Value, see: &mut dyn FnMut(&str, String)) {
    match value {
        Value::Array(items) => {
            for (n, item) in items.iter().enumerate() {
                flatten(&format!("{path}[{n}]"), item, see);
            }
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                let dot = if path.is_empty() { "" } else { "." };
                flatten(&format!("{path}{dot}{name}"), field, see);
            }
        }
        Value::String(word) => see(path, word.clone()),
        other => see(path, other.to_string()),
    }
}
