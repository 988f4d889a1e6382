//! The entry points that are inlined into their callers, each in a function of its own, so that it has a size: scalar
//! code and the portable level. Those of other levels are functions by themselves.

use core::hint::black_box;
use glam::Vec3;
use hairis::wide::f32x8;
use hairis::{
    Bsdf, Bsdf8, Eval, Eval8, EvalSlices, Gather, Gather8, Gaussian, Hair, LengthError, Level,
    Matched, Model, Sample, Sample8, SampleSlices, Vec3x8,
};
use hairis_variants::Cauchy;

/// Declares one function per entry point, and `of`, which lists them.
macro_rules! outlined {
    ($($name:ident($($arg:ident: $type:ty),*) -> $out:ty { $body:expr })*) => {
        $(
            #[inline(never)]
            fn $name<M: Model>($($arg: $type),*) -> $out {
                $body
            }
        )*
        fn of<M: Model>() {
            $( black_box($name::<M> as fn($($type),*) -> $out); )*
        }
    };
}

outlined! {
    scalar_prepare(bsdf: &Bsdf<M>, wo: Vec3) -> Gather<M> { bsdf.prepare(wo) }
    scalar_eval_pdf(gather: &Gather<M>, wi: Vec3) -> Eval { gather.eval_pdf(wi) }
    scalar_sample(gather: &Gather<M>, xi: [f32; 3]) -> Option<Sample> { gather.sample(xi) }
    portable_prepare8_shared(bsdf: &Bsdf<M>, wo: &Vec3x8) -> Gather8<M> { bsdf.prepare8_at(Level::portable(), wo) }
    portable_prepare8_mixed(bsdf: &Bsdf8<M>, wo: &Vec3x8) -> Gather8<M> { bsdf.prepare8_at(Level::portable(), wo) }
    portable_eval_pdf8(gather: &Gather<M>, wi: &Vec3x8) -> Eval8 { gather.eval_pdf8_at(Level::portable(), wi) }
    portable_eval_pdf8_points(gather: &Gather8<M>, wi: &Vec3x8) -> Eval8 { gather.eval_pdf8_at(Level::portable(), wi) }
    portable_sample8(gather: &Gather<M>, xi: &[f32x8; 3]) -> Sample8 { gather.sample8_at(Level::portable(), xi) }
    portable_sample8_points(gather: &Gather8<M>, xi: &[f32x8; 3]) -> Sample8 { gather.sample8_at(Level::portable(), xi) }
    portable_eval_pdf_batch(gather: &Gather<M>, wi: [&[f32]; 3], out: EvalSlices<'_>) -> Result<(), LengthError> {
        gather.eval_pdf_batch_at(Level::portable(), wi, out)
    }
    portable_sample_batch(gather: &Gather<M>, xi: [&[f32]; 3], out: SampleSlices<'_>) -> Result<(), LengthError> {
        gather.sample_batch_at(Level::portable(), xi, out)
    }
}

/// Takes the address of every function, so that none is left out of the program.
pub(crate) fn keep() {
    of::<Hair<Gaussian>>();
    of::<Hair<Cauchy>>();
    of::<Matched<Gaussian>>();
    of::<Matched<Cauchy>>();
}
