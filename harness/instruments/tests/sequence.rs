//! Tests of `sequence`.

mod halton;
mod stratified;

use hairis_conformance::statistics::{chi_square, ks_p_value, ks_statistic};
use hairis_instruments::sequence::{
    Independent, MAX_XI_F32, SequenceKind, XiSource, stream_id, to_unit_f32, unit_f64,
};

#[test]
fn f32_never_reaches_one() {
    assert_eq!(MAX_XI_F32, 16_777_215.0 / 16_777_216.0);
    for x in [
        1.0 - f64::EPSILON / 2.0,
        1.0 - 2.0_f64.powi(-26),
        1.0,
        2.0,
        f64::INFINITY,
    ] {
        assert_eq!(to_unit_f32(x), MAX_XI_F32, "x {x}");
    }
    assert_eq!(to_unit_f32(-1.0), 0.0);
    assert_eq!(to_unit_f32(f64::NAN), 0.0);
    assert_eq!(to_unit_f32(0.25), 0.25);
    assert!(unit_f64(u64::MAX) < 1.0 && unit_f64(0) == 0.0);
}

#[test]
fn independent_is_uniform_and_streams_differ() {
    let mut xi = Independent::new(42, 0);
    let mut s: Vec<f64> = (0..100_000).map(|_| xi.next_f64()).collect();
    let d = ks_statistic(&mut s, |x| x);
    assert!(ks_p_value(d, s.len()) > 0.01, "distance {d}");
    let mut cells = vec![0_u64; 16 * 16];
    for _ in 0..256_000 {
        let [x, y] = xi.next_xi::<2>();
        let cell = |x: f64| (0..16).rev().find(|&i| x >= i as f64 / 16.0).unwrap_or(0);
        cells[16 * cell(x) + cell(y)] += 1;
    }
    let p = chi_square(&cells, &vec![1_000.0; 256], 5.0).p_value;
    assert!(p > 0.01, "pairs: p {p}");
    let first = |seed, stream| Independent::new(seed, stream).next_f64();
    assert!(first(1, 0) != first(1, 1) && first(1, 0) != first(2, 0));
    assert_eq!(first(1, 5), first(1, 5));
}

#[test]
fn next_below_is_uniform() {
    let mut xi = Independent::new(9, 0);
    let mut counts = [0_u64; 7];
    for _ in 0..70_000 {
        counts[xi.next_below(7)] += 1;
    }
    assert!(
        chi_square(&counts, &[10_000.0; 7], 5.0).p_value > 0.01,
        "{counts:?}"
    );
    assert_eq!(xi.next_below(0), 0);
    assert_eq!(xi.next_below(1), 0);
}

#[test]
fn stream_ids_tell_indices_apart() {
    let mut ids: Vec<u64> = (0..50)
        .flat_map(|a| (0..50).map(move |b| stream_id(&[a, b])))
        .collect();
    ids.extend((0..50).map(|a| stream_id(&[a])));
    let n = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), n);
    assert_ne!(stream_id(&[]), stream_id(&[0]));
}

#[test]
fn every_kind_stays_in_range_and_integrates() {
    // A product of three linear factors with integral 1; 64 randomisations of 64 points.
    for kind in SequenceKind::ALL {
        let mut means = hairis_instruments::stats::Moments::new();
        for run in 0..64 {
            let mut source = kind.source(7, stream_id(&[run]), 3, 64);
            let mut sum = 0.0;
            for _ in 0..64 {
                let mut p = [0.0; 3];
                source.next_point(&mut p);
                assert!(p.iter().all(|x| (0.0..1.0).contains(x)), "{kind:?} {p:?}");
                sum += p.iter().map(|x| 2.0 * x).product::<f64>();
            }
            means.push(sum / 64.0);
        }
        let e = means.mean_estimate();
        assert!(e.z_score(1.0).abs() < 4.0, "{kind:?} {e:?}");
        let independent = (4.0_f64 / 3.0).powi(3) - 1.0;
        let gain = independent / 64.0 / means.variance();

        match kind {
            SequenceKind::Independent => assert!((0.5..2.0).contains(&gain), "{gain}"),
            // Measured 26 (Halton) and 11 (stratified).
            _ => assert!(gain > 5.0, "{kind:?} {gain}"),
        }
    }
}
