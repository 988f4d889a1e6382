//! One line of the input, checked.

use super::json::{Json, shortened};
use crate::sampler::Sampler;
use crate::subject::ModelKind;
use core::fmt;
use glam::Vec3;
use hairis::textbook::Parameters;
use hairis::{HairDesc, HairParams, ParamError};

/// How far from 1 the length of a direction may be; it is normalised then.
const LENGTH_TOLERANCE: f64 = 1e-3;
/// How far from 1 the length of a unit vector of single precision may be: its digits are kept as they are, so that all
/// paths answer for the same direction.
const ROUNDED: f64 = 2e-7;

/// The samplers of the kernels, as a line may name them.
pub(super) const SAMPLERS: [Sampler; 4] = [Sampler::Ou, Sampler::Matched5, Sampler::Matched, Sampler::Matched25];

/// Why a line was refused: the path of the field at fault, and what is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    field: String,
    problem: String,
}

impl Refusal {
    pub(super) fn at(field: &str, problem: impl Into<String>) -> Self {
        Self { field: field.to_owned(), problem: problem.into() }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.field, self.problem)
    }
}

/// What is asked about a gather point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Query {
    /// The value and the densities at a unit direction.
    Wi(Vec3),
    /// The sample of three numbers in `[0, 1)`: for the lobe, the longitude and the azimuth.
    Xi([f32; 3]),
}

/// A line of the input, rounded to single precision: every path is asked the same question, and what they differ by is
/// computed, not read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Request {
    pub(super) model: ModelKind,
    pub(super) sampler: Sampler,
    pub(super) params: HairParams,
    /// Unit.
    pub(super) wo: Vec3,
    pub(super) query: Query,
}

impl Request {
    /// Reads a line.
    pub(super) fn parse(line: &str) -> Result<Self, Refusal> {
        let known = ["model", "sampler", "params", "wo", "wi", "xi"];
        let [model, sampler, params, wo, wi, xi] = Json::parse(line)?.fields("", known)?;
        let model = Json::text(model, "model")?.ok_or_else(|| Refusal::at("model", "missing"))?;
        let model = named("model", &model, ModelKind::ALL, ModelKind::name)?;
        let sampler = Json::text(sampler, "sampler")?
            .map_or(Ok(Sampler::Ou), |sampler| named("sampler", &sampler, SAMPLERS, Sampler::name))?;
        let exact = parameters(params.ok_or_else(|| Refusal::at("params", "missing"))?)?;
        let params = checked(&exact)?;
        let wo = direction(wo, "wo")?;
        let query = match (wi, xi) {
            (Some(wi), None) => Query::Wi(direction(Some(wi), "wi")?),
            (None, Some(xi)) => Query::Xi(uniform(Some(xi), "xi")?),
            (None, None) => return Err(Refusal::at("wi", "missing, and so is xi: one of them is needed")),
            (Some(_), Some(_)) => return Err(Refusal::at("wi", "given together with xi: only one of them may be")),
        };
        Ok(Self { model, sampler, params, wo, query })
    }
}

/// The one of `all` that has this name.
fn named<T: Copy, const N: usize>(
    field: &str,
    name: &str,
    all: [T; N],
    name_of: fn(T) -> &'static str,
) -> Result<T, Refusal> {
    all.into_iter().find(|one| name_of(*one) == name).ok_or_else(|| {
        let names = all.map(|one| format!("\"{}\"", name_of(one))).join(" or ");
        Refusal::at(field, format!("must be {names}, got \"{}\"", shortened(name)))
    })
}

/// The hair of `params`, every field required.
fn parameters(params: Json) -> Result<Parameters<f64>, Refusal> {
    let known = ["alpha", "beta", "gamma_tt", "gamma_g", "phi_g", "i_r", "i_tt", "i_trt", "i_g"];
    let [alpha, beta, gamma_tt, gamma_g, phi_g, i_r, i_tt, i_trt, i_g] = params.fields("params", known)?;
    Ok(Parameters {
        alpha: Json::three(alpha, "params.alpha")?,
        beta: Json::three(beta, "params.beta")?,
        gamma_tt: Json::number(gamma_tt, "params.gamma_tt")?,
        gamma_g: Json::number(gamma_g, "params.gamma_g")?,
        phi_g: Json::number(phi_g, "params.phi_g")?,
        intensity_r: Json::three(i_r, "params.i_r")?,
        intensity_tt: Json::three(i_tt, "params.i_tt")?,
        intensity_trt: Json::three(i_trt, "params.i_trt")?,
        intensity_g: Json::number(i_g, "params.i_g")?,
    })
}

/// The parameters in single precision, within their ranges: a width of pi is one whichever precision it is written in.
fn checked(exact: &Parameters<f64>) -> Result<HairParams, Refusal> {
    let [alpha_r, alpha_tt, alpha_trt] = exact.alpha.map(single);
    let [beta_r, beta_tt, beta_trt] = exact.beta.map(single);
    let desc = HairDesc {
        alpha_r,
        alpha_tt,
        alpha_trt,
        beta_r,
        beta_tt,
        beta_trt,
        gamma_tt: single(exact.gamma_tt),
        gamma_g: single(exact.gamma_g),
        phi_g: single(exact.phi_g),
        intensity_r: exact.intensity_r.map(single),
        intensity_tt: exact.intensity_tt.map(single),
        intensity_trt: exact.intensity_trt.map(single),
        intensity_g: single(exact.intensity_g),
    };
    HairParams::new(&desc).map_err(|error| refused(&error, exact))
}

/// A refusal in the words of [`ParamError`], with the field's name and value as they are in the input.
fn refused(error: &ParamError, exact: &Parameters<f64>) -> Refusal {
    let (field, value) = match (error.field(), error) {
        ("alpha_r", _) => ("alpha[0]".to_owned(), exact.alpha[0]),
        ("alpha_tt", _) => ("alpha[1]".to_owned(), exact.alpha[1]),
        ("alpha_trt", _) => ("alpha[2]".to_owned(), exact.alpha[2]),
        ("beta_r", _) => ("beta[0]".to_owned(), exact.beta[0]),
        ("beta_tt", _) => ("beta[1]".to_owned(), exact.beta[1]),
        ("beta_trt", _) => ("beta[2]".to_owned(), exact.beta[2]),
        ("gamma_tt", _) => ("gamma_tt".to_owned(), exact.gamma_tt),
        ("gamma_g", _) => ("gamma_g".to_owned(), exact.gamma_g),
        ("phi_g", _) => ("phi_g".to_owned(), exact.phi_g),
        ("intensity_r", ParamError::Intensity(_, c, _)) => (format!("i_r[{c}]"), exact.intensity_r[*c]),
        ("intensity_tt", ParamError::Intensity(_, c, _)) => (format!("i_tt[{c}]"), exact.intensity_tt[*c]),
        ("intensity_trt", ParamError::Intensity(_, c, _)) => (format!("i_trt[{c}]"), exact.intensity_trt[*c]),
        ("intensity_g", _) => ("i_g".to_owned(), exact.intensity_g),
        _ => return Refusal::at("params", error.to_string()),
    };
    let text = error.to_string();
    let rule = text.split_once(" must ").and_then(|(_, rest)| rest.rsplit_once(", got ")).map(|(rule, _)| rule);
    let problem = match rule {
        // Finite in the input, but too large for single precision.
        Some(_) if single(value).is_infinite() => format!("too large for single precision, got {value:e}"),
        Some(rule) => format!("must {rule}, got {value}"),
        None => text,
    };
    Refusal::at(&format!("params.{field}"), problem)
}

/// A direction, normalised.
fn direction(json: Option<Json>, field: &str) -> Result<Vec3, Refusal> {
    let [u, v, w] = Json::three(json, field)?;
    let length = u.hypot(v).hypot(w);
    if (length - 1.0).abs() <= ROUNDED {
        Ok(single3([u, v, w]))
    } else if (length - 1.0).abs() <= LENGTH_TOLERANCE {
        Ok(single3([u / length, v / length, w / length]))
    } else {
        Err(Refusal::at(field, format!("must be a unit vector (to {LENGTH_TOLERANCE}), got length {length}")))
    }
}

/// Three numbers in `[0, 1)`.
fn uniform(json: Option<Json>, field: &str) -> Result<[f32; 3], Refusal> {
    let xi = Json::three(json, field)?;
    for (i, x) in xi.iter().enumerate() {
        if !(0.0..1.0).contains(x) {
            return Err(Refusal::at(&format!("{field}[{i}]"), format!("must be in [0, 1), got {x}")));
        }
    }
    Ok(single_xi(xi))
}

/// The nearest number of single precision.
#[expect(clippy::cast_possible_truncation, reason = "single precision is what is asked for")]
pub(super) fn single(x: f64) -> f32 {
    x as f32
}

/// A direction in single precision.
fn single3([u, v, w]: [f64; 3]) -> Vec3 {
    Vec3::new(single(u), single(v), single(w))
}

/// Uniform numbers in single precision, below 1 still.
fn single_xi(xi: [f64; 3]) -> [f32; 3] {
    const LARGEST: f32 = 1.0 - f32::EPSILON / 2.0;
    xi.map(|x| single(x).min(LARGEST))
}
