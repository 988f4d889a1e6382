//! Tests of `plot::axis`.

use hairis_instruments::plot::Axis;

fn labels(axis: &Axis, values: &[f64]) -> Vec<String> {
    axis.clone()
        .fit(values, 0.0, 500.0)
        .ticks()
        .into_iter()
        .filter_map(|tick| tick.1)
        .collect()
}

#[test]
fn labels_are_round_numbers() {
    assert_eq!(
        labels(&Axis::linear("x"), &[0.0, 0.93]),
        ["0.0", "0.2", "0.4", "0.6", "0.8"],
        "fifths"
    );
    assert_eq!(
        labels(&Axis::linear("x").range(-90.0, 90.0).step(45.0), &[]),
        ["−90", "−45", "0", "45", "90"],
        "given"
    );
    assert_eq!(
        labels(&Axis::log("x"), &[1.0, 1e5]),
        ["1", "10", "100", "1000", "10⁴", "10⁵"],
        "decades"
    );
}

#[test]
fn any_data_gives_a_usable_axis() {
    let odd = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.0,
        -1.0,
        1e308,
        -1e308,
        1e-308,
        5e-324,
    ];
    for axis in [
        Axis::linear("x"),
        Axis::log("x"),
        Axis::log("x").range(0.0, 1.0),
    ] {
        for n in 0..odd.len() {
            let fitted = axis.clone().fit(&odd[n..], 10.0, 90.0);
            let [low, high] = fitted.ends();
            assert!(
                low < high && (high - low).is_finite(),
                "{axis:?} {fitted:?}"
            );
            for value in odd {
                assert!(
                    value.is_nan() || fitted.pixel(value).is_finite(),
                    "{value} {fitted:?}"
                );
            }
            assert!(fitted.ticks().len() < 400, "{fitted:?}");
        }
    }
}
