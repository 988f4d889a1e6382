//! One line of the input, checked.

use super::json::{Json, join};
use glam::Vec3;
use hairis::ParamError;
use hairis_variants::{AnyMaterial, Field, Kind, ModelId, Values};

/// Tolerance of the length of a direction; it is normalised then.
const LENGTH_TOLERANCE: f64 = 1e-3;
/// Tolerance of the length of a unit vector in single precision. Such a vector is not normalised, so that all paths answer
/// for the same direction.
const ROUNDED: f64 = 2e-7;

/// Refusal of a line: the path of the field at fault, and the problem. A line of the input is echoed in part.
pub(super) fn refusal(field: &str, problem: impl Into<String>) -> String {
    format!("{}: {}", cut(field, 80), cut(&problem.into(), 240))
}

/// The first `longest` characters of a text.
pub(super) fn cut(text: &str, longest: usize) -> String {
    match text.char_indices().nth(longest) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_owned(),
    }
}

/// Query about a shading point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Query {
    /// The value and the densities at a unit direction.
    Wi(Vec3),
    /// The sample of three numbers in `[0, 1)`: for the lobe, the inclination and the azimuth.
    Xi([f32; 3]),
}

/// A line of the input, rounded to single precision for the kernels, and as it is for the formulas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request {
    pub(super) model: ModelId,
    pub(super) values: Values,
    pub(super) material: AnyMaterial,
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
    pub(super) fn parse(line: &str) -> Result<Self, String> {
        let line = Json::parse(line)?;
        // The fields of a line are those of its model; of the first, where the name is not that of any.
        let first = line
            .peek("model")
            .and_then(|name| ModelId::find(name, None))
            .unwrap_or(ModelId::ALL[0]);
        let choice = first.choice().map(|(field, _)| field);
        let h = first.is_near_field().then_some("h");
        let known = ["model"]
            .into_iter()
            .chain(choice)
            .chain(["params"])
            .chain(h)
            .chain(["wo", "wi", "xi"]);
        let line = line.fields("", &known.collect::<Vec<_>>())?;
        let given = |name: &str| line.get(name).ok_or_else(|| refusal(name, "missing"));

        let names: Vec<_> = ModelId::defaults_of_names().map(ModelId::name).collect();
        word("model", given("model")?, &names)?;
        let mut model = first;
        if let Some((field, json)) = choice.and_then(|field| Some((field, line.get(field)?))) {
            let of_name = ModelId::ALL.iter().filter(|id| id.name() == first.name());
            let words: Vec<_> = of_name
                .filter_map(|id| id.choice())
                .map(|(_, word)| word)
                .collect();
            model = ModelId::find(first.name(), Some(words[word(field, json, &words)?]))
                .unwrap_or(first);
        }
        let (values, exact) = read(model.defaults(), given("params")?.clone())?;
        let material = model
            .material(&values)
            .map_err(|error| refused(model.fields(), &error, &exact))?;
        let h = line
            .get("h")
            .map_or(Ok(0.0), |json| number("h", json))?
            .clamp(-1.0, 1.0);
        let wo = direction("wo", given("wo")?)?;
        let (query, numbers) = match [line.get("wi"), line.get("xi")] {
            [Some(wi), None] => {
                let wi = direction("wi", wi)?;
                (Query::Wi(single3(wi)), wi)
            }
            [None, Some(xi)] => {
                let xi = uniform("xi", xi)?;
                (Query::Xi(single_xi(xi)), xi)
            }
            [None, None] => return Err(refusal("wi", "missing; give wi or xi")),
            [Some(_), Some(_)] => {
                return Err(refusal("wi", "given together with xi; give one of them"));
            }
        };
        let exact = Exact {
            values: exact,
            wo,
            h,
            query: numbers,
        };
        Ok(Self {
            model,
            values,
            material,
            wo: single3(wo),
            h: single(h),
            query,
            exact,
        })
    }
}

/// The values that `params` gives in place of the defaults, rounded, and as they are in the input.
fn read(mut values: Values, params: Json) -> Result<(Values, Values<f64>), String> {
    let fields = values.fields();
    let given = params.fields(
        "params",
        &fields.iter().map(|field| field.name).collect::<Vec<_>>(),
    )?;
    for head in fields
        .iter()
        .filter(|field| field.instead_of.is_none())
        .map(|field| field.name)
    {
        // A group of fields, exactly one of which is given; a field alone may be missing for now.
        let group = fields
            .iter()
            .filter(|field| field.name == head || field.instead_of == Some(head));
        let group: Vec<&str> = group.map(|field| field.name).collect();
        let found: Vec<&str> = group
            .iter()
            .copied()
            .filter(|name| given.contains_key(*name))
            .collect();
        if found.is_empty() && group.len() > 1 {
            return Err(refusal(
                &join("params", head),
                format!("missing; give one of {}", group.join(", ")),
            ));
        }
        if let [first, others @ ..] = &*found
            && !others.is_empty()
        {
            let problem = format!(
                "given together with {}; give one of them",
                others.join(", ")
            );
            return Err(refusal(&join("params", first), problem));
        }
    }
    let mut exact = values.map(f64::from);
    for field in fields {
        let at = join("params", field.name);
        let is_grouped = || {
            fields
                .iter()
                .any(|other| other.instead_of == Some(field.name))
        };
        let json = match given.get(field.name) {
            None if field.optional || field.instead_of.is_some() || is_grouped() => continue,
            json => json.ok_or_else(|| refusal(&at, "missing"))?,
        };
        if let Some(other) = field.instead_of {
            (values, exact) = (values.without(other), exact.without(other));
        }
        let numbers = match field.kind {
            Kind::Number => vec![number(&at, json)?],
            #[expect(clippy::cast_precision_loss, reason = "a few words")]
            Kind::Word(words) => vec![word(&at, json, words)? as f64],
            kind => numbers(&at, json, kind.width())?,
        };
        exact = exact.with(field.name, &numbers);
        values = values.with(
            field.name,
            &numbers.iter().map(|x| single(*x)).collect::<Vec<_>>(),
        );
    }
    Ok((values, exact))
}

/// A refusal with the text of [`ParamError`], and the field's name and value as they are in the input.
fn refused(fields: &[Field], error: &ParamError, exact: &Values<f64>) -> String {
    let text = error.to_string();
    let rule = text
        .split_once(" must ")
        .and_then(|(_, rest)| rest.rsplit_once(", got "));
    let (Some((field, number)), Some((rule, value))) = (Field::refused(fields, error), rule) else {
        return refusal("params", text);
    };
    let is_list = field.kind.width() > 1;
    let item = number
        .filter(|_| is_list)
        .map_or_else(String::new, |number| format!("[{number}]"));
    let numbers = exact.numbers(field.name);
    let problem = match if is_list {
        number.and_then(|number| numbers.get(number))
    } else {
        numbers.first()
    } {
        // Finite in the input, but too large for single precision.
        Some(value) if single(*value).is_infinite() => {
            format!("too large for single precision, got {value:e}")
        }
        Some(value) => format!("must {rule}, got {value}"),
        None => format!("must {rule}, got {value}"),
    };
    refusal(&format!("params.{}{item}", field.name), problem)
}

/// The place among `words` of the one at `path`.
fn word(path: &str, json: &Json, words: &[&str]) -> Result<usize, String> {
    let Json::Text(text) = json else {
        return Err(refusal(path, format!("must be a string, got {json}")));
    };
    words.iter().position(|word| word == text).ok_or_else(|| {
        let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
        refusal(path, format!("must be {}, got {json}", words.join(" or ")))
    })
}

/// The number at `path`.
fn number(path: &str, json: &Json) -> Result<f64, String> {
    match json {
        Json::Number(number) => Ok(*number),
        other => Err(refusal(path, format!("must be a number, got {other}"))),
    }
}

/// The `len` numbers at `path`.
fn numbers(path: &str, json: &Json, len: usize) -> Result<Vec<f64>, String> {
    match json {
        Json::Array(items) if items.len() == len => items
            .iter()
            .zip(0..)
            .map(|(json, i)| number(&format!("{path}[{i}]"), json))
            .collect(),
        Json::Array(items) => Err(refusal(
            path,
            format!("must have {len} numbers, got {}", items.len()),
        )),
        other => Err(refusal(
            path,
            format!("must be an array of {len} numbers, got {other}"),
        )),
    }
}

/// The direction at `path`, normalised.
fn direction(path: &str, json: &Json) -> Result<[f64; 3], String> {
    let numbers = numbers(path, json, 3)?;
    let length = numbers[0].hypot(numbers[1]).hypot(numbers[2]);
    if (length - 1.0).abs() > LENGTH_TOLERANCE {
        return Err(refusal(
            path,
            format!("must be a unit vector (to {LENGTH_TOLERANCE}), got length {length}"),
        ));
    }
    let divisor = if (length - 1.0).abs() <= ROUNDED {
        1.0
    } else {
        length
    };
    Ok([0, 1, 2].map(|row| numbers[row] / divisor))
}

/// The three numbers in `[0, 1)` at `path`.
fn uniform(path: &str, json: &Json) -> Result<[f64; 3], String> {
    let xi = numbers(path, json, 3)?;
    match xi.iter().position(|x| !(0.0..1.0).contains(x)) {
        Some(i) => Err(refusal(
            &format!("{path}[{i}]"),
            format!("must be in [0, 1), got {}", xi[i]),
        )),
        None => Ok([xi[0], xi[1], xi[2]]),
    }
}

/// The nearest number of single precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "single precision is what is asked for"
)]
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
        let json = Json::parse(text)?;
        let (values, exact) = read(P::default().values(), json)?;
        P::from_values(&values).map_err(|error| refused(P::FIELDS, &error, &exact))
    }

    #[test]
    fn words_and_fields_that_may_be_missing() {
        let read = params::<KajiyaKayParams>(
            r#"{"kd":[0.1,0.2,0.3],"ks":[0,0,0],"exponent":9,"form":"published"}"#,
        );
        let read = read.expect("legal").values();
        assert_eq!(
            (read.word("form"), read.numbers("exponent")),
            ("published", &[9.0][..])
        );
        let read = params::<KajiyaKayParams>(r#"{"kd":[0.1,0.2,0.3],"ks":[0,0,0],"exponent":9}"#)
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
                params::<KajiyaKayParams>(text),
                Err(problem.to_owned()),
                "{text}"
            );
        }
    }

    #[test]
    fn one_field_of_a_group() {
        let read =
            |rest: &str| params::<ChiangParams>(&format!(r#"{{"beta_m":0.3,"beta_n":0.3{rest}}}"#));
        assert_eq!(read(r#","melanin":[0.3,0]"#), Ok(ChiangParams::blond()));
        assert_eq!(
            read(r#","tilt":0,"eta":1.5,"sigma_a":[0,1,2]"#).map(|read| read.desc().sigma_a),
            Ok([0.0, 1.0, 2.0])
        );
        assert!(read(r#","color":[0.5,0.4,0.3]"#).is_ok(), "a colour");
        for (rest, problem) in [
            (
                "",
                "params.sigma_a: missing; give one of sigma_a, melanin, color",
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
                "params.color: must be in [0, 1], got 1.5",
            ),
            (
                r#","sigma_a":[0,0,0],"eta":0.5"#,
                "params.eta: must be in [1, 4], got 0.5",
            ),
        ] {
            assert_eq!(read(rest), Err(problem.to_owned()), "{rest}");
        }
    }
}
