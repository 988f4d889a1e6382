//! Slice calls on heap slices of exactly the length asked for: lengths 0 to 69, three offsets, every level. What lies before
//! and behind them is the allocator's, which AddressSanitizer and valgrind watch.
//!
//! With the argument `bad` it reads one float behind a slice: the tool must report that.

use hairis::columns::{EvalColumns, SampleColumns};
use hairis::model::Model;
use hairis::simd::{Level, f32x8};
use hairis::{Bsdf, Gaussian, HairParams, Matched, Material, Published, Vec3x8};

/// Numbers in [0, 1), by a linear congruence.
struct Numbers(u32);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// A block on the heap of `offset + len` floats: the slice of its last `len` ends where the block does.
    fn block(&mut self, offset: usize, len: usize) -> Box<[f32]> {
        (0..offset + len).map(|_| self.next()).collect()
    }
}

fn slices<M: Model>(bsdf: &Bsdf<M>, numbers: &mut Numbers) -> u64 {
    let mut calls = 0;
    for level in Level::available() {
        for len in 0..70 {
            for offset in 0..3 {
                let input: [Box<[f32]>; 3] = core::array::from_fn(|_| numbers.block(offset, len));
                let input = [
                    &input[0][offset..],
                    &input[1][offset..],
                    &input[2][offset..],
                ];
                let mut output: [Box<[f32]>; 11] =
                    core::array::from_fn(|_| numbers.block(offset, len));
                let [u, v, w, r, g, b, pdf, x, y, z, slot] =
                    output.each_mut().map(|block| &mut block[offset..]);
                let out = EvalColumns {
                    value: Some([&mut *r, &mut *g, &mut *b]),
                    pdf: Some(&mut *pdf),
                };
                bsdf.with_level(level)
                    .eval_columns(input, out)
                    .expect("one length");
                let values = EvalColumns {
                    value: Some([&mut *x, &mut *y, &mut *z]),
                    pdf: None,
                };
                bsdf.with_level(level)
                    .eval_columns(input, values)
                    .expect("one length");
                let densities = EvalColumns {
                    value: None,
                    pdf: Some(&mut *slot),
                };
                bsdf.with_level(level)
                    .eval_columns(input, densities)
                    .expect("one length");
                let same = r
                    .iter()
                    .zip(&*x)
                    .chain(pdf.iter().zip(&*slot))
                    .all(|(a, b)| a.to_bits() == b.to_bits());
                assert!(same, "{len} entries from {offset} on {level}");
                let out = SampleColumns {
                    wi: Some([u, v, w]),
                    value: Some([r, g, b]),
                    pdf: Some(pdf),
                    weight: Some([x, y, z]),
                    slot: Some(slot),
                };
                bsdf.with_level(level)
                    .sample_columns(input, out)
                    .expect("one length");
                let [u, v, w, pdf, x, y, z, ..] =
                    output.each_mut().map(|block| &mut block[offset..]);
                let out = SampleColumns {
                    wi: Some([u, v, w]),
                    pdf: Some(pdf),
                    weight: Some([x, y, z]),
                    ..SampleColumns::default()
                };
                bsdf.with_level(level)
                    .sample_columns(input, out)
                    .expect("one length");
                let [u, v, w, ..] = output.each_mut().map(|block| &mut block[offset..]);
                let some = SampleColumns {
                    wi: Some([u, v, w]),
                    ..SampleColumns::default()
                };
                bsdf.with_level(level)
                    .sample_columns(input, some)
                    .expect("one length");
                calls += 6;
            }
        }
    }
    calls
}

/// Packets from boxes: loads and stores of whole vectors.
fn packets<M: Model>(material: &Material<M>, numbers: &mut Numbers) -> u64 {
    let mut calls = 0;
    for level in Level::available() {
        for _ in 0..16 {
            let wi = Box::new(Vec3x8::from(core::array::from_fn(|_| {
                glam::Vec3::new(
                    numbers.next() - 0.5,
                    numbers.next() - 0.5,
                    numbers.next() - 0.5,
                )
                .normalize_or_zero()
            })));
            let xi = Box::new(core::array::from_fn(|_| {
                f32x8::new(core::array::from_fn(|_| numbers.next()))
            }));
            let points = Box::new(material.with_level(level).prepare8(&*wi));
            let all = [
                points.with_level(level).eval_pdf8(&wi).pdf,
                points.with_level(level).sample8(&xi).pdf,
                points.with_level(level).lobes8(&wi).0[0].pdf,
            ];
            assert!(
                all.iter()
                    .all(|pdf| pdf.to_array().iter().all(|x| x.is_finite())),
                "{all:?}"
            );
            calls += 4;
        }
    }
    calls
}

fn main() {
    let mut numbers = Numbers(1);
    if std::env::args().nth(1).as_deref() == Some("bad") {
        let block = numbers.block(0, 69);
        // SAFETY: none: this is the access that the tool must report.
        let beyond = unsafe { core::ptr::read_volatile(block.as_ptr().add(block.len())) };
        println!("read {beyond} behind a slice, unnoticed");
        return;
    }
    let params = HairParams::brown();
    let (hair, matched) = (
        Material::new(&Published(Gaussian), &params),
        Material::new(&Matched::<_>(Gaussian), &params),
    );
    let calls = slices(&hair.prepare(glam::Vec3::new(0.6, 0.8, 0.0)), &mut numbers)
        + slices(
            &matched.prepare(glam::Vec3::new(0.6, 0.8, 0.0)),
            &mut numbers,
        )
        + packets(&hair, &mut numbers)
        + packets(&matched, &mut numbers);
    let levels: Vec<&str> = Level::available().map(Level::name).collect();
    println!("{calls} calls on {}", levels.join(", "));
}
