//! Claims of the paper: quotations, figures, and the verdict that follows from the figures.

use super::bounded::Bounded;
use serde::Serialize;

/// Number of standard errors that a sampled figure must keep from the threshold.
const ERRORS: f64 = 2.0;

/// Origin of a figure, and the meaning of its error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// Integral in double precision; the error is a bound estimate.
    Quadrature,
    /// Mean of random samples; the error is the standard error.
    Sampled,
    /// Combination of samples and of times measured on this machine; the error is the standard error. Depends on the machine as well as on
    /// the seed.
    Timed,
    /// Number of cells that were counted, without an error.
    Counted,
}

impl Origin {
    /// Returns the name of the origin in tables.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Quadrature => "quadrature",
            Self::Sampled => "samples",
            Self::Timed => "samples and times",
            Self::Counted => "counted",
        }
    }
}

/// Role of a figure in the verdict on its claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Worst of all cases that the claim is made for.
    Everywhere,
    /// Worst of the cases within the limits of the [`Threshold`].
    WithinLimits,
    /// Explanation that does not decide.
    Further,
}

/// Number with its error and its meaning.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Meaning of the number, in words.
    pub name: String,
    /// Value of the figure.
    pub value: f64,
    /// Standard error or, by quadrature, a bound estimate of the error; in the unit of the value.
    pub error: f64,
    /// Unit of value and error, empty for ratios and shares.
    pub unit: &'static str,
    /// Origin of the number.
    pub origin: Origin,
    /// Role of the figure in the verdict.
    pub role: Role,
}

impl Figure {
    /// Returns a figure without a unit that explains but does not decide.
    pub fn new(name: impl Into<String>, origin: Origin, number: impl Into<Bounded>) -> Self {
        let Bounded { value, error } = number.into();
        Self {
            name: name.into(),
            value,
            error,
            unit: "",
            origin,
            role: Role::Further,
        }
    }

    /// Returns one figure by quadrature for each named number.
    pub(super) fn integrals<const N: usize>(named: [(&str, Bounded); N]) -> Vec<Self> {
        named
            .map(|(name, number)| Self::new(name, Origin::Quadrature, number))
            .into()
    }

    /// Returns a figure that counts cells.
    pub(super) fn cells(name: &str, count: usize) -> Self {
        Self {
            unit: "cells",
            ..Self::new(name, Origin::Counted, Bounded::exact(count as f64))
        }
    }

    /// Returns a bound on the distance of the true value from the figure.
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
    /// Claim holds at the bound and below.
    AtMost,
    /// Claim holds at the bound and above.
    AtLeast,
}

/// Threshold that the deciding figures of a claim must keep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Threshold {
    /// Quantity that is bounded, in words.
    pub of: &'static str,
    /// Side of the bound on which the claim holds.
    pub side: Side,
    /// Bound, in the unit of the figures with a [`Role`] in the verdict.
    pub bound: f64,
    /// Limits, in words, within which the second of those figures is the worst.
    pub limits: &'static str,
}

impl Threshold {
    /// Returns true if a figure keeps the threshold with its error to spare: two standard errors, or the error of the quadrature. NaN does
    /// not keep it.
    #[must_use]
    pub fn is_kept_by(&self, figure: &Figure) -> bool {
        match self.side {
            Side::AtMost => figure.value + figure.margin() <= self.bound,
            Side::AtLeast => figure.value - figure.margin() >= self.bound,
        }
    }
}

/// Verdict on a claim, as its two deciding figures give it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// Claim whose worst of all cases keeps the threshold.
    #[serde(rename = "holds")]
    Holds,
    /// Claim that fails somewhere, but whose worst case within the stated limits keeps the threshold.
    #[serde(rename = "holds within limits")]
    HoldsWithinLimits,
    /// Claim of which neither figure keeps the threshold.
    #[serde(rename = "false")]
    False,
}

impl Verdict {
    /// Returns the name of the verdict in tables and in JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsWithinLimits => "holds within limits",
            Self::False => "false",
        }
    }
}

/// Claim to be judged: the words of the paper, and the threshold that decides.
#[derive(Clone, Copy, Debug)]
pub struct Statement {
    /// Name of the claim.
    pub id: &'static str,
    /// Words of the paper.
    pub quotation: &'static str,
    /// Section of the paper.
    pub source: &'static str,
    /// Quantity that is bounded, in words.
    pub of: &'static str,
    /// Side of the bound on which the claim holds.
    pub side: Side,
    /// Bound.
    pub bound: f64,
    /// Limits within which the claim may hold, in words.
    pub limits: &'static str,
}

impl Statement {
    /// Returns the claim with the verdict that follows from its first two figures: the worst of all cases, and the worst within the limits.
    #[must_use]
    pub fn judge(self, mut figures: Vec<Figure>, sentence: String) -> Claim {
        let Self {
            id,
            quotation,
            source,
            of,
            side,
            bound,
            limits,
        } = self;
        let threshold = Threshold {
            of,
            side,
            bound,
            limits,
        };
        let is_kept = |place: usize| {
            figures
                .get(place)
                .is_some_and(|figure| threshold.is_kept_by(figure))
        };
        let verdict = match [is_kept(0), is_kept(1)] {
            [true, _] => Verdict::Holds,
            [false, true] => Verdict::HoldsWithinLimits,
            [false, false] => Verdict::False,
        };
        for (figure, role) in figures
            .iter_mut()
            .zip([Role::Everywhere, Role::WithinLimits])
        {
            figure.role = role;
        }
        Claim {
            id,
            quotation,
            source,
            figures,
            threshold,
            verdict,
            sentence,
        }
    }
}

/// Claim of the paper, with its figures and its verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Name of the claim, for scripts.
    pub id: &'static str,
    /// Quotation from the paper, or its formula.
    pub quotation: &'static str,
    /// Section of the paper that the quotation is from.
    pub source: &'static str,
    /// Worst of all cases, worst within the limits of the threshold, and further figures.
    pub figures: Vec<Figure>,
    /// Threshold of the first two figures.
    pub threshold: Threshold,
    /// Verdict that follows from figures and threshold.
    pub verdict: Verdict,
    /// Summary of the figures in a sentence.
    pub sentence: String,
}
