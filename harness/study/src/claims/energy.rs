//! Estimated energies, and how far they are from the integrals that they stand for.

use super::bounded::{Bounded, integrals, largest};
use super::claim::{Claim, Figure, Origin, Side, Statement};
use super::hair::theta_h_interval;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis_reference::Shape;

const STATEMENT: Statement = Statement {
    id: "energy-within-1-percent",
    quotation: "The approximation error is less than 1% for β < 30° and |α| < 20°.",
    source: "section 3.2.3",
    of: "relative error of the longitudinal integral √(2π) β",
    side: Side::AtMost,
    bound: 0.01,
    limits: "θ_o = 0°, β ≤ 10°, |α| ≤ 20°",
};

/// Largest width that the claim covers, in degrees.
const BETA: f64 = 30.0;
/// Largest shift that the claim covers, in degrees.
pub const ALPHA: f64 = 20.0;

/// Inclinations at which the claim is tested, in degrees.
const THETA_O: [f64; 2] = [0.0, 75.0];

/// Widest R, TT or TRT lobe within the limits, in degrees.
const NARROW: f64 = 10.0;

/// Returns the relative error that comes from integrating a Gaussian over the whole line in place of `interval`; all arguments in degrees.
pub fn error(alpha: f64, beta: f64, interval: [f64; 2]) -> Bounded {
    let [alpha, beta] = [alpha, beta].map(f64::to_radians);
    let [r] = integrals(
        |x| [Shape::Gaussian.bell(beta, x - alpha)],
        &interval,
        alpha,
        beta,
    );
    let whole = (2.0 * PI).sqrt() * beta;
    Bounded {
        value: 1.0 - r.value / whole,
        error: f64::EPSILON + r.error / whole,
    }
    .magnitude()
}

/// Returns the largest error over the claimed shifts and the widths up to `beta`, in steps of half a degree.
fn worst(interval: [f64; 2], beta: f64) -> Bounded {
    largest(steps(beta).flat_map(|beta| shifts().map(move |alpha| error(alpha, beta, interval))))
}

/// Returns the widths from half a degree to `most`, in degrees.
fn steps(most: f64) -> impl Iterator<Item = f64> {
    (1..)
        .map(|n| 0.5 * f64::from(n))
        .take_while(move |beta| *beta <= most)
}

/// Returns shifts over the claimed range, in degrees. They include its ends, where the error is largest.
fn shifts() -> impl Iterator<Item = f64> {
    (-4..=4).map(|n| f64::from(n) * ALPHA / 4.0)
}

/// Returns the largest width up to which every lobe, shifted as claimed, is within 1%, in degrees; 0 if none is.
fn widest(interval: [f64; 2]) -> f64 {
    let kept =
        |beta: f64| shifts().all(|alpha| error(alpha, beta, interval).value < STATEMENT.bound);
    steps(BETA)
        .take_while(|beta| kept(*beta))
        .last()
        .unwrap_or(0.0)
}

/// Judges the estimated energies.
pub(super) fn claim() -> Claim {
    let real = THETA_O.map(|theta_o| theta_h_interval(theta_o.to_radians()));
    let seen = real.map(|interval| worst(interval, BETA));
    let widest_lobe = largest(shifts().map(|alpha| error(alpha, BETA, real[1])));
    let limits = real.map(widest);
    let printed = worst([-FRAC_PI_2, FRAC_PI_2], BETA);
    let sentence = format!(
        "That is so if θ_h runs over ±90° ({:.2}%); it runs over ±45° about θ_o/2, where the error reaches {:.0}% seen \
         from 0° and {:.0}% from 75° (a narrow lobe off the sphere); from 0° it stays below 1% for β up to {}°.",
        100.0 * printed.value,
        100.0 * seen[0].value,
        100.0 * seen[1].value,
        limits[0],
    );
    let mut figures = Figure::integrals([
        (
            "largest error in the claimed range, θ_o = 0° and 75°",
            largest(seen),
        ),
        (
            "largest error for β ≤ 10°, θ_o = 0°",
            worst(real[0], NARROW),
        ),
        ("largest error, θ_o = 0°", seen[0]),
        ("largest error, θ_o = 75°", seen[1]),
        ("largest error at β = 30°, θ_o = 75°", widest_lobe),
        ("largest error if θ_h ran over ±90°", printed),
    ]);
    figures.extend(limits.into_iter().zip(THETA_O).map(|(value, theta_o)| {
        let name = format!("widest β for which it holds, θ_o = {theta_o}°");
        Figure {
            unit: "°",
            ..Figure::new(name, Origin::Quadrature, Bounded { value, error: 0.5 })
        }
    }));
    STATEMENT.judge(figures, sentence)
}
