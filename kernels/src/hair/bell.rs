//! Bell curves that the published model is built of: its extension point.

use super::quadrature::GRADED;
use crate::simd::Lanes;

/// Bell curve of unit peak, which takes the place of every Gaussian of the published model.
///
/// The arguments are `s = (x / width)^2`, the squared distance from the centre in widths, and the Cauchy value `1 / (1 + s)`, which
/// the density of the published sampler needs anyway. A bell is written once over [`Lanes`]. For full speed mark all its functions
/// `#[inline(always)]` and pass no closures on.
///
/// ```
/// use hairis::{HairParams, Material, Published};
/// use hairis::model::Bell;
/// use hairis::simd::Lanes;
/// use glam::Vec3;
/// /// A parabola with its corners rounded: `max(0, 1 - s/8)^4`.
/// #[derive(Clone, Copy, Debug)]
/// struct Bump;
/// impl Bell for Bump {
///     #[inline(always)]
///     fn one<L: Lanes>(s: L, _cauchy: L) -> L {
///         let x = L::splat(0.0).max(s * -0.125 + 1.0);
///         (x * x) * (x * x)
///     }
/// }
/// let hair = Material::new(&Published(Bump), &HairParams::default());
/// assert!(hair.prepare(Vec3::Y).pdf(Vec3::Y) > 0.0);
/// ```
pub trait Bell: Copy {
    /// Evaluates the bell at the squared distance `s` in widths; the result is 1 at `s` 0.
    ///
    /// `cauchy` is `1 / (1 + s)`.
    fn one<L: Lanes>(s: L, cauchy: L) -> L;

    /// Evaluates the product of two bells.
    #[inline(always)]
    fn two<L: Lanes>(at: TwoBells<L>) -> L {
        Self::one(at.s, at.cauchy_s) * Self::one(at.t, at.cauchy_t)
    }

    /// Evaluates the bells of the four lobes at one direction: [`one`](Self::one) for R, [`two`](Self::two) for TT, `one` for TRT,
    /// and `two` for the glints. Override it where the four together cost less than one after another.
    #[inline(always)]
    fn four<L: Lanes>(at: FourBells<L>) -> [L; 4] {
        [
            Self::one(at.s_r, at.cauchy_r),
            Self::two(at.tt),
            Self::one(at.s_trt, at.cauchy_trt),
            Self::two(at.glint),
        ]
    }

    /// Computes the integral from `lo` to `hi`, in widths from the centre, for [`Single`](crate::model::Single).
    ///
    /// Provided: a quadrature.
    #[doc(hidden)]
    #[inline(always)]
    fn area<L: Lanes>(lo: L, hi: L) -> L {
        bell_area::<Self, L>(lo, hi)
    }

    /// Returns a factor on every width of the material, finite and at least 0.5, which is read once per material.
    #[inline]
    fn width_factor(&self) -> f32 {
        1.0
    }
}

/// Arguments of the product of two bells, at squared distances `s` and `t` in widths.
#[derive(Clone, Copy, Debug)]
pub struct TwoBells<L> {
    /// Squared distance from the centre of the first, in widths.
    pub s: L,
    /// Squared distance from the centre of the second, in widths.
    pub t: L,
    /// `1 / ((1 + s) (1 + t))`.
    pub cauchy: L,
    /// `1 / (1 + s)`.
    pub cauchy_s: L,
    /// `1 / (1 + t)`.
    pub cauchy_t: L,
}

/// Arguments of the bells of the four lobes at one direction.
#[derive(Clone, Copy, Debug)]
pub struct FourBells<L> {
    /// Squared distance of the inclination from the centre of R, in widths.
    pub s_r: L,
    /// `1 / (1 + s_r)`.
    pub cauchy_r: L,
    /// Inclination and azimuth of TT.
    pub tt: TwoBells<L>,
    /// Squared distance of the inclination from the centre of TRT, in widths.
    pub s_trt: L,
    /// `1 / (1 + s_trt)`.
    pub cauchy_trt: L,
    /// Inclination and azimuth of the glints.
    pub glint: TwoBells<L>,
}

/// Nodes of an integral over `x`, the distance from the centre of a bell in widths. The nodes are even in `u`, with
/// `x = u / (1 - u^2)`, except for the grading towards both ends.
///
/// A bell of any width is smooth over `u`, and so are the cosines beside it up to the ends.
#[derive(Clone, Copy)]
pub(super) struct Nodes<L> {
    /// `1 + u` of the first node, and `1 - u` of the last: they keep their digits where they vanish.
    above: L,
    below: L,
    span: L,
}

impl<L: Lanes> Nodes<L> {
    #[inline(always)]
    pub(super) fn between(from: L, to: L) -> Self {
        let ([above, below_from], [above_to, below]) = (compress(from), compress(to));
        Self {
            above,
            below,
            span: L::select(L::splat(0.0).lt(from), below_from - below, above_to - above),
        }
    }

    /// Returns `x` of a node, and its weight times `dx`.
    #[inline(always)]
    pub(super) fn at(&self, [node, rest, weight]: [f32; 3]) -> (L, L) {
        let c = L::splat;
        let above = c(node).mul_add(self.span, self.above);
        let below = c(rest).mul_add(self.span, self.below);
        let inv = L::quotient(c(1.0), above * below);
        let u = (above - below) * 0.5;
        (
            u * inv,
            u.mul_add(u, c(1.0)) * (inv * inv) * (self.span * weight),
        )
    }
}

/// Returns `1 + u` and `1 - u` for `x = u / (1 - u^2)`.
#[inline(always)]
fn compress<L: Lanes>(x: L) -> [L; 2] {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let twice = (x + x).abs();
    let root = twice.mul_add(twice, one).sqrt();
    let inv = L::quotient(one, one + root);
    let (large, small) = (
        twice.mul_add(inv, one),
        (one + L::quotient(one, root + twice)) * inv,
    );
    let negative = x.lt(zero);
    [
        L::select(negative, small, large),
        L::select(negative, large, small),
    ]
}

/// Integrates a bell over `[lo, hi]`, in widths from its centre.
#[inline]
pub(super) fn bell_area<B: Bell, L: Lanes>(lo: L, hi: L) -> L {
    let (one, nodes) = (L::splat(1.0), Nodes::between(lo, hi));
    let mut sum = L::splat(0.0);
    for node in GRADED {
        let (x, dx) = nodes.at(node);
        sum = sum + B::one(x * x, L::quotient(one, one + x * x)) * dx;
    }
    sum
}
