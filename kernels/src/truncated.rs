//! The Cauchy distribution cut to an interval: the published sampler's longitude, TT azimuth and glint azimuth.

use crate::math::{atan2_upper, sin_cos_half_turn};
use crate::{Broadcast, Lanes};

/// A Cauchy distribution of width 1 centred on 0 and cut to `[lo, hi]`, as the angles of its ends: with
/// `x = tan y`, `y` is uniform on an interval of length `span` about `mid`.
///
/// - Source: Ou et al. 2012, appendices A, C and D, whose `A` and `B` are `mid + span/2` and `mid - span/2`.
/// - Density: `1 / (span (1 + x^2))` on the interval, per unit of `x` (per width).
///
/// The angle between the ends is formed without their difference, and `x` by rotating from the middle: both keep
/// their digits where the interval lies far from the centre, as it does for a narrow lobe shifted past the pole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TruncatedCauchy<L> {
    pub(crate) sin_mid: L,
    pub(crate) cos_mid: L,
    pub(crate) span: L,
}

impl<L: Lanes> TruncatedCauchy<L> {
    /// The distribution on `[lo, hi]`, in the units of `width`.
    #[inline(always)]
    pub(crate) fn new(lo: L, hi: L, width: L) -> Self {
        let c = L::splat;
        let (one, half) = (c(1.0), c(0.5));
        let width_sq = width * width;
        // Cosine and sine of the sum of the end angles, times `r`.
        let cos_sum = width_sq - lo * hi;
        let sin_sum = width * (lo + hi);
        let r = (lo.mul_add(lo, width_sq) * hi.mul_add(hi, width_sq)).sqrt();
        // Half of that sum, from whichever of the two half-angle forms does not cancel.
        let ratio = cos_sum / r;
        let sine = sin_sum / r;
        let large = (half * (one + ratio.abs())).sqrt();
        let small = half * sine / large;
        let inside = c(0.0).lt(cos_sum);
        Self {
            sin_mid: L::select(inside, small, large.copysign(sin_sum)),
            cos_mid: L::select(inside, large, small.abs()),
            span: atan2_upper(width * (hi - lo), lo.mul_add(hi, width_sq)),
        }
    }

    /// The value at cdf `xi`, in widths.
    #[inline(always)]
    pub(crate) fn invert(self, xi: L) -> L {
        let (sin, cos) = sin_cos_half_turn((xi - L::splat(0.5)) * self.span);
        self.cos_mid.mul_add(sin, self.sin_mid * cos) / self.cos_mid.mul_add(cos, -(self.sin_mid * sin))
    }

    /// One distribution for each lobe, read for the lobe each lane has chosen.
    #[inline(always)]
    pub(crate) fn pick<C: Broadcast<L>>(sin_mid: &[C; 4], cos_mid: &[C; 4], span: &[C; 4], choice: L::Choice) -> Self {
        Self { sin_mid: C::pick(sin_mid, choice), cos_mid: C::pick(cos_mid, choice), span: C::pick(span, choice) }
    }
}
