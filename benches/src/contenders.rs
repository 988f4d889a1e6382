//! Contenders of `hairis compare`: the formulas in scalar code, and the kernel on one lane, on eight lanes and in slices.
//!
//! Kernels at a prepared hit are those of the list of models, behind its run-time handles, because kernels of typed handles would be
//! compiled once more here. The choice of the model is part of the time of each call: one or two nanoseconds. Operations that prepare
//! hits, and calls on hits, are typed: a BSDF of any model is copied with the size of the largest, and has no calls on hits.

mod inputs;
mod points;
mod truth;

pub use inputs::{TIMED_DIRECTIONS, TimedInputs};
pub use truth::Truth;

use crate::check::to_f64;
use crate::entries::REFERENCE;
use crate::inputs::{arrays, packets, xi_packets};
use crate::platform::{Platform, platform};
use crate::task::{PROBE, Pass, Point, Slices, task};
use core::marker::PhantomData;
use glam::Vec3;
use hairis::columns::{EvalColumns, SampleColumns};
use hairis::simd::{Level, f32x8};
use hairis::{Material, ParamError, Vec3x8};
use hairis_reference::{Formulas, Reference, Visitor, reference, visit};
use hairis_variants::{AnyBsdf, AnyMaterial, ModelId, Parameters};
use serde::Serialize;

/// Operation that `hairis compare` times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimedOp {
    /// Computes everything that is constant for one shading point (section 3.3 of the paper).
    Prepare,
    /// Value and density of a direction at a shading point that was prepared beforehand.
    EvalPdf,
    /// Direction sampled with its value, density and weight, at a shading point that was prepared beforehand.
    Sample,
    /// [`EvalPdf`](Self::EvalPdf) on hair with lobes so narrow that the directions lie in the far tails of every lobe.
    EvalPdfTails,
    /// [`Sample`](Self::Sample) on the narrow hair of [`EvalPdfTails`](Self::EvalPdfTails).
    SampleTails,
    /// Prepares a shading point for each direction, and evaluates its value and density: all on one head of hair.
    PointsEval,
    /// Prepares shading points on one material, and draws one sample with its value at each.
    PointsShared,
    /// Prepares shading points on one material, and draws four samples at each.
    PointsOf4,
    /// Prepares shading points on one material, and draws sixteen samples at each.
    PointsOf16,
    /// Prepares shading points on eight heads of hair, one per lane, packed once, and draws one sample at each.
    PointsMixed,
    /// [`PointsMixed`](Self::PointsMixed), with the eight materials packed anew for each eight shading points.
    PointsPacked,
}

impl TimedOp {
    /// Operations in the order in which the tables list them.
    pub const ALL: [Self; 11] = [
        Self::Prepare,
        Self::EvalPdf,
        Self::Sample,
        Self::EvalPdfTails,
        Self::SampleTails,
        Self::PointsEval,
        Self::PointsShared,
        Self::PointsOf4,
        Self::PointsOf16,
        Self::PointsMixed,
        Self::PointsPacked,
    ];

    /// Returns the name of the operation in tables.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Prepare => "prepare",
            Self::EvalPdf => "eval + pdf",
            Self::Sample => "sample",
            Self::EvalPdfTails => "eval + pdf, far tails",
            Self::SampleTails => "sample, far tails",
            Self::PointsEval => "prepare + eval + pdf",
            Self::PointsShared => "prepare + 1 sample",
            Self::PointsOf4 => "prepare + 4 samples",
            Self::PointsOf16 => "prepare + 16 samples",
            Self::PointsMixed => "prepare + 1, 8 hairs",
            Self::PointsPacked => "prepare + 1, 8 hairs, packing",
        }
    }
}

/// Name of the kernel called with one direction.
const ONE: &str = "one lane";
/// Name of the kernel called with eight directions.
const EIGHT: &str = "eight lanes";

/// Name of the kernel called with eight directions at one shading point, where [`EIGHT`] has eight shading points.
const EIGHT_AT_ONE: &str = "eight lanes, one point";

/// Name of [`EIGHT`] with numbers that are packed just before the call, as in hosts that compute them one by one.
const FRESH: &str = "eight lanes, just written";
/// Name of the kernel called once with slices of all directions.
const SLICES: &str = "slices";
/// Name of the kernel called with slices of eight directions.
const SHORT: &str = "slices of 8";
/// Name of the kernel called once with all directions, each at a shading point of its own.
const HITS: &str = "slices of hits";
/// Name of [`HITS`] with [`Conserving`](hairis::Conserving), which hosts are advised to use for their materials.
const CONSERVING_HITS: &str = "slices of hits, Conserving";
/// Number of directions in a call of [`SHORT`].
const FEW: usize = 8;

/// Implementation of an operation that takes part in the comparison.
#[derive(Debug)]
pub struct Contender {
    /// Name of the implementation: [`REFERENCE`], or one of the ways of calling the kernel.
    pub name: &'static str,
    /// Instruction set of its lanes.
    pub level: &'static str,
    /// Whether the answers have each channel divided by its albedo where the albedo is above 1.
    pub conserves: bool,
    /// Pass over all inputs, which is what is timed.
    pub task: Box<dyn Pass>,
}

/// Operation of one model, with all contenders and the correct answers.
#[derive(Debug)]
pub struct Contest {
    /// Operation that is timed.
    pub op: TimedOp,
    /// Name of the model.
    pub model: &'static str,
    /// Contenders: first the formulas in `f32` with the libm crate and with std, then the kernel.
    pub contenders: Vec<Contender>,
    /// Correct answers.
    pub truth: Truth,
}

/// Returns every timed operation of a model, or an empty list unless the model is the [default](ModelId::is_default) of its name.
///
/// # Errors
///
/// Returns an error if the model rejects the parameters.
///
/// # Panics
///
/// Panics if any of the inputs does not have [`TIMED_DIRECTIONS`] elements.
pub fn contests(model: ModelId, inputs: &TimedInputs) -> Result<Vec<Contest>, ParamError> {
    visit(model, OfModel(inputs))
}

/// Contenders of an operation with the correct answers, or the error of rejected parameters.
type Entrants = Result<(Contenders, Truth), ParamError>;

/// Visitor that builds the operations of one model.
struct OfModel<'a>(&'a TimedInputs);

impl Visitor for OfModel<'_> {
    type Output = Result<Vec<Contest>, ParamError>;

    fn visit<M: Formulas>(self) -> Self::Output {
        // Decided at compile time, so that models that are not timed are not compiled.
        if const { !ModelId::of::<M>().is_default() } {
            return Ok(Vec::new());
        }
        let inputs = self.0.typed()?;
        let contest = |op: TimedOp| {
            let (contenders, truth) = match op {
                TimedOp::Prepare => prepare::<M>(&inputs),
                TimedOp::EvalPdf => eval_pdf::<M>(&inputs.params[0], &inputs, true),
                TimedOp::EvalPdfTails => eval_pdf::<M>(&inputs.narrow, &inputs, false),
                TimedOp::Sample => sample::<M>(&inputs.params[0], &inputs, true),
                TimedOp::SampleTails => sample::<M>(&inputs.narrow, &inputs, false),
                TimedOp::PointsEval => points::eval::<M>(&inputs),
                TimedOp::PointsShared => points::shared::<M, 1, 1>(&inputs),
                TimedOp::PointsOf4 => points::shared::<M, 4, 1>(&inputs),
                TimedOp::PointsOf16 => points::shared::<M, 16, 2>(&inputs),
                TimedOp::PointsMixed => points::mixed::<M>(&inputs, false),
                TimedOp::PointsPacked => points::mixed::<M>(&inputs, true),
            }?;
            Ok(Contest {
                op,
                model: M::NAME,
                contenders: contenders.0,
                truth,
            })
        };
        TimedOp::ALL.into_iter().map(contest).collect()
    }
}

/// Returns the formulas in `f64` for these parameters, seen from each of `wo`.
fn truth<M: Formulas>(
    params: &M::Params,
    wo: &[Vec3],
) -> Result<Vec<Box<dyn Reference<f64>>>, ParamError> {
    wo.iter()
        .map(|wo| reference(ModelId::of::<M>(), &params.values(), to_f64(*wo), 0.0))
        .collect()
}

/// Passes over the formulas, with the libm crate and with std.
type Baselines = [Box<dyn Pass>; 2];

/// List of contenders that is being built.
struct Contenders(Vec<Contender>);

impl Contenders {
    /// Begins the list with the formulas in `f32`, with the libm crate and with std, and with the kernel on one lane.
    fn new([libm, std]: Baselines, one: Box<dyn Pass>) -> Self {
        let [libm, std] =
            [("scalar, libm crate", libm), ("scalar, std", std)].map(|(level, task)| Contender {
                name: REFERENCE,
                level,
                conserves: false,
                task,
            });
        Self(vec![
            libm,
            std,
            Contender {
                name: ONE,
                level: "scalar",
                conserves: false,
                task: one,
            },
        ])
    }

    /// Adds one contender for every level of this CPU.
    fn levels(mut self, name: &'static str, task: impl Fn(Level) -> Box<dyn Pass>) -> Self {
        self.0.extend(Level::available().map(|level| Contender {
            name,
            level: level.name(),
            conserves: name == CONSERVING_HITS,
            task: task(level),
        }));
        self
    }
}

/// Material in three implementations: the kernel, and the formulas with the libm crate and with std.
struct Implementations<M: Formulas> {
    material: Material<M>,
    libm: M::Constants<f32>,
    std: M::Constants<Platform>,
}

impl<M: Formulas> Implementations<M> {
    fn new(params: &M::Params) -> Self {
        Self {
            material: Material::new(&M::MODEL, params),
            libm: M::formulas(params),
            std: M::formulas(params),
        }
    }

    /// Returns the formulas seen from `wo`, with the libm crate and with std.
    fn references(&self, wo: Vec3) -> (M::Point<f32>, M::Point<Platform>) {
        let wo = wo.to_array();
        (
            M::point(&self.libm, wo, 0.0),
            M::point(&self.std, platform(wo), Platform(0.0)),
        )
    }
}

/// Makes the material as hosts do that choose the model at run time.
fn chosen<M: Formulas>(params: &M::Params) -> Result<AnyMaterial, ParamError> {
    ModelId::of::<M>().material(&params.values())
}

fn prepare<M: Formulas>(inputs: &TimedInputs<M::Params>) -> Entrants {
    let params = &inputs.params[0];
    let Implementations::<M> {
        material,
        libm,
        std,
    } = Implementations::new(params);
    let wo = arrays(&inputs.wo);
    let contenders = Contenders::new(
        [
            task(&wo, move |wo| {
                Point::<_, f32>(M::point(&libm, *wo, 0.0), PhantomData)
            }),
            task(&wo, move |wo| {
                Point(M::point(&std, platform(*wo), Platform(0.0)), PhantomData)
            }),
        ],
        task(&inputs.wo, move |wo| material.prepare(*wo)),
    )
    .levels(EIGHT, |level| {
        let material = material.with_level(level);
        task(&packets(&inputs.wo), move |wo| material.prepare8(wo))
    });
    Ok((
        contenders,
        Truth::of_directions(truth::<M>(params, &inputs.wo)?, &[PROBE; TIMED_DIRECTIONS]),
    ))
}

fn eval_pdf<M: Formulas>(
    params: &M::Params,
    inputs: &TimedInputs<M::Params>,
    every_way: bool,
) -> Entrants {
    let (wo, wi) = (inputs.wo[0], arrays(&inputs.wi));
    let (libm, std) = Implementations::<M>::new(params).references(wo);
    let formulas = [
        task(&wi, move |wi| libm.eval_pdf(*wi)),
        task(&wi, move |wi| std.eval_pdf(platform(*wi))),
    ];
    let bsdf = chosen::<M>(params)?.prepare(wo);
    Ok((
        evaluated(formulas, bsdf, &inputs.wi, every_way),
        Truth::of_directions(truth::<M>(params, &[wo])?, &inputs.wi),
    ))
}

/// Returns the contenders that evaluate a handle, after the formulas.
fn evaluated(formulas: Baselines, bsdf: AnyBsdf, wi: &[Vec3], every_way: bool) -> Contenders {
    let rows = arrays(wi);
    let slices = |len| {
        let rows = &rows;
        move |level| -> Box<dyn Pass> {
            let bsdf = bsdf.with_level(level);
            let call = move |wi: [&[f32]; 3], [r, g, b, pdf]: [&mut [f32]; 4]| {
                bsdf.eval_columns(
                    wi,
                    EvalColumns {
                        value: Some([r, g, b]),
                        pdf: Some(pdf),
                    },
                )
            };
            Box::new(Slices::new(len, rows, call))
        }
    };
    let contenders = Contenders::new(formulas, task(wi, move |wi| bsdf.eval_pdf(*wi)))
        .levels(EIGHT, |level| {
            let bsdf = bsdf.with_level(level);
            task(&packets(wi), move |wi| bsdf.eval_pdf8(wi))
        })
        .levels(SLICES, slices(TIMED_DIRECTIONS));
    if !every_way {
        return contenders;
    }
    let (eights, _) = wi.as_chunks::<8>();
    let fresh = |level| {
        let bsdf = bsdf.with_level(level);
        task(eights, move |wi| bsdf.eval_pdf8(&Vec3x8::from(*wi)))
    };
    contenders.levels(FRESH, fresh).levels(SHORT, slices(FEW))
}

fn sample<M: Formulas>(
    params: &M::Params,
    inputs: &TimedInputs<M::Params>,
    every_way: bool,
) -> Entrants {
    let (wo, xi) = (inputs.wo[0], &inputs.xi);
    let (libm, std) = Implementations::<M>::new(params).references(wo);
    let formulas = [
        task(xi, move |xi| libm.sample(*xi)),
        task(xi, move |xi| std.sample(platform(*xi))),
    ];
    let bsdf = chosen::<M>(params)?.prepare(wo);
    Ok((
        sampled(formulas, bsdf, xi, every_way),
        Truth::of_samples(truth::<M>(params, &[wo])?, xi),
    ))
}

/// Returns the contenders that sample a handle, after the formulas.
fn sampled(formulas: Baselines, bsdf: AnyBsdf, xi: &[[f32; 3]], every_way: bool) -> Contenders {
    let slices = |len| {
        move |level| -> Box<dyn Pass> {
            let bsdf = bsdf.with_level(level);
            let call =
                move |xi: [&[f32]; 3],
                      [r, g, b, pdf, u, v, w, wr, wg, wb, slot]: [&mut [f32]; 11]| {
                    let out = SampleColumns {
                        wi: Some([u, v, w]),
                        value: Some([r, g, b]),
                        pdf: Some(pdf),
                        weight: Some([wr, wg, wb]),
                        slot: Some(slot),
                    };
                    bsdf.sample_columns(xi, out)
                };
            Box::new(Slices::new(len, xi, call))
        }
    };
    let contenders = Contenders::new(formulas, task(xi, move |xi| bsdf.sample(*xi)))
        .levels(EIGHT, |level| {
            let bsdf = bsdf.with_level(level);
            task(&xi_packets(xi), move |xi| bsdf.sample8(xi))
        })
        .levels(SLICES, slices(TIMED_DIRECTIONS));
    if !every_way {
        return contenders;
    }
    let (eights, _) = xi.as_chunks::<8>();
    let packed = |xi: &[[f32; 3]; 8]| -> [f32x8; 3] {
        core::array::from_fn(|k| f32x8::new(xi.map(|xi| xi[k])))
    };
    let fresh = |level| {
        let bsdf = bsdf.with_level(level);
        task(eights, move |xi| bsdf.sample8(&packed(xi)))
    };
    contenders.levels(FRESH, fresh).levels(SHORT, slices(FEW))
}
