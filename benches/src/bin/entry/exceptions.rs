//! Floating-point exceptions raised by calls on one lane, in a program that is compiled as a host's program is.
//!
//! The compiler may vectorise scalar code, and the values it computes in unused lanes may raise an exception. Whether they do depends
//! on the compiler options, and those of the tests are different.

use core::hint::black_box;
use hairis::model::{LobeEval, Model};
use hairis::simd::{Vec3x, control, set_control};
use hairis::{Bsdf, Eval, Hit, Material, PerLobe, Sample};
use hairis_benches::entries::is_compiled;
use hairis_benches::inputs::{Inputs, materials};
use hairis_variants::{ModelId, Registered, Visitor};

/// Flags of the exceptions that are counted: invalid operation, division by zero and overflow.
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
    prepare(material: &Material<M>, hit: Hit) -> Bsdf<M> = material.prepare(hit);
    eval_pdf(bsdf: &Bsdf<M>, wi: Vec3x<f32>) -> Eval = bsdf.eval_pdf(wi);
    pdf(bsdf: &Bsdf<M>, wi: Vec3x<f32>) -> f32 = bsdf.pdf(wi);
    lobes(bsdf: &Bsdf<M>, wi: Vec3x<f32>) -> PerLobe<LobeEval> = bsdf.lobes(wi);
    sample(bsdf: &Bsdf<M>, xi: [f32; 3]) -> Option<Sample> = bsdf.sample(xi);
    albedo(bsdf: &Bsdf<M>) -> PerLobe<[f32; 3]> = bsdf.albedo();
    conserving(bsdf: &Bsdf<M>) -> Bsdf<M> = bsdf.conserving();
}

/// Prints for each model how many calls raise an exception. Returns true if no call does.
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
        if const { !is_compiled(ModelId::of::<M>()) } {
            return true;
        }
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
            let (material, wi) = (&materials[i % 8], Vec3x::from(*wi));
            let bsdf = prepare(material, hit);
            let raised = [
                raises(|| prepare(material, hit)),
                raises(|| eval_pdf(&bsdf, wi)),
                raises(|| pdf(&bsdf, wi)),
                raises(|| lobes(&bsdf, wi)),
                raises(|| sample(&bsdf, *xi)),
                i % 8 == 0 && raises(|| albedo(&bsdf)),
                i % 8 == 0 && raises(|| conserving(&bsdf)),
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

/// Returns true if `f` raises one of the exceptions in [`FLAGS`].
fn raises<T>(f: impl FnOnce() -> T) -> bool {
    let before = control();
    set_control(before & !0x3f);
    black_box(f());
    let after = control();
    set_control(before);
    after & FLAGS != 0
}
