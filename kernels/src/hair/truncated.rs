//! Cauchy distribution cut to an interval: the inclination, the azimuth of TT and that of the glints in the published sampler.

use crate::model::math::{atan2_upper, tan_half_turn};
use crate::simd::Lanes;

/// Cauchy distribution of width 1 centred on 0 and cut to `[lo, hi]`, as the angles of its ends: with `x = tan y`, `y` is uniform on
/// an interval of length `span` about `mid`.
///
/// - Source: Ou et al. 2012, appendices A, C and D, whose `A` and `B` are `mid + span/2` and `mid - span/2`.
/// - Density: `1 / (span (1 + x^2))` on the interval, per unit of `x` (per width).
///
/// The angle between the ends is computed without their difference, and `x` by rotating from the middle. Both thus keep their digits
/// where the interval lies far from the centre, as it does for a narrow lobe shifted past the pole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TruncatedCauchy<L> {
    /// Tangent of the middle angle.
    pub(crate) tan_mid: L,
    pub(crate) span: L,
}

impl<L: Lanes> TruncatedCauchy<L> {
    /// Makes the distribution on `[lo, hi]`, in the units of `width`.
    #[inline(always)]
    pub(crate) fn new(lo: L, hi: L, width: L) -> Self {
        let width_sq = width * width;
        // Cosine and sine of the sum of the end angles, times `r`.
        let cos_sum = width_sq - lo * hi;
        let sin_sum = width * (lo + hi);
        let r = (lo.mul_add(lo, width_sq) * hi.mul_add(hi, width_sq)).sqrt();
        // Half of that sum, from whichever of the two half-angle forms does not cancel: the cosine is not negative.
        let inside = L::splat(0.0).lt(cos_sum);
        let large = r + cos_sum.abs();
        Self {
            tan_mid: L::quotient(
                L::select(inside, sin_sum, large.times_sign(sin_sum)),
                L::select(inside, large, sin_sum.abs()),
            ),
            span: atan2_upper(width * (hi - lo), lo.mul_add(hi, width_sq)),
        }
    }

    /// Returns the value at cdf `1/2 + from_middle`, in widths.
    ///
    /// The ends of every interval of the models are less than `1e5` widths from the centre, so that the denominator
    /// stays further above 0 than it is rounded.
    #[inline(always)]
    pub(crate) fn invert(self, from_middle: L) -> L {
        let (n, d) = tan_half_turn(from_middle * self.span);
        L::quotient(self.tan_mid.mul_add(d, n), self.tan_mid.mul_add(-n, d))
    }
}
