//! The answers, computed along the chosen path.

use super::request::{Query, Request, SAMPLERS};
use crate::config::Path;
use crate::sampler::{Directions, Visit, visit};
use crate::subject::{ModelKind, to_f64};
use core::array::from_fn;
use glam::Vec3;
use hairis::textbook::{Oracle, Parameters};
use hairis::{
    Bsdf, Bsdf8, Eval, EvalSlices, Gather, Gaussian, Hair, HairParams, Lobe, LobeEval, LobeEval8, Model as _, PerLobe,
    Sample, SampleSlices, Vec3x8,
};
use serde::Serialize;
use wide::f32x8;

/// Names of the lobes in the output.
const LOBES: &[&str] = Hair::<Gaussian>::LOBES;

/// One line of the output. Numbers are printed as short as reading them back in the same precision allows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Line {
    /// An answer in single precision.
    Single(Answer<f32>),
    /// An answer in double precision.
    Double(Answer<f64>),
    /// To a line that was refused.
    Refused { error: String },
}

/// The answer to a request.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Answer<T> {
    /// To a direction.
    Value { s: [T; 3], pdf: T, pdf_lobe: [T; 4] },
    /// To uniform numbers. A discarded sample has no lobe, and 0 everywhere else.
    Sample { wi: [T; 3], s: [T; 3], pdf: T, pdf_lobe: [T; 4], lobe: Option<&'static str>, weight: [T; 3] },
}

/// How many lines a path takes at once.
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
    // The requests of each model and sampler together; the answers then go back to their places.
    let mut answers = Vec::with_capacity(requests.len());
    for (model, sampler) in ModelKind::ALL.into_iter().flat_map(|model| SAMPLERS.map(|sampler| (model, sampler))) {
        let of = requests.iter().enumerate().filter(|(_, r)| (r.model, r.sampler) == (model, sampler));
        let (at, requests): (Vec<usize>, Vec<&Request>) = of.map(|(at, r)| (at, *r)).unzip();
        answers.extend(at.into_iter().zip(visit(model, sampler, Along { path, requests: &requests })));
    }
    answers.sort_unstable_by_key(|(at, _)| *at);
    answers.into_iter().map(|(_, answer)| Line::Single(answer)).collect()
}

/// The answers along a path that calls the kernels.
struct Along<'a> {
    path: Path,
    requests: &'a [&'a Request],
}

impl Visit for Along<'_> {
    type Output = Vec<Answer<f32>>;

    fn visit<M: HairModel + 'static>(self, model: M, _: Directions) -> Self::Output {
        match self.path {
            Path::X8 => eight(model, self.requests),
            Path::Batch => batch(model, self.requests),
            Path::Scalar | Path::F64 => scalar(model, self.requests),
        }
    }
}

/// A model of hair, whichever way its directions are drawn.
trait HairModel: hairis::Model<Params = HairParams> {}
impl<M: hairis::Model<Params = HairParams>> HairModel for M {}

/// One direction a call.
fn scalar<M: HairModel>(hair: M, requests: &[&Request]) -> Vec<Answer<f32>> {
    let one = |request: &&Request| {
        let gather = gather(hair, request);
        match request.query {
            Query::Wi(wi) => valued(gather.eval_pdf(wi), densities(&gather.lobes(wi))),
            Query::Xi(xi) => sampled(gather.sample(xi), |wi| densities(&gather.lobes(wi))),
        }
    };
    requests.iter().map(one).collect()
}

/// Eight lines a call: every lane has its own material, gather point and query. Lanes to spare repeat the last line.
fn eight<M: HairModel>(hair: M, requests: &[&Request]) -> Vec<Answer<f32>> {
    let mut answers = Vec::with_capacity(requests.len());
    for group in requests.chunks(8) {
        let lane = |i: usize| group[i.min(group.len() - 1)];
        let materials: [Bsdf<M>; 8] = from_fn(|i| Bsdf::new(&hair, &lane(i).params));
        let wo = Vec3x8::from(from_fn(|i| lane(i).wo));
        let gathers = Bsdf8::pack(materials.each_ref()).prepare8(&wo);
        // A lane whose line has no xi samples all the same, and its sample is not looked at.
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
        answers.extend(group.iter().enumerate().map(|(i, request)| match request.query {
            Query::Wi(_) => valued(evals.lane(i), densities_of_lane(&lobes, i)),
            Query::Xi(_) => sampled(samples.lane(i), |_| densities_of_lane(&lobes, i)),
        }));
    }
    answers
}

/// Slices in, slices out: a call for all directions, and one for all samples, of neighbouring lines that share a gather
/// point.
fn batch<M: HairModel>(hair: M, requests: &[&Request]) -> Vec<Answer<f32>> {
    let mut answers = Vec::with_capacity(requests.len());
    for run in requests.chunk_by(|a, b| a.params == b.params && a.wo == b.wo) {
        let gather = gather(hair, run[0]);
        let mut wi = Vec::new();
        let mut xi = Vec::new();
        for request in run {
            match request.query {
                Query::Wi(direction) => wi.push(direction),
                Query::Xi(numbers) => xi.push(numbers),
            }
        }
        let mut values = batch_values(&gather, &wi).into_iter();
        let mut samples = batch_samples(&gather, &xi).into_iter();
        answers.extend(run.iter().filter_map(|request| match request.query {
            Query::Wi(_) => values.next(),
            Query::Xi(_) => samples.next(),
        }));
    }
    answers
}

const ONE_LENGTH: &str = "slices that were made of one length";

fn batch_values<M: HairModel>(gather: &Gather<M>, wi: &[Vec3]) -> Vec<Answer<f32>> {
    let len = wi.len();
    let [u, v, w]: [Vec<f32>; 3] = from_fn(|row| wi.iter().map(|wi| wi[row]).collect());
    let (mut value, mut pdf) = ([vec![0.0; len], vec![0.0; len], vec![0.0; len]], vec![0.0; len]);
    let out = EvalSlices { value: value.each_mut().map(Vec::as_mut_slice), pdf: &mut pdf };
    gather.eval_pdf_batch([&u, &v, &w], out).expect(ONE_LENGTH);
    let lobes = batch_densities(gather, wi);
    let answer = |i: usize| valued(Eval { value: from_fn(|c| value[c][i]), pdf: pdf[i] }, lobes[i]);
    (0..len).map(answer).collect()
}

fn batch_samples<M: HairModel>(gather: &Gather<M>, xi: &[[f32; 3]]) -> Vec<Answer<f32>> {
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
    let answer = |i: usize| {
        let lobe = Lobe::ALL.into_iter().zip(0_u8..).find(|(_, number)| f32::from(*number) == slot[i]);
        let sample = lobe.map(|(lobe, _)| Sample { wi: wi[i], value: at(1, i), pdf: pdf[i], weight: at(2, i), lobe });
        sampled(sample, |_| lobes[i])
    };
    (0..len).map(answer).collect()
}

/// Densities of the lobes: they have no slices of their own, so eight directions a call.
fn batch_densities<M: HairModel>(gather: &Gather<M>, wi: &[Vec3]) -> Vec<[f32; 4]> {
    let eight = |wi: &[Vec3]| {
        let lobes = gather.lobes8(&Vec3x8::from(from_fn(|i| wi[i.min(wi.len() - 1)])));
        (0..wi.len()).map(|i| densities_of_lane(&lobes, i)).collect::<Vec<_>>()
    };
    wi.chunks(8).flat_map(eight).collect()
}

/// The formulas in double precision.
fn textbook(request: &Request) -> Answer<f64> {
    let parameters = Parameters::from(&request.params);
    let hair = Oracle::prepare(&parameters, request.model.shape(), to_f64(request.wo), request.sampler.bands());
    match request.query {
        Query::Wi(wi) => {
            let wi = to_f64(wi);
            Answer::Value { s: hair.eval(wi), pdf: hair.pdf(wi), pdf_lobe: hair.lobe_pdfs(wi).0 }
        }
        Query::Xi(xi) => {
            let drawn = hair.sample(xi.map(f64::from));
            Answer::Sample {
                wi: drawn.wi,
                s: drawn.value,
                pdf: drawn.pdf,
                pdf_lobe: hair.lobe_pdfs(drawn.wi).0,
                lobe: drawn.lobe.map(name),
                weight: drawn.weight,
            }
        }
    }
}

fn gather<M: HairModel>(hair: M, request: &Request) -> Gather<M> {
    Bsdf::new(&hair, &request.params).prepare(request.wo)
}

fn valued(eval: Eval, pdf_lobe: [f32; 4]) -> Answer<f32> {
    Answer::Value { s: eval.value, pdf: eval.pdf, pdf_lobe }
}

fn sampled(sample: Option<Sample>, pdf_lobe: impl FnOnce(Vec3) -> [f32; 4]) -> Answer<f32> {
    match sample {
        None => {
            Answer::Sample { wi: [0.0; 3], s: [0.0; 3], pdf: 0.0, pdf_lobe: [0.0; 4], lobe: None, weight: [0.0; 3] }
        }
        Some(s) => Answer::Sample {
            wi: s.wi.into(),
            s: s.value,
            pdf: s.pdf,
            pdf_lobe: pdf_lobe(s.wi),
            lobe: Some(name(s.lobe)),
            weight: s.weight,
        },
    }
}

fn densities(lobes: &PerLobe<LobeEval>) -> [f32; 4] {
    lobes.0.map(|lobe| lobe.pdf)
}

fn densities_of_lane(lobes: &PerLobe<LobeEval8>, lane: usize) -> [f32; 4] {
    lobes.0.map(|lobe| lobe.pdf.as_array()[lane])
}

fn name(lobe: Lobe) -> &'static str {
    LOBES[lobe.index()]
}
