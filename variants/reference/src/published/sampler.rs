//! The published sampler: sections 3.2.1 to 3.2.3 and appendices A to D.

use super::{HairReference, cos_half};
use crate::real::Real;
use hairis::Lobe;

impl<T: Real> HairReference<T> {
    /// Draws a direction from one lobe alone by two uniform numbers; nothing is discarded.
    #[inline]
    #[must_use]
    pub fn sample_lobe(&self, lobe: Lobe, xi_theta: T, xi_phi: T) -> [T; 3] {
        self.direction(
            self.sample_theta(lobe, xi_theta),
            self.sample_phi(lobe, xi_phi),
        )
    }

    /// Draws `theta_i = 2 beta tan(xi (A - B) + B) + 2 alpha - theta_o` from a lobe, after section 3.2.1, appendix A and ERRATA E1.
    #[inline]
    #[must_use]
    pub fn sample_theta(&self, lobe: Lobe, xi: T) -> T {
        T::from_f64(2.0) * self.longitudinal[lobe].sample(xi) - self.theta_o
    }

    /// Returns the density of `theta_i`, per radian: the paper's `p(theta_i)` times `cos_theta_i`.
    ///
    /// - Integral: 1 over [-pi/2, pi/2].
    #[inline]
    #[must_use]
    pub fn pdf_theta(&self, lobe: Lobe, theta_i: T) -> T {
        let half = T::from_f64(0.5);
        self.longitudinal[lobe].pdf((theta_i + self.theta_o) * half) * half
    }

    /// Returns the probability of an inclination of at most `theta_i`, the inverse of [`sample_theta`](Self::sample_theta).
    #[inline]
    #[must_use]
    pub fn cdf_theta(&self, lobe: Lobe, theta_i: T) -> T {
        self.longitudinal[lobe].cdf((theta_i + self.theta_o) * T::from_f64(0.5))
    }

    /// Draws `phi = phi_o - phi_i` like the paper (section 3.2.2): in [-pi, pi] for R and TRT-g, in [0, 2 pi] for TT, and in
    /// [-pi/2, pi/2] for the glint.
    #[inline]
    #[must_use]
    pub fn sample_phi(&self, lobe: Lobe, xi: T) -> T {
        let (one, two, half) = (T::from_f64(1.0), T::from_f64(2.0), T::from_f64(0.5));
        match lobe {
            Lobe::R | Lobe::TRT => two * (two * xi - one).max(-one).min(one).asin(),
            Lobe::TT => self.transmission.sample(xi),
            _ if xi < half => self.glint.sample(two * xi),
            _ => -self.glint.sample(two * (one - xi)),
        }
    }

    /// Returns the density of `phi`, per radian, for a `phi` in [-pi, pi].
    ///
    /// - Integral: 1 over [-pi, pi]. The density of the glint is exactly 0 beyond pi/2 (ERRATA E3).
    #[inline]
    #[must_use]
    pub fn pdf_phi(&self, lobe: Lobe, phi: T) -> T {
        match lobe {
            Lobe::R | Lobe::TRT => T::from_f64(0.25) * cos_half(phi),
            Lobe::TT => self.transmission.pdf(phi.abs()),
            _ => T::from_f64(0.5) * self.glint.pdf(phi.abs()),
        }
    }

    /// Returns the `xi` from which [`sample_phi`](Self::sample_phi) draws `phi`, for a `phi` in (-pi, pi]: the probability
    /// accumulated from -pi for R and TRT-g, and from 0 upwards through pi and -pi for TT and the glint.
    #[inline]
    #[must_use]
    pub fn cdf_phi(&self, lobe: Lobe, phi: T) -> T {
        let (zero, one, half) = (T::default(), T::from_f64(1.0), T::from_f64(0.5));
        match lobe {
            Lobe::R | Lobe::TRT => half * ((phi * half).sin() + one),
            Lobe::TT if phi < zero => self.transmission.cdf(phi + T::PI + T::PI),
            Lobe::TT => self.transmission.cdf(phi),
            _ if phi < zero => one - half * self.glint.cdf(-phi),
            _ => half * self.glint.cdf(phi),
        }
    }

    /// Returns the direction `(sin theta_i, cos theta_i cos phi_i, cos theta_i sin phi_i)` with `phi_i = phi_o - phi`.
    #[inline]
    pub(super) fn direction(&self, theta_i: T, phi: T) -> [T; 3] {
        let phi_i = self.phi_o - phi;
        let cos_theta_i = theta_i.cos();
        [
            theta_i.sin(),
            cos_theta_i * phi_i.cos(),
            cos_theta_i * phi_i.sin(),
        ]
    }
}
