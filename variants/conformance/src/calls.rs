//! The handles' calls, each compiled once per model: inlined into every property, a model would be compiled fifty times.

use hairis::wide::f32x8;
use hairis::{
    Bsdf, Bsdf8, Eval, Eval8, EvalSlices, Gather, Gather8, Hit, Hit8, Level, LobeEval, LobeEval8, LobeMask, Model,
    PerLobe, Sample, Sample8, SampleSlices, SampleWeightSlices, Vec3x, Vec3x8,
};

/// A direction, or any vector, in the fibre's frame.
pub(crate) type Direction = Vec3x<f32>;

macro_rules! calls {
    ($($name:ident($($arg:ident: $type:ty),*) -> $out:ty = $body:expr;)*) => { $(
        #[inline(never)]
        pub(crate) fn $name<M: Model>($($arg: $type),*) -> $out {
            $body
        }
    )* };
}

calls! {
    prepare(bsdf: &Bsdf<M>, hit: Hit) -> Gather<M> = bsdf.prepare(hit);
    prepare8(bsdf: &Bsdf<M>, level: Level, hits: Hit8) -> Gather8<M> = bsdf.prepare8_at(level, hits);
    prepare_packed(bsdf: &Bsdf8<M>, level: Level, hits: Hit8) -> Gather8<M> = bsdf.prepare8_at(level, hits);
    eval(gather: &Gather<M>, wi: Direction) -> Eval = gather.eval_pdf(wi);
    eval8(gather: &Gather<M>, level: Level, wi: &Vec3x8) -> Eval8 = gather.eval_pdf8_at(level, wi);
    eval_each(gather: &Gather8<M>, level: Level, wi: &Vec3x8) -> Eval8 = gather.eval_pdf8_at(level, wi);
    lobes(gather: &Gather<M>, wi: Direction) -> PerLobe<LobeEval> = gather.lobes(wi);
    lobes8(gather: &Gather<M>, wi: &Vec3x8) -> PerLobe<LobeEval8> = gather.lobes8(wi);
    lobes_each(gather: &Gather8<M>, wi: &Vec3x8) -> PerLobe<LobeEval8> = gather.lobes8(wi);
    sample(gather: &Gather<M>, xi: [f32; 3]) -> Option<Sample> = gather.sample(xi);
    sample8(gather: &Gather<M>, level: Level, xi: &[f32x8; 3]) -> Sample8 = gather.sample8_at(level, xi);
    sample_each(gather: &Gather8<M>, level: Level, xi: &[f32x8; 3]) -> Sample8 = gather.sample8_at(level, xi);
    with_lobes(gather: &Gather<M>, lobes: LobeMask) -> Gather<M> = gather.with_lobes(lobes);
    with_lobes_each(gather: &Gather8<M>, lobes: LobeMask) -> Gather8<M> = gather.with_lobes(lobes);
    conserving(gather: &Gather<M>) -> Gather<M> = gather.conserving();
    albedo(gather: &Gather<M>) -> PerLobe<[f32; 3]> = gather.albedo();
    conserving_each(gather: &Gather8<M>, level: Level) -> Gather8<M> = gather.conserving_at(level);
    albedo_each(gather: &Gather8<M>, level: Level) -> PerLobe<[f32x8; 3]> = gather.albedo8_at(level);
}

/// Value and density of many directions.
pub(crate) fn eval_slices<M: Model>(
    gather: &Gather<M>,
    level: Level,
    wi: [&[f32]; 3],
    out: [&mut [f32]; 4],
) -> Result<(), hairis::LengthError> {
    let [r, g, b, pdf] = out;
    gather.eval_pdf_batch_at(level, wi, EvalSlices { value: [r, g, b], pdf })
}

/// Direction, density and weight of many samples.
pub(crate) fn weight_slices<M: Model>(
    gather: &Gather<M>,
    level: Level,
    xi: [&[f32]; 3],
    out: [&mut [f32]; WEIGHT_COLUMNS.len()],
) -> Result<(), hairis::LengthError> {
    let [u, v, w, pdf, wr, wg, wb] = out;
    gather.sample_weight_batch_at(level, xi, SampleWeightSlices { wi: [u, v, w], pdf, weight: [wr, wg, wb] })
}

/// Places of the columns of [`weight_slices`] among those of [`sample_slices`].
pub(crate) const WEIGHT_COLUMNS: [usize; 7] = [0, 1, 2, 6, 7, 8, 9];

/// Columns of a sample in slices: direction, value, density, weight, slot.
pub(crate) const COLUMNS: usize = 11;

/// Many samples.
pub(crate) fn sample_slices<M: Model>(
    gather: &Gather<M>,
    level: Level,
    xi: [&[f32]; 3],
    out: [&mut [f32]; COLUMNS],
) -> Result<(), hairis::LengthError> {
    let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] = out;
    let slices = SampleSlices { wi: [u, v, w], value: [r, g, b], pdf, weight: [wr, wg, wb], slot };
    gather.sample_batch_at(level, xi, slices)
}
