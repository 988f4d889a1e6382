//! Answers of `hairis eval`, computed along the chosen code path.

use super::request::{Exact, Query, Request};
use crate::args::CodePath;
use core::array::from_fn;
use core::ops::Index;
use glam::Vec3;
use hairis::columns::{EvalColumns, SampleColumns};
use hairis::model::LobeEval8;
use hairis::{Eval, Hit, Lobe, PerLobe, Sample, Vec3x8};
use hairis_materials::MaterialSpec;
use hairis_reference::{ReferenceSample, exact_reference};
use hairis_variants::{AnyBsdf, AnyMaterial8, ModelId};
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;
use wide::f32x8;

/// Answer to a request. `pdf_lobe` has one number per lobe of the model.
#[derive(Debug, Serialize)]
struct Answer<T> {
    /// Direction of a sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    wi: Option<[T; 3]>,
    s: [T; 3],
    pdf: T,
    pdf_lobe: Vec<T>,
    #[serde(flatten)]
    choice: Option<Choice<T>>,
    /// Colours of the lobes, under the name that the model gives them.
    #[serde(flatten)]
    colors: BTreeMap<&'static str, Vec<[T; 3]>>,
}

/// Further fields of the answer to uniform numbers. A discarded sample has no lobe, and 0 in every other field.
#[derive(Debug, Serialize)]
struct Choice<T> {
    lobe: Option<&'static str>,
    weight: [T; 3],
}

/// Returns the number of lines that a path takes at once.
pub(super) const fn block_len(path: CodePath) -> usize {
    match path {
        CodePath::Scalar | CodePath::F64 => 1,
        CodePath::X8 => 8,
        CodePath::Batch => 256,
    }
}

/// Answers a block of lines, in order. Numbers have the fewest digits that read back as the same number in the same precision.
pub(super) fn answers(
    path: CodePath,
    block: &[Result<Request, String>],
) -> serde_json::Result<Vec<String>> {
    let mut lines = vec![String::new(); block.len()];
    for (line, request) in lines.iter_mut().zip(block) {
        match request {
            Err(error) => *line = json!({ "error": error }).to_string(),
            Ok(request) if path == CodePath::F64 => {
                *line = serde_json::to_string(&formulas(request))?
            }
            Ok(_) => {}
        }
    }
    // Requests of one model are answered together; the answers then go back to their places.
    for model in ModelId::ALL.iter().filter(|_| path != CodePath::F64) {
        let requests = block
            .iter()
            .enumerate()
            .filter_map(|(at, line)| Some((at, line.as_ref().ok()?)));
        let (places, requests): (Vec<usize>, Vec<&Request>) =
            requests.filter(|(_, of)| of.spec.model == *model).unzip();
        let found: Vec<_> = match path {
            CodePath::X8 => requests.chunks(8).flat_map(eight).collect(),
            CodePath::Batch => {
                let is_shared = |a: &&Request, b: &&Request| {
                    (a.wo, a.h) == (b.wo, b.h) && a.spec.values == b.spec.values
                };
                requests.chunk_by(is_shared).flat_map(batch).collect()
            }
            CodePath::Scalar | CodePath::F64 => requests.into_iter().map(scalar).collect(),
        };
        for (at, answer) in places.into_iter().zip(&found) {
            lines[at] = serde_json::to_string(answer)?;
        }
    }
    Ok(lines)
}

/// Answers a request with one direction per call.
fn scalar(request: &Request) -> Answer<f32> {
    let bsdf = bsdf(request);
    let (found, wi) = match request.query {
        Query::Wi(wi) => (valued(bsdf.eval_pdf(wi)), wi),
        Query::Xi(xi) => {
            let sample = bsdf.sample(xi);
            (drawn(sample), sample.map_or(request.wo, |sample| sample.wi))
        }
    };
    let densities = bsdf.lobes(wi).0.map(|lobe| lobe.pdf);
    answer(request.spec.model, found, densities, &|| {
        bsdf.lobes(request.wo).0.map(|lobe| lobe.color)
    })
}

/// Answers up to eight lines in one call, all of one model: every lane has its own material, shading point and query. Spare lanes repeat
/// the last line.
fn eight(group: &[&Request]) -> Vec<Answer<f32>> {
    let lane = |i: usize| group[i.min(group.len() - 1)];
    let materials =
        AnyMaterial8::pack(from_fn(|i| &lane(i).spec.material)).expect("requests of one model");
    let wo = Vec3x8::from(from_fn(|i| lane(i).wo));
    let bsdfs = materials.prepare8(Hit {
        wo,
        h: f32x8::new(from_fn(|i| lane(i).h)),
    });
    // A lane whose line has no xi samples as well, but its sample is ignored.
    let xi: [[f32; 3]; 8] = from_fn(|i| match lane(i).query {
        Query::Wi(_) => [0.5; 3],
        Query::Xi(xi) => xi,
    });
    let samples = bsdfs.sample8(&from_fn(|row| f32x8::new(xi.map(|xi| xi[row]))));
    let wi = Vec3x8::from(from_fn(|i| match lane(i).query {
        Query::Wi(wi) => wi,
        Query::Xi(_) => samples.wi.lane(i),
    }));
    let (evals, lobes, at_wo) = (bsdfs.eval_pdf8(&wi), bsdfs.lobes8(&wi), bsdfs.lobes8(&wo));
    let of_lane = |(i, request): (usize, &&Request)| {
        let found = match request.query {
            Query::Wi(_) => valued(evals.lane(i)),
            Query::Xi(_) => drawn(samples.lane(i)),
        };
        let colors = || at_wo.0.map(|lobe| lobe.color.map(|c| c.as_array()[i]));
        answer(
            request.spec.model,
            found,
            densities_of_lane(&lobes, i),
            &colors,
        )
    };
    group.iter().enumerate().map(of_lane).collect()
}

/// Answers lines that share a shading point with slices: one call for all directions, and one for all samples.
fn batch(run: &[&Request]) -> Vec<Answer<f32>> {
    let bsdf = bsdf(run[0]);
    let (mut wi, mut xi) = (Vec::new(), Vec::new());
    for request in run {
        match request.query {
            Query::Wi(direction) => wi.push(direction),
            Query::Xi(numbers) => xi.push(numbers),
        }
    }
    let mut values = batch_values(&bsdf, &wi)
        .into_iter()
        .zip(batch_densities(&bsdf, &wi));
    let (wi, samples): (Vec<Vec3>, Vec<Found<f32>>) = batch_samples(&bsdf, &xi).into_iter().unzip();
    let mut samples = samples.into_iter().zip(batch_densities(&bsdf, &wi));
    let of_line = |request: &&Request| {
        let (found, densities) = match request.query {
            Query::Wi(_) => values.next()?,
            Query::Xi(_) => samples.next()?,
        };
        Some(answer(request.spec.model, found, densities, &|| {
            bsdf.lobes(request.wo).0.map(|lobe| lobe.color)
        }))
    };
    run.iter().filter_map(of_line).collect()
}

const ONE_LENGTH: &str = "slices of one length";

/// Returns three numbers of each item, as columns.
fn columns<V: Index<usize, Output = f32>>(of: &[V]) -> [Vec<f32>; 3] {
    from_fn(|row| of.iter().map(|item| item[row]).collect())
}

/// Returns the three numbers of columns at index `i`.
fn at(columns: &[Vec<f32>; 3], i: usize) -> [f32; 3] {
    columns.each_ref().map(|column| column[i])
}

/// Evaluates value and density at each direction.
fn batch_values(bsdf: &AnyBsdf, wi: &[Vec3]) -> Vec<Found<f32>> {
    let (mut value, mut pdf) = (columns(wi), vec![0.0; wi.len()]);
    let out = EvalColumns {
        value: Some(value.each_mut().map(Vec::as_mut_slice)),
        pdf: Some(&mut pdf),
    };
    bsdf.eval_columns(columns(wi).each_ref().map(Vec::as_slice), out)
        .expect(ONE_LENGTH);
    (0..wi.len())
        .map(|i| Found::Value(at(&value, i), pdf[i]))
        .collect()
}

/// Draws the samples, and returns each with its direction.
fn batch_samples(bsdf: &AnyBsdf, xi: &[[f32; 3]]) -> Vec<(Vec3, Found<f32>)> {
    let mut vectors: [[Vec<f32>; 3]; 3] = from_fn(|_| columns(xi));
    let (mut pdf, mut slot) = (vec![0.0; xi.len()], vec![0.0; xi.len()]);
    let [wi, value, weight] = vectors
        .each_mut()
        .map(|v| v.each_mut().map(Vec::as_mut_slice));
    let out = SampleColumns {
        wi: Some(wi),
        value: Some(value),
        pdf: Some(&mut pdf),
        weight: Some(weight),
        slot: Some(&mut slot),
    };
    bsdf.sample_columns(columns(xi).each_ref().map(Vec::as_slice), out)
        .expect(ONE_LENGTH);
    let sample = |i: usize| {
        let [wi, value, weight] = vectors.each_ref().map(|vector| at(vector, i));
        let lobe = Lobe::ALL
            .into_iter()
            .zip(0_u8..)
            .find(|(_, number)| f32::from(*number) == slot[i]);
        let sample = lobe.map(|(lobe, _)| Sample {
            wi: wi.into(),
            value,
            pdf: pdf[i],
            weight,
            lobe,
        });
        (wi.into(), drawn(sample))
    };
    (0..xi.len()).map(sample).collect()
}

/// Evaluates the densities of the lobes. They have no slice call, so this takes eight directions per call.
fn batch_densities(bsdf: &AnyBsdf, wi: &[Vec3]) -> Vec<[f32; Lobe::COUNT]> {
    let eight = |wi: &[Vec3]| {
        let lobes = bsdf.lobes8(&Vec3x8::from(from_fn(|i| wi[i.min(wi.len() - 1)])));
        (0..wi.len())
            .map(|i| densities_of_lane(&lobes, i))
            .collect::<Vec<_>>()
    };
    wi.chunks(8).flat_map(eight).collect()
}

/// Answers a request from the formulas in double precision, for the numbers of the line as they are.
fn formulas(request: &Request) -> Answer<f64> {
    let MaterialSpec {
        model,
        values,
        exact,
        ..
    } = &request.spec;
    let Exact {
        wo,
        h,
        query: numbers,
    } = &request.exact;
    let point = exact_reference(*model, values, exact, *wo, *h).expect("checked when it was read");
    let (found, wi) = match request.query {
        Query::Wi(_) => (
            Found::Value(point.eval(*numbers), point.pdf(*numbers)),
            *numbers,
        ),
        Query::Xi(_) => {
            let sample = point.sample(*numbers);
            (Found::Sample(sample), sample.wi)
        }
    };
    let densities = point.lobes(wi).0.map(|lobe| lobe.pdf);
    answer(*model, found, densities, &|| {
        point.lobes(*wo).0.map(|lobe| lobe.color)
    })
}

fn bsdf(request: &Request) -> AnyBsdf {
    request.spec.material.prepare(Hit {
        wo: request.wo.into(),
        h: request.h,
    })
}

/// Result of a query: a value with its density, or a sample.
enum Found<T> {
    Value([T; 3], T),
    Sample(ReferenceSample<T>),
}

const fn valued(eval: Eval) -> Found<f32> {
    Found::Value(eval.value, eval.pdf)
}

/// Converts a sample of the kernels; a discarded one becomes zeros.
fn drawn(sample: Option<Sample>) -> Found<f32> {
    let none = ReferenceSample {
        wi: [0.0; 3],
        value: [0.0; 3],
        pdf: 0.0,
        weight: [0.0; 3],
        lobe: None,
    };
    Found::Sample(sample.map_or(
        none,
        |Sample {
             wi,
             value,
             pdf,
             weight,
             lobe,
         }| ReferenceSample {
            wi: wi.into(),
            value,
            pdf,
            weight,
            lobe: Some(lobe),
        },
    ))
}

/// Assembles the answer, with the densities of the model's own lobes, and their colours if the model reports them.
fn answer<T: Copy + Default>(
    model: ModelId,
    found: Found<T>,
    mut densities: [T; Lobe::COUNT],
    colors: &dyn Fn() -> [[T; 3]; Lobe::COUNT],
) -> Answer<T> {
    let names = model.lobes();
    let (wi, s, pdf, choice) = match found {
        Found::Value(s, pdf) => (None, s, pdf, None),
        Found::Sample(ReferenceSample {
            wi,
            value,
            pdf,
            weight,
            lobe,
        }) => {
            if lobe.is_none() {
                densities = [T::default(); Lobe::COUNT];
            }
            (
                Some(wi),
                value,
                pdf,
                Some(Choice {
                    lobe: lobe.map(|lobe| names[lobe.index()]),
                    weight,
                }),
            )
        }
    };
    let colors = model
        .colors()
        .map(|name| (name, colors()[..names.len()].to_vec()))
        .into_iter()
        .collect();
    Answer {
        wi,
        s,
        pdf,
        pdf_lobe: densities[..names.len()].to_vec(),
        choice,
        colors,
    }
}

fn densities_of_lane(lobes: &PerLobe<LobeEval8>, lane: usize) -> [f32; Lobe::COUNT] {
    lobes.0.map(|lobe| lobe.pdf.as_array()[lane])
}
