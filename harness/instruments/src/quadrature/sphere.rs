//! Integrals over the sphere of directions, in the coordinates of a fibre.

use super::adaptive::{Integral, Tolerance, bell_breakpoints, integrate_rectangle};
use crate::direction::fibre_direction;
use core::f64::consts::{FRAC_PI_2, PI};
use glam::DVec3;

/// Integrator over all directions, with the measure `d omega = cos theta dtheta dphi`.
///
/// Announce each lobe by `theta_lobe` and `phi_lobe`, or each edge by a plain breakpoint. Widths down to 0.01 rad and far below are
/// then resolved to the tolerance. The poles are never evaluated.
///
/// # Examples
/// ```
/// use hairis_instruments::quadrature::SphereIntegrator;
/// let r = SphereIntegrator::new().integrate(|_, _| [1.0]);
/// assert!(r.converged && (r.value[0] - 4.0 * core::f64::consts::PI).abs() < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct SphereIntegrator {
    theta: Vec<f64>,
    phi: Vec<f64>,
    /// Tolerance of the integrals.
    pub tolerance: Tolerance,
}

impl Default for SphereIntegrator {
    fn default() -> Self {
        Self::new()
    }
}

impl SphereIntegrator {
    /// Makes an integrator with a relative tolerance of 1e-8 and without breakpoints of lobes.
    #[must_use]
    pub fn new() -> Self {
        Self {
            theta: vec![-FRAC_PI_2, 0.0, FRAC_PI_2],
            phi: vec![-PI, -FRAC_PI_2, 0.0, FRAC_PI_2, PI],
            tolerance: Tolerance::relative(1e-8),
        }
    }

    /// Sets the tolerance of the integrals.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: Tolerance) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Adds a breakpoint in `theta`, in rad; a breakpoint outside (-pi/2, pi/2) is dropped.
    #[must_use]
    pub fn theta_break(mut self, theta: f64) -> Self {
        if theta.abs() < FRAC_PI_2 {
            self.theta.push(theta);
        }
        self
    }

    /// Adds a breakpoint in `phi`, in rad, wrapped to [-pi, pi]; a breakpoint that is not finite is dropped.
    #[must_use]
    pub fn phi_break(mut self, phi: f64) -> Self {
        if phi.is_finite() {
            self.phi.push(phi - 2.0 * PI * (phi / (2.0 * PI)).round());
        }
        self
    }

    /// Adds the breakpoints of a bell in `theta`: its centre, and 3 and 12 widths to either side, in rad.
    ///
    /// A bell of width `beta` in `theta_h = (theta_i + theta_o)/2` has the width `2 beta` in `theta_i`, about `2 alpha - theta_o`.
    #[must_use]
    pub fn theta_lobe(self, centre: f64, width: f64) -> Self {
        bell_breakpoints(0.0, width)
            .into_iter()
            .fold(self, |q, d| q.theta_break(centre + d))
    }

    /// Adds the breakpoints of a bell in `phi`: its centre, and 3 and 12 widths to either side, in rad and wrapped.
    #[must_use]
    pub fn phi_lobe(self, centre: f64, width: f64) -> Self {
        // Beyond half a turn, the wrapped tails would only cut the circle into more panels.
        bell_breakpoints(0.0, width)
            .into_iter()
            .filter(|d| d.abs() < PI)
            .fold(self, |q, d| q.phi_break(centre + d))
    }

    /// Integrates `f(theta, phi)`, a function per steradian, over the sphere. The cosine of the measure is applied here.
    pub fn integrate<const N: usize>(
        &self,
        mut f: impl FnMut(f64, f64) -> [f64; N],
    ) -> Integral<N> {
        let integrand = |theta: f64, phi| f(theta, phi).map(|v| v * theta.cos());
        integrate_rectangle(integrand, &self.theta, &self.phi, &self.tolerance)
    }

    /// Integrates a function of direction, per steradian, over the sphere.
    pub fn integrate_direction<const N: usize>(
        &self,
        mut f: impl FnMut(DVec3) -> [f64; N],
    ) -> Integral<N> {
        self.integrate(|theta, phi| f(fibre_direction(theta, phi)))
    }
}
