//! The operations, and the contenders of each.

use super::Op;
use super::check::Truth;
use super::inputs::{DIRECTIONS, Inputs};
use super::{points, task};
use crate::subject::to_f64;
use core::marker::PhantomData;
use glam::Vec3;
use hairis::reference::Reference;
use hairis::wide::f32x8;
use hairis::{Bsdf, EvalSlices, Level, ParamError, SampleSlices, Vec3x8};
use hairis_benches::entries::TEXTBOOK;
use hairis_benches::inputs::{arrays, packets, xi_packets};
use hairis_benches::platform::{Platform, platform};
use hairis_benches::task::{PROBE, Pass, Point, Slices};
use hairis_variants::{AnyReference, ModelId, Parameters, Registered, Visitor};

/// The kernel, one direction per call.
pub(super) const ONE: &str = "one lane";
/// The kernel, eight directions per call.
pub(super) const EIGHT: &str = "eight lanes";

/// The kernel, eight directions at one shading point per call, where [`EIGHT`] has eight shading points.
pub(super) const EIGHT_AT_ONE: &str = "eight lanes, one point";

/// [`EIGHT`], with numbers that are put into a packet just before the call, as hosts do that compute them one by one.
const FRESH: &str = "eight lanes, just written";
/// The kernel, all directions in one call.
const SLICES: &str = "slices";
/// The kernel, eight directions in one call.
const SHORT: &str = "slices of 8";
/// The kernel, all directions in one call, each at a shading point of its own.
pub(super) const HITS: &str = "slices of hits";
/// Directions of [`SHORT`].
const FEW: usize = 8;

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
    /// The two [`textbooks`] first.
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
                Op::EvalPdf => eval_pdf::<M>(id, &inputs.params[0], &inputs, true)?,
                Op::EvalPdfTails => eval_pdf::<M>(id, &inputs.narrow, &inputs, false)?,
                Op::Sample => sample::<M>(id, &inputs.params[0], &inputs, true)?,
                Op::SampleTails => sample::<M>(id, &inputs.narrow, &inputs, false)?,
                Op::PointsEval => points::eval::<M>(id, &inputs)?,
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

/// The formulas in `f32`: on the libm crate, and on std.
pub(super) fn textbooks(libm: Box<dyn Pass>, std: Box<dyn Pass>) -> Vec<Contender> {
    let of = |level, task| Contender { name: TEXTBOOK, level, task };
    vec![of("scalar, libm crate", libm), of("scalar, std", std)]
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

/// The formulas seen from `wo`: on the libm crate, and on std.
fn references<M: Registered>(params: &M::Params, wo: Vec3) -> (M::Reference<f32>, M::Reference<Platform>) {
    let wo = wo.to_array();
    (M::reference(params, wo, 0.0), M::reference(params, platform(wo), Platform(0.0)))
}

fn prepare<M: Registered>(id: ModelId, inputs: &Inputs<M::Params>) -> Result<(Vec<Contender>, Truth), ParamError> {
    let params = inputs.params[0];
    let (bsdf, wo) = (Bsdf::new(&M::MODEL, &params), arrays(&inputs.wo));
    let (libm, std) = (M::formulas::<f32>(&params), M::formulas::<Platform>(&params));
    let mut contenders = textbooks(
        task(&wo, move |wo| Point::<_, f32>(M::reference_at(&libm, *wo, 0.0), PhantomData)),
        task(&wo, move |wo| Point(M::reference_at(&std, platform(*wo), Platform(0.0)), PhantomData)),
    );
    contenders.push(scalar(ONE, task(&inputs.wo, move |wo| bsdf.prepare(*wo))));
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&packets(&inputs.wo), move |wo| bsdf.prepare8_at(level, wo)));
    Ok((contenders, Truth::of_directions(truth(id, &params, &inputs.wo)?, &[PROBE; DIRECTIONS])))
}

fn eval_pdf<M: Registered>(
    id: ModelId,
    params: &M::Params,
    inputs: &Inputs<M::Params>,
    every_way: bool,
) -> Result<(Vec<Contender>, Truth), ParamError> {
    let wo = inputs.wo[0];
    let (libm, std) = references::<M>(params, wo);
    let gather = Bsdf::new(&M::MODEL, params).prepare(wo);
    let wi = arrays(&inputs.wi);
    let mut contenders =
        textbooks(task(&wi, move |wi| libm.eval_pdf(*wi)), task(&wi, move |wi| std.eval_pdf(platform(*wi))));
    contenders.push(scalar(ONE, task(&inputs.wi, move |wi| gather.eval_pdf(*wi))));
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&packets(&inputs.wi), move |wi| gather.eval_pdf8_at(level, wi)));
    let slices = |len| {
        move |level| -> Box<dyn Pass> {
            let call = move |wi: [&[f32]; 3], [r, g, b, pdf]: [&mut [f32]; 4]| {
                gather.eval_pdf_batch_at(level, wi, EvalSlices { value: [r, g, b], pdf })
            };
            Box::new(Slices::new(len, &arrays(&inputs.wi), call))
        }
    };
    let mut contenders = with_levels(contenders, SLICES, slices(DIRECTIONS));
    if every_way {
        let (eights, _) = inputs.wi.as_chunks::<8>();
        contenders = with_levels(contenders, FRESH, |level| {
            task(eights, move |wi| gather.eval_pdf8_at(level, &Vec3x8::from(*wi)))
        });
        contenders = with_levels(contenders, SHORT, slices(FEW));
    }
    Ok((contenders, Truth::of_directions(truth(id, params, &[wo; DIRECTIONS])?, &inputs.wi)))
}

fn sample<M: Registered>(
    id: ModelId,
    params: &M::Params,
    inputs: &Inputs<M::Params>,
    every_way: bool,
) -> Result<(Vec<Contender>, Truth), ParamError> {
    let wo = inputs.wo[0];
    let (libm, std) = references::<M>(params, wo);
    let gather = Bsdf::new(&M::MODEL, params).prepare(wo);
    let mut contenders =
        textbooks(task(&inputs.xi, move |xi| libm.sample(*xi)), task(&inputs.xi, move |xi| std.sample(platform(*xi))));
    contenders.push(scalar(ONE, task(&inputs.xi, move |xi| gather.sample(*xi))));
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&xi_packets(&inputs.xi), move |xi| gather.sample8_at(level, xi)));
    let slices = |len| {
        move |level| -> Box<dyn Pass> {
            let call = move |xi: [&[f32]; 3], [r, g, b, pdf, u, v, w, wr, wg, wb, slot]: [&mut [f32]; 11]| {
                let out = SampleSlices { wi: [u, v, w], value: [r, g, b], pdf, weight: [wr, wg, wb], slot };
                gather.sample_batch_at(level, xi, out)
            };
            Box::new(Slices::new(len, &inputs.xi, call))
        }
    };
    let mut contenders = with_levels(contenders, SLICES, slices(DIRECTIONS));
    if every_way {
        let (eights, _) = inputs.xi.as_chunks::<8>();
        contenders = with_levels(contenders, FRESH, |level| {
            task(eights, move |xi| {
                let xi = core::array::from_fn(|k| f32x8::new(xi.map(|xi| xi[k])));
                gather.sample8_at(level, &xi)
            })
        });
        contenders = with_levels(contenders, SHORT, slices(FEW));
    }
    Ok((contenders, Truth::of_samples(truth(id, params, &[wo; DIRECTIONS])?, &inputs.xi)))
}
