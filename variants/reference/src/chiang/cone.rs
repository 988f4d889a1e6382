//! Longitudinal lobe: a spherical Gaussian summed around the fibre.

use super::bessel_i0_scaled;
use crate::real::Real;

/// Cone of inclination `-theta'` about which light spreads with variance v: d'Eon et al. 2011.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cone<T> {
    variance: T,
    /// Sine and cosine of theta'; the cosine is at least 0.
    sin: T,
    cos: T,
}

impl<T: Real> Cone<T> {
    pub(crate) fn new(variance: T, sin: T, cos: T) -> Self {
        Self { variance, sin, cos }
    }

    pub(crate) fn inclination(&self) -> T {
        (-self.sin).atan2(self.cos)
    }

    /// Returns the exponent of M, `2 sin^2 ((theta_i + theta') / 2) / v`, and its width, the root of v.
    pub(crate) fn exponent(&self, sin_theta_i: T, cos_theta_i: T) -> [T; 2] {
        let (x, y) = (cos_theta_i - self.cos, sin_theta_i + self.sin);
        let two = T::from_f64(2.0);
        [
            (x * x + y * y) / (two * self.variance),
            self.variance.sqrt(),
        ]
    }

    /// Evaluates M: `csch(1/v) / (2 v) exp(-sin theta_i sin theta' / v) I0(cos theta_i cos theta' / v)`, whose three exponents are
    /// added before they overflow (variants/ERRATA.md E8).
    ///
    /// The exponents add up to `(cos(theta_i + theta') - 1) / v`, half the squared distance of two points of a circle.
    pub(crate) fn density(&self, sin_theta_i: T, cos_theta_i: T) -> T {
        let (two, v) = (T::from_f64(2.0), self.variance);
        let [exponent, _] = self.exponent(sin_theta_i, cos_theta_i);
        (-exponent).exp() * bessel_i0_scaled(cos_theta_i * self.cos / v)
            / (v * -(-two / v).exp_m1())
    }

    /// Draws `1 - cos` of the angle from the cone's mantle, of density `exp(-delta / v)` on `[0, 2]`.
    pub(crate) fn sample(&self, xi: T) -> T {
        let (two, v) = (T::from_f64(2.0), self.variance);
        (-v * (xi * (-two / v).exp_m1()).ln_1p()).min(two)
    }

    pub(crate) fn cdf(&self, delta: T) -> T {
        (-delta / self.variance).exp_m1() / (-T::from_f64(2.0) / self.variance).exp_m1()
    }

    /// Returns sine and cosine of the inclination at `delta` and at half a turn times `xi_turn` about the direction -theta'.
    pub(crate) fn direction(&self, delta: T, xi_turn: T) -> [T; 2] {
        let along = T::from_f64(1.0) - delta;
        let across = (delta * (T::from_f64(2.0) - delta)).sqrt();
        let (sin, cos) = ((T::PI * xi_turn).sin(), (T::PI * xi_turn).cos());
        let sin_theta_i = across * cos * self.cos - along * self.sin;
        let cos_theta_i = (along * self.cos + across * cos * self.sin).hypot(across * sin);
        [sin_theta_i, cos_theta_i]
    }
}
