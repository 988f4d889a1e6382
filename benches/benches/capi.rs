//! Time of calls through the C library over that of the same calls in Rust, raw and conserving.
//!
//! `HAIRIS_LIBRARY=PREFIX/lib/libhairis.so cargo bench -p hairis-benches --bench capi` prints a record of the library that
//! `variants/capi/install.sh PREFIX` installs. Every pair has given the same bits before it is timed.
#![allow(unsafe_code, reason = "calls of C")]

mod library;

use core::array::from_fn;
use core::hint::black_box;
use core::ptr::null;
use glam::Vec3;
use hairis::columns::{EvalColumns, HitColumns, MaterialTable, SampleColumns};
use hairis::model::Model;
use hairis::simd::Level;
use hairis::{Conserving, Eval, Gaussian, Matched, Material, Published, Sample};
use hairis_benches::inputs::{Column, DIRECTIONS, Inputs, arrays};
use hairis_benches::{cpu, turns};
use hairis_variants::{Cauchy, Chiang, KajiyaKay, Parameters, Registered};
use library::Library;
use library::layout::{
    ENERGY_CONSERVING, ENERGY_RAW, EvalResult, Evals, Hits, OK, RawBsdf, RawMaterial, SampleResult,
    Samples,
};
use std::env;

fn main() {
    let Ok(path) = env::var("HAIRIS_LIBRARY") else {
        println!(
            "HAIRIS_LIBRARY must be the path of libhairis.so, got nothing; variants/capi/install.sh PREFIX installs it"
        );
        return;
    };
    println!("# CPU: {}", cpu::name());
    println!("# calls run on {}", Level::detect());
    println!("model,call,energy,ns,base_ns,ratio");
    let (library, inputs) = (Library::open(&path), Inputs::draw());
    let run = Run {
        library: &library,
        turns: turns::turns(),
        inputs: &inputs,
    };
    run.model::<Published<Gaussian>>();
    run.model::<Matched<Gaussian>>();
    run.model::<Matched<Cauchy>>();
    run.model::<KajiyaKay>();
    run.model::<Chiang>();
}

/// Calls of a model in turns.
#[derive(Clone, Copy)]
struct Run<'a> {
    library: &'a Library,
    turns: usize,
    inputs: &'a Inputs,
}

impl Run<'_> {
    fn model<M: Registered>(self) {
        self.energy::<M, M>(M::MODEL, ENERGY_RAW, "raw");
        self.energy::<M, _>(Conserving(M::MODEL), ENERGY_CONSERVING, "conserving");
    }

    /// Calls of `M` with an energy, which `model` has in Rust.
    fn energy<M: Registered, R: Model<Params = M::Params>>(
        self,
        model: R,
        energy: u32,
        word: &str,
    ) {
        let presets = M::Params::PRESETS;
        let (preset, params) = &presets[0];
        let pair = Pair {
            run: self,
            label: [M::NAME, M::CHOICE.map_or("", |(_, word)| word), word],
            rust: &Material::new(&model, params),
            c: &self.library.material::<M>(preset, energy),
        };
        pair.one();
        pair.columns();
        let rust: Vec<_> = presets
            .iter()
            .map(|(_, params)| Material::new(&model, params))
            .collect();
        let c: Vec<_> = presets
            .iter()
            .map(|(preset, _)| self.library.material::<M>(preset, energy))
            .collect();
        pair.table(&rust, &c);
    }
}

/// A material in Rust and in C.
#[derive(Clone, Copy)]
struct Pair<'a, R: Model> {
    run: Run<'a>,
    label: [&'a str; 3],
    rust: &'a Material<R>,
    c: &'a RawMaterial,
}

fn eval_bits(e: Eval) -> [u32; 4] {
    let [r, g, b] = e.value;
    [r, g, b, e.pdf].map(f32::to_bits)
}

fn sample_bits(sample: Option<Sample>) -> ([u32; 10], i32) {
    sample.map_or(([0; 10], -1), |s| {
        let ([r, g, b], [x, y, z]) = (s.value, s.weight);
        let bits = [s.wi.x, s.wi.y, s.wi.z, s.pdf, r, g, b, x, y, z].map(f32::to_bits);
        (bits, i32::try_from(s.lobe.index()).expect("a slot"))
    })
}

fn c_eval_bits(e: EvalResult) -> [u32; 4] {
    let [r, g, b] = e.value;
    [r, g, b, e.pdf].map(f32::to_bits)
}

fn c_sample_bits(s: SampleResult) -> ([u32; 10], i32) {
    let ([u, v, w], [r, g, b], [x, y, z]) = (s.wi, s.value, s.weight);
    let bits = [u, v, w, s.pdf, r, g, b, x, y, z].map(f32::to_bits);
    (bits, s.lobe)
}

impl<R: Model> Pair<'_, R> {
    fn row(self, call: &str, ours: impl FnMut(), base: impl FnMut()) {
        let [ours, base, ratio] = turns::pair(self.run.turns, DIRECTIONS, ours, base);
        let [model, choice, energy] = self.label;
        println!("{model} {choice},{call},{energy},{ours:.2},{base:.2},{ratio:.3}");
    }

    /// Times a call per direction, after both have given the same bits.
    fn scalar<A, B, T: PartialEq>(
        self,
        call: &str,
        (ours, ours_bits): (impl Fn(usize) -> A, fn(A) -> T),
        (base, base_bits): (impl Fn(usize) -> B, fn(B) -> T),
    ) {
        for i in 0..DIRECTIONS {
            assert!(
                ours_bits(ours(i)) == base_bits(base(i)),
                "{:?} {call}: direction {i}",
                self.label
            );
        }
        // The results of either are kept whole.
        self.row(
            call,
            || (0..DIRECTIONS).for_each(|i| _ = black_box(&ours(i))),
            || (0..DIRECTIONS).for_each(|i| _ = black_box(&base(i))),
        );
    }

    /// One direction: at a BSDF, whose constants no call keeps from the one before, and at a hit of its own.
    fn one(self) {
        let Self {
            rust,
            c,
            run: Run {
                library, inputs, ..
            },
            ..
        } = self;
        let Inputs { wi, wo, xi } = inputs;
        let (bsdf, raw) = (rust.prepare(wo[0]), library.prepare(c, wo[0]));
        // SAFETY of this and the others: the handles are those of the library.
        let eval =
            |raw: &RawBsdf, wi: Vec3| unsafe { (library.hairis_eval_pdf)(raw, wi.x, wi.y, wi.z) };
        let sample = |raw: &RawBsdf, xi: [f32; 3]| unsafe {
            (library.hairis_sample)(raw, xi[0], xi[1], xi[2])
        };
        self.scalar(
            "eval_pdf",
            (|i| eval(&raw, wi[i]), c_eval_bits),
            (|i| black_box(&bsdf).eval_pdf(wi[i]), eval_bits),
        );
        self.scalar(
            "sample",
            (|i| sample(&raw, xi[i]), c_sample_bits),
            (|i| black_box(&bsdf).sample(xi[i]), sample_bits),
        );
        let eval = |i| eval(&library.prepare(c, wo[i]), wi[i]);
        let sample = |i| sample(&library.prepare(c, wo[i]), xi[i]);
        let prepare = |i| black_box(rust).prepare(wo[i]);
        self.scalar(
            "prepare and eval_pdf",
            (eval, c_eval_bits),
            (|i| prepare(i).eval_pdf(wi[i]), eval_bits),
        );
        self.scalar(
            "prepare and sample",
            (sample, c_sample_bits),
            (|i| prepare(i).sample(xi[i]), sample_bits),
        );
        self.scalar(
            "prepare and eval_pdf over eval_hit",
            (eval, c_eval_bits),
            (|i| black_box(rust).eval_hit(wo[i], wi[i]), eval_bits),
        );
        self.scalar(
            "prepare and sample over sample_hit",
            (sample, c_sample_bits),
            (|i| black_box(rust).sample_hit(wo[i], xi[i]), sample_bits),
        );
    }

    /// Columns at a BSDF and columns of hits, with every column of results.
    fn columns(self) {
        let Self { rust, c, run, .. } = self;
        let library = run.library;
        let wo = run.inputs.wo[0];
        let (bsdf, raw) = (rust.prepare(wo), library.prepare(c, wo));
        // SAFETY of this and the others: the columns have `n` numbers, which slicing them has checked.
        self.slices(
            "eval_columns",
            DIRECTIONS,
            |s, p| unsafe { (library.hairis_eval_columns)(&raw, p.1, &s.wi.c(p), &s.c_evals(p)) },
            |s, p| {
                bsdf.eval_columns(s.wi.rust(p), evals(&mut s.out, p))
                    .is_ok()
            },
        );
        self.slices(
            "sample_columns",
            DIRECTIONS,
            |s, p| unsafe {
                (library.hairis_sample_columns)(&raw, p.1, &s.xi.c(p), &s.c_samples(p))
            },
            |s, p| {
                bsdf.sample_columns(s.xi.rust(p), samples(&mut s.out, p))
                    .is_ok()
            },
        );
        for (n, [eval, sample]) in [
            (DIRECTIONS, ["eval_hits", "sample_hits"]),
            (8, ["eval_hits of eight", "sample_hits of eight"]),
        ] {
            self.slices(
                eval,
                n,
                |s, p| unsafe {
                    (library.hairis_eval_hits)(
                        c,
                        1,
                        p.1,
                        &s.c_hits(p, &[]),
                        &s.wi.c(p),
                        &s.c_evals(p),
                    )
                },
                |s, p| {
                    rust.eval_hits(s.wo.hits(p), s.wi.rust(p), evals(&mut s.out, p))
                        .is_ok()
                },
            );
            self.slices(
                sample,
                n,
                |s, p| unsafe {
                    (library.hairis_sample_hits)(
                        c,
                        1,
                        p.1,
                        &s.c_hits(p, &[]),
                        &s.xi.c(p),
                        &s.c_samples(p),
                    )
                },
                |s, p| {
                    rust.sample_hits(s.wo.hits(p), s.xi.rust(p), samples(&mut s.out, p))
                        .is_ok()
                },
            );
        }
    }

    /// Columns of hits on every preset: sorted by material, and in any order.
    fn table(self, rust: &[Material<R>], c: &[RawMaterial]) {
        let library = self.run.library;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "below the number of presets"
        )]
        let mut index: Vec<u32> = self
            .run
            .inputs
            .xi
            .iter()
            .map(|xi| (xi[0] * c.len() as f32) as u32)
            .collect();
        for call in ["eval_hits of a table", "eval_hits of a sorted table"] {
            self.slices(
                call,
                DIRECTIONS,
                |s, p| unsafe {
                    let hits = s.c_hits(p, &index);
                    (library.hairis_eval_hits)(
                        c.as_ptr(),
                        c.len(),
                        p.1,
                        &hits,
                        &s.wi.c(p),
                        &s.c_evals(p),
                    )
                },
                |s, p| {
                    let table = MaterialTable {
                        materials: rust,
                        index: &index,
                    };
                    table
                        .eval_hits(s.wo.hits(p), s.wi.rust(p), evals(&mut s.out, p))
                        .is_ok()
                },
            );
            index.sort_unstable();
        }
    }

    /// Times calls over columns, `n` rows each, after both have written the same bits.
    fn slices(
        self,
        call: &str,
        n: usize,
        ours: impl Fn(&mut Slices, Part) -> i32,
        base: impl Fn(&mut Slices, Part) -> bool,
    ) {
        let [mut a, mut b] = [(); 2].map(|()| Slices::new(self.run.inputs));
        let parts = || (0..DIRECTIONS).step_by(n).map(|at| (at, n));
        let label = self.label;
        assert!(
            parts().all(|part| ours(&mut a, part) == OK),
            "{label:?} {call}: a status"
        );
        assert!(
            parts().all(|part| base(&mut b, part)),
            "{label:?} {call}: a length"
        );
        let numbers = |s: &Slices| {
            s.out
                .clone()
                .map(|column| column.part(0, DIRECTIONS).to_vec())
        };
        let is_same = |x: &f32, y: &f32| x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan();
        let same = numbers(&a)
            .iter()
            .flatten()
            .zip(numbers(&b).iter().flatten())
            .all(|(x, y)| is_same(x, y));
        assert!(same, "{label:?} {call}: other numbers than Rust's");
        self.row(
            call,
            || parts().for_each(|part| _ = black_box(ours(&mut a, part))),
            || parts().for_each(|part| _ = black_box(base(&mut b, part))),
        );
    }
}

/// First row and number of rows.
type Part = (usize, usize);

/// Three columns.
struct Three([Column; 3]);

impl Three {
    fn new(first: usize, rows: &[[f32; 3]]) -> Self {
        Self(from_fn(|k| {
            Column::new(first + k, rows.iter().map(|row| row[k]))
        }))
    }
    fn rust(&self, (at, n): Part) -> [&[f32]; 3] {
        self.0.each_ref().map(|column| column.part(at, n))
    }
    fn hits(&self, part: Part) -> HitColumns<'_> {
        let wo = self.rust(part);
        HitColumns { wo, h: None }
    }
    fn c(&self, part: Part) -> [*const f32; 3] {
        self.rust(part).map(<[f32]>::as_ptr)
    }
}

/// Columns of a call and its results.
struct Slices {
    wo: Three,
    wi: Three,
    xi: Three,
    out: [Column; 11],
}

impl Slices {
    fn new(inputs: &Inputs) -> Self {
        Self {
            wo: Three::new(0, &arrays(&inputs.wo)),
            wi: Three::new(3, &arrays(&inputs.wi)),
            xi: Three::new(6, &inputs.xi),
            out: from_fn(|k| Column::new(9 + k, [])),
        }
    }
    fn c_out(&mut self, (at, n): Part) -> [*mut f32; 11] {
        self.out
            .each_mut()
            .map(|column| column.part_mut(at, n).as_mut_ptr())
    }
    fn c_evals(&mut self, part: Part) -> Evals {
        let [r, g, b, pdf, ..] = self.c_out(part);
        Evals {
            value: [r, g, b],
            pdf,
        }
    }
    fn c_samples(&mut self, part: Part) -> Samples {
        let [u, v, w, r, g, b, pdf, x, y, z, lobe] = self.c_out(part);
        Samples {
            wi: [u, v, w],
            value: [r, g, b],
            pdf,
            weight: [x, y, z],
            lobe,
        }
    }
    fn c_hits(&self, part: Part, index: &[u32]) -> Hits {
        let index = if index.is_empty() {
            null()
        } else {
            index.as_ptr()
        };
        Hits {
            wo: self.wo.c(part),
            h: null(),
            index,
        }
    }
}

fn evals(out: &mut [Column; 11], (at, n): Part) -> EvalColumns<'_> {
    let [r, g, b, pdf, ..] = out.each_mut().map(|column| column.part_mut(at, n));
    EvalColumns {
        value: Some([r, g, b]),
        pdf: Some(pdf),
    }
}

fn samples(out: &mut [Column; 11], (at, n): Part) -> SampleColumns<'_> {
    let [u, v, w, r, g, b, pdf, x, y, z, slot] =
        out.each_mut().map(|column| column.part_mut(at, n));
    SampleColumns {
        wi: Some([u, v, w]),
        value: Some([r, g, b]),
        pdf: Some(pdf),
        weight: Some([x, y, z]),
        slot: Some(slot),
    }
}
