//! Tests of `sequence::halton`.

use hairis_conformance::statistics::{chi_square, ks_p_value, ks_statistic};
use hairis_instruments::sequence::{Halton, XiSource};
use hairis_instruments::stats::Moments;

fn cell(x: f64, cells: u32) -> usize {
    (0..cells as usize)
        .rev()
        .find(|&i| x >= i as f64 / f64::from(cells))
        .unwrap_or(0)
}

#[test]
fn scrambled_points_keep_elementary_intervals() {
    // Every run of 2^2 3^2 5 points has exactly one point in each box of the (4, 9, 5) grid.
    let n = 4 * 9 * 5;
    for stream in 0..20 {
        let mut halton = Halton::new(3, 1, stream);
        for block in 0..3 {
            let mut counts = vec![0; n];
            for _ in 0..n {
                let [x, y, z] = halton.next_xi::<3>();
                counts[(cell(x, 4) * 9 + cell(y, 9)) * 5 + cell(z, 5)] += 1;
            }
            assert!(
                counts.iter().all(|&c| c == 1),
                "stream {stream} block {block}"
            );
        }
    }
}

#[test]
fn one_point_is_uniform_over_randomisations() {
    for dim in 0..6 {
        for index in [0, 1, 77, u64::MAX] {
            let mut s: Vec<f64> = (0..20_000)
                .map(|stream| Halton::new(6, 3, stream).coordinate(dim, index))
                .collect();
            let d = ks_statistic(&mut s, |x| x);
            // 24 tests in all: Sidak at 1%.
            assert!(
                ks_p_value(d, s.len()) > hairis_instruments::stats::sidak(0.01, 24),
                "dim {dim} index {index}: {d}"
            );
        }
    }
}

#[test]
fn two_points_fall_as_a_random_permutation_would_have_them() {
    // Points 0 and 1 in base 5: their first digits are a uniform ordered pair of distinct digits, twenty cells.
    let mut counts = vec![0_u64; 25];
    for stream in 0..40_000 {
        let h = Halton::new(3, 8, stream);
        counts[cell(h.coordinate(2, 0), 5) * 5 + cell(h.coordinate(2, 1), 5)] += 1;
    }
    let expected: Vec<f64> = (0..25)
        .map(|i| if i % 6 == 0 { 0.0 } else { 2_000.0 })
        .collect();
    let p = chi_square(&counts, &expected, 5.0).p_value;
    assert!(p > 0.01, "p {p}");
}

#[test]
fn star_discrepancy_beats_random() {
    // Measured on the anchored boxes of a 32 x 32 grid: for n = 1024, random points are near 0.03, Halton points near 0.004.
    let mut worst = Moments::new();
    for stream in 0..10 {
        let mut halton = Halton::new(2, 5, stream);
        let points: Vec<[f64; 2]> = (0..1_024).map(|_| halton.next_xi::<2>()).collect();
        let mut d = 0.0_f64;
        for i in 1..=32 {
            for j in 1..=32 {
                let (x, y) = (f64::from(i) / 32.0, f64::from(j) / 32.0);
                let inside = points.iter().filter(|p| p[0] < x && p[1] < y).count();
                d = d.max((inside as f64 / 1_024.0 - x * y).abs());
            }
        }
        worst.push(d);
    }

    assert!(worst.mean() < 0.01, "{}", worst.mean());
}
