//! The Cauchy distribution on an interval, from which the published sampler draws.

use crate::Real;

/// A Cauchy density cut to `[lo, hi]` and normalised there: the sampler of M, of TT and of one glint.
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
    /// B (D of the glint): `atan((lo - location) / scale)`.
    atan_lo: T,
    /// A - B (C - D of the glint, C of TT).
    span: T,
}

impl<T: Real> CauchyDensity<T> {
    /// The density of peak `location` and half width at half maximum `scale` on `[lo, hi]`.
    ///
    /// A - B is formed as `atan2(scale (hi - lo), scale^2 + lo hi)`, bounds taken from `location`: the difference of
    /// two arc tangents loses every digit when a narrow lobe lies outside the interval.
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

    /// Density of [`sample`](Self::sample) at `x`.
    ///
    /// `scale / (span ((x - location)^2 + scale^2))`
    ///
    /// - Source: Ou et al. 2012, appendices A, C, D; interval of M by ERRATA E1, of the glint by E3.
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

    /// Probability that a sample is at most `x`: 0 at `lo`, 1 at `hi` and beyond.
    ///
    /// `(atan((x - location) / scale) - B) / (A - B)`, the difference formed as A - B is.
    #[inline]
    #[must_use]
    pub fn cdf(&self, x: T) -> T {
        let x = x.max(self.lo).min(self.hi);
        let (below, at) = (self.lo - self.location, x - self.location);
        (self.scale * (x - self.lo)).atan2(self.scale * self.scale + below * at) / self.span
    }

    /// The value whose [`cdf`](Self::cdf) is `xi`.
    ///
    /// `scale tan(xi (A - B) + B) + location`, kept within `[lo, hi]` where the tangent overshoots by rounding.
    ///
    /// - Accuracy: error of about `epsilon (x - location)^2 / scale`, negligible in `f64`. In `f32` it is felt by a
    ///   narrow lobe whose peak lies outside the interval, a loss left in: it is what the printed formula gives.
    #[inline]
    #[must_use]
    pub fn sample(&self, xi: T) -> T {
        let x = self.scale * (xi * self.span + self.atan_lo).tan() + self.location;
        x.max(self.lo).min(self.hi)
    }
}
