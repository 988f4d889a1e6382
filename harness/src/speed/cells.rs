//! The operations, and the contenders of each.

use super::check::Truth;
use super::inputs::{DIRECTIONS, Inputs};
use super::{Op, points, task};
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

/// Contender, and its times.
pub(super) struct Contender {
    pub(super) name: &'static str,
    /// Instruction set of its lanes.
    pub(super) level: &'static str,
    pub(super) task: Box<dyn Pass>,
    /// Passes in a stretch.
    pub(super) passes: u32,
    /// Time per direction in each round, ns.
    pub(super) ns: Vec<f64>,
}

impl Contender {
    fn new(name: &'static str, level: &'static str, task: Box<dyn Pass>) -> Self {
        Self { name, level, task, passes: 1, ns: Vec::new() }
    }
}

/// One operation of one model: a table's block of rows.
pub(super) struct SpeedCell {
    pub(super) op: Op,
    pub(super) model: &'static str,
    /// The formulas in `f32` on the libm crate and on std first, then the kernel.
    pub(super) contenders: Vec<Contender>,
    pub(super) truth: Truth,
}

/// The contenders of an operation, and the answers.
pub(super) type Timed = Result<(Contenders, Truth), ParamError>;

/// All operations of one model, on inputs of this seed; none unless it is the first of its name.
pub(super) struct SpeedCells(pub(super) u64);

impl Visitor for SpeedCells {
    type Output = Result<Vec<SpeedCell>, ParamError>;

    fn visit<M: Registered>(self) -> Self::Output {
        // At compile time: models that are not timed are not compiled.
        if const { !ModelId::of::<M>().is_default() } {
            return Ok(Vec::new());
        }
        let inputs = Inputs::draw(self.0)?;
        let timed = |op: Op| {
            let (contenders, truth) = match op {
                Op::Prepare => prepare::<M>(&inputs),
                Op::EvalPdf => eval_pdf::<M>(&inputs.params[0], &inputs, true),
                Op::EvalPdfTails => eval_pdf::<M>(&inputs.narrow, &inputs, false),
                Op::Sample => sample::<M>(&inputs.params[0], &inputs, true),
                Op::SampleTails => sample::<M>(&inputs.narrow, &inputs, false),
                Op::PointsEval => points::eval::<M>(&inputs),
                Op::PointsShared => points::shared::<M, 1, 1>(&inputs),
                Op::PointsOf4 => points::shared::<M, 4, 1>(&inputs),
                Op::PointsOf16 => points::shared::<M, 16, 2>(&inputs),
                Op::PointsMixed => points::mixed::<M>(&inputs, false),
                Op::PointsPacked => points::mixed::<M>(&inputs, true),
            }?;
            Ok(SpeedCell { op, model: M::NAME, contenders: contenders.0, truth })
        };
        Op::ALL.into_iter().map(timed).collect()
    }
}

/// The formulas in `f64` for these parameters, seen from each of `wo`.
pub(super) fn truth<M: Registered>(params: &M::Params, wo: &[Vec3]) -> Result<Vec<AnyReference<f64>>, ParamError> {
    wo.iter().map(|wo| ModelId::of::<M>().reference(&params.values(), to_f64(*wo), 0.0)).collect()
}

/// The contenders so far.
pub(super) struct Contenders(Vec<Contender>);

impl Contenders {
    /// The formulas in `f32` on the libm crate and on std, and the kernel on one lane.
    pub(super) fn new(libm: Box<dyn Pass>, std: Box<dyn Pass>, one: Box<dyn Pass>) -> Self {
        let [libm, std] = [("scalar, libm crate", libm), ("scalar, std", std)]
            .map(|(level, task)| Contender::new(TEXTBOOK, level, task));
        Self(vec![libm, std, Contender::new(ONE, "scalar", one)])
    }

    /// Then one on every level of this CPU.
    pub(super) fn levels(mut self, name: &'static str, task: impl Fn(Level) -> Box<dyn Pass>) -> Self {
        self.0.extend(Level::available().map(|level| Contender::new(name, level.name(), task(level))));
        self
    }
}

/// A material: the kernel's, and the formulas on the libm crate and on std.
pub(super) struct Material<M: Registered> {
    pub(super) bsdf: Bsdf<M>,
    pub(super) libm: M::Formulas<f32>,
    pub(super) std: M::Formulas<Platform>,
}

impl<M: Registered> Material<M> {
    pub(super) fn new(params: &M::Params) -> Self {
        Self { bsdf: Bsdf::new(&M::MODEL, params), libm: M::formulas(params), std: M::formulas(params) }
    }

    /// The formulas seen from `wo`.
    fn references(&self, wo: Vec3) -> (M::Reference<f32>, M::Reference<Platform>) {
        let wo = wo.to_array();
        (M::reference_at(&self.libm, wo, 0.0), M::reference_at(&self.std, platform(wo), Platform(0.0)))
    }
}

fn prepare<M: Registered>(inputs: &Inputs<M::Params>) -> Timed {
    let params = &inputs.params[0];
    let Material::<M> { bsdf, libm, std } = Material::new(params);
    let wo = arrays(&inputs.wo);
    let contenders = Contenders::new(
        task(&wo, move |wo| Point::<_, f32>(M::reference_at(&libm, *wo, 0.0), PhantomData)),
        task(&wo, move |wo| Point(M::reference_at(&std, platform(*wo), Platform(0.0)), PhantomData)),
        task(&inputs.wo, move |wo| bsdf.prepare(*wo)),
    )
    .levels(EIGHT, |level| task(&packets(&inputs.wo), move |wo| bsdf.prepare8_at(level, wo)));
    Ok((contenders, Truth::of_directions(truth::<M>(params, &inputs.wo)?, &[PROBE; DIRECTIONS])))
}

fn eval_pdf<M: Registered>(params: &M::Params, inputs: &Inputs<M::Params>, every_way: bool) -> Timed {
    let (wo, wi) = (inputs.wo[0], arrays(&inputs.wi));
    let material = Material::<M>::new(params);
    let ((libm, std), gather) = (material.references(wo), material.bsdf.prepare(wo));
    let slices = |len| {
        let wi = &wi;
        move |level| -> Box<dyn Pass> {
            let call = move |wi: [&[f32]; 3], [r, g, b, pdf]: [&mut [f32]; 4]| {
                gather.eval_pdf_batch_at(level, wi, EvalSlices { value: [r, g, b], pdf })
            };
            Box::new(Slices::new(len, wi, call))
        }
    };
    let mut contenders = Contenders::new(
        task(&wi, move |wi| libm.eval_pdf(*wi)),
        task(&wi, move |wi| std.eval_pdf(platform(*wi))),
        task(&inputs.wi, move |wi| gather.eval_pdf(*wi)),
    )
    .levels(EIGHT, |level| task(&packets(&inputs.wi), move |wi| gather.eval_pdf8_at(level, wi)))
    .levels(SLICES, slices(DIRECTIONS));
    if every_way {
        let (eights, _) = inputs.wi.as_chunks::<8>();
        let fresh = |level| task(eights, move |wi| gather.eval_pdf8_at(level, &Vec3x8::from(*wi)));
        contenders = contenders.levels(FRESH, fresh).levels(SHORT, slices(FEW));
    }
    Ok((contenders, Truth::of_directions(truth::<M>(params, &[wo; DIRECTIONS])?, &inputs.wi)))
}

fn sample<M: Registered>(params: &M::Params, inputs: &Inputs<M::Params>, every_way: bool) -> Timed {
    let (wo, xi) = (inputs.wo[0], &inputs.xi);
    let material = Material::<M>::new(params);
    let ((libm, std), gather) = (material.references(wo), material.bsdf.prepare(wo));
    let slices = |len| {
        move |level| -> Box<dyn Pass> {
            let call = move |xi: [&[f32]; 3], [r, g, b, pdf, u, v, w, wr, wg, wb, slot]: [&mut [f32]; 11]| {
                let out = SampleSlices { wi: [u, v, w], value: [r, g, b], pdf, weight: [wr, wg, wb], slot };
                gather.sample_batch_at(level, xi, out)
            };
            Box::new(Slices::new(len, xi, call))
        }
    };
    let mut contenders = Contenders::new(
        task(xi, move |xi| libm.sample(*xi)),
        task(xi, move |xi| std.sample(platform(*xi))),
        task(xi, move |xi| gather.sample(*xi)),
    )
    .levels(EIGHT, |level| task(&xi_packets(xi), move |xi| gather.sample8_at(level, xi)))
    .levels(SLICES, slices(DIRECTIONS));
    if every_way {
        let (eights, _) = xi.as_chunks::<8>();
        let packed = |xi: &[[f32; 3]; 8]| -> [f32x8; 3] { core::array::from_fn(|k| f32x8::new(xi.map(|xi| xi[k]))) };
        let fresh = |level| task(eights, move |xi| gather.sample8_at(level, &packed(xi)));
        contenders = contenders.levels(FRESH, fresh).levels(SHORT, slices(FEW));
    }
    Ok((contenders, Truth::of_samples(truth::<M>(params, &[wo; DIRECTIONS])?, xi)))
}
