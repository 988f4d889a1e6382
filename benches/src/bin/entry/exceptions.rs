//! Floating-point exceptions of calls on one lane, in a program compiled as a host's is.
//!
//! The compiler may make vectors of scalar code and compute in their unused lanes what raises an exception: whether it does
//! depends on its options, and the tests are compiled with others.

use core::hint::black_box;
use hairis::{
    Bsdf, Eval, Gather, Hit, LobeEval, Model, PerLobe, Sample, Vec3x, control, set_control,
};
use hairis_benches::inputs::{Inputs, materials};
use hairis_variants::{ModelId, Registered, Visitor};

/// Invalid, division by zero, overflow.
const FLAGS: u32 = 1 | 4 | 8;

macro_rules! calls {
    ($($name:ident($($arg:ident: $type:ty),*) -> $out:ty = $body:expr;)*) => { $(
        #[inline(never)]
        fn $name<M: Model>($($arg: $type),*) -> $out {
            $body
        }
    )* };
}

calls! {
    prepare(bsdf: &Bsdf<M>, hit: Hit) -> Gather<M> = bsdf.prepare(hit);
    eval_pdf(gather: &Gather<M>, wi: Vec3x<f32>) -> Eval = gather.eval_pdf(wi);
    pdf(gather: &Gather<M>, wi: Vec3x<f32>) -> f32 = gather.pdf(wi);
    lobes(gather: &Gather<M>, wi: Vec3x<f32>) -> PerLobe<LobeEval> = gather.lobes(wi);
    sample(gather: &Gather<M>, xi: [f32; 3]) -> Option<Sample> = gather.sample(xi);
    albedo(gather: &Gather<M>) -> PerLobe<[f32; 3]> = gather.albedo();
    conserving(gather: &Gather<M>) -> Gather<M> = gather.conserving();
}

/// Prints how many calls of each model raise an exception. Whether there are none.
pub(crate) fn check() -> bool {
    let inputs = Inputs::draw();
    ModelId::ALL
        .iter()
        .map(|id| {
            id.visit(OfModel {
                inputs: &inputs,
                id: *id,
            })
        })
        .fold(true, |all, quiet| all & quiet)
}

struct OfModel<'a> {
    inputs: &'a Inputs,
    id: ModelId,
}

impl Visitor for OfModel<'_> {
    type Output = bool;

    fn visit<M: Registered>(self) -> bool {
        let names = [
            "prepare",
            "eval_pdf",
            "pdf",
            "lobes",
            "sample",
            "albedo",
            "conserving",
        ];
        let mut counts = [0; 7];
        let materials = materials::<M>();
        for (i, ((wo, wi), xi)) in self
            .inputs
            .wo
            .iter()
            .zip(&self.inputs.wi)
            .zip(&self.inputs.xi)
            .enumerate()
        {
            let hit = Hit::new(Vec3x::from(*wo), 2.0 * self.inputs.xi[i ^ 1][0] - 1.0);
            let (bsdf, wi) = (&materials[i % 8], Vec3x::from(*wi));
            let gather = prepare(bsdf, hit);
            let raised = [
                raises(|| prepare(bsdf, hit)),
                raises(|| eval_pdf(&gather, wi)),
                raises(|| pdf(&gather, wi)),
                raises(|| lobes(&gather, wi)),
                raises(|| sample(&gather, *xi)),
                i % 8 == 0 && raises(|| albedo(&gather)),
                i % 8 == 0 && raises(|| conserving(&gather)),
            ];
            for (count, raised) in counts.iter_mut().zip(raised) {
                *count += u32::from(raised);
            }
        }
        for (name, count) in names
            .into_iter()
            .zip(counts)
            .filter(|(_, count)| *count > 0)
        {
            println!(
                "FAIL {:?} {name}: {count} calls of {} raise an exception",
                self.id,
                self.inputs.wi.len()
            );
        }
        counts == [0; 7]
    }
}

/// Whether `f` raises an exception.
fn raises<T>(f: impl FnOnce() -> T) -> bool {
    let before = control();
    set_control(before & !0x3f);
    black_box(f());
    let after = control();
    set_control(before);
    after & FLAGS != 0
}
