//! The all-Cauchy variant: a bell with wider tails that the published sampler follows exactly.

use core::f32::consts::FRAC_PI_2;
use hairis::math::{atan_unit, atan2_upper, sin_cos_absolute};
use hairis::{Bell, Hair, Lanes, Matched, MatchedBell, ParamError, Truncated};

/// The bell `1 / (1 + s)`, a Cauchy whose scale is the width: every Gaussian of the published model becomes this.
///
/// - Source: Ou et al. 2012, section 3.3 "Replacing Gaussian with Cauchy".
/// - Widths: those of the Gaussian model times a factor, by default 1 as in the paper.
///
/// ```
/// use glam::Vec3;
/// use hairis::{Bsdf, HairParams};
/// use hairis_variants::Cauchy;
/// let hair = Bsdf::new(&Cauchy::PAPER.model(), &HairParams::default());
/// let sample = hair.prepare(Vec3::Y).sample([0.5, 0.25, 0.75]).expect("not along the fibre");
/// assert!(sample.weight.iter().all(|w| *w > 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cauchy {
    width_factor: f32,
}

impl Cauchy {
    /// The Gaussian model's own widths: the paper's words, and within 0.5% of the least-squares best factor.
    pub const PAPER: Self = Self { width_factor: 1.0 };
    /// Both bells are half as high at the same distance: a factor of `sqrt(2 ln 2)`.
    pub const HALF_WIDTH: Self = Self { width_factor: 1.177_410_0 };
    /// Both bells have the same area over the whole line: a factor of `sqrt(2 / pi)`.
    pub const AREA: Self = Self { width_factor: 0.797_884_6 };

    /// A bell whose widths are those of the Gaussian model times `width_factor`.
    ///
    /// # Errors
    ///
    /// If the factor is not in `[0.5, 4]`.
    #[inline]
    pub fn with_width_factor(width_factor: f32) -> Result<Self, ParamError> {
        if (0.5..=4.0).contains(&width_factor) {
            Ok(Self { width_factor })
        } else {
            Err(ParamError::WidthFactor("width_factor", width_factor))
        }
    }

    /// The model made of this bell.
    #[inline]
    #[must_use]
    pub const fn model(self) -> Hair<Self> {
        Hair(self)
    }

    /// The model made of this bell, with the sampler that follows it closer than the published one.
    #[inline]
    #[must_use]
    pub const fn matched(self) -> Matched<Self> {
        Matched(self)
    }
}

impl Default for Cauchy {
    /// [`PAPER`](Self::PAPER).
    #[inline]
    fn default() -> Self {
        Self::PAPER
    }
}

impl Bell for Cauchy {
    #[inline(always)]
    fn one<L: Lanes>(_s: L, cauchy: L) -> L {
        cauchy
    }

    #[inline(always)]
    fn two<L: Lanes>(_s: L, _t: L, cauchy: L, _cauchy_s: L, _cauchy_t: L) -> L {
        cauchy
    }

    #[inline]
    fn width_factor(&self) -> f32 {
        self.width_factor
    }
}

/// A Cauchy cut to an interval: masses are angles, the ends those of the interval.
///
/// - Accuracy: a point's cdf is that asked for to 3e-7, and next to an end to as much of its distance from it.
impl MatchedBell for Cauchy {
    const UNIT: f32 = 1.0;

    #[inline(always)]
    fn truncate<L: Lanes>(lo: L, hi: L) -> Truncated<L> {
        let one = L::splat(1.0);
        let span = atan2_upper(hi - lo, lo.mul_add(hi, one));
        Truncated { mass: span, inv_mass: one / span, ends: [lo, hi] }
    }

    #[inline(always)]
    fn locate<L: Lanes>(cut: &Truncated<L>, x: L, _bell: L) -> (L::Mask, L) {
        let one = L::splat(1.0);
        let [lo, hi] = cut.ends;
        // Sine and cosine, to a scale, of the angles that the point makes with the ends. The smaller is at most a right
        // one.
        let (sin_lo, sin_hi) = ((x - lo).abs(), (hi - x).abs());
        let (cos_lo, cos_hi) = (x.mul_add(lo, one), x.mul_add(hi, one));
        let lower = (sin_lo * cos_hi).lt(sin_hi * cos_lo);
        let (sin, cos) = (L::select(lower, sin_lo, sin_hi), L::select(lower, cos_lo, cos_hi));
        let steep = cos.lt(sin);
        let angle = atan_unit(L::select(steep, cos, sin) / L::select(steep, sin, cos));
        (lower, L::select(steep, L::splat(FRAC_PI_2) - angle, angle) * cut.inv_mass)
    }

    #[inline(always)]
    fn invert<L: Lanes>(cut: &Truncated<L>, from_lo: L, from_hi: L) -> L {
        // The nearer end, turned towards the other.
        let end = L::select(from_lo.lt(from_hi), cut.ends[0], cut.ends[1]);
        let (sin, cos) = sin_cos_absolute(from_lo.min(from_hi) * cut.mass);
        turned(end, sin.times_sign(from_hi - from_lo), cos)
    }

    #[inline(always)]
    fn invert_both<L: Lanes>(cut: &Truncated<L>, v: f32) -> [L; 2] {
        let (sin, cos) = sin_cos_absolute(L::splat(v) * cut.mass);
        [turned(cut.ends[0], sin, cos), turned(cut.ends[1], -sin, cos)]
    }
}

/// The tangent of the angle of `tangent` plus one of this sine and cosine.
#[inline(always)]
fn turned<L: Lanes>(tangent: L, sin: L, cos: L) -> L {
    tangent.mul_add(cos, sin) / tangent.mul_add(-sin, cos)
}
