//! Floating-point exceptions raised by calls, in a program that is compiled as a host's program is.
//!
//! The compiler may vectorise scalar code, and the values it computes in unused lanes may raise an exception. Whether they do depends
//! on the compiler options, and those of the tests are different.

use core::hint::black_box;
use hairis::model::{LobeEval, Model};
use hairis::simd::{Vec3x, control, set_control};
use hairis::{Bsdf, Conserving, Hit, Material, PerLobe};
use hairis_benches::entries::is_compiled;
use hairis_benches::inputs::{Inputs, params};
use hairis_benches::{Name, Task};
use hairis_variants::{Kind, ModelId, Parameters, Registered, Visitor};

/// Flags of the exceptions that are counted: invalid operation, division by zero and overflow.
const FLAGS: u32 = 1 | 4 | 8;

/// Returns true if `f` raises one of the exceptions in [`FLAGS`].
fn raises<T>(f: impl FnOnce() -> T) -> bool {
    let before = control();
    set_control(before & !0x3f);
    black_box(f());
    let after = control();
    set_control(before);
    after & FLAGS != 0
}

/// Prints how many calls of an entry point raise an exception, and returns the count.
pub(crate) fn raised_by<T: Task>(name: &Name, task: &mut T) -> u32 {
    let raising = (0..task.calls())
        .map(|index| u32::from(raises(|| task.call(index))))
        .sum();
    if raising > 0 {
        println!(
            "FAIL {name}: {raising} of {} calls raise an exception",
            task.calls()
        );
    }
    raising
}

macro_rules! calls {
    ($($name:ident($($arg:ident: $type:ty),*) -> $out:ty = $body:expr;)*) => { $(
        #[inline(never)]
        fn $name<M: Model>($($arg: $type),*) -> $out {
            $body
        }
    )* };
}

calls! {
    material(model: &M, params: &M::Params) -> Material<M> = Material::new(model, params);
    max_albedo(material: &Material<M>) -> f32 = material.max_albedo();
    conserving_scale(material: &Material<M>) -> f32 = material.conserving_scale();
    prepare(material: &Material<M>, hit: Hit) -> Bsdf<M> = material.prepare(hit);
    pdf(bsdf: &Bsdf<M>, wi: Vec3x<f32>) -> f32 = bsdf.pdf(wi);
    lobes(bsdf: &Bsdf<M>, wi: Vec3x<f32>) -> PerLobe<LobeEval> = bsdf.lobes(wi);
    albedo(bsdf: &Bsdf<M>) -> PerLobe<[f32; 3]> = bsdf.albedo();
    conserving(bsdf: &Bsdf<M>) -> Bsdf<M> = bsdf.conserving();
}

/// Prints for each model, raw and conserving, how many calls on one lane that are no entry points raise an exception. Returns the count.
pub(crate) fn on_one_lane() -> u32 {
    assert!(
        raises(|| black_box(0.0_f32) / black_box(0.0)),
        "the control raises an exception"
    );
    let inputs = Inputs::draw();
    ModelId::ALL
        .iter()
        .map(|id| id.visit(OfModel(&inputs)))
        .sum()
}

const NAMES: [&str; 8] = [
    "material",
    "max_albedo",
    "conserving_scale",
    "prepare",
    "pdf",
    "lobes",
    "albedo",
    "conserving",
];

struct OfModel<'a>(&'a Inputs);

impl Visitor for OfModel<'_> {
    type Output = u32;

    fn visit<M: Registered>(self) -> u32 {
        if const { !is_compiled(ModelId::of::<M>()) } {
            return 0;
        }
        [params::<M>(), dark::<M>()]
            .iter()
            .map(|all| self.count(&M::MODEL, all) + self.count(&Conserving(M::MODEL), all))
            .sum()
    }
}

/// Returns materials with a colour that is black, and with it lobes without energy: each colour in turn, and then all of them.
fn dark<M: Registered>() -> [M::Params; 8] {
    let mut materials = params::<M>();
    let colors = || {
        M::Params::FIELDS
            .iter()
            .filter(|field| field.kind == Kind::Rgb)
    };
    let count = colors().count();
    for (i, material) in materials.iter_mut().enumerate() {
        let chosen = colors()
            .enumerate()
            .filter(|(k, _)| i % (count + 1) == *k || i % (count + 1) == count);
        let values = chosen.fold(material.values(), |values, (_, field)| {
            values.with(field.name, &[0.0; 3])
        });
        *material = M::Params::from_values(&values).expect("black is in range");
    }
    materials
}

impl OfModel<'_> {
    fn count<M: Model>(&self, model: &M, all: &[M::Params; 8]) -> u32 {
        let mut counts = [0; NAMES.len()];
        let mut count = |name: &str, raised: bool| {
            let place = NAMES.iter().position(|other| *other == name);
            counts[place.expect("the name is in the list")] += u32::from(raised);
        };
        for (i, (wo, wi)) in self.0.wo.iter().zip(&self.0.wi).enumerate() {
            let hit = Hit::new(Vec3x::from(*wo), 2.0 * self.0.xi[i ^ 1][0] - 1.0);
            let (params, wi) = (&all[i % 8], Vec3x::from(*wi));
            let hair = material(model, params);
            let bsdf = prepare(&hair, hit);
            if i < 8 {
                count("material", raises(|| material(model, params)));
                count("max_albedo", raises(|| max_albedo(&hair)));
                count("conserving_scale", raises(|| conserving_scale(&hair)));
            }
            count("prepare", raises(|| prepare(&hair, hit)));
            count("pdf", raises(|| pdf(&bsdf, wi)));
            count("lobes", raises(|| lobes(&bsdf, wi)));
            count("albedo", raises(|| albedo(&bsdf)));
            count("conserving", raises(|| conserving(&bsdf)));
        }
        for (name, count) in NAMES
            .into_iter()
            .zip(counts)
            .filter(|(_, count)| *count > 0)
        {
            println!(
                "FAIL {} {name}: {count} calls raise an exception",
                core::any::type_name::<M>()
            );
        }
        counts.iter().sum()
    }
}
