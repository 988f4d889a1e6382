//! Entry points that are inlined into their callers: scalar code and the portable level. Each gets a function of its own here, so that
//! its size can be measured. The entry points of the other levels are functions already.

use core::hint::black_box;
use glam::Vec3;
use hairis::columns::{EvalColumns, LengthError, SampleColumns};
use hairis::model::Model;
use hairis::simd::{Level, f32x8};
use hairis::{
    Bsdf, Bsdf8, Eval, Eval8, Gaussian, Matched, Material, Material8, Published, Sample, Sample8,
    Vec3x8,
};
use hairis_benches::entries::is_compiled;
use hairis_variants::{Cauchy, ModelId, Registered};

/// Declares one function per entry point, and the function `of`, which takes their addresses.
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
    scalar_prepare(material: &Material<M>, wo: Vec3) -> Bsdf<M> { material.prepare(wo) }
    scalar_eval_pdf(bsdf: &Bsdf<M>, wi: Vec3) -> Eval { bsdf.eval_pdf(wi) }
    scalar_sample(bsdf: &Bsdf<M>, xi: [f32; 3]) -> Option<Sample> { bsdf.sample(xi) }
    portable_prepare8_shared(material: &Material<M>, wo: &Vec3x8) -> Bsdf8<M> { material.with_level(Level::portable()).prepare8(wo) }
    portable_prepare8_mixed(material: &Material8<M>, wo: &Vec3x8) -> Bsdf8<M> { material.with_level(Level::portable()).prepare8(wo) }
    portable_eval_pdf8(bsdf: &Bsdf<M>, wi: &Vec3x8) -> Eval8 { bsdf.with_level(Level::portable()).eval_pdf8(wi) }
    portable_eval_pdf8_points(bsdf: &Bsdf8<M>, wi: &Vec3x8) -> Eval8 { bsdf.with_level(Level::portable()).eval_pdf8(wi) }
    portable_sample8(bsdf: &Bsdf<M>, xi: &[f32x8; 3]) -> Sample8 { bsdf.with_level(Level::portable()).sample8(xi) }
    portable_sample8_points(bsdf: &Bsdf8<M>, xi: &[f32x8; 3]) -> Sample8 { bsdf.with_level(Level::portable()).sample8(xi) }
    portable_eval_columns(bsdf: &Bsdf<M>, wi: [&[f32]; 3], out: EvalColumns<'_>) -> Result<(), LengthError> {
        bsdf.with_level(Level::portable()).eval_columns(wi, out)
    }
    portable_sample_columns(bsdf: &Bsdf<M>, xi: [&[f32]; 3], out: SampleColumns<'_>) -> Result<(), LengthError> {
        bsdf.with_level(Level::portable()).sample_columns(xi, out)
    }
}

/// Takes the addresses of the functions of a model, if its entry points are compiled.
fn of_compiled<M: Registered>() {
    if const { is_compiled(ModelId::of::<M>()) } {
        of::<M>();
    }
}

/// Takes the address of every function, so that none is left out of the program.
pub(crate) fn keep() {
    of_compiled::<Published<Gaussian>>();
    of_compiled::<Published<Cauchy>>();
    of_compiled::<Matched<Gaussian>>();
    of_compiled::<Matched<Cauchy>>();
}
