//! One line of the input, checked.

use super::json::{Fields, Json, shortened};
use core::fmt;
use glam::Vec3;
use hairis::ParamError;
use hairis_variants::{AnyBsdf, Field, Kind, ModelId, Values};

/// Tolerance of the length of a direction; it is normalised then.
const LENGTH_TOLERANCE: f64 = 1e-3;
/// Tolerance of the length of a unit vector in single precision. Such a vector is not normalised, so that all paths answer
/// for the same direction.
const ROUNDED: f64 = 2e-7;

/// Refusal of a line: the path of the field at fault, and the problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    field: String,
    problem: String,
}

impl Refusal {
    pub(super) fn at(field: &str, problem: impl Into<String>) -> Self {
        Self { field: cut(field.to_owned(), LONGEST_FIELD), problem: cut(problem.into(), LONGEST_PROBLEM) }
    }
}

/// Longest path of a field and longest problem in a refusal, in characters: a line of the input is echoed in part.
const LONGEST_FIELD: usize = 80;
const LONGEST_PROBLEM: usize = 240;

fn cut(mut text: String, longest: usize) -> String {
    if let Some((at, _)) = text.char_indices().nth(longest) {
        text.truncate(at);
        text.push_str("...");
    }
    text
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.field, self.problem)
    }
}

/// Query about a shading point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Query {
    /// The value and the densities at a unit direction.
    Wi(Vec3),
    /// The sample of three numbers in `[0, 1)`: for the lobe, the longitude and the azimuth.
    Xi([f32; 3]),
}

/// A line of the input, rounded to single precision for the kernels, and as it is for the formulas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request {
    pub(super) model: ModelId,
    pub(super) values: Values,
    pub(super) bsdf: AnyBsdf,
    /// Unit.
    pub(super) wo: Vec3,
    /// Offset across the fibre; 0 for a model of the far field.
    pub(super) h: f32,
    pub(super) query: Query,
    pub(super) exact: Exact,
}

/// The numbers of a line in double precision; the query is the `wi` or `xi` of [`Query`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Exact {
    pub(super) values: Values<f64>,
    pub(super) wo: [f64; 3],
    pub(super) h: f64,
    pub(super) query: [f64; 3],
}

impl Request {
    /// Reads a line.
    pub(super) fn parse(line: &str) -> Result<Self, Refusal> {
        let line = Json::parse(line)?;
        // The fields of a line are those of its model; of the first, where the name is not that of any.
        let first = line.peek("model").and_then(|name| ModelId::find(name, None)).unwrap_or(ModelId::ALL[0]);
        let choice = first.choice().map(|(field, _)| field);
        let h = first.is_near_field().then_some("h");
        let known = ["model"].into_iter().chain(choice).chain(["params"]).chain(h).chain(["wo", "wi", "xi"]);
        let mut line = line.fields("", &known.collect::<Vec<_>>())?;

        let name = line.text("model")?;
        named("model", &name, &ModelId::defaults_of_names().map(ModelId::name).collect::<Vec<_>>())?;
        let model = match choice.filter(|field| line.has(field)) {
            Some(field) => chosen(first.name(), field, &line.text(field)?)?,
            None => first,
        };
        let (values, exact) = read(model.defaults(), line.take("params")?)?;
        let bsdf = model.bsdf(&values).map_err(|error| refused(model.fields(), &error, &exact))?;
        let h = if line.has("h") { line.number("h")?.clamp(-1.0, 1.0) } else { 0.0 };
        let wo = direction(&mut line, "wo")?;
        let (query, numbers) = match [line.has("wi"), line.has("xi")] {
            [true, false] => {
                let wi = direction(&mut line, "wi")?;
                (Query::Wi(single3(wi)), wi)
            }
            [false, true] => {
                let xi = uniform(&mut line, "xi")?;
                (Query::Xi(single_xi(xi)), xi)
            }
            [false, false] => return Err(line.refuse("wi", "missing; give wi or xi")),
            [true, true] => return Err(line.refuse("wi", "given together with xi; give one of them")),
        };
        let exact = Exact { values: exact, wo, h, query: numbers };
        Ok(Self { model, values, bsdf, wo: single3(wo), h: single(h), query, exact })
    }
}

/// The model of this name and of this word in the field of its choice.
fn chosen(name: &str, field: &str, word: &str) -> Result<ModelId, Refusal> {
    let of_name = ModelId::ALL.iter().filter(|id| id.name() == name);
    named(field, word, &of_name.filter_map(|id| id.choice()).map(|(_, word)| word).collect::<Vec<_>>())?;
    ModelId::find(name, Some(word)).ok_or_else(|| Refusal::at(field, "not of this model"))
}

/// The place of `name` in `names`.
fn named(field: &str, name: &str, names: &[&str]) -> Result<usize, Refusal> {
    names.iter().position(|one| *one == name).ok_or_else(|| {
        let names: Vec<String> = names.iter().map(|one| format!("\"{one}\"")).collect();
        Refusal::at(field, format!("must be {}, got \"{}\"", names.join(" or "), shortened(name)))
    })
}

/// The values that `params` gives in place of the defaults, rounded, and as they are in the input.
fn read(mut values: Values, params: Json) -> Result<(Values, Values<f64>), Refusal> {
    let fields = values.fields();
    let mut given = params.fields("params", &fields.iter().map(|field| field.name).collect::<Vec<_>>())?;
    for field in fields.iter().filter(|field| field.instead_of.is_none()) {
        one_of_group(field.name, fields, &given)?;
    }
    let mut exact = values.map(f64::from);
    for field in fields {
        if !given.has(field.name) && (field.optional || in_group(field, fields)) {
            continue;
        }
        if let Some(other) = field.instead_of {
            (values, exact) = (values.without(other), exact.without(other));
        }
        let numbers = numbers(field, &mut given)?;
        exact = exact.with(field.name, &numbers);
        values = values.with(field.name, &numbers.iter().map(|x| single(*x)).collect::<Vec<_>>());
    }
    Ok((values, exact))
}

/// Whether `field` replaces another, or another replaces it.
fn in_group(field: &Field, fields: &[Field]) -> bool {
    field.instead_of.is_some() || fields.iter().any(|other| other.instead_of == Some(field.name))
}

/// Refuses the group of `head` if not exactly one of its fields is given; a field alone may be missing for now.
fn one_of_group(head: &str, fields: &[Field], given: &Fields) -> Result<(), Refusal> {
    let group = fields.iter().filter(|field| field.name == head || field.instead_of == Some(head));
    let (found, missing): (Vec<&str>, Vec<&str>) = group.map(|field| field.name).partition(|name| given.has(name));
    match (&*found, &*missing) {
        ([], [_, others @ ..]) if !others.is_empty() => {
            Err(given.refuse(head, format!("missing; give one of {head}, {}", others.join(", "))))
        }
        ([first, others @ ..], _) if !others.is_empty() => {
            Err(given.refuse(first, format!("given together with {}; give one of them", others.join(", "))))
        }
        _ => Ok(()),
    }
}

/// The numbers of a field of `params`; for a word its index.
fn numbers(field: &Field, given: &mut Fields) -> Result<Vec<f64>, Refusal> {
    match field.kind {
        Kind::Number => Ok(vec![given.number(field.name)?]),
        Kind::Word(words) => {
            let word = given.text(field.name)?;
            #[expect(clippy::cast_precision_loss, reason = "a few words")]
            named(&format!("params.{}", field.name), &word, words).map(|place| vec![place as f64])
        }
        kind => given.numbers(field.name, kind.width()),
    }
}

/// A refusal with the text of [`ParamError`], and the field's name and value as they are in the input.
fn refused(fields: &[Field], error: &ParamError, exact: &Values<f64>) -> Refusal {
    let text = error.to_string();
    let rule = text.split_once(" must ").and_then(|(_, rest)| rest.rsplit_once(", got "));
    let (Some((field, number)), Some((rule, value))) = (Field::refused(fields, error), rule) else {
        return Refusal::at("params", text);
    };
    let is_list = field.kind.width() > 1;
    let item = number.filter(|_| is_list).map_or_else(String::new, |number| format!("[{number}]"));
    let numbers = exact.numbers(field.name);
    let problem = match if is_list { number.and_then(|number| numbers.get(number)) } else { numbers.first() } {
        // Finite in the input, but too large for single precision.
        Some(value) if single(*value).is_infinite() => format!("too large for single precision, got {value:e}"),
        Some(value) => format!("must {rule}, got {value}"),
        None => format!("must {rule}, got {value}"),
    };
    Refusal::at(&format!("params.{}{item}", field.name), problem)
}

/// A direction, normalised.
fn direction(line: &mut Fields, field: &str) -> Result<[f64; 3], Refusal> {
    let [u, v, w] = line.three(field)?;
    let length = u.hypot(v).hypot(w);
    if (length - 1.0).abs() <= ROUNDED {
        Ok([u, v, w])
    } else if (length - 1.0).abs() <= LENGTH_TOLERANCE {
        Ok([u / length, v / length, w / length])
    } else {
        Err(Refusal::at(field, format!("must be a unit vector (to {LENGTH_TOLERANCE}), got length {length}")))
    }
}

/// Three numbers in `[0, 1)`.
fn uniform(line: &mut Fields, field: &str) -> Result<[f64; 3], Refusal> {
    let xi = line.three(field)?;
    for (i, x) in xi.iter().enumerate() {
        if !(0.0..1.0).contains(x) {
            return Err(Refusal::at(&format!("{field}[{i}]"), format!("must be in [0, 1), got {x}")));
        }
    }
    Ok(xi)
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

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_variants::{ChiangParams, KajiyaKayParams, Parameters};

    /// The parameters that a text gives, or the refusal.
    fn params<P: Parameters>(text: &str) -> Result<P, String> {
        let json = Json::parse(text).map_err(|refusal| refusal.to_string())?;
        let (values, exact) = read(P::default().values(), json).map_err(|refusal| refusal.to_string())?;
        P::from_values(&values).map_err(|error| refused(P::FIELDS, &error, &exact).to_string())
    }

    #[test]
    fn words_and_fields_that_may_be_missing() {
        let read = params::<KajiyaKayParams>(r#"{"kd":[0.1,0.2,0.3],"ks":[0,0,0],"exponent":9,"form":"published"}"#);
        let read = read.expect("legal").values();
        assert_eq!((read.word("form"), read.numbers("exponent")), ("published", &[9.0][..]));
        let read = params::<KajiyaKayParams>(r#"{"kd":[0.1,0.2,0.3],"ks":[0,0,0],"exponent":9}"#).expect("legal");
        assert_eq!(read.values().word("form"), "reciprocal");
        for (text, problem) in [
            (r#"{"ks":[0,0,0],"exponent":9}"#, "params.kd: missing"),
            (
                r#"{"kd":[0,0,0],"ks":[0,0,0],"exponent":9,"form":"new"}"#,
                "params.form: must be \"reciprocal\" or \"published\", got \"new\"",
            ),
            (r#"{"kd":[0,-1,0],"ks":[0,0,0],"exponent":9}"#, "params.kd[1]: must be finite and at least 0, got -1"),
            (r#"{"kd":[0,0,0],"ks":[0,0,0],"exponent":0.1}"#, "params.exponent: must be in [1, 10000], got 0.1"),
        ] {
            assert_eq!(params::<KajiyaKayParams>(text), Err(problem.to_owned()), "{text}");
        }
    }

    #[test]
    fn one_field_of_a_group() {
        let read = |rest: &str| params::<ChiangParams>(&format!(r#"{{"beta_m":0.3,"beta_n":0.3{rest}}}"#));
        assert_eq!(read(r#","melanin":[0.3,0]"#), Ok(ChiangParams::blond()));
        assert_eq!(
            read(r#","tilt":0,"eta":1.5,"sigma_a":[0,1,2]"#).map(|read| read.desc().sigma_a),
            Ok([0.0, 1.0, 2.0])
        );
        assert!(read(r#","color":[0.5,0.4,0.3]"#).is_ok(), "a colour");
        for (rest, problem) in [
            ("", "params.sigma_a: missing; give one of sigma_a, melanin, color"),
            (r#","melanin":[0,0],"color":[0,0,0]"#, "params.melanin: given together with color; give one of them"),
            (r#","melanin":[0,-1]"#, "params.melanin[1]: must be finite and at least 0, got -1"),
            (r#","color":[0,1.5,0]"#, "params.color: must be in [0, 1], got 1.5"),
            (r#","sigma_a":[0,0,0],"eta":0.5"#, "params.eta: must be in [1, 4], got 0.5"),
        ] {
            assert_eq!(read(rest), Err(problem.to_owned()), "{rest}");
        }
    }
}
