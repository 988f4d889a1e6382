//! Wider tails: the cost of sampling a Gaussian factor from a Cauchy distribution of the same width.

use super::bounded::{Bounded, Spread, integrals};
use super::claim::{Claim, Figure, Side, Statement};
use super::hair::{Longitudinal, longitudinal_grid, theta_h_interval};
use core::f64::consts::PI;
use hairis_reference::Shape;

const STATEMENT: Statement = Statement {
    id: "wider-tails",
    quotation: "The fact that cauchy distributions have wider tails than gaussian guarantees that using cauchy to \
                approximate the gaussian in importance sampling will not increase variance.",
    source: "section 3.2",
    of: "relative variance that one factor adds to exact sampling",
    side: Side::AtMost,
    bound: 1e-6,
    limits: "the longitudinal factor of the parameter grid that suffers least",
};

/// Half the length, in widths, of the interval that stands for the infinite line. A Gaussian beyond it is below double precision.
pub const REACH: f64 = 40.0;

/// Returns `(integral of c) (integral of g^2 / c) / (integral of g)^2 - 1` over an interval, for bells of one width and centre.
pub fn added(alpha: f64, beta: f64, interval: [f64; 2], cauchy_area: Option<f64>) -> Bounded {
    let integrand = |x: f64| {
        let [g, c] = [Shape::Gaussian, Shape::Cauchy].map(|shape| shape.bell(beta, x - alpha));
        [g, g * g / c, c]
    };
    let [gaussian, weighted, cauchy] = integrals(integrand, &interval, alpha, beta);
    let area = cauchy_area.map_or(cauchy, Bounded::exact);
    area.times(weighted)
        .over(gaussian.times(gaussian))
        .plus(-1.0)
}

/// Returns the largest ratio of a Gaussian to a Cauchy, both of peak 1.
pub fn largest_weight() -> f64 {
    let weight = |x: f64| Shape::Gaussian.bell(1.0, x) / Shape::Cauchy.bell(1.0, x);
    (0..=8_000)
        .map(|n| weight(f64::from(n) / 1_000.0))
        .fold(0.0, f64::max)
}

/// Judges the claim about wider tails.
pub(super) fn claim() -> Claim {
    let of_lobe = |l: Longitudinal| added(l.alpha, l.beta, theta_h_interval(l.theta_o), None);
    let Spread { most, least, .. } = longitudinal_grid().into_iter().map(of_lobe).collect();
    let line = added(0.0, 1.0, [-REACH, REACH], Some(PI));
    let both = line.plus(1.0).times(line.plus(1.0)).plus(-1.0);
    let weight = Bounded {
        value: largest_weight(),
        error: 1e-7,
    };
    let in_means = weight.times(Bounded::exact(PI / (2.0 * PI).sqrt()));
    let sentence = format!(
        "Wider tails bound the weight, by {:.4} (bells of peak 1), but the shape still differs: each Gaussian factor adds \
         a relative variance of {:.3} on the line, {:.3} to {:.2} on the grid's intervals.",
        weight.value, line.value, least.value, most.value
    );
    let figures = Figure::integrals([
        ("added variance, most on the grid", most),
        ("added variance, least on the grid", least),
        ("added variance of a factor on the line", line),
        ("added variance of two factors on the line", both),
        ("largest Gaussian over Cauchy", weight),
        ("largest weight of a factor on the line, in means", in_means),
    ]);
    STATEMENT.judge(figures, sentence)
}
