//! Contenders of `hairis compare`: the formulas in scalar code, and the kernel on one lane, on eight and in slices.

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
use hairis_variants::{ModelId, Parameters};
use serde::Serialize;

/// Timed operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimedOp {
    /// Everything constant for one shading point (section 3.3 of the paper).
    Prepare,
    /// Value and density of a direction, the shading point prepared beforehand.
    EvalPdf,
    /// A direction with its value, density and weight, the shading point prepared beforehand.
    Sample,
    /// [`EvalPdf`](Self::EvalPdf) of hair so narrow that the directions lie in the far tails of every lobe.
    EvalPdfTails,
    /// [`Sample`](Self::Sample) of the same hair.
    SampleTails,
    /// A shading point of its own for each direction, and its value and density: all on one head of hair.
    PointsEval,
    /// Preparing one material's shading points, and one sample with its value at each.
    PointsShared,
    /// Preparing shading points, and four samples at each.
    PointsOf4,
    /// With sixteen.
    PointsOf16,
    /// With one, on eight heads of hair, one per lane, packed once.
    PointsMixed,
    /// Eight materials packed anew for each eight shading points.
    PointsPacked,
}

impl TimedOp {
    /// Every operation, in the order of the tables.
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

    /// Name of the operation in tables.
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

/// The kernel, one direction per call.
const ONE: &str = "one lane";
/// The kernel, eight directions per call.
const EIGHT: &str = "eight lanes";

/// The kernel, eight directions at one shading point per call, where [`EIGHT`] has eight shading points.
const EIGHT_AT_ONE: &str = "eight lanes, one point";

/// [`EIGHT`], with numbers that are put into a packet just before the call, as hosts do that compute them one by one.
const FRESH: &str = "eight lanes, just written";
/// The kernel, all directions in one call.
const SLICES: &str = "slices";
/// The kernel, eight directions in one call.
const SHORT: &str = "slices of 8";
/// The kernel, all directions in one call, each at a shading point of its own.
const HITS: &str = "slices of hits";
/// [`HITS`] with [`Conserving`](hairis::Conserving), as hosts are told to make their materials.
const CONSERVING_HITS: &str = "slices of hits, Conserving";
/// Directions of [`SHORT`].
const FEW: usize = 8;

/// Code that takes part in an operation.
#[derive(Debug)]
pub struct Contender {
    /// [`REFERENCE`], or one of the kinds of calls of the kernel.
    pub name: &'static str,
    /// Instruction set of its lanes.
    pub level: &'static str,
    /// Whether its answers have each channel divided by its albedo where that is above 1.
    pub conserves: bool,
    /// Pass over all inputs.
    pub task: Box<dyn Pass>,
}

/// One operation of one model.
#[derive(Debug)]
pub struct Contest {
    /// The operation.
    pub op: TimedOp,
    /// Name of the model.
    pub model: &'static str,
    /// The formulas in `f32` on the libm crate and on std first, then the kernel.
    pub contenders: Vec<Contender>,
    /// The answers.
    pub truth: Truth,
}

/// Returns every timed operation of a model; none unless [`ModelId::is_default`].
///
/// # Errors
///
/// If the model refuses the parameters.
///
/// # Panics
///
/// If there are not [`TIMED_DIRECTIONS`] of each input.
pub fn contests(model: ModelId, inputs: &TimedInputs) -> Result<Vec<Contest>, ParamError> {
    visit(model, OfModel(inputs))
}

/// The contenders of an operation, and the answers.
type Entrants = Result<(Contenders, Truth), ParamError>;

/// The operations of one model.
struct OfModel<'a>(&'a TimedInputs);

impl Visitor for OfModel<'_> {
    type Output = Result<Vec<Contest>, ParamError>;

    fn visit<M: Formulas>(self) -> Self::Output {
        // At compile time: models that are not timed are not compiled.
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

/// The formulas in `f64` for these parameters, seen from each of `wo`.
fn truth<M: Formulas>(
    params: &M::Params,
    wo: &[Vec3],
) -> Result<Vec<Box<dyn Reference<f64>>>, ParamError> {
    wo.iter()
        .map(|wo| reference(ModelId::of::<M>(), &params.values(), to_f64(*wo), 0.0))
        .collect()
}

/// The contenders so far.
struct Contenders(Vec<Contender>);

impl Contenders {
    /// The formulas in `f32` on the libm crate and on std, and the kernel on one lane.
    fn new(libm: Box<dyn Pass>, std: Box<dyn Pass>, one: Box<dyn Pass>) -> Self {
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

    /// Then one on every level of this CPU.
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

/// A material: the kernel's, and the formulas on the libm crate and on std.
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

    /// The formulas seen from `wo`.
    fn references(&self, wo: Vec3) -> (M::Point<f32>, M::Point<Platform>) {
        let wo = wo.to_array();
        (
            M::point(&self.libm, wo, 0.0),
            M::point(&self.std, platform(wo), Platform(0.0)),
        )
    }
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
        task(&wo, move |wo| {
            Point::<_, f32>(M::point(&libm, *wo, 0.0), PhantomData)
        }),
        task(&wo, move |wo| {
            Point(M::point(&std, platform(*wo), Platform(0.0)), PhantomData)
        }),
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
    let implementations = Implementations::<M>::new(params);
    let ((libm, std), bsdf) = (
        implementations.references(wo),
        implementations.material.prepare(wo),
    );
    let slices = |len| {
        let wi = &wi;
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
            Box::new(Slices::new(len, wi, call))
        }
    };
    let mut contenders = Contenders::new(
        task(&wi, move |wi| libm.eval_pdf(*wi)),
        task(&wi, move |wi| std.eval_pdf(platform(*wi))),
        task(&inputs.wi, move |wi| bsdf.eval_pdf(*wi)),
    )
    .levels(EIGHT, |level| {
        let bsdf = bsdf.with_level(level);
        task(&packets(&inputs.wi), move |wi| bsdf.eval_pdf8(wi))
    })
    .levels(SLICES, slices(TIMED_DIRECTIONS));
    if every_way {
        let (eights, _) = inputs.wi.as_chunks::<8>();
        let fresh = |level| {
            let bsdf = bsdf.with_level(level);
            task(eights, move |wi| bsdf.eval_pdf8(&Vec3x8::from(*wi)))
        };
        contenders = contenders.levels(FRESH, fresh).levels(SHORT, slices(FEW));
    }
    Ok((
        contenders,
        Truth::of_directions(truth::<M>(params, &[wo])?, &inputs.wi),
    ))
}

fn sample<M: Formulas>(
    params: &M::Params,
    inputs: &TimedInputs<M::Params>,
    every_way: bool,
) -> Entrants {
    let (wo, xi) = (inputs.wo[0], &inputs.xi);
    let implementations = Implementations::<M>::new(params);
    let ((libm, std), bsdf) = (
        implementations.references(wo),
        implementations.material.prepare(wo),
    );
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
    let mut contenders = Contenders::new(
        task(xi, move |xi| libm.sample(*xi)),
        task(xi, move |xi| std.sample(platform(*xi))),
        task(xi, move |xi| bsdf.sample(*xi)),
    )
    .levels(EIGHT, |level| {
        let bsdf = bsdf.with_level(level);
        task(&xi_packets(xi), move |xi| bsdf.sample8(xi))
    })
    .levels(SLICES, slices(TIMED_DIRECTIONS));
    if every_way {
        let (eights, _) = xi.as_chunks::<8>();
        let packed = |xi: &[[f32; 3]; 8]| -> [f32x8; 3] {
            core::array::from_fn(|k| f32x8::new(xi.map(|xi| xi[k])))
        };
        let fresh = |level| {
            let bsdf = bsdf.with_level(level);
            task(eights, move |xi| bsdf.sample8(&packed(xi)))
        };
        contenders = contenders.levels(FRESH, fresh).levels(SHORT, slices(FEW));
    }
    Ok((
        contenders,
        Truth::of_samples(truth::<M>(params, &[wo])?, xi),
    ))
}
