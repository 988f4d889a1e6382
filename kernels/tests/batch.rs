//! Slices in, slices out: the same bits as packets, nothing beyond the ends, and every length checked.

use crate::subject::{Tested, subjects};
use crate::support::{Draws, direction};
use glam::Vec3;
use hairis::wide::f32x8;
use hairis::{Bsdf, EvalSlices, Gather, HairParams, LengthError, Level, SampleSlices, Vec3x8};

/// What a slice held before.
const UNTOUCHED: f32 = -77.0;
/// Room around the slice under test.
const MARGIN: usize = 9;

fn gather() -> Gather<Tested> {
    Bsdf::new(&subjects()[0].0, &HairParams::default()).prepare(direction(0.4, 1.0))
}

/// Around one packet and around two of every backend: slices are worked off in 8, 16 or 32 at a time.
fn lengths() -> impl Iterator<Item = usize> {
    (0..=40).chain(63..=66)
}

fn inputs(len: usize, offset: usize, uniform: bool) -> [Vec<f32>; 3] {
    let mut draws = Draws(len as u64 * 31 + offset as u64);
    let mut columns = [vec![9.0; offset], vec![9.0; offset], vec![9.0; offset]];
    for _ in 0..len {
        let wi = direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
        let row = if uniform { draws.xi3() } else { wi.to_array() };
        for (column, x) in columns.iter_mut().zip(row) {
            column.push(x);
        }
    }
    columns
}

/// `N` columns of room for `len` numbers at an offset, with margins.
fn columns<const N: usize>(len: usize, offset: usize) -> [Vec<f32>; N] {
    core::array::from_fn(|_| vec![UNTOUCHED; offset + len + MARGIN])
}

fn assert_margins(columns: &[Vec<f32>], len: usize, offset: usize, at: &str) {
    for (i, column) in columns.iter().enumerate() {
        let outside = column[..offset].iter().chain(&column[offset + len..]);
        assert!(outside.into_iter().all(|x| *x == UNTOUCHED), "{at}: column {i} was written outside: {column:?}");
    }
}

#[test]
fn batches_equal_packets_at_every_length_and_alignment() {
    let gather = gather();
    for level in Level::available() {
        for len in lengths() {
            for offset in [0, 1, 3, 7] {
                let at = format!("{level} len {len} offset {offset}");
                let wi = inputs(len, offset, false);
                let read = wi.each_ref().map(|column| &column[offset..]);
                let mut out = columns::<4>(len, offset);
                let [r, g, b, pdf] = out.each_mut().map(|column| &mut column[offset..offset + len]);
                gather.eval_pdf_batch_at(level, read, EvalSlices { value: [r, g, b], pdf }).unwrap();
                assert_margins(&out, len, offset, &at);
                let mut parts = columns::<4>(len, offset);
                let [r, g, b, pdf] = parts.each_mut().map(|column| &mut column[offset..offset + len]);
                gather.eval_batch_at(level, read, [r, g, b]).unwrap();
                gather.pdf_batch_at(level, read, pdf).unwrap();
                assert_eq!(parts, out, "{at}: value and density apart");
                for i in 0..len {
                    let one = gather.eval_pdf8_at(level, &Vec3x8::splat(Vec3::new(read[0][i], read[1][i], read[2][i])));
                    let [red, green, blue] = one.lane(0).value;
                    let want = [red, green, blue, one.lane(0).pdf].map(f32::to_bits);
                    assert_eq!(want, out.each_ref().map(|column| column[offset + i].to_bits()), "{at} entry {i}");
                }
            }
        }
    }
}

#[test]
fn sampled_batches_equal_packets_at_every_length_and_alignment() {
    let gather = gather();
    for level in Level::available() {
        for len in lengths() {
            for offset in [0, 2, 5] {
                let at = format!("{level} len {len} offset {offset}");
                let xi = inputs(len, offset, true);
                let read = xi.each_ref().map(|column| &column[offset..]);
                let mut out = columns::<11>(len, offset);
                let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] =
                    out.each_mut().map(|column| &mut column[offset..offset + len]);
                let slices = SampleSlices { wi: [u, v, w], value: [r, g, b], pdf, weight: [wr, wg, wb], slot };
                gather.sample_batch_at(level, read, slices).unwrap();
                assert_margins(&out, len, offset, &at);
                for i in 0..len {
                    let s = gather.sample8_at(level, &read.map(|column| f32x8::splat(column[i])));
                    let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
                    let want = [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot];
                    let want = want.map(|x| x.as_array()[0].to_bits());
                    assert_eq!(want, out.each_ref().map(|column| column[offset + i].to_bits()), "{at} entry {i}");
                }
            }
        }
    }
}

#[test]
fn the_level_found_is_the_default() {
    let gather = gather();
    let wi = inputs(13, 0, false);
    let read = wi.each_ref().map(|column| &column[..]);
    let mut out = [columns::<4>(13, 0), columns::<4>(13, 0)];
    for (out, level) in out.iter_mut().zip([None, Some(Level::detect())]) {
        let [r, g, b, pdf] = out.each_mut().map(|column| &mut column[..13]);
        let slices = EvalSlices { value: [r, g, b], pdf };
        match level {
            None => gather.eval_pdf_batch(read, slices).unwrap(),
            Some(level) => gather.eval_pdf_batch_at(level, read, slices).unwrap(),
        }
    }
    assert_eq!(out[0], out[1], "eval_pdf_batch and eval_pdf_batch_at of the level found");
}

#[test]
fn a_slice_of_another_length_is_named_and_nothing_written() {
    const NAMES: [&str; 7] = ["wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b", "pdf"];
    let gather = gather();
    for (wrong, name) in NAMES.into_iter().enumerate().skip(1) {
        for len in [0, 4, 6, 40] {
            let length = |i: usize| if i == wrong { len } else { 5 };
            let wi = [0, 1, 2].map(|i| vec![0.5; length(i)]);
            let mut out = [3, 4, 5, 6].map(|i| vec![UNTOUCHED; length(i)]);
            let [r, g, b, pdf] = out.each_mut().map(|column| &mut column[..]);
            let got = gather.eval_pdf_batch(wi.each_ref().map(|c| &c[..]), EvalSlices { value: [r, g, b], pdf });
            assert_eq!(got, Err(LengthError { field: name, len, expected: 5 }), "slice {wrong}");
            assert!(out.iter().flatten().all(|x| *x == UNTOUCHED), "{name} is refused, yet written");
            let mut parts = [3, 4, 5, 6].map(|i| vec![UNTOUCHED; length(i)]);
            let [r, g, b, pdf] = parts.each_mut().map(|column| &mut column[..]);
            let wi = wi.each_ref().map(|c| &c[..]);
            let want = |of_it: bool| if of_it { got } else { Ok(()) };
            assert_eq!(gather.eval_batch(wi, [r, g, b]), want(name != "pdf"), "{name}: value alone");
            assert_eq!(gather.pdf_batch(wi, pdf), want(!name.starts_with("value")), "{name}: density alone");
            let text = format!("{name} has {len} entries where the first slice has 5");
            assert_eq!(got.unwrap_err().to_string(), text, "the message");
        }
    }
}

#[test]
fn a_slice_of_samples_of_another_length_is_named_and_nothing_written() {
    const NAMES: [&str; 14] = [
        "xi.lobe", "xi.theta", "xi.phi", "wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b", "pdf", "weight.r",
        "weight.g", "weight.b", "slot",
    ];
    let gather = gather();
    for (wrong, name) in NAMES.into_iter().enumerate().skip(1) {
        let length = |i: usize| if i == wrong { 17 } else { 16 };
        let xi = [0, 1, 2].map(|i| vec![0.5; length(i)]);
        let mut out: [Vec<f32>; 11] = core::array::from_fn(|i| vec![UNTOUCHED; length(i + 3)]);
        let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] = out.each_mut().map(|column| &mut column[..]);
        let slices = SampleSlices { wi: [u, v, w], value: [r, g, b], pdf, weight: [wr, wg, wb], slot };
        let got = gather.sample_batch(xi.each_ref().map(|c| &c[..]), slices);
        assert_eq!(got, Err(LengthError { field: name, len: 17, expected: 16 }), "slice {wrong}");
        assert!(out.iter().flatten().all(|x| *x == UNTOUCHED), "{name} is refused, yet written");
    }
}
