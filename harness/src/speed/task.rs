//! Work of a contender in a pass, and its answers in one form for all contenders.

use crate::light::Seen8;
use core::hint::black_box;
use core::marker::PhantomData;
use glam::Vec3;
use hairis::reference::{Reference, ReferenceSample};
use hairis::{Eval, Eval8, Gather, Gather8, Model, Sample, Sample8, Vec3x8};

/// Direction at which prepared shading points are evaluated to check them: no lobe is negligible there.
pub(super) const PROBE: Vec3 = Vec3::new(0.28, 0.576, 0.768);

/// Answer of a contender for one direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContenderAnswer {
    /// The direction it drew; `None` if it was given one, zero if it discarded the sample.
    pub(super) wi: Option<Vec3>,
    pub(super) value: [f32; 3],
    pub(super) pdf: f32,
}

/// The result of one call: of one direction, or of eight.
pub(crate) trait Output {
    fn answers(&self, out: &mut Vec<ContenderAnswer>);
}

/// Work over all the inputs of a run.
pub(crate) trait Pass {
    /// One call per input; results are dropped.
    fn pass(&self);
    /// The same calls, their results kept, in the order of the directions.
    fn answers(&self) -> Vec<ContenderAnswer>;
}

/// A function of one argument and the arguments it is given.
struct Task<I, O, F> {
    inputs: Vec<I>,
    call: F,
    output: PhantomData<fn() -> O>,
}

/// A pass that calls `call` with each of `inputs`.
pub(crate) fn task<'a, I, O, F>(inputs: &[I], call: F) -> Box<dyn Pass + 'a>
where
    I: Clone + 'a,
    O: Output + 'a,
    F: Fn(&I) -> O + 'a,
{
    Box::new(Task { inputs: inputs.to_vec(), call, output: PhantomData })
}

impl<I, O: Output, F: Fn(&I) -> O> Pass for Task<I, O, F> {
    // One loop for all contenders: each call reads its input from memory and leaves its result there. References are
    // hidden from the optimiser, not values, so that no copy is timed; and calls stay apart, so that no loop over
    // one lane is made into one over four.
    #[inline(never)]
    fn pass(&self) {
        for input in &self.inputs {
            black_box(&(self.call)(black_box(input)));
        }
    }

    fn answers(&self) -> Vec<ContenderAnswer> {
        let mut out = Vec::new();
        for input in &self.inputs {
            (self.call)(input).answers(&mut out);
        }
        out
    }
}

/// A function of one argument with several results, each passed on as it comes.
struct Several<I, O, F> {
    inputs: Vec<I>,
    call: F,
    /// The place of the `i`th answer among those of the directions.
    place: fn(usize) -> usize,
    output: PhantomData<fn() -> O>,
}

/// A pass that calls `call` with each of `inputs`; of its answers in the order they come, the `i`th is the answer to
/// direction `place(i)`.
pub(super) fn several<I, O, F>(inputs: &[I], place: fn(usize) -> usize, call: F) -> Box<dyn Pass>
where
    I: Clone + 'static,
    O: Output + 'static,
    F: Fn(&I, &mut dyn FnMut(&O)) + 'static,
{
    Box::new(Several { inputs: inputs.to_vec(), call, place, output: PhantomData })
}

impl<I, O: Output, F: Fn(&I, &mut dyn FnMut(&O))> Pass for Several<I, O, F> {
    #[inline(never)]
    fn pass(&self) {
        for input in &self.inputs {
            (self.call)(black_box(input), &mut |result| {
                black_box(result);
            });
        }
    }

    fn answers(&self) -> Vec<ContenderAnswer> {
        let mut out = Vec::new();
        for input in &self.inputs {
            (self.call)(input, &mut |result| result.answers(&mut out));
        }
        let mut ordered = out.clone();
        for (i, answer) in out.iter().enumerate() {
            ordered[(self.place)(i)] = *answer;
        }
        ordered
    }
}

impl Output for ([f32; 3], f32) {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        out.push(ContenderAnswer { wi: None, value: self.0, pdf: self.1 });
    }
}

impl Output for Eval {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        out.push(ContenderAnswer { wi: None, value: self.value, pdf: self.pdf });
    }
}

impl Output for Eval8 {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        for lane in 0..8 {
            self.lane(lane).answers(out);
        }
    }
}

impl Output for Seen8 {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        for lane in 0..8 {
            let value = self.radiance.map(|c| c.to_array()[lane]);
            out.push(ContenderAnswer { wi: None, value, pdf: self.pdf.to_array()[lane] });
        }
    }
}

impl Output for ReferenceSample<f32> {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        out.push(ContenderAnswer { wi: Some(self.wi.into()), value: self.value, pdf: self.pdf });
    }
}

impl Output for Option<Sample> {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        out.push(match self {
            Some(sample) => ContenderAnswer { wi: Some(sample.wi), value: sample.value, pdf: sample.pdf },
            None => ContenderAnswer { wi: Some(Vec3::ZERO), value: [0.0; 3], pdf: 0.0 },
        });
    }
}

impl Output for Sample8 {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        for lane in 0..8 {
            self.lane(lane).answers(out);
        }
    }
}

/// A shading point of the formulas.
pub(super) struct FormulaPoint<R>(pub(super) R);

impl<R: Reference<f32>> Output for FormulaPoint<R> {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        self.0.eval_pdf(PROBE.to_array()).answers(out);
    }
}

impl<M: Model> Output for Gather<M> {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        self.eval_pdf(PROBE).answers(out);
    }
}

impl<M: Model> Output for Gather8<M> {
    fn answers(&self, out: &mut Vec<ContenderAnswer>) {
        self.eval_pdf8(&Vec3x8::splat(PROBE)).answers(out);
    }
}
