//! The operations, and who takes part in each.

use super::Op;
use super::check::Truth;
use super::inputs::{DIRECTIONS, Inputs, arrays, packets, pairs, xi_packets};
use super::slices;
use super::task::{PROBE, Pass, task};
use crate::subject::Subject;
use glam::Vec3;
use hairis::textbook::Textbook;
use hairis::{Bsdf, Bsdf8, HairParams, Level, Model};

/// Name of the contender that all others are compared with; the first of every cell.
pub(super) const TEXTBOOK: &str = "textbook";
/// The kernel, one direction a call.
const ONE: &str = "one lane";
/// The kernel, eight directions a call.
const EIGHT: &str = "eight lanes";

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
                Op::EvalPdf => eval_pdf(subject, inputs),
                Op::Sample => sample(subject, inputs),
                Op::PointsShared => points_shared(subject, inputs),
                Op::PointsMixed => points_mixed(subject, inputs, false),
                Op::PointsPacked => points_mixed(subject, inputs, true),
            };
            Cell { op, model: subject.name, contenders, truth }
        })
        .collect()
}

fn scalar(name: &'static str, task: Box<dyn Pass>) -> Contender {
    Contender { name, level: "scalar", task }
}

/// The contenders so far, then one on every level of this CPU.
fn with_levels(
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

fn eval_pdf<M>(subject: &Subject<M>, inputs: &Inputs) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let (hair, wo) = (&inputs.hair[0], inputs.wo[0]);
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

fn sample<M>(subject: &Subject<M>, inputs: &Inputs) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let (hair, wo) = (&inputs.hair[0], inputs.wo[0]);
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

/// A gather point and one sample of it, all on the same hair.
fn points_shared<M>(subject: &Subject<M>, inputs: &Inputs) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let hair = &inputs.hair[0];
    let (parameters, shape) = (subject.parameters::<f32>(hair), subject.shape);
    let bsdf = Bsdf::new(&subject.model, hair);
    let contenders = vec![
        scalar(
            TEXTBOOK,
            task(&pairs(&arrays(&inputs.wo), &inputs.xi), move |(wo, xi)| {
                Textbook::prepare(&parameters, shape, *wo).sample(*xi)
            }),
        ),
        scalar(ONE, task(&pairs(&inputs.wo, &inputs.xi), move |(wo, xi)| bsdf.prepare(*wo).sample(*xi))),
    ];
    let contenders = with_levels(contenders, EIGHT, |level| {
        task(&pairs(&packets(&inputs.wo), &xi_packets(&inputs.xi)), move |(wo, xi)| {
            bsdf.prepare8_at(level, wo).sample8_at(level, xi)
        })
    });
    let points = inputs.wo.iter().map(|wo| subject.oracle(hair, *wo)).collect();
    (contenders, Truth::of_samples(points, &inputs.xi))
}

/// A gather point and one sample of it, each lane on hair of its own; packed beforehand, or once a packet.
fn points_mixed<M>(subject: &Subject<M>, inputs: &Inputs, pack_each: bool) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let parameters = inputs.hair.map(|hair| subject.parameters::<f32>(&hair));
    let shape = subject.shape;
    let bsdfs = inputs.hair.map(|hair| Bsdf::new(&subject.model, &hair));
    let numbered: Vec<(usize, Vec3)> = inputs.wo.iter().enumerate().map(|(i, wo)| (i % 8, *wo)).collect();
    let arrays: Vec<(usize, [f32; 3])> = numbered.iter().map(|(i, wo)| (*i, wo.to_array())).collect();
    let contenders = vec![
        scalar(
            TEXTBOOK,
            task(&pairs(&arrays, &inputs.xi), move |((hair, wo), xi)| {
                Textbook::prepare(&parameters[*hair], shape, *wo).sample(*xi)
            }),
        ),
        scalar(ONE, task(&pairs(&numbered, &inputs.xi), move |((hair, wo), xi)| bsdfs[*hair].prepare(*wo).sample(*xi))),
    ];
    let eights = pairs(&packets(&inputs.wo), &xi_packets(&inputs.xi));
    let packed = Bsdf8::pack(bsdfs.each_ref());
    let contenders = with_levels(contenders, EIGHT, |level| {
        if pack_each {
            task(&eights, move |(wo, xi)| Bsdf8::pack(bsdfs.each_ref()).prepare8_at(level, wo).sample8_at(level, xi))
        } else {
            task(&eights, move |(wo, xi)| packed.prepare8_at(level, wo).sample8_at(level, xi))
        }
    });
    let points = numbered.iter().map(|(i, wo)| subject.oracle(&inputs.hair[*i], *wo)).collect();
    (contenders, Truth::of_samples(points, &inputs.xi))
}
