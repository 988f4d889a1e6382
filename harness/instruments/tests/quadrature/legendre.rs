//! Tests of `quadrature::legendre`.

use hairis_instruments::quadrature::GaussLegendre;

#[test]
fn nodes_of_order_five_match_the_closed_form() {
    let rule = GaussLegendre::new(5);
    let inner = (5.0 - 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let outer = (5.0 + 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let r = 13.0 * 70.0_f64.sqrt();
    let want = [
        [-outer, (322.0 - r) / 900.0],
        [-inner, (322.0 + r) / 900.0],
        [0.0, 128.0 / 225.0],
        [inner, (322.0 + r) / 900.0],
        [outer, (322.0 - r) / 900.0],
    ];
    for (got, want) in rule.nodes().iter().zip(want) {
        assert!(
            (got[0] - want[0]).abs() < 4e-16 && (got[1] - want[1]).abs() < 4e-16,
            "{got:?} {want:?}"
        );
    }
}

#[test]
fn rules_are_exact_to_their_degree() {
    for n in [1, 2, 3, 4, 7, 16, 33, 64, 200] {
        let rule = GaussLegendre::new(n);
        assert_eq!(rule.nodes().len(), n);
        let total: f64 = rule.nodes().iter().map(|x| x[1]).sum();
        assert!((total - 2.0).abs() < 1e-13, "order {n}: {total}");
        let degree = i32::try_from(2 * n - 1).expect("small");
        let got: f64 = rule.on(0.0, 1.0).map(|[x, w]| w * x.powi(degree)).sum();
        assert!(
            (got * f64::from(degree + 1) - 1.0).abs() < 1e-12,
            "order {n}: {got}"
        );
    }
    assert_eq!(GaussLegendre::new(0).nodes(), [[0.0, 2.0]]);
}
