//! The operations, and the contenders of each.

use super::Op;
use super::check::Truth;
use super::inputs::{DIRECTIONS, Inputs};
use super::{points, task};
use crate::subject::to_f64;
use glam::Vec3;
use hairis::reference::Reference;
use hairis::{Bsdf, EvalSlices, Level, ParamError, SampleSlices};
use hairis_benches::entries::TEXTBOOK;
use hairis_benches::inputs::{arrays, packets, xi_packets};
use hairis_benches::task::{PROBE, Pass, Point, Slices};
use hairis_variants::{AnyReference, ModelId, Parameters, Registered, Visitor};

/// The kernel, one direction per call.
pub(super) const ONE: &str = "one lane";
/// The kernel, eight directions per call.
pub(super) const EIGHT: &str = "eight lanes";

/// The kernel, eight directions at one shading point per call, where [`EIGHT`] has eight shading points.
pub(super) const EIGHT_AT_ONE: &str = "eight lanes, one point";

/// The kernel, all directions in one call.
const SLICES: &str = "slices";

/// Contender.
pub(super) struct Contender {
    pub(super) name: &'static str,
    /// Instruction set of its lanes.
    pub(super) level: &'static str,
    pub(super) task: Box<dyn Pass>,
}

/// One operation of one model: a table's block of rows.
pub(super) struct SpeedCell {
    pub(super) op: Op,
    pub(super) model: &'static str,
    /// The reference first.
    pub(super) contenders: Vec<Contender>,
    pub(super) truth: Truth,
}

/// All operations of one model, on inputs of this seed; none unless it is the first of its name.
pub(super) struct SpeedCells(pub(super) u64);

impl Visitor for SpeedCells {
    type Output = Result<Vec<SpeedCell>, ParamError>;

    fn visit<M: Registered>(self) -> Self::Output {
        // At compile time: models that are not timed are not compiled.
        if const { !ModelId::of::<M>().is_default() } {
            return Ok(Vec::new());
        }
        let (id, inputs) = (ModelId::of::<M>(), Inputs::draw(self.0)?);
        let timed = |op| {
            let (contenders, truth) = match op {
                Op::Prepare => prepare::<M>(id, &inputs)?,
                Op::EvalPdf => eval_pdf::<M>(id, &inputs.params[0], &inputs)?,
                Op::EvalPdfTails => eval_pdf::<M>(id, &inputs.narrow, &inputs)?,
                Op::Sample => sample::<M>(id, &inputs.params[0], &inputs)?,
                Op::SampleTails => sample::<M>(id, &inputs.narrow, &inputs)?,
                Op::PointsShared => points::shared::<M, 1, 1>(id, &inputs)?,
                Op::PointsOf4 => points::shared::<M, 4, 1>(id, &inputs)?,
                Op::PointsOf16 => points::shared::<M, 16, 2>(id, &inputs)?,
                Op::PointsMixed => points::mixed::<M>(id, &inputs, false)?,
                Op::PointsPacked => points::mixed::<M>(id, &inputs, true)?,
            };
            Ok(SpeedCell { op, model: id.name(), contenders, truth })
        };
        Op::ALL.into_iter().map(timed).collect()
    }
}

/// The formulas in `f64` for these parameters, seen from each of `wo`.
pub(super) fn truth<P: Parameters>(id: ModelId, params: &P, wo: &[Vec3]) -> Result<Vec<AnyReference<f64>>, ParamError> {
    wo.iter().map(|wo| id.reference(&params.values(), to_f64(*wo), 0.0)).collect()
}

pub(super) fn scalar(name: &'static str, task: Box<dyn Pass>) -> Contender {
    Contender { name, level: "scalar", task }
}

/// The contenders so far, then one on every level of this CPU.
pub(super) fn with_levels(
    mut contenders: Vec<Contender>,
    name: &'static str,
    task: impl Fn(Level) -> Box<dyn Pass>,
) -> Vec<Contender> {
    contenders.extend(Level::available().map(|level| Contender { name, level: level.name(), task: task(level) }));
    contenders
}

fn prepare<M: Registered>(id: ModelId, inputs: &Inputs<M::Params>) -> Result<(Vec<Contender>, Truth), ParamError> {
    let params = inputs.params[0];
    let (bsdf, formulas) = (Bsdf::new(&M::MODEL, &params), M::formulas::<f32>(&params));
    let contenders = vec![
        scalar(TEXTBOOK, task(&arrays(&inputs.wo), move |wo| Point(M::reference_at(&formulas, *wo, 0.0)))),
        scalar(ONE, task(&inputs.wo, move |wo| bsdf.prepare(*wo))),
    ];
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&packets(&inputs.wo), move |wo| bsdf.prepare8_at(level, wo)));
    Ok((contenders, Truth::of_directions(truth(id, &params, &inputs.wo)?, &[PROBE; DIRECTIONS])))
}

fn eval_pdf<M: Registered>(
    id: ModelId,
    params: &M::Params,
    inputs: &Inputs<M::Params>,
) -> Result<(Vec<Contender>, Truth), ParamError> {
    let wo = inputs.wo[0];
    let reference = M::reference::<f32>(params, wo.to_array(), 0.0);
    let gather = Bsdf::new(&M::MODEL, params).prepare(wo);
    let contenders = vec![
        scalar(TEXTBOOK, task(&arrays(&inputs.wi), move |wi| reference.eval_pdf(*wi))),
        scalar(ONE, task(&inputs.wi, move |wi| gather.eval_pdf(*wi))),
    ];
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&packets(&inputs.wi), move |wi| gather.eval_pdf8_at(level, wi)));
    let contenders = with_levels(contenders, SLICES, |level| {
        Box::new(Slices::new(DIRECTIONS, &arrays(&inputs.wi), move |wi, [r, g, b, pdf]: [&mut [f32]; 4]| {
            gather.eval_pdf_batch_at(level, wi, EvalSlices { value: [r, g, b], pdf })
        }))
    });
    Ok((contenders, Truth::of_directions(truth(id, params, &[wo; DIRECTIONS])?, &inputs.wi)))
}

fn sample<M: Registered>(
    id: ModelId,
    params: &M::Params,
    inputs: &Inputs<M::Params>,
) -> Result<(Vec<Contender>, Truth), ParamError> {
    let wo = inputs.wo[0];
    let reference = M::reference::<f32>(params, wo.to_array(), 0.0);
    let gather = Bsdf::new(&M::MODEL, params).prepare(wo);
    let contenders = vec![
        scalar(TEXTBOOK, task(&inputs.xi, move |xi| reference.sample(*xi))),
        scalar(ONE, task(&inputs.xi, move |xi| gather.sample(*xi))),
    ];
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&xi_packets(&inputs.xi), move |xi| gather.sample8_at(level, xi)));
    let contenders = with_levels(contenders, SLICES, |level| {
        let call = move |xi: [&[f32]; 3], [r, g, b, pdf, u, v, w, wr, wg, wb, slot]: [&mut [f32]; 11]| {
            let out = SampleSlices { wi: [u, v, w], value: [r, g, b], pdf, weight: [wr, wg, wb], slot };
            gather.sample_batch_at(level, xi, out)
        };
        Box::new(Slices::new(DIRECTIONS, &inputs.xi, call))
    });
    Ok((contenders, Truth::of_samples(truth(id, params, &[wo; DIRECTIONS])?, &inputs.xi)))
}
