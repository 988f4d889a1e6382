//! Time of slices, fresh packets and slices of eight over that of kernels written by hand, in one run; and of slices of hits over
//! that of slices of one hit.
//!
//! `cargo bench -p hairis-benches --bench hand` prints a record. Both are called in turns, stretch by stretch; a ratio is the median
//! of those of all turns, with its quartiles.

#[cfg(not(target_arch = "x86_64"))]
fn main() {}

#[cfg(target_arch = "x86_64")]
fn main() {
    x86::main();
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use core::array::from_fn;
    use core::hint::black_box;
    use glam::Vec3;
    use hairis::columns::SampleColumns;
    use hairis::columns::{EvalColumns, HitColumns};
    use hairis::model::Bell;
    use hairis::model::Model;
    use hairis::simd::Level;
    use hairis::simd::Vec3x;
    use hairis::simd::f32x8;
    use hairis::{Bsdf, Gaussian, HairParams, Matched, Material, Published};
    use hairis_benches::cpu;
    use hairis_benches::hand::{Constants, Set};
    use hairis_benches::inputs::{Column, DIRECTIONS, Inputs, arrays};
    use hairis_variants::Cauchy;
    use std::env;
    use std::time::Instant;

    /// Turns of the two kernels.
    const TURNS: usize = 1001;
    /// Passes over the inputs in a turn.
    const PASSES: usize = 4;
    /// Largest difference of the two where neither is negligible: the sum of their bounds.
    const TOLERANCE: f32 = 1e-3;

    pub(crate) fn main() {
        // Cargo runs benches as tests, too.
        let turns = if env::args().any(|word| word == "--bench") {
            TURNS
        } else {
            1
        };
        println!("# CPU: {}", cpu::name());
        println!("# compiled for {}", Level::portable());
        println!("task,call,level,ns,base_ns,ratio,ratio_low,ratio_high");
        let inputs = Inputs::draw();
        for level in Level::available() {
            let Some(set) = Set::of(level) else { continue };
            let run = |task| Run { task, level, turns };
            eval::<_, false>(run("eval-gaussian"), set, Gaussian, &inputs);
            eval::<_, true>(run("eval-cauchy"), set, Cauchy::PAPER, &inputs);
            sample(run("sample-gaussian"), set, &inputs);
            hits(
                Run {
                    task: "published",
                    level,
                    turns,
                },
                &Published(Gaussian),
                &inputs,
            );
            hits(
                Run {
                    task: "matched",
                    level,
                    turns,
                },
                &Matched::<_>(Gaussian),
                &inputs,
            );
        }
    }

    /// One task on one instruction set.
    #[derive(Clone, Copy)]
    struct Run<'a> {
        task: &'a str,
        level: Level,
        turns: usize,
    }

    impl Run<'_> {
        /// Times two calls in turns and prints a row.
        fn compare(self, call: &str, mut ours: impl FnMut(), mut hand: impl FnMut()) {
            let mut times = Vec::new();
            for turn in 0..self.turns + 1 {
                let (mut a, mut b) = (0.0, 0.0);
                // Whichever is first changes from turn to turn.
                if turn % 2 == 0 {
                    a = stretch(&mut ours);
                }
                b += stretch(&mut hand);
                if turn % 2 == 1 {
                    a = stretch(&mut ours);
                }
                times.push([a, b, a / b]);
            }
            // The first turn warms up.
            let times = &mut times[1..];
            let mut quantile = |k: usize, q: f64| {
                times.sort_by(|a, b| a[k].total_cmp(&b[k]));
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    clippy::cast_precision_loss,
                    reason = "some thousand"
                )]
                times[(q * (times.len() - 1) as f64).round() as usize][k]
            };
            let (ns, hand) = (quantile(0, 0.5), quantile(1, 0.5));
            let ratio = [0.5, 0.25, 0.75].map(|q| quantile(2, q));
            let [ratio, low, high] = ratio;
            println!(
                "{},{call},{},{ns:.3},{hand:.3},{ratio:.3},{low:.3},{high:.3}",
                self.task, self.level
            );
        }

        /// Calls on columns of `len` rows, which must give the same.
        fn columns<const N: usize>(
            self,
            call: &str,
            (rows, len): (&[[f32; 3]], usize),
            ours: impl Fn([&[f32]; 3], [&mut [f32]; N]),
            hand: impl Fn([&[f32]; 3], [&mut [f32]; N]),
        ) {
            let from: [Column; 3] = from_fn(|k| Column::new(k, rows.iter().map(|row| row[k])));
            let mut to: [Column; N] = from_fn(|k| Column::new(3 + k, []));
            let mut to_hand: [Column; N] = from_fn(|k| Column::new(3 + k, []));
            self.compare(
                call,
                || pass(&from, &mut to, len, &ours),
                || pass(&from, &mut to_hand, len, &hand),
            );
            for (by_hand, ours) in to_hand.iter().zip(&to) {
                let (a, b) = (by_hand.part(0, DIRECTIONS), ours.part(0, DIRECTIONS));
                let agree = |(a, b): &(&f32, &f32)| (*a - *b).abs() <= TOLERANCE * b.abs() + 1e-7;
                let wrong = a.iter().zip(b).filter(|pair| !agree(pair)).count();
                // Next to the boundary of two lobes either may be chosen.
                assert!(
                    wrong <= DIRECTIONS / 200,
                    "{} {call} {}: {wrong} answers differ",
                    self.task,
                    self.level
                );
            }
        }
    }

    /// Time of a call of some passes, ns per direction.
    #[inline(never)]
    fn stretch(call: &mut impl FnMut()) -> f64 {
        let start = Instant::now();
        for _ in 0..PASSES {
            call();
        }
        #[expect(clippy::cast_precision_loss, reason = "some thousand")]
        let directions = (PASSES * DIRECTIONS) as f64;
        start.elapsed().as_secs_f64() * 1e9 / directions
    }

    /// Calls on all rows, `len` at a time.
    #[inline(always)]
    fn pass<const N: usize>(
        from: &[Column; 3],
        to: &mut [Column; N],
        len: usize,
        call: &impl Fn([&[f32]; 3], [&mut [f32]; N]),
    ) {
        for at in (0..DIRECTIONS).step_by(len) {
            let [x, y, z] = black_box(from);
            let mut parts: [&mut [f32]; N] = from_fn(|_| Default::default());
            for (part, column) in parts.iter_mut().zip(&mut *to) {
                *part = column.part_mut(at, len);
            }
            call([x.part(at, len), y.part(at, len), z.part(at, len)], parts);
            black_box(&to);
        }
    }

    /// The first eight numbers of each column.
    #[inline(always)]
    fn eight(columns: [&[f32]; 3]) -> [&[f32; 8]; 3] {
        columns.map(|column| column.first_chunk().expect("eight rows"))
    }

    #[inline(always)]
    fn eight_mut<const N: usize>(columns: [&mut [f32]; N]) -> [&mut [f32; 8]; N] {
        columns.map(|column| column.first_chunk_mut().expect("eight rows"))
    }

    /// Writes eight rows to the columns of a packet, number by number, as a host does that has just computed them: the compiler does
    /// not know the lanes, and makes no vectors of them.
    #[inline(always)]
    fn write(rows: &[[f32; 3]; 8], lanes: &[usize; 8], [x, y, z]: [&mut [f32; 8]; 3]) {
        for (row, lane) in rows.iter().zip(black_box(lanes)) {
            [x[lane % 8], y[lane % 8], z[lane % 8]] = *row;
        }
    }

    /// Uses every number of some columns.
    #[inline(always)]
    fn used<const N: usize>(sum: &mut [f32; 8], columns: [&[f32; 8]; N]) {
        for column in columns {
            for (sum, x) in sum.iter_mut().zip(column) {
                *sum += x;
            }
        }
    }

    const LANES: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

    fn packet() -> [f32x8; 3] {
        [f32x8::ZERO; 3]
    }

    fn bsdf<B: Bell>(level: Level, bell: B, inputs: &Inputs) -> (Bsdf<Published<B>>, Constants) {
        let (params, wo) = (HairParams::bright(), inputs.wo[0]);
        (
            Material::new(&Published(bell), &params)
                .with_level(level)
                .prepare(wo),
            Constants::new(params.desc(), wo.to_array()),
        )
    }

    fn eval<B: Bell, const CAUCHY: bool>(run: Run<'_>, set: Set, bell: B, inputs: &Inputs) {
        let (bsdf, constants) = &bsdf(run.level, bell, inputs);
        let wi: Vec<[f32; 3]> = inputs.wi.iter().map(Vec3::to_array).collect();
        let ours = |from: [&[f32]; 3], [r, g, b, pdf]: [&mut [f32]; 4]| {
            let done = bsdf.eval_columns(
                from,
                EvalColumns {
                    value: Some([r, g, b]),
                    pdf: Some(pdf),
                },
            );
            black_box(done.is_ok());
        };
        run.columns("slices", (&wi, DIRECTIONS), ours, |from, to| {
            set.eval::<CAUCHY>(constants, from, to)
        });
        run.columns("slices of eight", (&wi, 8), ours, |from, to| {
            set.eval8::<CAUCHY>(constants, eight(from), eight_mut(to));
        });
        let (rows, _) = wi.as_chunks::<8>();
        run.compare(
            "fresh packets",
            || {
                let mut sum = [0.0; 8];
                for rows in rows {
                    let [mut x, mut y, mut z] = packet();
                    write(
                        rows,
                        &LANES,
                        [x.as_mut_array(), y.as_mut_array(), z.as_mut_array()],
                    );
                    let eval = bsdf.eval_pdf8(&Vec3x::new(x, y, z));
                    let [r, g, b] = &eval.value;
                    used(
                        &mut sum,
                        [
                            r.as_array(),
                            g.as_array(),
                            b.as_array(),
                            eval.pdf.as_array(),
                        ],
                    );
                }
                black_box(sum);
            },
            || {
                let mut sum = [0.0; 8];
                for rows in rows {
                    let (mut from, mut to) = ([[0.0; 8]; 3], [[0.0; 8]; 4]);
                    write(rows, &LANES, from.each_mut());
                    set.eval8::<CAUCHY>(constants, from.each_ref(), to.each_mut());
                    used(&mut sum, to.each_ref());
                }
                black_box(sum);
            },
        );
    }

    fn sample(run: Run<'_>, set: Set, inputs: &Inputs) {
        let (bsdf, constants) = &bsdf(run.level, Gaussian, inputs);
        let xi = &inputs.xi;
        let ours = |from: [&[f32]; 3], [u, v, w, pdf, r, g, b]: [&mut [f32]; 7]| {
            let out = SampleColumns {
                wi: Some([u, v, w]),
                pdf: Some(pdf),
                weight: Some([r, g, b]),
                ..SampleColumns::default()
            };
            black_box(bsdf.sample_columns(from, out).is_ok());
        };
        run.columns("slices", (xi, DIRECTIONS), ours, |from, to| {
            set.sample::<false>(constants, from, to)
        });
        run.columns("slices of eight", (xi, 8), ours, |from, to| {
            set.sample8::<false>(constants, eight(from), eight_mut(to));
        });
        let (rows, _) = xi.as_chunks::<8>();
        run.compare(
            "fresh packets",
            || {
                let mut sum = [0.0; 8];
                for rows in rows {
                    let mut from = packet();
                    let [x, y, z] = &mut from;
                    write(
                        rows,
                        &LANES,
                        [x.as_mut_array(), y.as_mut_array(), z.as_mut_array()],
                    );
                    let s = bsdf.sample8(&from);
                    let ([r, g, b], wi) = (&s.weight, &s.wi);
                    let wi = [wi.x.as_array(), wi.y.as_array(), wi.z.as_array()];
                    let [u, v, w] = wi;
                    used(
                        &mut sum,
                        [
                            u,
                            v,
                            w,
                            s.pdf.as_array(),
                            r.as_array(),
                            g.as_array(),
                            b.as_array(),
                        ],
                    );
                }
                black_box(sum);
            },
            || {
                let mut sum = [0.0; 8];
                for rows in rows {
                    let (mut from, mut to) = ([[0.0; 8]; 3], [[0.0; 8]; 7]);
                    write(rows, &LANES, from.each_mut());
                    set.sample8::<false>(constants, from.each_ref(), to.each_mut());
                    used(&mut sum, to.each_ref());
                }
                black_box(sum);
            },
        );
    }
    /// Columns of as many numbers, from the place `first` on.
    fn columns<const N: usize>(first: usize, rows: &[[f32; N]]) -> [Column; N] {
        from_fn(|k| Column::new(first + k, rows.iter().map(|row| row[k])))
    }

    fn parts<const N: usize>(columns: &[Column; N]) -> [&[f32]; N] {
        from_fn(|k| columns[k].part(0, DIRECTIONS))
    }

    fn parts_mut<const N: usize>(columns: &mut [Column; N]) -> [&mut [f32]; N] {
        columns
            .each_mut()
            .map(|column| column.part_mut(0, DIRECTIONS))
    }

    /// Slices of hits, each with a `wo` of its own, beside slices of the published model at one hit: the columns of a path tracer.
    fn hits<M: Model<Params = HairParams>>(run: Run<'_>, model: &M, inputs: &Inputs) {
        let (level, params) = (run.level, HairParams::bright());
        let material = Material::new(model, &params).with_level(level);
        let one = Material::new(&Published(Gaussian), &params)
            .with_level(level)
            .prepare(inputs.wo[0]);
        let wo: [Column; 3] = columns(0, &arrays(&inputs.wo));
        let wi: [Column; 3] = columns(3, &arrays(&inputs.wi));
        let xi: [Column; 3] = columns(3, &inputs.xi);
        let hits = HitColumns {
            wo: parts(&wo),
            h: None,
        };
        let rows = vec![[0.0; 7]; DIRECTIONS];
        let (mut of_hits, mut of_one): ([Column; 7], [Column; 7]) =
            (columns(6, &rows), columns(6, &rows));
        run.compare(
            "hits: eval",
            || {
                let [r, g, b, pdf, ..] = parts_mut(&mut of_hits);
                let out = EvalColumns {
                    value: Some([r, g, b]),
                    pdf: Some(pdf),
                };
                black_box(material.eval_hits(black_box(hits), parts(&wi), out).is_ok());
            },
            || {
                let [r, g, b, pdf, ..] = parts_mut(&mut of_one);
                let out = EvalColumns {
                    value: Some([r, g, b]),
                    pdf: Some(pdf),
                };
                black_box(one.eval_columns(black_box(parts(&wi)), out).is_ok());
            },
        );
        run.compare(
            "hits: sample",
            || {
                let [u, v, w, pdf, r, g, b] = parts_mut(&mut of_hits);
                let (wi, weight) = (Some([u, v, w]), Some([r, g, b]));
                let out = SampleColumns {
                    wi,
                    pdf: Some(pdf),
                    weight,
                    ..SampleColumns::default()
                };
                black_box(
                    material
                        .sample_hits(black_box(hits), parts(&xi), out)
                        .is_ok(),
                );
            },
            || {
                let [u, v, w, pdf, r, g, b] = parts_mut(&mut of_one);
                let out = SampleColumns {
                    wi: Some([u, v, w]),
                    pdf: Some(pdf),
                    weight: Some([r, g, b]),
                    ..SampleColumns::default()
                };
                black_box(one.sample_columns(black_box(parts(&xi)), out).is_ok());
            },
        );
    }
}
