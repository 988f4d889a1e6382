//! Comparison of results with the formulas: where the bounds of [`Accuracy`] apply, and errors beyond those that a model allows by design.

use crate::Accuracy;
use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// Least angle to the axis, in rad, at which the bounds apply.
pub const AXIS: f64 = 1e-3;
/// Distance from pi/2, rad, within which a rounded `|phi|` may fall on either side of the cut of the glints' density.
const CUT: f64 = 1e-6;
/// Distance of `|phi|` from pi, rad, within which the formulas have lost the digits of `cos(phi / 2)`: a double at pi is good to 4e-16.
const SEAM: f64 = 1e-9;

/// Returns the angle of a direction to the axis of the fibre, in `[0, pi/2]` rad.
#[must_use]
pub fn from_axis([u, v, w]: [f64; 3]) -> f64 {
    v.hypot(w).atan2(u.abs())
}

/// Returns the azimuth of `wo` relative to that of `wi`, in `[-pi, pi]` rad.
#[must_use]
pub fn azimuth_between(wo: [f64; 3], wi: [f64; 3]) -> f64 {
    let turn = wo[2].atan2(wo[1]) - wi[2].atan2(wi[1]);
    turn - TAU * (turn / TAU).round()
}

/// Returns true if the bounds apply to `wi`, seen from `wo`: further than [`AXIS`] from the axis, off the cut of the glints (ERRATA E3), and
/// not so close to pi that the formulas fail.
#[must_use]
pub fn is_bounded(wo: [f64; 3], wi: [f64; 3]) -> bool {
    let phi = azimuth_between(wo, wi).abs();
    from_axis(wi) > AXIS && (phi - FRAC_PI_2).abs() > CUT && PI - phi > SEAM
}

/// Returns the relative error in excess of an absolute error of `slack`. NaN counts as infinite.
#[must_use]
pub fn relative_excess(got: f32, want: f64, slack: f64) -> f64 {
    let excess = (f64::from(got) - want).abs() - slack;
    if excess <= 0.0 {
        0.0
    } else if excess.is_finite() {
        excess / want
    } else {
        f64::INFINITY
    }
}

/// Returns the distance of a cdf from the numbers that it should return. Azimuths are on a circle of length 1, because both ends of the
/// cosines' cdf are one direction.
#[must_use]
pub fn cdf_distance(cdf: [f64; 2], xi: [f32; 3]) -> f64 {
    let off = |k: usize| (cdf[k] - f64::from(xi[k + 1])).abs();
    off(0).max(off(1).min((1.0 - off(1)).abs()))
}

impl Accuracy {
    /// Returns the absolute error of the density that the model allows by design, given that of S by channel. A density proportional to
    /// S, as the mean of RGB, vanishes with S.
    #[must_use]
    pub fn pdf_slack(&self, value: [f64; 3], pdf: f64, slack: [f64; 3]) -> f64 {
        if !self.slack_in_pdf || slack == [0.0; 3] {
            return 0.0;
        }
        let [slack, value] = [slack, value].map(|rgb| rgb.iter().sum::<f64>());
        // If S is too small for a double, the whole density is allowed as error.
        let share = if value > 0.0 { slack / value } else { 1.0 };
        share * pdf
    }
}
