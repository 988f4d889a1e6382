//! Cauchy distribution on an interval, from which the published sampler draws.

use crate::real::Real;

/// Cauchy density cut to `[lo, hi]` and normalised there, from which M, TT and one glint are sampled.
///
/// - Source: Ou et al. 2012, appendices A, C and D.
/// - Units: rad.
///
/// ```
/// use hairis_reference::CauchyDensity;
/// let density = CauchyDensity::new(0.1, 0.2, -1.0, 1.0);
/// let x = density.sample(0.3_f64);
/// assert!((density.cdf(x) - 0.3).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CauchyDensity<T> {
    location: T,
    scale: T,
    lo: T,
    hi: T,
    /// B (D for the glint): `atan((lo - location) / scale)`.
    atan_lo: T,
    /// A - B (C - D for the glint, C for TT).
    span: T,
}

impl<T: Real> CauchyDensity<T> {
    /// Makes the density of peak `location` and half width at half maximum `scale` on `[lo, hi]`.
    ///
    /// A - B is computed as `atan2(scale (hi - lo), scale^2 + lo hi)`, with bounds measured from `location`, because the difference
    /// of two arc tangents loses every digit when a narrow lobe lies outside the interval.
    #[inline]
    #[must_use]
    pub fn new(location: T, scale: T, lo: T, hi: T) -> Self {
        let (below, above) = (lo - location, hi - location);
        Self {
            location,
            scale,
            lo,
            hi,
            atan_lo: (below / scale).atan(),
            span: (scale * (hi - lo)).atan2(scale * scale + below * above),
        }
    }

    /// Returns the density with which [`sample`](Self::sample) draws `x`.
    ///
    /// `scale / (span ((x - location)^2 + scale^2))`
    ///
    /// - Source: Ou et al. 2012, appendices A, C, D; interval of M by ERRATA E1, and of the glint by E3.
    /// - Units: per rad of `x`, not per steradian.
    /// - Domain: any `x`. Exactly 0 outside `[lo, hi]`.
    /// - Integral: 1 over `[lo, hi]` (test `reference::each_lobe_and_the_mixture_integrate_to_one`).
    #[inline]
    #[must_use]
    pub fn pdf(&self, x: T) -> T {
        if x < self.lo || x > self.hi {
            return T::default();
        }
        let from_peak = x - self.location;
        self.scale / (self.span * (from_peak * from_peak + self.scale * self.scale))
    }

    /// Returns the probability that a sample is at most `x`: 0 at `lo`, and 1 at `hi` and beyond.
    ///
    /// `(atan((x - location) / scale) - B) / (A - B)`, with the difference computed like A - B
    #[inline]
    #[must_use]
    pub fn cdf(&self, x: T) -> T {
        let x = x.max(self.lo).min(self.hi);
        let (below, at) = (self.lo - self.location, x - self.location);
        (self.scale * (x - self.lo)).atan2(self.scale * self.scale + below * at) / self.span
    }

    /// Returns the value whose [`cdf`](Self::cdf) is `xi`.
    ///
    /// `scale tan(xi (A - B) + B) + location`, kept within `[lo, hi]` where the tangent overshoots by rounding
    ///
    /// - Accuracy: the error is about `epsilon (x - location)^2 / scale`, which is negligible in `f64`. In `f32` it affects a narrow
    ///   lobe whose peak lies outside the interval, a loss that is left in because the printed formula has it.
    #[inline]
    #[must_use]
    pub fn sample(&self, xi: T) -> T {
        let x = self.scale * (xi * self.span + self.atan_lo).tan() + self.location;
        x.max(self.lo).min(self.hi)
    }
}
