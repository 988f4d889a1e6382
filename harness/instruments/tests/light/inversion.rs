//! Tests of `light::inversion`.

use hairis_instruments::light::inversion::{cell, guide, search};
use hairis_instruments::sequence::Independent;

#[test]
fn guided_searches_find_what_bisection_finds() {
    let mut xi = Independent::new(11, 0);
    for length in [1, 2, 3, 100, 1024] {
        for kind in 0..4 {
            let mut sum = 0.0;
            let weight = |xi: &mut Independent| match kind {
                0 => 1.0,
                1 => xi.next_f64().powi(20),
                2 if xi.next_f64() < 0.9 => 0.0,
                2 => 1.0,
                _ => 1.0 / 3.0,
            };
            let cumulative: Vec<f64> = (0..length)
                .map(|_| {
                    sum += weight(&mut xi);
                    sum
                })
                .collect();
            if sum == 0.0 {
                continue;
            }
            let guide: Vec<u32> = guide(&cumulative).collect();
            let edges = (0..=length)
                .map(|k| f64::from(k) / f64::from(length))
                .chain([f64::EPSILON, 1.0 - f64::EPSILON]);
            for xi in edges.chain((0..1000).map(|_| xi.next_f64())) {
                let xi = xi.min(1.0 - f64::EPSILON / 2.0);
                let target = (xi * sum).min(sum * (1.0 - f64::EPSILON / 2.0));
                let expected = cumulative
                    .partition_point(|c| *c <= target)
                    .min(cumulative.len() - 1);
                let start = |guide: &[u32]| {
                    let index = guide[cell(xi, guide.len())] as usize;
                    (index, cumulative[index])
                };
                assert_eq!(
                    search(&cumulative, sum, start(&guide), xi).0,
                    expected,
                    "{length} of kind {kind} at {xi}"
                );
            }
        }
    }
}
