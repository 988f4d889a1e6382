//! Rays, their hits on segments, and the hits that they ignore.

use clap::ValueEnum;
use glam::Vec3;
use hairis::simd::Lanes;

/// Ray whose hits are at distances between 0 and `t_max`, both excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start of the ray.
    pub origin: Vec3,
    /// Unit direction of the ray.
    pub direction: Vec3,
    /// End of the ray as a distance; infinity for an unbounded ray.
    pub t_max: f32,
    /// Strand that the ray leaves, whose near hits are ignored.
    pub skip: Option<Skip>,
}

impl Ray {
    /// Creates a ray without end that leaves no strand.
    #[must_use]
    pub const fn new(origin: Vec3, direction: Vec3) -> Self {
        Self {
            origin,
            direction,
            t_max: f32::INFINITY,
            skip: None,
        }
    }
}

/// The place of hair that rays meet, and that those that it scatters leave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Meet {
    /// On the axis: a hair is a ribbon that faces the ray
    #[default]
    Axis,
    /// On the surface of a round tube, which rays meet from outside alone
    Surface,
}

/// Hits to ignore, because a ray starts on the axis or the surface of a fibre, and would meet the very fibre that it leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skip {
    /// Strand whose hits are ignored ...
    pub strand: u32,
    /// ... below this distance.
    pub before: f32,
}

impl Skip {
    /// Creates a skip that ignores the hits of a strand until the ray has left it.
    ///
    /// `before = 1.5 radius / max(cos_theta, 0.01)` from the axis; from the surface 2.5 radii, because a chord has up to two.
    ///
    /// The image does not depend on the factor from 1.5 to 10; with 0, strands shadow themselves and lose 0.5 %. If whole strands
    /// were ignored without limit, curls would lose their shadows; if only segments were, rays would meet hair again at their joints.
    #[inline]
    #[must_use]
    pub fn leaving(strand: u32, radius: f32, cos_theta: f32, from: Meet) -> Self {
        let radii = match from {
            Meet::Axis => 1.5,
            Meet::Surface => 2.5,
        };
        Self {
            strand,
            before: radii * radius / cos_theta.max(0.01),
        }
    }
}

/// Intersection of a ray with a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray to the place nearest to the axis, or to the surface: see [`Meet`].
    pub t: f32,
    /// Number of the segment.
    pub segment: u32,
    /// Number of the segment's strand.
    pub strand: u32,
    /// Place along the segment: 0 at the root's end, 1 at the tip's end.
    pub s: f32,
    /// Offset across the fibre in radii, in `[-1, 1]`, as in `hairis::Hit::h`. It is positive on the side of the axis (root to
    /// tip) cross the ray's direction.
    pub h: f32,
}

/// Ray whose components are the same in all lanes.
#[derive(Clone, Copy)]
pub(super) struct Spread<L> {
    pub(super) origin: [L; 3],
    pub(super) direction: [L; 3],
    /// Reciprocal of the direction, finite also where the direction is 0.
    pub(super) inverse: [L; 3],
    pub(super) origin_inverse: [L; 3],
    /// Whether the ray goes down along each axis, as 0 or 1.
    pub(super) negative: [usize; 3],
    pub(super) meet: Meet,
}

impl<L: Lanes> Spread<L> {
    #[inline(always)]
    pub(super) fn new(ray: &Ray, meet: Meet) -> Self {
        let (o, d) = (ray.origin, ray.direction);
        let inverse = [reciprocal(d.x), reciprocal(d.y), reciprocal(d.z)];
        Self {
            origin: [L::splat(o.x), L::splat(o.y), L::splat(o.z)],
            direction: [L::splat(d.x), L::splat(d.y), L::splat(d.z)],
            inverse: [
                L::splat(inverse[0]),
                L::splat(inverse[1]),
                L::splat(inverse[2]),
            ],
            origin_inverse: [
                L::splat(o.x * inverse[0]),
                L::splat(o.y * inverse[1]),
                L::splat(o.z * inverse[2]),
            ],
            negative: [
                usize::from(inverse[0] < 0.0),
                usize::from(inverse[1] < 0.0),
                usize::from(inverse[2] < 0.0),
            ],
            meet,
        }
    }
}

/// Returns `1 / x`, at most 1e18 in magnitude, so that no product with it is NaN.
#[inline(always)]
fn reciprocal(x: f32) -> f32 {
    if x.abs() < 1e-18 {
        1e18_f32.copysign(x)
    } else {
        1.0 / x
    }
}
