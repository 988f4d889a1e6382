//! Calls that prepare and use a hit at once have the bits of the calls one after the other.

use crate::conserving::{columns, slices};
use glam::Vec3;
use hairis::columns::{
    EvalColumns, HitColumns, HitsError, LengthError, MaterialTable, SampleColumns, in_groups,
};
use hairis::model::Model;
use hairis::simd::Level;
use hairis::{Conserving, Gaussian, HairParams, Hit, Matched, Material, Published};
use hairis_variants::{Chiang, ChiangParams, KajiyaKay, KajiyaKayParams};

const LEN: usize = 45;

fn one_hit_is_two_calls<M: Model>(material: &Material<M>) {
    let [wo, wi, xi] = columns(LEN);
    for i in 0..LEN {
        let at = |columns: &[Vec<f32>; 3]| [columns[0][i], columns[1][i], columns[2][i]];
        let hit = Hit::new(Vec3::from(at(&wo)), 2.0 * xi[2][i] - 1.0);
        let (wi, bsdf) = (Vec3::from(at(&wi)), material.prepare(hit));
        assert_eq!(material.eval_hit(hit, wi), bsdf.eval_pdf(wi), "hit {i}");
        assert_eq!(
            material.sample_hit(hit, at(&xi)),
            bsdf.sample(at(&xi)),
            "hit {i}"
        );
    }
}

#[test]
fn one_hit_has_the_bits_of_a_prepared_one() {
    let hair = HairParams::blond();
    one_hit_is_two_calls(&Material::new(&Published(Gaussian), &hair));
    one_hit_is_two_calls(&Material::new(&Matched::new(Gaussian), &hair));
    one_hit_is_two_calls(&Material::new(&Conserving(Published(Gaussian)), &hair));
    one_hit_is_two_calls(&Material::new(&KajiyaKay, &KajiyaKayParams::default()));
    one_hit_is_two_calls(&Material::new(&Chiang::MEAN, &ChiangParams::default()));
}

#[test]
fn columns_that_differ_in_length_are_named() {
    let [wo, wi, xi] = columns(LEN);
    let hair = Material::new(&Published(Gaussian), &HairParams::blond());
    let hits = HitColumns {
        wo: slices(&wo),
        h: None,
    };
    let mut short = [0.0; 3];
    let samples = SampleColumns {
        pdf: Some(&mut short),
        ..SampleColumns::default()
    };
    let nothing = EvalColumns::default();
    let error = hair.eval_sample_hits(hits, slices(&wi), nothing, slices(&xi), samples);
    let want = LengthError {
        field: "sample.pdf",
        len: 3,
        expected: LEN,
    };
    assert_eq!(error, Err(want));
    let [_, xi_short] = [0, 1].map(|_| xi.each_ref().map(|column| column[..LEN - 1].to_vec()));
    let table = MaterialTable {
        materials: &[hair],
        index: &[0; LEN],
    };
    let error = table.eval_sample_hits(
        hits,
        slices(&wi),
        EvalColumns::default(),
        slices(&xi_short),
        SampleColumns::default(),
    );
    let want = LengthError {
        field: "xi.lobe",
        len: LEN - 1,
        expected: LEN,
    };
    assert_eq!(error, Err(HitsError::Length(want)));
}

#[test]
fn rows_come_in_groups_of_one_index_and_go_back_to_their_places() {
    for (indices, len) in [1, 2, 5, 40, 1000]
        .into_iter()
        .flat_map(|indices| [0, 1, 7, 255, 256, 257, 700].map(|len| (indices, len)))
    {
        let [[number, other, _], ..] = columns(700);
        let (number, other) = (&number[..len], &other[..len]);
        // Some indices follow each other, others do not; they spread over the whole range of a `u32`.
        let index: Vec<u32> = (0..len)
            .map(|i| if i % 97 < 30 { i / 30 } else { i * i })
            .map(|i| {
                u32::try_from(i % indices)
                    .unwrap()
                    .wrapping_mul(0x0101_0101)
            })
            .collect();
        for mixed in [1, 8] {
            let (mut out, mut left_out) = (vec![f32::NAN; len], []);
            let mut calls = 0;
            in_groups(
                &index,
                [number, &[], other],
                [&mut left_out, &mut out],
                mixed,
                |index, [number, nothing, other], [left_out, out]| {
                    let of = |one: &u32| index.iter().filter(|other| *other == one).count();
                    let is_one = of(&index[0]) == index.len();
                    let is_mixed = index.len() <= mixed && index.iter().all(|one| of(one) <= 2);
                    assert!(is_one || is_mixed, "{indices} indices, {mixed}: {index:?}");
                    assert!(
                        nothing.is_empty() && left_out.is_empty(),
                        "columns left out"
                    );
                    for (((out, index), number), other) in
                        out.iter_mut().zip(index).zip(number).zip(other)
                    {
                        *out = number + other + (index % 1024) as f32;
                    }
                    calls += 1;
                },
            );
            let want: Vec<_> = number
                .iter()
                .zip(other)
                .zip(&index)
                .map(|((number, other), index)| number + other + (index % 1024) as f32)
                .collect();
            assert_eq!(
                out, want,
                "{indices} indices of {len} rows, {mixed} together"
            );
            assert!(
                calls <= len.div_ceil(256) * indices + len / 30,
                "{calls} calls"
            );
        }
    }
}

#[test]
fn hits_of_many_materials_have_the_bits_of_their_own() {
    let presets = HairParams::presets().map(|(_, hair)| hair);
    let model = Conserving(Published(Gaussian));
    let [wo, wi, _] = columns(600);
    let hits = |rows: core::ops::Range<usize>| HitColumns {
        wo: slices(&wo).map(|column| &column[rows.clone()]),
        h: None,
    };
    for level in Level::available() {
        let materials = presets.map(|hair| Material::new(&model, &hair).with_level(level));
        for period in [6, 3, 1] {
            let index: Vec<u32> = (0..600).map(|i| i * i / 7 % period).collect();
            let (mut pdf, mut own) = (vec![0.0; 600], vec![0.0; 600]);
            let out = EvalColumns {
                pdf: Some(&mut pdf),
                ..EvalColumns::default()
            };
            let table = MaterialTable {
                materials: &materials,
                index: &index,
            };
            table.eval_hits(hits(0..600), slices(&wi), out).unwrap();
            for (i, own) in own.chunks_mut(1).enumerate() {
                let out = EvalColumns {
                    pdf: Some(own),
                    ..EvalColumns::default()
                };
                let wi = slices(&wi).map(|column| &column[i..=i]);
                materials[index[i] as usize]
                    .eval_hits(hits(i..i + 1), wi, out)
                    .unwrap();
            }
            assert_eq!(pdf, own, "{level}, {period} materials");
        }
    }
}
