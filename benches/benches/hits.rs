//! Time of hits with `Conserving` over those without, of one hit in one call over two calls, of evaluating and sampling at once over
//! doing both, and of making a material.
//!
//! `cargo bench -p hairis-benches --bench hits` prints a record.

use core::array::from_fn;
use core::hint::black_box;
use glam::Vec3;
use hairis::columns::{EvalColumns, HitColumns, MaterialTable, SampleColumns, in_groups};
use hairis::model::Model;
use hairis::simd::Level;
use hairis::{Conserving, Gaussian, Matched, Material, Material8, Published};
use hairis_benches::inputs::{Column, DIRECTIONS, Inputs, arrays, packets};
use hairis_benches::{cpu, turns};
use hairis_variants::{AllCauchy, Cauchy, Parameters, Registered};

/// Presets of hair.
const PRESETS: usize = 6;

fn main() {
    let turns = turns::turns();
    println!("# CPU: {}", cpu::name());
    println!("# compiled for {}", Level::portable());
    println!("model,call,level,ns,base_ns,ratio");
    let inputs = Inputs::draw();
    let run = |model| Run {
        model,
        turns,
        inputs: &inputs,
    };
    run("gaussian").all::<Published<Gaussian>>();
    run("cauchy").all::<AllCauchy>();
    run("gaussian-matched").all::<Matched<Gaussian>>();
    run("cauchy-matched").all::<Matched<Cauchy>>();
}

/// Keeps a result that nothing reads, where it is: eight prepared hits have up to 7 kB.
#[inline(always)]
fn keep<T>(result: T) {
    black_box(&result);
}

/// Columns of a call and its results.
struct Columns {
    wo: [Column; 3],
    wi: [Column; 3],
    xi: [Column; 3],
    out: [Column; 11],
}

impl Columns {
    fn new(inputs: &Inputs) -> Self {
        let columns = |first: usize, rows: &[[f32; 3]]| {
            from_fn(|k| Column::new(first + k, rows.iter().map(|row| row[k])))
        };
        Self {
            wo: columns(0, &arrays(&inputs.wo)),
            wi: columns(3, &arrays(&inputs.wi)),
            xi: columns(6, &inputs.xi),
            out: from_fn(|k| Column::new(9 + k, [])),
        }
    }

    /// Hits, directions, uniform numbers, and what is written: all of an evaluation, and of a sample what a path tracer needs.
    #[expect(clippy::type_complexity, reason = "the arguments of one call")]
    fn parts(
        &mut self,
    ) -> (
        HitColumns<'_>,
        [&[f32]; 3],
        [&[f32]; 3],
        EvalColumns<'_>,
        SampleColumns<'_>,
    ) {
        let [r, g, b, p, u, v, w, q, wr, wg, wb] =
            self.out.each_mut().map(|c| c.part_mut(0, DIRECTIONS));
        let [wo, wi, xi] =
            [&self.wo, &self.wi, &self.xi].map(|c| c.each_ref().map(|c| c.part(0, DIRECTIONS)));
        let evals = EvalColumns {
            value: Some([r, g, b]),
            pdf: Some(p),
        };
        let samples = SampleColumns {
            wi: Some([u, v, w]),
            pdf: Some(q),
            weight: Some([wr, wg, wb]),
            ..SampleColumns::default()
        };
        (HitColumns { wo, h: None }, wi, xi, evals, samples)
    }
}

/// Evaluates and samples each hit in one call.
fn both_at_once<M: Model>(material: &Material<M>, columns: &mut Columns) {
    let (hits, wi, xi, evals, samples) = columns.parts();
    black_box(
        material
            .eval_sample_hits(hits, wi, evals, xi, samples)
            .is_ok(),
    );
}

/// Evaluates and samples each hit in a call each.
fn both_calls<M: Model>(material: &Material<M>, columns: &mut Columns) {
    let (hits, wi, xi, evals, samples) = columns.parts();
    black_box(material.eval_hits(hits, wi, evals).is_ok());
    black_box(material.sample_hits(hits, xi, samples).is_ok());
}

/// The pairs of one model.
#[derive(Clone, Copy)]
struct Run<'a> {
    model: &'a str,
    turns: usize,
    inputs: &'a Inputs,
}

impl Run<'_> {
    /// Times two calls in turns and prints a row, per each of so many hits.
    fn pair(self, call: &str, level: &str, hits: usize, ours: impl FnMut(), base: impl FnMut()) {
        let [ours, base, ratio] = turns::pair(self.turns, hits, ours, base);
        let model = self.model;
        println!("{model},{call},{level},{ours:.2},{base:.2},{ratio:.3}");
    }

    fn all<M: Registered>(self) {
        let model = M::MODEL;
        // Everyday hair: blond.
        let hair = M::Params::PRESETS[1].1;
        let raw = Material::new(&model, &hair);
        let fit = Material::new(&Conserving(model), &hair);
        self.pair(
            "new",
            "-",
            1,
            || {
                black_box(Material::new(&Conserving(model), black_box(&hair)));
            },
            || {
                black_box(Material::new(&model, black_box(&hair)));
            },
        );
        self.one(&raw, &fit);
        for level in Level::available() {
            self.slices(level, &raw.with_level(level), &fit.with_level(level));
            self.packets(level, &raw.with_level(level), &fit.with_level(level));
            self.mixed::<M>(level);
        }
    }

    /// Calls of one hit.
    fn one<M: Model>(self, raw: &Material<M>, fit: &Material<Conserving<M>>) {
        let inputs = self.inputs;
        let evals = |call: &dyn Fn(Vec3, Vec3)| {
            for (wo, wi) in inputs.wo.iter().zip(&inputs.wi) {
                call(*wo, *wi);
            }
        };
        let samples = |call: &dyn Fn(Vec3, [f32; 3])| {
            for (wo, xi) in inputs.wo.iter().zip(&inputs.xi) {
                call(*wo, *xi);
            }
        };
        let row = |call, ours: &mut dyn FnMut(), base: &mut dyn FnMut()| {
            self.pair(call, "one lane", DIRECTIONS, ours, base);
        };
        row(
            "eval_hit: Conserving over raw",
            &mut || evals(&|wo, wi| keep(fit.eval_hit(wo, wi))),
            &mut || evals(&|wo, wi| keep(raw.eval_hit(wo, wi))),
        );
        row(
            "sample_hit: Conserving over raw",
            &mut || samples(&|wo, xi| keep(fit.sample_hit(wo, xi))),
            &mut || samples(&|wo, xi| keep(raw.sample_hit(wo, xi))),
        );
        row(
            "prepare: Conserving over raw",
            &mut || evals(&|wo, _| keep(fit.prepare(wo))),
            &mut || evals(&|wo, _| keep(raw.prepare(wo))),
        );
        row(
            "eval_hit over prepare and eval_pdf",
            &mut || evals(&|wo, wi| keep(raw.eval_hit(wo, wi))),
            &mut || evals(&|wo, wi| keep(black_box(raw.prepare(wo)).eval_pdf(wi))),
        );
        row(
            "sample_hit over prepare and sample",
            &mut || samples(&|wo, xi| keep(raw.sample_hit(wo, xi))),
            &mut || samples(&|wo, xi| keep(black_box(raw.prepare(wo)).sample(xi))),
        );
    }

    /// Slices of hits on one material.
    fn slices<M: Model>(self, level: Level, raw: &Material<M>, fit: &Material<Conserving<M>>) {
        let [mut ours, mut base] = [(); 2].map(|()| Columns::new(self.inputs));
        let row = |call, ours: &mut dyn FnMut(), base: &mut dyn FnMut()| {
            self.pair(call, level.name(), DIRECTIONS, ours, base);
        };
        row(
            "eval_hits: Conserving over raw",
            &mut || {
                let (hits, wi, _, out, _) = ours.parts();
                black_box(fit.eval_hits(hits, wi, out).is_ok());
            },
            &mut || {
                let (hits, wi, _, out, _) = base.parts();
                black_box(raw.eval_hits(hits, wi, out).is_ok());
            },
        );
        row(
            "sample_hits: Conserving over raw",
            &mut || {
                let (hits, _, xi, _, out) = ours.parts();
                black_box(fit.sample_hits(hits, xi, out).is_ok());
            },
            &mut || {
                let (hits, _, xi, _, out) = base.parts();
                black_box(raw.sample_hits(hits, xi, out).is_ok());
            },
        );
        row(
            "eval_sample_hits over both calls",
            &mut || both_at_once(raw, &mut ours),
            &mut || both_calls(raw, &mut base),
        );
        row(
            "eval_sample_hits over both calls: Conserving",
            &mut || both_at_once(fit, &mut ours),
            &mut || both_calls(fit, &mut base),
        );
    }

    /// Packets of hits on one material and on eight.
    fn packets<M: Model>(self, level: Level, raw: &Material<M>, fit: &Material<Conserving<M>>) {
        let [wo, wi] = [&self.inputs.wo, &self.inputs.wi].map(|rows| packets(rows));
        let hits = || wo.iter().zip(&wi);
        let (raw8, fit8) = (Material8::pack([raw; 8]), Material8::pack([fit; 8]));
        let row = |call, ours: &mut dyn FnMut(), base: &mut dyn FnMut()| {
            self.pair(call, level.name(), DIRECTIONS, ours, base);
        };
        row(
            "packets of one material: Conserving over raw",
            &mut || hits().for_each(|(wo, wi)| keep(fit.prepare8(wo).eval_pdf8(wi))),
            &mut || hits().for_each(|(wo, wi)| keep(raw.prepare8(wo).eval_pdf8(wi))),
        );
        row(
            "packets of eight materials: Conserving over raw",
            &mut || hits().for_each(|(wo, wi)| keep(fit8.prepare8(wo).eval_pdf8(wi))),
            &mut || hits().for_each(|(wo, wi)| keep(raw8.prepare8(wo).eval_pdf8(wi))),
        );
        row(
            "prepare8 of one material: Conserving over raw",
            &mut || wo.iter().for_each(|wo| keep(fit.prepare8(wo))),
            &mut || wo.iter().for_each(|wo| keep(raw.prepare8(wo))),
        );
        row(
            "prepare8 of eight materials: Conserving over raw",
            &mut || wo.iter().for_each(|wo| keep(fit8.prepare8(wo))),
            &mut || wo.iter().for_each(|wo| keep(raw8.prepare8(wo))),
        );
    }

    /// Slices of hits on the presets, in any order.
    fn mixed<M: Registered>(self, level: Level) {
        let presets = M::Params::PRESETS;
        let raw: [Material<M>; PRESETS] =
            from_fn(|i| Material::new(&M::MODEL, &presets[i].1).with_level(level));
        let fit: [Material<Conserving<M>>; PRESETS] =
            from_fn(|i| Material::new(&Conserving(M::MODEL), &presets[i].1).with_level(level));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "below the number of presets"
        )]
        let index: Vec<u32> = self
            .inputs
            .xi
            .iter()
            .map(|xi| (xi[0] * PRESETS as f32) as u32)
            .collect();
        let references: Vec<_> = raw.iter().collect();
        let by_reference = |columns: &mut Columns| {
            let (HitColumns { wo: [u, v, w], .. }, [x, y, z], _, out, _) = columns.parts();
            let (Some([r, g, b]), Some(pdf)) = (out.value, out.pdf) else {
                unreachable!("all are asked for")
            };
            let (from, to) = ([u, v, w, x, y, z], [r, g, b, pdf]);
            in_groups(
                &index,
                from,
                to,
                1,
                |index, [u, v, w, x, y, z], [r, g, b, pdf]| {
                    let hits = HitColumns {
                        wo: [u, v, w],
                        h: None,
                    };
                    let out = EvalColumns {
                        value: Some([r, g, b]),
                        pdf: Some(pdf),
                    };
                    keep(
                        references[index[0] as usize]
                            .eval_hits(hits, [x, y, z], out)
                            .is_ok(),
                    );
                },
            );
        };
        let fit = MaterialTable {
            materials: &fit,
            index: &index,
        };
        let table = MaterialTable {
            materials: &raw,
            index: &index,
        };
        // Sixty-four materials by turns: two hits of each in a chunk.
        let many: Vec<_> = (0..64).map(|i| raw[i % PRESETS]).collect();
        let turns: Vec<u32> = (0..64).cycle().take(index.len()).collect();
        let turns = MaterialTable {
            materials: &many,
            index: &turns,
        };
        let [mut ours, mut base] = [(); 2].map(|()| Columns::new(self.inputs));
        let mut row = |call, ours_call: &dyn Fn(&mut Columns), base_call: &dyn Fn(&mut Columns)| {
            let (ours, base) = (|| ours_call(&mut ours), || base_call(&mut base));
            self.pair(call, level.name(), DIRECTIONS, ours, base);
        };
        let of_six = |columns: &mut Columns| {
            let (hits, wi, _, out, _) = columns.parts();
            keep(table.eval_hits(hits, wi, out).is_ok());
        };
        let of_one = |columns: &mut Columns| {
            let (hits, wi, _, out, _) = columns.parts();
            keep(raw[0].eval_hits(hits, wi, out).is_ok());
        };
        row(
            "eval_hits of six materials: Conserving over raw",
            &|columns| {
                let (hits, wi, _, out, _) = columns.parts();
                keep(fit.eval_hits(hits, wi, out).is_ok());
            },
            &of_six,
        );
        row("eval_hits of six materials over one", &of_six, &of_one);
        row(
            "eval_hits by references over a table",
            &by_reference,
            &of_six,
        );
        row(
            "eval_hits of a material per hit over one",
            &|columns| {
                let (hits, wi, _, out, _) = columns.parts();
                keep(turns.eval_hits(hits, wi, out).is_ok());
            },
            &of_one,
        );
    }
}
