//! All-Cauchy variant of the published model: a bell with wider tails, which the published sampler follows exactly.

use core::f32::consts::FRAC_PI_2;
use hairis::model::math::{atan_unit, tan_half_turn};
use hairis::model::{Bell, MatchedBell, TwoBells};
use hairis::params::Rule;
use hairis::simd::Lanes;
use hairis::{Matched, ParamError, Published};

/// Cauchy bell `1 / (1 + s)`, whose scale is the width. It replaces every Gaussian of the published model.
///
/// - Source: Ou et al. 2012, section 3.3 "Replacing Gaussian with Cauchy".
/// - Widths: the widths of the Gaussian model times a factor, which is 1 by default, as in the paper.
///
/// ```
/// use glam::Vec3;
/// use hairis::{HairParams, Material};
/// use hairis_variants::Cauchy;
/// let hair = Material::new(&Cauchy::PAPER.model(), &HairParams::default());
/// let sample = hair.prepare(Vec3::Y).sample([0.5, 0.25, 0.75]).expect("not along the fibre");
/// assert!(sample.weight.iter().all(|w| *w > 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cauchy {
    width_factor: f32,
}

impl Cauchy {
    /// Bell with the widths of the Gaussian model, as in the paper; the factor is within 0.5% of the best by least squares.
    pub const PAPER: Self = Self { width_factor: 1.0 };
    /// Bell that is half as high at the same distance as the Gaussian: a factor of `sqrt(2 ln 2)`.
    pub const HALF_WIDTH: Self = Self {
        width_factor: 1.177_410_0,
    };
    /// Bell that has the same area over the whole line as the Gaussian: a factor of `sqrt(2 / pi)`.
    pub const AREA: Self = Self {
        width_factor: 0.797_884_6,
    };

    /// Makes a bell whose widths are the widths of the Gaussian model times `width_factor`.
    ///
    /// # Errors
    ///
    /// Returns an error if the factor is outside `[0.5, 4]`.
    #[inline]
    pub fn with_width_factor(width_factor: f32) -> Result<Self, ParamError> {
        Rule::Range([0.5, 4.0]).check("width_factor", &[width_factor])?;
        Ok(Self { width_factor })
    }

    /// Returns the model made of this bell, with the published sampler.
    #[inline]
    #[must_use]
    pub const fn model(self) -> Published<Self> {
        Published(self)
    }

    /// Returns the model made of this bell, with the matched sampler.
    #[inline]
    #[must_use]
    pub const fn matched(self) -> Matched<Self> {
        Matched(self)
    }
}

impl Default for Cauchy {
    /// Returns the bell of the paper, [`PAPER`](Self::PAPER).
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
    fn two<L: Lanes>(at: TwoBells<L>) -> L {
        at.cauchy
    }

    #[inline(always)]
    fn area<L: Lanes>(lo: L, hi: L) -> L {
        Self::closed_area(lo, hi)
    }

    #[inline]
    fn width_factor(&self) -> f32 {
        self.width_factor
    }
}

/// The integral is an angle, measured from the point of the interval that is nearest to the centre.
///
/// - Accuracy: the integral up to an inverted point is within 3e-7 rad of the given integral.
impl MatchedBell for Cauchy {
    const UNIT: f32 = 1.0;

    #[inline(always)]
    fn origin<L: Lanes>(lo: L, hi: L) -> L {
        lo.max(L::splat(0.0).min(hi))
    }

    #[inline(always)]
    fn integral<L: Lanes>(origin: L, x: L) -> L {
        // Sine and cosine, up to a common factor, of the angle from the origin, which is at most a right angle.
        let (sin, cos) = (x - origin, x.mul_add(origin, L::splat(1.0)));
        let across = sin.abs();
        let steep = cos.lt(across);
        let angle = atan_unit(L::quotient(across.min(cos), across.max(cos)));
        L::select(steep, L::splat(FRAC_PI_2) - angle, angle).times_sign(sin)
    }

    #[inline(always)]
    fn invert<L: Lanes>(origin: L, sum: L) -> L {
        let (n, d) = tan_half_turn(sum);
        L::quotient(origin.mul_add(d, n), origin.mul_add(-n, d))
    }
}
