//! Tests of `sequence::stratified`.

use hairis_conformance::statistics::{ks_p_value, ks_statistic};
use hairis_instruments::sequence::{Stratified, XiSource, strata};

#[test]
fn strata_multiply_to_the_number_of_samples() {
    assert_eq!(strata(16, 2), [4, 4]);
    assert_eq!(strata(32, 2), [8, 4]);
    assert_eq!(strata(64, 3), [4, 4, 4]);
    assert_eq!(strata(17, 2), [17, 1]);
    assert_eq!(strata(0, 2), [1, 1]);
    for n in 1..200 {
        for dims in 1..4 {
            assert_eq!(
                strata(n, dims).iter().product::<usize>(),
                n,
                "{n} in {dims}"
            );
        }
    }
}

#[test]
fn each_cell_holds_one_point_of_each_pass() {
    let mut source = Stratified::new(&[4, 3, 2], 1, 2);
    let mut orders = Vec::new();
    for pass in 0..5 {
        let mut counts = [0; 24];
        let mut order = Vec::new();
        for _ in 0..24 {
            let [x, y, z] = source.next_xi::<3>();
            let cell = |x: f64, n: usize| {
                (0..n)
                    .rev()
                    .find(|&i| x >= i as f64 / n as f64)
                    .unwrap_or(0)
            };
            let c = (cell(z, 2) * 3 + cell(y, 3)) * 4 + cell(x, 4);
            counts[c] += 1;
            order.push(c);
        }
        assert!(counts.iter().all(|&c| c == 1), "pass {pass}");
        orders.push(order);
    }
    assert_ne!(orders[0], orders[1], "each pass is shuffled anew");
}

#[test]
fn the_first_point_is_uniform_over_randomisations() {
    let mut s: Vec<f64> = (0..20_000)
        .map(|stream| Stratified::new(&[4, 4], 6, stream).next_xi::<2>()[1])
        .collect();
    let d = ks_statistic(&mut s, |x| x);
    assert!(ks_p_value(d, s.len()) > 0.01, "distance {d}");
}
