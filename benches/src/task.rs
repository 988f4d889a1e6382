//! Entry points with their inputs, and one form of answer for all of them.

use crate::inputs::Column;
use crate::platform::Platform;
use core::array::from_fn;
use core::fmt;
use core::hint::black_box;
use core::marker::PhantomData;
use glam::Vec3;
use hairis::columns::LengthError;
use hairis::model::Model;
use hairis::simd::f32x8;
use hairis::{Bsdf, Bsdf8, Eval, Eval8, Sample, Sample8, Vec3x8};
use hairis_reference::{Real, Reference, ReferenceSample};

/// Direction in which prepared shading points are evaluated to check them: no lobe is negligible for it.
pub const PROBE: Vec3 = Vec3::new(0.28, 0.576, 0.768);

/// Answer of an entry point for one direction, with the parts that the entry point computes.
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// Sampled direction: `None` for evaluations, zero for a discarded sample.
    pub wi: Option<Vec3>,
    /// Value S, if the entry point computes it.
    pub value: Option<[f32; 3]>,
    /// Density, if the entry point computes it.
    pub pdf: Option<f32>,
}

/// Entry point with the arguments of all its calls.
pub trait Task {
    /// Returns the number of calls per pass.
    fn calls(&self) -> usize;
    /// Returns the number of directions per call.
    fn directions(&self) -> usize;
    /// Makes one call, whose result is written to memory and dropped.
    fn call(&mut self, index: usize);
    /// Returns the answers of a pass, in the order of the directions.
    fn answers(&mut self) -> Vec<Answer>;
}

/// Pass over all calls, which is timed as one loop behind a dynamic call.
pub trait Pass {
    /// Makes all calls and drops their results.
    fn pass(&mut self);
    /// Returns the answers of a pass, in the order of the directions.
    fn answers(&mut self) -> Vec<Answer>;
}

impl fmt::Debug for dyn Pass + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Pass")
    }
}

impl<T: Task> Pass for T {
    #[inline(never)]
    fn pass(&mut self) {
        for index in 0..self.calls() {
            self.call(index);
        }
    }
    fn answers(&mut self) -> Vec<Answer> {
        Task::answers(self)
    }
}

/// Result of one call, for one direction or for eight.
pub trait Output {
    /// Appends an answer for each direction to `out`.
    fn answers(&self, out: &mut Vec<Answer>);
}

/// Task that calls a function of one argument with each of a list of arguments.
#[derive(Debug)]
pub struct Each<I, O, F> {
    inputs: Vec<I>,
    directions: usize,
    call: F,
    output: PhantomData<fn() -> O>,
}

impl<I, O: Output, F: Fn(&I) -> O> Each<I, O, F> {
    /// Makes a task that calls `call` once for each of `inputs`; each call answers for `directions` directions.
    pub const fn new(directions: usize, inputs: Vec<I>, call: F) -> Self {
        Self {
            inputs,
            directions,
            call,
            output: PhantomData,
        }
    }
}

impl<I, O: Output, F: Fn(&I) -> O> Task for Each<I, O, F> {
    fn calls(&self) -> usize {
        self.inputs.len()
    }
    fn directions(&self) -> usize {
        self.directions
    }
    // References are hidden from the optimiser, not values, so that no copy is timed. Calls stay separate, so that no loop over one
    // lane is vectorised into a loop over four.
    #[inline(always)]
    fn call(&mut self, index: usize) {
        black_box(&(self.call)(black_box(&self.inputs[index])));
    }
    fn answers(&mut self) -> Vec<Answer> {
        let mut out = Vec::new();
        for input in &self.inputs {
            (self.call)(input).answers(&mut out);
        }
        out
    }
}

/// Makes a pass that calls `call` with a copy of each of `inputs`.
pub fn task<'a, I, O, F>(inputs: &[I], call: F) -> Box<dyn Pass + 'a>
where
    I: Clone + 'a,
    O: Output + 'a,
    F: Fn(&I) -> O + 'a,
{
    Box::new(Each::new(1, inputs.to_vec(), call))
}

/// Pass over a function of one argument that yields several results, each passed on as soon as it is computed.
#[derive(Debug)]
pub struct Several<I, O, F> {
    inputs: Vec<I>,
    call: F,
    place: fn(usize) -> usize,
    output: PhantomData<fn() -> O>,
}

impl<I, O: Output, F: Fn(&I, &mut dyn FnMut(&O))> Several<I, O, F> {
    /// Makes a pass that calls `call` once for each of `inputs`. The `i`th answer that the calls yield belongs to direction `place(i)`.
    pub const fn new(inputs: Vec<I>, place: fn(usize) -> usize, call: F) -> Self {
        Self {
            inputs,
            call,
            place,
            output: PhantomData,
        }
    }
}

impl<I, O: Output, F: Fn(&I, &mut dyn FnMut(&O))> Pass for Several<I, O, F> {
    #[inline(never)]
    fn pass(&mut self) {
        for input in &self.inputs {
            (self.call)(black_box(input), &mut |result| {
                black_box(result);
            });
        }
    }
    fn answers(&mut self) -> Vec<Answer> {
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

/// Task that calls a function from `I` slices to `N` slices with parts of columns. The outputs are the density; the value; or the
/// value, the density and more.
#[derive(Debug)]
pub struct Slices<F, const N: usize, const I: usize = 3> {
    inputs: [Column; I],
    outputs: [Column; N],
    calls: usize,
    len: usize,
    call: F,
    read: fn([f32; N]) -> Answer,
}

/// Makes columns, the first with number `first`, from rows.
#[inline(never)]
fn columns<const N: usize>(first: usize, rows: &[[f32; N]]) -> [Column; N] {
    from_fn(|k| Column::new(first + k, rows.iter().map(|row| row[k])))
}

/// Returns the answer that a row of `N` columns holds.
fn read<const N: usize>(row: [f32; N]) -> Answer {
    Answer {
        wi: (N > 4).then(|| Vec3::new(row[4], row[5], row[6])),
        value: (N >= 3).then(|| [row[0], row[1], row[2]]),
        pdf: match N {
            1 => Some(row[0]),
            3 => None,
            _ => Some(row[3]),
        },
    }
}

impl<F, const N: usize, const I: usize> Slices<F, N, I>
where
    F: Fn([&[f32]; I], [&mut [f32]; N]) -> Result<(), LengthError>,
{
    /// Makes a task that calls `call` on consecutive groups of `len` rows; a remainder of fewer rows is dropped.
    pub fn new(len: usize, rows: &[[f32; I]], call: F) -> Self {
        Self {
            inputs: columns(0, rows),
            outputs: columns(I, &[]),
            calls: rows.len() / len,
            len,
            call,
            read,
        }
    }

    /// Replaces the function that makes an answer of a row of the outputs.
    #[must_use]
    pub fn read_by(self, read: fn([f32; N]) -> Answer) -> Self {
        Self { read, ..self }
    }
}

impl<F, const N: usize, const I: usize> Task for Slices<F, N, I>
where
    F: Fn([&[f32]; I], [&mut [f32]; N]) -> Result<(), LengthError>,
{
    fn calls(&self) -> usize {
        self.calls
    }
    fn directions(&self) -> usize {
        self.len
    }
    #[inline(always)]
    fn call(&mut self, index: usize) {
        let (at, len) = (index * self.len, self.len);
        // Loops instead of `map`, which is not inlined here and would take a quarter of the time of short slices.
        let (mut inputs, mut outputs): ([&[f32]; I], [&mut [f32]; N]) =
            ([&[]; I], from_fn(|_| Default::default()));
        for (part, column) in inputs.iter_mut().zip(black_box(&self.inputs)) {
            *part = column.part(at, len);
        }
        for (part, column) in outputs.iter_mut().zip(&mut self.outputs) {
            *part = column.part_mut(at, len);
        }
        // All slices have the same length; if they had not, the check of the answers would fail.
        let done = (self.call)(inputs, outputs);
        black_box((&self.outputs, done.is_ok()));
    }
    fn answers(&mut self) -> Vec<Answer> {
        let calls = self.calls();
        (0..calls).for_each(|index| self.call(index));
        let row = |i: usize| from_fn(|k| self.outputs[k].part(i, 1)[0]);
        (0..calls * self.len).map(|i| (self.read)(row(i))).collect()
    }
}

/// Number in single precision, with the functions of the libm crate or of the platform.
pub trait Single: Real {
    /// Returns the plain `f32`.
    fn number(self) -> f32;
}

impl Single for f32 {
    fn number(self) -> f32 {
        self
    }
}

impl Single for Platform {
    fn number(self) -> f32 {
        self.0
    }
}

impl<T: Single> Output for ([T; 3], T) {
    fn answers(&self, out: &mut Vec<Answer>) {
        out.push(Answer {
            wi: None,
            value: Some(self.0.map(T::number)),
            pdf: Some(self.1.number()),
        });
    }
}

/// Answers of an elementary function on eight lanes, which has no density.
impl Output for [f32x8; 2] {
    fn answers(&self, out: &mut Vec<Answer>) {
        let [first, second] = self.map(f32x8::to_array);
        out.extend((0..8).map(|i| Answer {
            wi: None,
            value: Some([first[i], second[i], 0.0]),
            pdf: None,
        }));
    }
}

impl Output for Eval {
    fn answers(&self, out: &mut Vec<Answer>) {
        out.push(Answer {
            wi: None,
            value: Some(self.value),
            pdf: Some(self.pdf),
        });
    }
}

impl Output for Eval8 {
    #[inline(never)]
    fn answers(&self, out: &mut Vec<Answer>) {
        for lane in 0..8 {
            self.lane(lane).answers(out);
        }
    }
}

impl<T: Single> Output for ReferenceSample<T> {
    fn answers(&self, out: &mut Vec<Answer>) {
        let (wi, value) = (self.wi.map(T::number), self.value.map(T::number));
        out.push(Answer {
            wi: Some(wi.into()),
            value: Some(value),
            pdf: Some(self.pdf.number()),
        });
    }
}

impl Output for Option<Sample> {
    #[inline(never)]
    fn answers(&self, out: &mut Vec<Answer>) {
        out.push(match self {
            Some(sample) => Answer {
                wi: Some(sample.wi),
                value: Some(sample.value),
                pdf: Some(sample.pdf),
            },
            None => Answer {
                wi: Some(Vec3::ZERO),
                value: Some([0.0; 3]),
                pdf: Some(0.0),
            },
        });
    }
}

impl Output for Sample8 {
    #[inline(never)]
    fn answers(&self, out: &mut Vec<Answer>) {
        for lane in 0..8 {
            self.lane(lane).answers(out);
        }
    }
}

/// Shading point of the formulas in numbers of type `T`, whose answer is its evaluation in the direction [`PROBE`].
#[derive(Debug)]
pub struct Point<R, T = f32>(pub R, pub PhantomData<T>);

impl<R: Reference<T>, T: Single> Output for Point<R, T> {
    fn answers(&self, out: &mut Vec<Answer>) {
        self.0
            .eval_pdf(PROBE.to_array().map(T::from_f32))
            .answers(out);
    }
}

impl<M: Model> Output for Bsdf<M> {
    #[inline(never)]
    fn answers(&self, out: &mut Vec<Answer>) {
        self.eval_pdf(PROBE).answers(out);
    }
}

impl<M: Model> Output for Bsdf8<M> {
    #[inline(never)]
    fn answers(&self, out: &mut Vec<Answer>) {
        self.eval_pdf8(&Vec3x8::splat(PROBE)).answers(out);
    }
}
