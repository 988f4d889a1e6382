//! Claims: words of the paper, figures, and the verdict that follows from the figures.

use crate::stats::Estimate;
use serde::Serialize;

/// Standard errors that a sampled figure must keep from the threshold.
const ERRORS: f64 = 2.0;

/// Origin of a figure, and the meaning of its error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// An integral in double precision; the error is a bound estimate.
    Quadrature,
    /// Random samples; the error is the standard error.
    Sampled,
    /// Times measured on this machine besides; the error is the standard error. It does not depend on the seed alone.
    Timed,
    /// Counted, without an error.
    Counted,
}

impl Origin {
    /// Name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quadrature => "quadrature",
            Self::Sampled => "samples",
            Self::Timed => "samples and times",
            Self::Counted => "counted",
        }
    }
}

/// Role of a figure in the verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// The worst of all cases the claim is made for.
    Everywhere,
    /// The same within the limits of the [`Threshold`].
    WithinLimits,
    /// Explains; does not decide.
    Further,
}

/// A number with its error and its meaning.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Its meaning.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Its standard error or, by quadrature, a bound estimate of its error; in the unit of the value.
    pub error: f64,
    /// Its unit; empty for ratios and shares.
    pub unit: &'static str,
    /// Its origin.
    pub origin: Origin,
    /// Its role in the verdict.
    pub role: Role,
}

impl Figure {
    /// A figure by quadrature.
    pub(super) fn integral(name: impl Into<String>, of: Bounded, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            value: of.value,
            error: of.error,
            unit,
            origin: Origin::Quadrature,
            role: Role::Further,
        }
    }

    /// A figure from samples.
    pub(super) fn sampled(name: impl Into<String>, of: Estimate, unit: &'static str) -> Self {
        let Estimate { value, standard_error: error } = of;
        Self { name: name.into(), value, error, unit, origin: Origin::Sampled, role: Role::Further }
    }

    /// A figure that is a number of things.
    pub(super) fn count(name: impl Into<String>, of: usize, unit: &'static str) -> Self {
        let value = of as f64;
        Self { name: name.into(), value, error: 0.0, unit, origin: Origin::Counted, role: Role::Further }
    }

    /// The same from another origin.
    pub(super) fn by(self, origin: Origin) -> Self {
        Self { origin, ..self }
    }

    /// Bound on the distance of the true value from the figure.
    fn margin(&self) -> f64 {
        match self.origin {
            Origin::Sampled | Origin::Timed => ERRORS * self.error,
            Origin::Quadrature | Origin::Counted => self.error,
        }
    }
}

/// Side of the bound on which a claim holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// At most the bound.
    AtMost,
    /// At least the bound.
    AtLeast,
}

/// Threshold for the figures of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Threshold {
    /// The bounded quantity.
    pub of: &'static str,
    /// The side of it on which the claim holds.
    pub side: Side,
    /// The bound, in the unit of the figures with a [`Role`] in the verdict.
    pub bound: f64,
    /// Limits within which the second of those figures is the worst, in words.
    pub limits: &'static str,
}

impl Threshold {
    /// Whether a figure keeps it with its error to spare: two standard errors, or the error of the quadrature. What is
    /// no number does not.
    #[must_use]
    pub fn is_kept_by(&self, figure: &Figure) -> bool {
        match self.side {
            Side::AtMost => figure.value + figure.margin() <= self.bound,
            Side::AtLeast => figure.value - figure.margin() >= self.bound,
        }
    }
}

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// The worst of all cases keeps the threshold.
    #[serde(rename = "holds")]
    Holds,
    /// It does not, but the worst within the stated limits does.
    #[serde(rename = "holds within limits")]
    HoldsWithinLimits,
    /// Neither does.
    #[serde(rename = "false")]
    False,
}

impl Verdict {
    /// Name in tables and in JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsWithinLimits => "holds within limits",
            Self::False => "false",
        }
    }
}

/// The words of the paper.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words {
    pub(super) id: &'static str,
    pub(super) quotation: &'static str,
    pub(super) source: &'static str,
}

/// A claim of the paper, and its verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Name of the claim, for scripts.
    pub id: String,
    /// The words of the paper, or its formula.
    pub quotation: &'static str,
    /// The section they are in.
    pub source: &'static str,
    /// The worst of all cases, the worst within the limits of the threshold, and further figures.
    pub figures: Vec<Figure>,
    /// The threshold of the first two.
    pub threshold: Threshold,
    /// The verdict.
    pub verdict: Verdict,
    /// Summary in a sentence.
    pub sentence: String,
}

impl Claim {
    /// The claim with the verdict that follows from its first two figures.
    pub(super) fn judge(
        words: Words,
        threshold: Threshold,
        [everywhere, within]: [Figure; 2],
        further: Vec<Figure>,
        sentence: String,
    ) -> Self {
        let verdict = if threshold.is_kept_by(&everywhere) {
            Verdict::Holds
        } else if threshold.is_kept_by(&within) {
            Verdict::HoldsWithinLimits
        } else {
            Verdict::False
        };
        let deciding = [Figure { role: Role::Everywhere, ..everywhere }, Figure { role: Role::WithinLimits, ..within }];
        Self {
            id: words.id.to_owned(),
            quotation: words.quotation,
            source: words.source,
            figures: deciding.into_iter().chain(further).collect(),
            threshold,
            verdict,
            sentence,
        }
    }

    /// The figure of this name.
    #[must_use]
    pub fn figure(&self, name: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.name == name)
    }
}

/// A number and a bound estimate of its error; arithmetic carries the error to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounded {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Bounded {
    pub(super) fn times(self, other: Self) -> Self {
        let error = (self.value * other.error).abs() + (other.value * self.error).abs();
        Self { value: self.value * other.value, error }
    }

    pub(super) fn over(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, error: (self.error + (value * other.error).abs()) / other.value.abs() }
    }

    pub(super) fn plus(self, exact: f64) -> Self {
        Self { value: self.value + exact, ..self }
    }

    pub(super) fn magnitude(self) -> Self {
        Self { value: self.value.abs(), ..self }
    }
}

/// The first of the largest; no number if there is none.
pub(super) fn largest(of: impl IntoIterator<Item = Bounded>) -> Bounded {
    let none = Bounded { value: f64::NAN, error: f64::NAN };
    of.into_iter().fold(none, |most, next| if next.value <= most.value { most } else { next })
}

/// The first of the smallest; no number if there is none.
pub(super) fn smallest(of: impl IntoIterator<Item = Bounded>) -> Bounded {
    let none = Bounded { value: f64::NAN, error: f64::NAN };
    of.into_iter().fold(none, |least, next| if next.value >= least.value { least } else { next })
}

/// Geometric mean.
pub(super) fn geometric_mean(of: impl IntoIterator<Item = Bounded>) -> Bounded {
    let (mut sum, mut error, mut n) = (0.0, 0.0, 0.0);
    for Bounded { value, error: of } in of {
        sum += value.ln();
        error += of / value;
        n += 1.0;
    }
    let value = f64::exp(sum / n);
    Bounded { value, error: value * error / n }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(value: f64, error: f64) -> Figure {
        Figure::integral("a number", Bounded { value, error }, "")
    }

    fn verdict(side: Side, figures: [Figure; 2]) -> Verdict {
        let words = Words { id: "id", quotation: "words", source: "section" };
        let threshold = Threshold { of: "a number", side, bound: 1.0, limits: "here" };
        Claim::judge(words, threshold, figures, Vec::new(), String::new()).verdict
    }

    #[test]
    fn figures_decide() {
        let [small, large, nan] = [0.5, 1.5, f64::NAN].map(|value| number(value, 0.0));
        for (side, good, bad) in [(Side::AtMost, &small, &large), (Side::AtLeast, &large, &small)] {
            assert_eq!(verdict(side, [good.clone(), good.clone()]), Verdict::Holds);
            assert_eq!(verdict(side, [bad.clone(), good.clone()]), Verdict::HoldsWithinLimits);
            assert_eq!(verdict(side, [bad.clone(), bad.clone()]), Verdict::False);
            assert_eq!(verdict(side, [nan.clone(), nan.clone()]), Verdict::False, "no number keeps nothing");
        }
    }

    #[test]
    fn what_is_unsure_is_not_kept() {
        let of = |error: f64| number(0.9, error);
        assert_eq!(verdict(Side::AtMost, [of(0.05), of(0.05)]), Verdict::Holds);
        assert_eq!(verdict(Side::AtMost, [of(0.2), of(0.05)]), Verdict::HoldsWithinLimits);
        let sampled = of(0.07).by(Origin::Sampled);
        assert_eq!(verdict(Side::AtMost, [sampled.clone(), sampled]), Verdict::False, "within two standard errors");
    }

    #[test]
    fn errors_are_carried() {
        let [a, b] = [(6.0, 0.3), (2.0, 0.1)].map(|(value, error)| Bounded { value, error });
        let near = |got: Bounded, value: f64, error: f64| {
            assert!((got.value - value).abs() < 1e-12 && (got.error - error).abs() < 1e-12, "{got:?}");
        };
        near(a.times(b), 12.0, 1.2);
        near(a.over(b), 3.0, 0.3);
        near(b.plus(-5.0).magnitude(), 3.0, 0.1);
        near(geometric_mean([Bounded { value: 2.0, error: 0.02 }, Bounded { value: 8.0, error: 0.08 }]), 4.0, 0.04);
        assert_eq!([largest([b, a]), smallest([a, b])], [a, b]);
        assert!(largest([]).value.is_nan(), "of nothing");
    }
}
