//! The answers, computed along the chosen path.

use super::request::{Exact, Query, Request};
use crate::config::Path;
use core::array::from_fn;
use glam::Vec3;
use hairis::reference::Reference;
use hairis::{Eval, EvalSlices, Hit, Lobe, LobeEval8, PerLobe, Sample, SampleSlices, Vec3x8};
use hairis_variants::{AnyBsdf8, AnyGather, ModelId};
use serde::Serialize;
use std::collections::BTreeMap;
use wide::f32x8;

/// One line of the output. Numbers have as few digits as reading them back in the same precision allows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Line {
    /// An answer in single precision.
    Single(Answer<f32>),
    /// An answer in double precision.
    Double(Answer<f64>),
    /// Answer to a refused line.
    Refused { error: String },
}

/// The answer to a request.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Answer<T> {
    #[serde(flatten)]
    what: What<T>,
    /// Colours of the lobes, under the name that the model gives them.
    #[serde(flatten)]
    colors: BTreeMap<&'static str, Vec<[T; 3]>>,
}

/// The answer to one of the two queries. `pdf_lobe` has one number per lobe of the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
enum What<T> {
    /// To a direction.
    Value { s: [T; 3], pdf: T, pdf_lobe: Vec<T> },
    /// To uniform numbers. A discarded sample has no lobe, and 0 everywhere else.
    Sample { wi: [T; 3], s: [T; 3], pdf: T, pdf_lobe: Vec<T>, lobe: Option<&'static str>, weight: [T; 3] },
}

/// Number of lines that a path takes at once.
pub(super) const fn block_len(path: Path) -> usize {
    match path {
        Path::Scalar | Path::F64 => 1,
        Path::X8 => 8,
        Path::Batch => 256,
    }
}

/// The answers to a block of requests, in order.
pub(super) fn answers(path: Path, requests: &[&Request]) -> Vec<Line> {
    if path == Path::F64 {
        return requests.iter().map(|request| Line::Double(textbook(request))).collect();
    }
    // The requests of each model together; the answers then go back to their places.
    let mut answers = Vec::with_capacity(requests.len());
    for model in ModelId::ALL {
        let of_model = requests.iter().enumerate().filter(|(_, request)| request.model == *model);
        let (at, requests): (Vec<usize>, Vec<&Request>) = of_model.map(|(at, request)| (at, *request)).unzip();
        let found = match path {
            Path::X8 => eight(&requests),
            Path::Batch => batch(&requests),
            Path::Scalar | Path::F64 => requests.iter().map(|request| scalar(request)).collect(),
        };
        answers.extend(at.into_iter().zip(found));
    }
    answers.sort_unstable_by_key(|(at, _)| *at);
    answers.into_iter().map(|(_, answer)| Line::Single(answer)).collect()
}

/// One direction per call.
fn scalar(request: &Request) -> Answer<f32> {
    let gather = gather(request);
    let densities = |wi| gather.lobes(wi).0.map(|lobe| lobe.pdf);
    let colors = || gather.lobes(request.wo).0.map(|lobe| lobe.color);
    match request.query {
        Query::Wi(wi) => valued(request, gather.eval_pdf(wi), densities(wi), colors),
        Query::Xi(xi) => sampled(request, gather.sample(xi), densities, colors),
    }
}

/// Eight lines per call, all of one model: every lane has its own material, shading point and query. Spare lanes repeat the
/// last line.
fn eight(requests: &[&Request]) -> Vec<Answer<f32>> {
    let mut answers = Vec::with_capacity(requests.len());
    for group in requests.chunks(8) {
        let lane = |i: usize| group[i.min(group.len() - 1)];
        let materials = AnyBsdf8::pack(from_fn(|i| &lane(i).bsdf)).expect("requests of one model");
        let wo = Vec3x8::from(from_fn(|i| lane(i).wo));
        let gathers = materials.prepare8(Hit { wo, h: f32x8::new(from_fn(|i| lane(i).h)) });
        // A lane whose line has no xi samples as well; its sample is ignored.
        let xi: [[f32; 3]; 8] = from_fn(|i| match lane(i).query {
            Query::Wi(_) => [0.5; 3],
            Query::Xi(xi) => xi,
        });
        let samples = gathers.sample8(&from_fn(|row| f32x8::new(xi.map(|xi| xi[row]))));
        let wi = Vec3x8::from(from_fn(|i| match lane(i).query {
            Query::Wi(wi) => wi,
            Query::Xi(_) => samples.wi.lane(i),
        }));
        let (evals, lobes) = (gathers.eval_pdf8(&wi), gathers.lobes8(&wi));
        let at_wo = gathers.lobes8(&wo);
        answers.extend(group.iter().enumerate().map(|(i, request)| {
            let colors = || at_wo.0.map(|lobe| lobe.color.map(|c| c.as_array()[i]));
            match request.query {
                Query::Wi(_) => valued(request, evals.lane(i), densities_of_lane(&lobes, i), colors),
                Query::Xi(_) => sampled(request, samples.lane(i), |_| densities_of_lane(&lobes, i), colors),
            }
        }));
    }
    answers
}

/// Slices: one call for all directions, and one for all samples, of neighbouring lines that share a shading
/// point.
fn batch(requests: &[&Request]) -> Vec<Answer<f32>> {
    let mut answers = Vec::with_capacity(requests.len());
    for run in requests.chunk_by(|a, b| (a.wo, a.h) == (b.wo, b.h) && a.values == b.values) {
        let gather = gather(run[0]);
        let mut wi = Vec::new();
        let mut xi = Vec::new();
        for request in run {
            match request.query {
                Query::Wi(direction) => wi.push(direction),
                Query::Xi(numbers) => xi.push(numbers),
            }
        }
        let mut values = batch_values(run[0], &gather, &wi).into_iter();
        let mut samples = batch_samples(run[0], &gather, &xi).into_iter();
        answers.extend(run.iter().filter_map(|request| match request.query {
            Query::Wi(_) => values.next(),
            Query::Xi(_) => samples.next(),
        }));
    }
    answers
}

const ONE_LENGTH: &str = "slices of one length";

fn batch_values(request: &Request, gather: &AnyGather, wi: &[Vec3]) -> Vec<Answer<f32>> {
    let len = wi.len();
    let [u, v, w]: [Vec<f32>; 3] = from_fn(|row| wi.iter().map(|wi| wi[row]).collect());
    let (mut value, mut pdf) = ([vec![0.0; len], vec![0.0; len], vec![0.0; len]], vec![0.0; len]);
    let out = EvalSlices { value: value.each_mut().map(Vec::as_mut_slice), pdf: &mut pdf };
    gather.eval_pdf_batch([&u, &v, &w], out).expect(ONE_LENGTH);
    let lobes = batch_densities(gather, wi);
    let colors = || gather.lobes(request.wo).0.map(|lobe| lobe.color);
    let answer = |i: usize| valued(request, Eval { value: from_fn(|c| value[c][i]), pdf: pdf[i] }, lobes[i], colors);
    (0..len).map(answer).collect()
}

fn batch_samples(request: &Request, gather: &AnyGather, xi: &[[f32; 3]]) -> Vec<Answer<f32>> {
    let len = xi.len();
    let [lobe, theta, phi]: [Vec<f32>; 3] = from_fn(|row| xi.iter().map(|xi| xi[row]).collect());
    let mut vectors: [[Vec<f32>; 3]; 3] = from_fn(|_| from_fn(|_| vec![0.0; len]));
    let (mut pdf, mut slot) = (vec![0.0; len], vec![0.0; len]);
    let [wi, value, weight] = vectors.each_mut().map(|v| v.each_mut().map(Vec::as_mut_slice));
    let out = SampleSlices { wi, value, pdf: &mut pdf, weight, slot: &mut slot };
    gather.sample_batch([&lobe, &theta, &phi], out).expect(ONE_LENGTH);
    let at = |vector: usize, i: usize| -> [f32; 3] { from_fn(|row| vectors[vector][row][i]) };
    let wi: Vec<Vec3> = (0..len).map(|i| at(0, i).into()).collect();
    let lobes = batch_densities(gather, &wi);
    let colors = || gather.lobes(request.wo).0.map(|lobe| lobe.color);
    let answer = |i: usize| {
        let lobe = Lobe::ALL.into_iter().zip(0_u8..).find(|(_, number)| f32::from(*number) == slot[i]);
        let sample = lobe.map(|(lobe, _)| Sample { wi: wi[i], value: at(1, i), pdf: pdf[i], weight: at(2, i), lobe });
        sampled(request, sample, |_| lobes[i], colors)
    };
    (0..len).map(answer).collect()
}

/// Densities of the lobes: they have no slice call, so eight directions per call.
fn batch_densities(gather: &AnyGather, wi: &[Vec3]) -> Vec<[f32; 4]> {
    let eight = |wi: &[Vec3]| {
        let lobes = gather.lobes8(&Vec3x8::from(from_fn(|i| wi[i.min(wi.len() - 1)])));
        (0..wi.len()).map(|i| densities_of_lane(&lobes, i)).collect::<Vec<_>>()
    };
    wi.chunks(8).flat_map(eight).collect()
}

/// The formulas in double precision, for the numbers of the line as they are.
fn textbook(request: &Request) -> Answer<f64> {
    let Request { model, values, exact: Exact { values: exact, wo, h, query: numbers }, .. } = request;
    let point = model.exact_reference(values, exact, *wo, *h).expect("checked when it was read");
    let densities = |wi| pdf_lobe(*model, point.lobes(wi).0.map(|lobe| lobe.pdf));
    let what = match request.query {
        Query::Wi(_) => {
            What::Value { s: point.eval(*numbers), pdf: point.pdf(*numbers), pdf_lobe: densities(*numbers) }
        }
        Query::Xi(_) => {
            let drawn = point.sample(*numbers);
            What::Sample {
                wi: drawn.wi,
                s: drawn.value,
                pdf: drawn.pdf,
                pdf_lobe: densities(drawn.wi),
                lobe: drawn.lobe.map(|lobe| name(*model, lobe)),
                weight: drawn.weight,
            }
        }
    };
    Answer { what, colors: colors(*model, || point.lobes(*wo).0.map(|lobe| lobe.color)) }
}

fn gather(request: &Request) -> AnyGather {
    request.bsdf.prepare(Hit { wo: request.wo.into(), h: request.h })
}

fn valued(request: &Request, eval: Eval, densities: [f32; 4], color: impl FnOnce() -> [[f32; 3]; 4]) -> Answer<f32> {
    let pdf_lobe = pdf_lobe(request.model, densities);
    let what = What::Value { s: eval.value, pdf: eval.pdf, pdf_lobe };
    Answer { what, colors: colors(request.model, color) }
}

fn sampled(
    request: &Request,
    sample: Option<Sample>,
    densities: impl FnOnce(Vec3) -> [f32; 4],
    color: impl FnOnce() -> [[f32; 3]; 4],
) -> Answer<f32> {
    let zero = [0.0; 3];
    let what = match sample {
        None => {
            let pdf_lobe = pdf_lobe(request.model, [0.0; 4]);
            What::Sample { wi: zero, s: zero, pdf: 0.0, pdf_lobe, lobe: None, weight: zero }
        }
        Some(s) => What::Sample {
            wi: s.wi.into(),
            s: s.value,
            pdf: s.pdf,
            pdf_lobe: pdf_lobe(request.model, densities(s.wi)),
            lobe: Some(name(request.model, s.lobe)),
            weight: s.weight,
        },
    };
    Answer { what, colors: colors(request.model, color) }
}

/// The densities of the model's own lobes.
fn pdf_lobe<T: Copy>(model: ModelId, densities: [T; 4]) -> Vec<T> {
    densities[..model.lobes().len()].to_vec()
}

/// The colours of the model's own lobes, if they are reported.
fn colors<T>(model: ModelId, all: impl FnOnce() -> [[T; 3]; 4]) -> BTreeMap<&'static str, Vec<[T; 3]>> {
    model.colors().map(|name| (name, all().into_iter().take(model.lobes().len()).collect())).into_iter().collect()
}

fn densities_of_lane(lobes: &PerLobe<LobeEval8>, lane: usize) -> [f32; 4] {
    lobes.0.map(|lobe| lobe.pdf.as_array()[lane])
}

fn name(model: ModelId, lobe: Lobe) -> &'static str {
    model.lobes()[lobe.index()]
}
