//! Contenders that take whole slices: one call per pass.

use super::task::{ContenderAnswer, Pass};
use core::cell::RefCell;
use core::hint::black_box;
use glam::Vec3;
use hairis::{EvalSlices, Gather, LengthError, Level, Model, SampleSlices};

/// A function from three columns to `N`.
struct Slices<F, const N: usize> {
    inputs: [Vec<f32>; 3],
    out: RefCell<[Vec<f32>; N]>,
    call: F,
}

/// A pass of [`Gather::eval_pdf_batch_at`].
pub(super) fn eval_pdf<M>(gather: Gather<M>, level: Level, wi: &[Vec3]) -> Box<dyn Pass>
where
    M: Model + 'static,
{
    let inputs = columns(wi, |wi| wi.to_array());
    pass(inputs, move |wi, [r, g, b, pdf]: [&mut [f32]; 4]| {
        gather.eval_pdf_batch_at(level, wi, EvalSlices { value: [r, g, b], pdf })
    })
}

/// A pass of [`Gather::sample_batch_at`].
pub(super) fn sample<M>(gather: Gather<M>, level: Level, xi: &[[f32; 3]]) -> Box<dyn Pass>
where
    M: Model + 'static,
{
    let inputs = columns(xi, |xi| *xi);
    pass(inputs, move |xi, [r, g, b, pdf, u, v, w, weight_r, weight_g, weight_b, slot]: [&mut [f32]; 11]| {
        let weight = [weight_r, weight_g, weight_b];
        gather.sample_batch_at(level, xi, SampleSlices { wi: [u, v, w], value: [r, g, b], pdf, weight, slot })
    })
}

fn columns<T>(rows: &[T], row: impl Fn(&T) -> [f32; 3]) -> [Vec<f32>; 3] {
    core::array::from_fn(|k| rows.iter().map(|r| row(r)[k]).collect())
}

fn pass<F, const N: usize>(inputs: [Vec<f32>; 3], call: F) -> Box<dyn Pass>
where
    F: Fn([&[f32]; 3], [&mut [f32]; N]) -> Result<(), LengthError> + 'static,
{
    let out = RefCell::new(core::array::from_fn(|_| vec![0.0; inputs[0].len()]));
    Box::new(Slices { inputs, out, call })
}

impl<F, const N: usize> Pass for Slices<F, N>
where
    F: Fn([&[f32]; 3], [&mut [f32]; N]) -> Result<(), LengthError>,
{
    #[inline(never)]
    fn pass(&self) {
        let mut out = self.out.borrow_mut();
        let inputs = black_box(&self.inputs).each_ref().map(Vec::as_slice);
        // All slices are of one length; if they were not, the answers would still be 0, and found wrong.
        let done = (self.call)(inputs, out.each_mut().map(Vec::as_mut_slice));
        black_box((&*out, done.is_ok()));
    }

    fn answers(&self) -> Vec<ContenderAnswer> {
        self.pass();
        let out = self.out.borrow();
        let at = |k: usize, i: usize| out[k][i];
        (0..out[0].len())
            .map(|i| ContenderAnswer {
                wi: (N > 4).then(|| Vec3::new(at(4, i), at(5, i), at(6, i))),
                value: [at(0, i), at(1, i), at(2, i)],
                pdf: at(3, i),
            })
            .collect()
    }
}
