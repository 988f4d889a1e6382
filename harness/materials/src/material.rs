//! Models of the registry with their parameters, as programs read them from JSON.

use crate::color;
pub use crate::json::single;
use crate::json::{Json, join, number, numbers, refusal, word};
use hairis::ParamError;
use hairis_variants::chiang::Likeness;
use hairis_variants::color::has_color;
use hairis_variants::{Field, Kind, ModelId, Values};
use std::collections::BTreeMap;

#[cfg(feature = "any")]
use hairis_variants::AnyMaterial;
#[cfg(not(feature = "any"))]
use hairis_variants::{Registered, Visitor};

/// Fields of a JSON object, by name.
type Fields = BTreeMap<String, Json>;

/// Model of which other renderers have parameters of their own: see [`Likeness`].
const LIKE: &str = "chiang";

/// Returns the model of a name, with its first sampler.
///
/// # Errors
///
/// Returns the rest of a sentence that begins with a flag or a field: what names there are, and the one that is none of them.
pub fn find_model(name: &str) -> Result<ModelId, String> {
    ModelId::find(name, None).ok_or_else(|| {
        let names: Vec<&str> = ModelId::defaults_of_names().map(ModelId::name).collect();
        format!("must be one of {}, got {name:?}", names.join(", "))
    })
}

/// Returns the model with another sampler, by the sampler's word.
///
/// # Errors
///
/// Returns the rest of a sentence that begins with a flag or a field: which words there are, and the one that is none of them.
pub fn find_sampler(model: ModelId, word: &str) -> Result<ModelId, String> {
    let name = model.name();
    ModelId::find(name, Some(word)).ok_or_else(|| {
        let of_name = ModelId::ALL.iter().filter(|id| id.name() == name);
        let words: Vec<_> = of_name.filter_map(|id| Some(id.choice()?.1)).collect();
        if words.is_empty() {
            format!("must be left out, as {name} has one sampler, got {word:?}")
        } else {
            format!("must be one of {}, got {word:?}", words.join(", "))
        }
    })
}

/// Material specification: a model of the registry with parameters that have been checked.
///
/// ```
/// use hairis_materials::MaterialSpec;
/// let params = r#"{"beta_m": 0.2, "beta_n": 0.3, "melanin_amount": [0.7, 0.4]}"#;
/// let text = format!(r#"{{"model": "chiang", "params": {params}}}"#);
/// let [material] = &MaterialSpec::parse_all(&text)?[..] else { panic!("one") };
/// assert_eq!(material.model.name(), "chiang");
/// let smooth = material.set(&["beta_m=0.1".to_owned()])?;
/// assert_eq!(smooth.values.numbers("beta_m"), [0.1]);
/// assert!(material.set(&["beta_m=7".to_owned()]).is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MaterialSpec {
    /// Model of the material.
    pub model: ModelId,
    /// Whether the input names the model's sampler, or another [`choice`](ModelId::choice) of the model.
    pub is_chosen: bool,
    /// Parameters, rounded to single precision.
    pub values: Values,
    /// Parameters in double precision, as they are in the input.
    pub exact: Values<f64>,
    /// Material for the kernels, made from the rounded parameters.
    #[cfg(feature = "any")]
    pub material: AnyMaterial,
}

/// Visitor that checks the values of a model's parameters without making a material.
#[cfg(not(feature = "any"))]
struct Check<'a>(&'a Values);

#[cfg(not(feature = "any"))]
impl Visitor for Check<'_> {
    type Output = Result<(), ParamError>;

    fn visit<M: Registered>(self) -> Self::Output {
        <M::Params as hairis_variants::Parameters>::from_values(self.0).map(|_| ())
    }
}

impl MaterialSpec {
    /// Makes the specification of a model with these parameters, after checking their values.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range.
    pub fn new(model: ModelId, values: Values) -> Result<Self, ParamError> {
        #[cfg(not(feature = "any"))]
        model.visit(Check(&values))?;
        Ok(Self {
            model,
            is_chosen: false,
            values,
            exact: values.map(f64::from),
            #[cfg(feature = "any")]
            material: model.material(&values)?,
        })
    }

    /// Returns a copy with other values. Those that differ are in single precision.
    fn with_values(&self, values: Values) -> Result<Self, String> {
        let changed = values
            .fields()
            .iter()
            .filter(|field| values.has(field.name))
            .filter(|field| values.numbers(field.name) != self.values.numbers(field.name));
        let exact = changed.fold(self.exact, |exact, field| {
            let numbers = values.numbers(field.name).iter();
            let numbers: Vec<f64> = numbers.map(|x| f64::from(*x)).collect();
            exact.with(field.name, &numbers)
        });
        let changed = Self::new(self.model, values).map_err(|error| error.to_string())?;
        Ok(Self {
            is_chosen: self.is_chosen,
            exact,
            ..changed
        })
    }

    /// Returns the first model with the name that an object gives, or the first model of all if no model has that name.
    #[must_use]
    pub fn first_of_name(object: &Json) -> ModelId {
        let name = object.peek("model");
        name.and_then(|name| ModelId::find(name, None))
            .unwrap_or(ModelId::ALL[0])
    }

    /// Returns the names of the fields in a request of `hairis eval` for a model: the fields of the material, followed by those of the
    /// query.
    pub fn fields_of_request(first: ModelId) -> impl Iterator<Item = &'static str> {
        let choice = first.choice().map(|(field, _)| field);
        let h = first.is_near_field().then_some("h");
        let like = (first.name() == LIKE).then_some("like");
        // A colour takes measurements of the kernels.
        let is_colored = cfg!(feature = "any") && has_color(first);
        let color = is_colored.then_some(["color", "color_of"]);
        ["model"]
            .into_iter()
            .chain(choice)
            .chain(like)
            .chain(color.into_iter().flatten())
            .chain(["params"])
            .chain(h)
            .chain(["wo", "wi", "xi"])
    }

    /// Reads a material from the fields of an object, whose model has been found by [`first_of_name`](Self::first_of_name).
    ///
    /// # Errors
    ///
    /// Returns an error that names the field and the problem if a field is missing or has no legal value.
    pub fn read(first: ModelId, object: &Fields) -> Result<Self, String> {
        let given = |name: &str| object.get(name).ok_or_else(|| refusal(name, "missing"));
        let names: Vec<_> = ModelId::defaults_of_names().map(ModelId::name).collect();
        word("model", given("model")?, &names)?;
        let choice = first.choice().map(|(field, _)| field);
        let choice = choice.and_then(|field| Some((field, object.get(field)?)));
        let mut model = first;
        if let Some((field, json)) = choice {
            let of_name = ModelId::ALL.iter().filter(|id| id.name() == first.name());
            let words: Vec<_> = of_name
                .filter_map(|id| id.choice())
                .map(|(_, word)| word)
                .collect();
            model = ModelId::find(first.name(), Some(words[word(field, json, &words)?]))
                .unwrap_or(first);
        }
        let color = color::read(object)?;
        if let Some(like) = object.get("like") {
            if color.is_some() {
                return Err(refusal(
                    "color",
                    "given together with like; give one of them",
                ));
            }
            let params = Self::like(like, given("params")?.clone())?;
            let is_chosen = choice.is_some();
            return Ok(Self {
                is_chosen,
                ..params
            });
        }
        let fields = model.fields();
        let params = given("params")?.clone();
        let mut params = params.fields("params", &names_of(fields))?;
        let absorption = fields.iter().filter(|field| head(field) == "sigma_a");
        for field in absorption.filter(|_| color.is_some()) {
            if params.contains_key(field.name) {
                let problem = format!(
                    "given together with params.{}; give one of them",
                    field.name
                );
                return Err(refusal("color", problem));
            }
            if field.name == "sigma_a" {
                params.insert("sigma_a".to_owned(), Json::parse("[0, 0, 0]")?);
            }
        }
        check_present(fields, &params)?;
        let (values, exact) = (model.defaults(), exact_defaults(model));
        let (values, exact) = replaced("params", values, exact, &params)?;
        let rounded =
            Self::new(model, values).map_err(|error| refused("params", fields, &error, &exact))?;
        let read = Self {
            is_chosen: choice.is_some(),
            exact,
            ..rounded
        };
        match color {
            Some(color) => {
                let values = color::shown(read.model, &read.values, color)?;
                read.with_values(values)
            }
            None => Ok(read),
        }
    }

    /// Reads the parameters of another renderer, whose name is `like`. They are converted in single precision.
    fn like(like: &Json, params: Json) -> Result<Self, String> {
        let names: Vec<&str> = Likeness::ALL.iter().map(|like| like.name).collect();
        let like = &Likeness::ALL[word("like", like, &names)?];
        let params = params.fields("params", &names_of(like.fields))?;
        check_present(like.fields, &params)?;
        let defaults = like.defaults();
        let (values, exact) = replaced("params", defaults, defaults.map(f64::from), &params)?;
        let refused = |error| refused("params", like.fields, &error, &exact);
        let (model, values) = like.entry(&values).map_err(refused)?;
        Self::new(model, values).map_err(refused)
    }

    /// Reads all materials of a text: objects with the fields of a request of `hairis eval`, one after another. The fields of the query
    /// are accepted and ignored.
    ///
    /// # Errors
    ///
    /// Returns an error if the text has no material, or if one is rejected. The error names the field and the problem, and the place of
    /// the material if there are several.
    pub fn parse_all(text: &str) -> Result<Vec<Self>, String> {
        // Files from Windows begin with a byte-order mark, and several files may have been joined.
        let objects = Json::parse_all(&text.replace('\u{feff}', " "))?;
        if objects.is_empty() {
            return Err("must have a material, got nothing".to_owned());
        }
        let is_single = objects.len() == 1;
        let read = |(place, object): (usize, Json)| {
            let first = Self::first_of_name(&object);
            let known: Vec<_> = Self::fields_of_request(first).collect();
            let material = object
                .fields("", &known)
                .and_then(|fields| Self::read(first, &fields));
            material.map_err(|problem| {
                if is_single {
                    problem
                } else {
                    format!("material {place}: {problem}")
                }
            })
        };
        (1..).zip(objects).map(read).collect()
    }

    /// Returns a copy in which some parameters are replaced, each by an assignment `NAME=VALUE`. A value is JSON, a word, or numbers
    /// separated by commas.
    ///
    /// # Errors
    ///
    /// Returns an error that names the parameter and the problem if the model has no such parameter, if the parameter is given twice,
    /// or if the value is not legal.
    pub fn set(&self, assignments: &[String]) -> Result<Self, String> {
        let fields = self.model.fields();
        let names = names_of(fields);
        let mut given = Fields::new();
        for assignment in assignments {
            let Some((name, value)) = assignment.split_once('=') else {
                return Err(refusal(assignment, "must be NAME=VALUE"));
            };
            let name = name.trim();
            if !names.contains(&name) {
                let (model, names) = (self.model.name(), names.join(", "));
                let problem = format!("no parameter of {model}, which has {names}");
                return Err(refusal(name, problem));
            }
            if given.insert(name.to_owned(), value_of(value)).is_some() {
                return Err(refusal(name, "given twice"));
            }
        }
        let (values, exact) = replaced("", self.values, self.exact, &given)?;
        let rounded =
            Self::new(self.model, values).map_err(|error| refused("", fields, &error, &exact))?;
        Ok(Self {
            is_chosen: self.is_chosen,
            exact,
            ..rounded
        })
    }
}

/// Returns the values of all given parameters as the JSON object that `hairis eval` reads.
#[must_use]
pub fn values_json(values: &Values) -> serde_json::Value {
    let json = |field: &Field| match field.kind {
        Kind::Number => serde_json::json!(values.numbers(field.name)[0]),
        Kind::Word(_) => serde_json::json!(values.word(field.name)),
        _ => serde_json::json!(values.numbers(field.name)),
    };
    let given = values
        .fields()
        .iter()
        .filter(|field| values.has(field.name));
    given
        .map(|field| (field.name.to_owned(), json(field)))
        .collect()
}

/// Parses the value of an assignment: as JSON, else as a list of JSON values between commas, else as a string.
fn value_of(text: &str) -> Json {
    let text = text.trim();
    let parse = |text: &str| Json::parse(text).ok();
    let listed = || parse(&format!("[{text}]")).filter(|_| text.contains(','));
    parse(text)
        .or_else(listed)
        .unwrap_or_else(|| Json::Text(text.to_owned()))
}

fn names_of(fields: &[Field]) -> Vec<&'static str> {
    fields.iter().map(|field| field.name).collect()
}

/// Returns the defaults of a model in double precision. Those that are a named value have the decimals of the name.
fn exact_defaults(model: ModelId) -> Values<f64> {
    let exact = model.defaults().map(f64::from);
    let named = model
        .fields()
        .iter()
        .filter(|field| !field.names.is_empty());
    named.fold(exact, |exact, field| {
        exact.with(field.name, &decimals(model.defaults().numbers(field.name)))
    })
}

/// Returns the shortest decimals that round to these numbers, in double precision.
fn decimals(numbers: &[f32]) -> Vec<f64> {
    let decimal = |x: &f32| x.to_string().parse().unwrap_or_else(|_| f64::from(*x));
    numbers.iter().map(decimal).collect()
}

/// Returns the name of the first field in the group of `field`; exactly one field of a group has a value.
fn head(field: &Field) -> &'static str {
    field.instead_of.unwrap_or(field.name)
}

/// Returns the field of the group of `field` that has a value: another field in its place, or the field itself.
#[must_use]
pub fn in_place_of(field: &Field, values: &Values) -> Option<&'static Field> {
    let mut fields = values.fields().iter();
    fields.find(|other| values.has(other.name) && head(other) == head(field))
}

/// Checks that every required field is given, and one field of each group.
fn check_present(fields: &[Field], given: &Fields) -> Result<(), String> {
    for field in fields.iter().filter(|field| field.instead_of.is_none()) {
        let group = fields.iter().filter(|other| head(other) == field.name);
        let group: Vec<&str> = group.map(|field| field.name).collect();
        let is_given = group.iter().any(|name| given.contains_key(*name));
        let problem = match &group[..] {
            _ if is_given => continue,
            _ if field.optional => continue,
            [_] => "missing".to_owned(),
            names => format!("missing; give one of {}", names.join(", ")),
        };
        return Err(refusal(&join("params", field.name), problem));
    }
    Ok(())
}

/// Replaces the values that `given` names, and clears the other fields of their groups. Returns the values rounded to single precision,
/// and as they are in the input.
fn replaced(
    path: &str,
    mut values: Values,
    mut exact: Values<f64>,
    given: &Fields,
) -> Result<(Values, Values<f64>), String> {
    let fields = values.fields();
    for field in fields {
        let Some(json) = given.get(field.name) else {
            continue;
        };
        let at = join(path, field.name);
        let others = fields
            .iter()
            .filter(|other| head(other) == head(field) && other.name != field.name);
        let together = others.clone().filter(|one| given.contains_key(one.name));
        let together: Vec<&str> = together.map(|other| other.name).collect();
        if !together.is_empty() {
            let names = together.join(", ");
            let problem = format!("given together with {names}; give one of them");
            return Err(refusal(&at, problem));
        }
        let numbers = match field.kind {
            Kind::Number => vec![number(&at, json)?],
            #[expect(clippy::cast_precision_loss, reason = "a few words")]
            Kind::Word(words) => vec![word(&at, json, words)? as f64],
            _ if !field.names.is_empty() && matches!(json, Json::Text(_)) => {
                decimals(field.named[word(&at, json, field.names)?])
            }
            kind => numbers(&at, json, kind.width())?,
        };
        for other in others {
            (values, exact) = (values.without(other.name), exact.without(other.name));
        }
        exact = exact.with(field.name, &numbers);
        let rounded: Vec<f32> = numbers.iter().map(|x| single(*x)).collect();
        values = values.with(field.name, &rounded);
    }
    Ok((values, exact))
}

/// Formats a refusal by the rule of [`ParamError`], with the name and the value of the field as they are in the input.
fn refused(path: &str, fields: &[Field], error: &ParamError, exact: &Values<f64>) -> String {
    let Some((field, number)) = Field::refused(fields, error) else {
        return refusal("params", error.to_string());
    };
    let item = number.map_or_else(String::new, |number| format!("[{number}]"));
    let value = exact.numbers(field.name).get(number.unwrap_or(0)).copied();
    let problem = match value {
        // Finite in the input, but too large for single precision.
        Some(value) if single(value).is_infinite() => {
            format!("too large for single precision, got {value:e}")
        }
        Some(value) => format!("must be {}, got {value}", error.rule()),
        None => format!("must be {}, got {}", error.rule(), error.value()),
    };
    refusal(&(join(path, field.name) + &item), problem)
}
