//! Bounded samples.

use hairis_study::claims::bounded::*;

#[test]
fn errors_are_carried() {
    let [a, b] = [(6.0, 0.3), (2.0, 0.1)].map(|(value, error)| Bounded { value, error });
    let near = |got: Bounded, value: f64, error: f64| {
        assert!(
            (got.value - value).abs() < 1e-12 && (got.error - error).abs() < 1e-12,
            "{got:?}"
        );
    };
    near(a.times(b), 12.0, 1.2);
    near(a.over(b), 3.0, 0.3);
    near(b.plus(-5.0).magnitude(), 3.0, 0.1);
    near([a, b].into_iter().sum(), 8.0, 0.4);
    let four = [
        Bounded {
            value: 2.0,
            error: 0.02,
        },
        Bounded {
            value: 8.0,
            error: 0.08,
        },
    ];
    near(four.into_iter().collect::<Spread>().mean, 4.0, 0.04);
    let Spread { least, most, .. } = [b, a].into_iter().collect();
    assert_eq!([most, least], [a, b]);
    assert!(largest([]).value.is_nan(), "of nothing");
}
