//! Answers of another program: cases with numbers of its own.

use crate::draws::of_formulas;
use hairis::Lobe;
use hairis_materials::MaterialSpec;
use hairis_materials::json::{Json, direction, number, numbers, offset, refusal};
use hairis_reference::{Reference, exact_reference};
use hairis_variants::ModelId;
use std::collections::BTreeMap;

/// Fields of a case besides those of a request of `hairis eval`. The first two are for readers alone.
const MORE: [&str; 9] = [
    "case",
    "expected",
    "scene",
    "drawn_with",
    "value",
    "pdf",
    "lobes",
    "albedo",
    "samples",
];

/// Answer to a case, with what the formulas answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Line of the file, from 1.
    pub line: usize,
    /// Number of the shading point.
    pub scene: f64,
    /// Unit direction of the viewer, in the frame of the fibre.
    pub wo: [f64; 3],
    /// Unit direction of the light.
    pub wi: [f64; 3],
    /// Density with which the direction was drawn, per steradian, if the case has it.
    pub drawn_with: Option<f64>,
    /// Numbers of the program.
    pub got: Numbers,
    /// Numbers of the formulas.
    pub want: Numbers,
    /// Density of sampling the direction from each lobe alone, per steradian, by the formulas; 0 in slots without a lobe.
    pub lobe_pdfs: [f64; Lobe::COUNT],
    /// Unit directions that the program has drawn at the shading point, or `None` for each that it has discarded.
    pub samples: Vec<Option<[f64; 3]>>,
    /// Directions that the sampler of the formulas draws there, more than those of the program.
    pub formulas: Vec<Option<[f64; 3]>>,
}

/// Numbers at one direction.
#[derive(Clone, Debug, Default)]
pub struct Numbers {
    /// S without the cosine, linear RGB, per steradian.
    pub value: Option<[f64; 3]>,
    /// Density, per steradian.
    pub pdf: Option<f64>,
    /// Contribution of each lobe to S, linear RGB, per steradian, by the place of its name in [`Answers::lobes`].
    pub lobes: Vec<Option<[f64; 3]>>,
    /// Integral of each lobe's contribution times the cosine over all directions, linear RGB, in the same order.
    pub albedo: Vec<Option<[f64; 3]>>,
}

impl Numbers {
    /// Returns the numbers of the formulas at a direction, without the albedos.
    #[must_use]
    pub fn of(model: ModelId, point: &dyn Reference<f64>, wi: [f64; 3]) -> Self {
        let (value, pdf) = point.eval_pdf(wi);
        let lobes = point
            .lobes(wi)
            .0
            .map(|lobe| lobe.color.map(|c| c * lobe.value));
        Self {
            value: Some(value),
            pdf: Some(pdf),
            lobes: lobes.map(Some)[..model.lobes().len()].to_vec(),
            albedo: Vec::new(),
        }
    }

    /// Returns the albedos of the formulas.
    #[must_use]
    pub fn albedos(model: ModelId, point: &dyn Reference<f64>) -> Vec<Option<[f64; 3]>> {
        point.albedo().0.map(Some)[..model.lobes().len()].to_vec()
    }
}

/// Answers to cases of one model.
#[derive(Clone, Debug)]
pub struct Answers {
    /// Names of the model's lobes.
    pub lobes: &'static [&'static str],
    /// Answers in the order of the file.
    pub answers: Vec<Answer>,
}

impl Answers {
    /// Returns the answers of each shading point in turn.
    pub fn scenes(&self) -> impl Iterator<Item = &[Answer]> {
        self.answers.chunk_by(|a, b| a.scene == b.scene)
    }

    /// Parses lines of JSON.
    ///
    /// # Errors
    ///
    /// Returns an error that names the line, the field and the problem if a line is no case, has no number to judge, or is of another
    /// model than the first.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut first: Option<ModelId> = None;
        let mut answers = Vec::new();
        for (line, text) in (1..).zip(text.lines()) {
            let (model, answer) =
                parse(line, text).map_err(|problem| format!("line {line}: {problem}"))?;
            let first = *first.get_or_insert(model);
            if model.lobes() != first.lobes() {
                let [first, model] = [first, model].map(ModelId::name);
                let problem = refusal(
                    "model",
                    format!("must be that of line 1, {first:?}, got {model:?}"),
                );
                return Err(format!("line {line}: {problem}"));
            }
            answers.push(answer);
        }
        let lobes = first.ok_or("must have a case, got nothing")?.lobes();
        Ok(Self { lobes, answers })
    }
}

fn parse(line: usize, text: &str) -> Result<(ModelId, Answer), String> {
    let json = Json::parse(text)?;
    let first = MaterialSpec::first_of_name(&json);
    let known: Vec<_> = MaterialSpec::fields_of_request(first)
        .filter(|name| *name != "xi")
        .chain(MORE)
        .collect();
    let fields = json.fields("", &known)?;
    let given = |name: &str| fields.get(name).ok_or_else(|| refusal(name, "missing"));
    let optional = |name: &str| fields.get(name).map(|json| number(name, json)).transpose();
    let spec = MaterialSpec::read(first, &fields)?;
    let [wo, wi] = ["wo", "wi"].map(|name| direction(name, given(name)?));
    let (wo, wi) = (wo?, wi?);
    let h = fields.get("h").map_or(Ok(0.0), offset)?;
    let drawn_with = optional("drawn_with")?;
    if let Some(density) = drawn_with.filter(|density| *density <= 0.0) {
        return Err(refusal(
            "drawn_with",
            format!("must be above 0, got {density}"),
        ));
    }
    let by_lobe = |field: &str| {
        let names = spec.model.lobes();
        let lobes = match fields.get(field) {
            Some(json) => json.clone().fields(field, names)?,
            None => BTreeMap::new(),
        };
        let lobe = |name: &&str| {
            let json = lobes.get(*name);
            json.map(|json| three(&format!("{field}.{name}"), json))
                .transpose()
        };
        names.iter().map(lobe).collect::<Result<Vec<_>, String>>()
    };
    let samples = match fields.get("samples") {
        Some(Json::Array(drawn)) => (drawn.iter().enumerate())
            .map(|(k, json)| match json {
                Json::Null => Ok(None),
                json => direction(&format!("samples[{k}]"), json).map(Some),
            })
            .collect::<Result<_, _>>()?,
        Some(json) => {
            return Err(refusal("samples", format!("must be an array, got {json}")));
        }
        None => Vec::new(),
    };
    let got = Numbers {
        value: fields
            .get("value")
            .map(|json| three("value", json))
            .transpose()?,
        pdf: optional("pdf")?,
        lobes: by_lobe("lobes")?,
        albedo: by_lobe("albedo")?,
    };
    let has_lobes = |lobes: &[Option<[f64; 3]>]| lobes.iter().any(Option::is_some);
    if got.value.is_none() && got.pdf.is_none() && !has_lobes(&got.lobes) && !has_lobes(&got.albedo)
    {
        return Err(refusal(
            "value",
            "missing; give value, pdf, lobes or albedo",
        ));
    }
    let point = exact_reference(spec.model, &spec.values, &spec.exact, wo, h)
        .map_err(|error| error.to_string())?;
    let answer = Answer {
        line,
        scene: optional("scene")?.unwrap_or(0.0),
        wo,
        wi,
        drawn_with,
        want: Numbers {
            // A quadrature, of which each shading point needs one.
            albedo: if has_lobes(&got.albedo) {
                Numbers::albedos(spec.model, &*point)
            } else {
                Vec::new()
            },
            ..Numbers::of(spec.model, &*point, wi)
        },
        got,
        lobe_pdfs: point.lobe_pdfs(wi).0,
        formulas: of_formulas(&*point, samples.len()),
        samples,
    };
    Ok((spec.model, answer))
}

fn three(path: &str, json: &Json) -> Result<[f64; 3], String> {
    let numbers = numbers(path, json, 3)?;
    Ok([0, 1, 2].map(|row| numbers[row]))
}
