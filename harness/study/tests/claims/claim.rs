//! Claims and verdicts.

use hairis_study::claims::bounded::Bounded;
use hairis_study::claims::claim::*;

fn number(value: f64, error: f64) -> Figure {
    Figure::new("a number", Origin::Quadrature, Bounded { value, error })
}

fn verdict(side: Side, figures: [Figure; 2]) -> Verdict {
    let (quotation, source, of) = ("words", "section", "a number");
    let statement = Statement {
        id: "id",
        quotation,
        source,
        of,
        side,
        bound: 1.0,
        limits: "here",
    };
    statement.judge(figures.into(), String::new()).verdict
}

#[test]
fn figures_decide() {
    let [small, large, nan] = [0.5, 1.5, f64::NAN].map(|value| number(value, 0.0));
    for (side, good, bad) in [
        (Side::AtMost, &small, &large),
        (Side::AtLeast, &large, &small),
    ] {
        assert_eq!(verdict(side, [good.clone(), good.clone()]), Verdict::Holds);
        assert_eq!(
            verdict(side, [bad.clone(), good.clone()]),
            Verdict::HoldsWithinLimits
        );
        assert_eq!(verdict(side, [bad.clone(), bad.clone()]), Verdict::False);
        assert_eq!(
            verdict(side, [nan.clone(), nan.clone()]),
            Verdict::False,
            "no number keeps nothing"
        );
    }
}

#[test]
fn what_is_unsure_is_not_kept() {
    let of = |error: f64| number(0.9, error);
    assert_eq!(verdict(Side::AtMost, [of(0.05), of(0.05)]), Verdict::Holds);
    assert_eq!(
        verdict(Side::AtMost, [of(0.2), of(0.05)]),
        Verdict::HoldsWithinLimits
    );
    let sampled = Figure {
        origin: Origin::Sampled,
        ..of(0.07)
    };
    assert_eq!(
        verdict(Side::AtMost, [sampled.clone(), sampled]),
        Verdict::False,
        "within two standard errors"
    );
}
