//! The operations, and who takes part in each.

use super::Op;
use super::check::Truth;
use super::inputs::{DIRECTIONS, Inputs, arrays, packets, xi_packets};
use super::task::{PROBE, Pass, task};
use super::{points, slices};
use crate::subject::Subject;
use hairis::textbook::Textbook;
use hairis::{Bsdf, HairParams, Level, Model};

/// Name of the contender that all others are compared with; the first of every cell.
pub(super) const TEXTBOOK: &str = "textbook";
/// The kernel, one direction a call.
pub(super) const ONE: &str = "one lane";
/// The kernel, eight directions a call.
pub(super) const EIGHT: &str = "eight lanes";

/// The kernel, eight directions at one gather point a call, where [`EIGHT`] has eight gather points.
pub(super) const EIGHT_AT_ONE: &str = "eight lanes, one point";

/// The kernel, all directions in one call.
const SLICES: &str = "slices";

/// One who takes part.
pub(super) struct Contender {
    pub(super) name: &'static str,
    /// Instruction set of its lanes.
    pub(super) level: &'static str,
    pub(super) task: Box<dyn Pass>,
}

/// One operation of one model: a table's block of rows.
pub(super) struct Cell {
    pub(super) op: Op,
    pub(super) model: &'static str,
    /// The textbook first.
    pub(super) contenders: Vec<Contender>,
    pub(super) truth: Truth,
}

/// All operations of one model.
pub(super) fn cells<M>(subject: &Subject<M>, inputs: &Inputs) -> Vec<Cell>
where
    M: Model<Params = HairParams> + 'static,
{
    Op::ALL
        .into_iter()
        .map(|op| {
            let (contenders, truth) = match op {
                Op::Prepare => prepare(subject, inputs),
                Op::EvalPdf => eval_pdf(subject, &inputs.hair[0], inputs),
                Op::EvalPdfTails => eval_pdf(subject, &inputs.narrow, inputs),
                Op::Sample => sample(subject, &inputs.hair[0], inputs),
                Op::SampleTails => sample(subject, &inputs.narrow, inputs),
                Op::PointsShared => points::shared::<_, 1, 1>(subject, inputs),
                Op::PointsOf4 => points::shared::<_, 4, 1>(subject, inputs),
                Op::PointsOf16 => points::shared::<_, 16, 2>(subject, inputs),
                Op::PointsMixed => points::mixed(subject, inputs, false),
                Op::PointsPacked => points::mixed(subject, inputs, true),
            };
            Cell { op, model: subject.name, contenders, truth }
        })
        .collect()
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

fn prepare<M>(subject: &Subject<M>, inputs: &Inputs) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let hair = &inputs.hair[0];
    let (parameters, shape) = (subject.parameters::<f32>(hair), subject.shape);
    let bsdf = Bsdf::new(&subject.model, hair);
    let contenders = vec![
        scalar(TEXTBOOK, task(&arrays(&inputs.wo), move |wo| Textbook::prepare(&parameters, shape, *wo))),
        scalar(ONE, task(&inputs.wo, move |wo| bsdf.prepare(*wo))),
    ];
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&packets(&inputs.wo), move |wo| bsdf.prepare8_at(level, wo)));
    let points = inputs.wo.iter().map(|wo| subject.oracle(hair, *wo)).collect();
    (contenders, Truth::of_directions(points, &[PROBE; DIRECTIONS]))
}

fn eval_pdf<M>(subject: &Subject<M>, hair: &HairParams, inputs: &Inputs) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let wo = inputs.wo[0];
    let textbook = Textbook::prepare(&subject.parameters::<f32>(hair), subject.shape, wo.to_array());
    let gather = Bsdf::new(&subject.model, hair).prepare(wo);
    let contenders = vec![
        scalar(TEXTBOOK, task(&arrays(&inputs.wi), move |wi| textbook.eval_pdf(*wi))),
        scalar(ONE, task(&inputs.wi, move |wi| gather.eval_pdf(*wi))),
    ];
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&packets(&inputs.wi), move |wi| gather.eval_pdf8_at(level, wi)));
    let contenders = with_levels(contenders, SLICES, |level| slices::eval_pdf(gather, level, &inputs.wi));
    (contenders, Truth::of_directions(vec![subject.oracle(hair, wo); DIRECTIONS], &inputs.wi))
}

fn sample<M>(subject: &Subject<M>, hair: &HairParams, inputs: &Inputs) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let wo = inputs.wo[0];
    let textbook = Textbook::prepare(&subject.parameters::<f32>(hair), subject.shape, wo.to_array());
    let gather = Bsdf::new(&subject.model, hair).prepare(wo);
    let contenders = vec![
        scalar(TEXTBOOK, task(&inputs.xi, move |xi| textbook.sample(*xi))),
        scalar(ONE, task(&inputs.xi, move |xi| gather.sample(*xi))),
    ];
    let contenders =
        with_levels(contenders, EIGHT, |level| task(&xi_packets(&inputs.xi), move |xi| gather.sample8_at(level, xi)));
    let contenders = with_levels(contenders, SLICES, |level| slices::sample(gather, level, &inputs.xi));
    (contenders, Truth::of_samples(vec![subject.oracle(hair, wo); DIRECTIONS], &inputs.xi))
}
