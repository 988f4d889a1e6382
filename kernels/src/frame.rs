//! Vectors of lanes, and the frame of a fibre.
//!
//! In the frame of a fibre `x` is `u`, along the fibre from root to tip, while `y` is `v` and `z` is `w`, which span the normal
//! plane. The azimuth of `v` is 0, and the azimuth of `w` is pi/2.

use crate::simd::Lanes;
use glam::{Vec3, Vec3A};
use wide::f32x8;

/// Vector of three numbers per lane. In a fibre's frame, `x` is along the fibre (u), and `y` and `z` are in its normal plane (v, w).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3x<L> {
    /// Component along u, or along the world's x.
    pub x: L,
    /// Component along v, or along the world's y.
    pub y: L,
    /// Component along w, or along the world's z.
    pub z: L,
}

/// Eight vectors, one per lane, stored by component.
pub type Vec3x8 = Vec3x<f32x8>;

impl<L> Vec3x<L> {
    /// Makes a vector from its three components.
    #[inline(always)]
    #[must_use]
    pub const fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }
}

impl<L: Lanes> Vec3x<L> {
    /// Returns the dot product of two vectors, lane by lane.
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> L {
        self.x
            .mul_add(other.x, self.y.mul_add(other.y, self.z * other.z))
    }

    /// Returns the cosine of the inclination of a unit vector in a fibre's frame, the factor that the value of [`Eval`](crate::Eval)
    /// leaves out.
    ///
    /// ```
    /// use hairis::Vec3x8;
    /// use glam::Vec3;
    /// let towards_light = Vec3x8::splat(Vec3::new(0.6, 0.48, 0.64));
    /// assert_eq!(towards_light.cos_theta().to_array(), [0.8; 8]);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn cos_theta(self) -> L {
        self.y.mul_add(self.y, self.z * self.z).sqrt()
    }

    /// Copies the vector with its components read one by one: see [`Schedule::alone`](crate::simd::Schedule::alone). Callers have
    /// often just written the components, and a read across two such writes waits until both have left the CPU's queue.
    #[inline(always)]
    #[must_use]
    pub(crate) fn alone(self) -> Self {
        Self::new(self.x.alone(), self.y.alone(), self.z.alone())
    }

    /// Multiplies the vector by a number per lane.
    #[inline(always)]
    #[must_use]
    pub fn scale(self, by: L) -> Self {
        Self::new(self.x * by, self.y * by, self.z * by)
    }

    /// Adds two vectors, lane by lane.
    #[inline(always)]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }

    /// Returns the vector in its storage form.
    #[inline(always)]
    pub fn store(self) -> Vec3x<L::Stored> {
        Vec3x::new(self.x.store(), self.y.store(), self.z.store())
    }

    /// Loads a stored vector, which may just have been written, as lanes.
    #[inline(always)]
    pub(crate) fn load_fresh<C: crate::simd::Broadcast<L>>(stored: &Vec3x<C>) -> Self {
        Self::new(
            stored.x.fresh_lanes(),
            stored.y.fresh_lanes(),
            stored.z.fresh_lanes(),
        )
    }

    /// Loads a stored vector as lanes.
    #[inline(always)]
    pub(crate) fn load<C: crate::simd::Broadcast<L>>(stored: &Vec3x<C>) -> Self {
        Self::new(stored.x.lanes(), stored.y.lanes(), stored.z.lanes())
    }
}

impl Vec3x8 {
    /// Repeats one vector in every lane.
    #[inline]
    #[must_use]
    pub fn splat(v: Vec3) -> Self {
        Self::new(f32x8::splat(v.x), f32x8::splat(v.y), f32x8::splat(v.z))
    }

    /// Returns the vector of one lane.
    ///
    /// # Panics
    ///
    /// Panics if `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(
            self.x.as_array()[lane],
            self.y.as_array()[lane],
            self.z.as_array()[lane],
        )
    }
}

impl From<[Vec3; 8]> for Vec3x8 {
    #[inline]
    fn from(v: [Vec3; 8]) -> Self {
        Self::new(
            f32x8::new(v.map(|v| v.x)),
            f32x8::new(v.map(|v| v.y)),
            f32x8::new(v.map(|v| v.z)),
        )
    }
}

impl From<[Vec3A; 8]> for Vec3x8 {
    #[inline]
    fn from(v: [Vec3A; 8]) -> Self {
        v.map(Vec3::from).into()
    }
}

impl From<Vec3x8> for [Vec3; 8] {
    #[inline]
    fn from(v: Vec3x8) -> Self {
        core::array::from_fn(|lane| v.lane(lane))
    }
}

impl From<Vec3x8> for [Vec3A; 8] {
    #[inline]
    fn from(v: Vec3x8) -> Self {
        core::array::from_fn(|lane| v.lane(lane).into())
    }
}

impl From<Vec3> for Vec3x<f32> {
    #[inline(always)]
    fn from(v: Vec3) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl From<Vec3A> for Vec3x<f32> {
    #[inline(always)]
    fn from(v: Vec3A) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl From<Vec3x<f32>> for Vec3A {
    #[inline(always)]
    fn from(v: Vec3x<f32>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl From<Vec3x<f32>> for Vec3 {
    #[inline(always)]
    fn from(v: Vec3x<f32>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

/// Orthonormal, right-handed frame of a fibre: `u` along the fibre from root to tip, `v` and `w` across.
///
/// ```
/// use glam::Vec3;
/// use hairis::FiberFrame;
/// let frame = FiberFrame::from_tangent(Vec3::new(0.0, 2.0, 0.0));
/// let local = frame.to_local(Vec3::Y);
/// assert!((local - Vec3::X).length() < 1e-6); // along the fibre
/// assert!((frame.to_world(local) - Vec3::Y).length() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiberFrame {
    /// Direction along the fibre, from root to tip, unit.
    pub u: Vec3,
    /// Direction of azimuth 0, unit.
    pub v: Vec3,
    /// Direction of azimuth pi/2, unit: `u` cross `v`.
    pub w: Vec3,
}

impl FiberFrame {
    /// Makes the frame of a fibre from its tangent (root to tip, of any length).
    ///
    /// `v` and `w` depend on the tangent alone, continuously except where its z changes sign. The choice of `v` and `w` does not
    /// matter to the published model, which depends only on differences of azimuth.
    ///
    /// - Domain: a tangent that is zero or not finite counts as +x.
    #[inline]
    #[must_use]
    pub fn from_tangent(tangent: Vec3) -> Self {
        let u = unit_or(tangent, Vec3::X);
        let (v, w) = u.any_orthonormal_pair();
        Self { u, v, w }
    }

    /// Makes the frame whose `v` (azimuth 0) is the part of `normal` across the fibre.
    ///
    /// - Domain: a normal that is zero, not finite or along the tangent is ignored, which gives the frame of
    ///   [`from_tangent`](Self::from_tangent).
    #[inline]
    #[must_use]
    pub fn from_tangent_normal(tangent: Vec3, normal: Vec3) -> Self {
        let any = Self::from_tangent(tangent);
        let normal = unit_or(normal, Vec3::ZERO);
        let across = normal - any.u * normal.dot(any.u);
        // Below this length the direction consists of rounding errors.
        if across.length_squared() < 1e-10 {
            return any;
        }
        let v = unit_or(across, any.v);
        // Repeated, because the first difference leaves up to 1e-2 of u where the normal is almost along it.
        let v = unit_or(v - any.u * v.dot(any.u), any.v);
        Self {
            u: any.u,
            v,
            w: any.u.cross(v),
        }
    }

    /// Transforms a vector from the world to the frame of the fibre: the `(u, v, w)` components of `v`.
    ///
    /// - Domain: directions, and any vector up to 1e37; beyond that length the sums may overflow.
    #[inline]
    #[must_use]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.u), v.dot(self.v), v.dot(self.w))
    }

    /// Transforms a vector from the frame of the fibre to the world.
    #[inline]
    #[must_use]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.u * v.x + self.v * v.y + self.w * v.z
    }

    /// Returns the cosine of the inclination of a unit vector in a fibre's frame, the factor that the value of [`Eval`](crate::Eval)
    /// leaves out.
    ///
    /// `cos theta_i = sqrt(v^2 + w^2)`
    #[inline]
    #[must_use]
    pub fn cos_theta(wi: Vec3) -> f32 {
        Vec3x::from(wi).cos_theta()
    }

    /// Returns the offset across the fibre of a hit with this outward normal, viewed from `wo`: [`Hit::h`](crate::Hit::h). Both
    /// vectors are in the world.
    ///
    /// `h = u . (n x wo) / cos theta_o`, with `n` the part of the normal across the fibre, at unit length
    ///
    /// - Domain: vectors of any length. If either vector lies along the fibre, or is zero or not finite, the offset is 0.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairis::FiberFrame;
    /// let frame = FiberFrame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z };
    /// assert_eq!(frame.offset(Vec3::Y, Vec3::Z), 1.0); // from v to w is a positive quarter turn
    /// assert_eq!(frame.offset(Vec3::Y, Vec3::Y), 0.0); // wo in the plane of the normal: a hit on the axis
    /// ```
    #[inline]
    #[must_use]
    pub fn offset(&self, normal: Vec3, wo: Vec3) -> f32 {
        let across = |vector: Vec3| {
            let local = self.to_local(unit_or(vector, Vec3::ZERO));
            unit_or(Vec3::new(0.0, local.y, local.z), Vec3::ZERO)
        };
        let (n, wo) = (across(normal), across(wo));
        (n.y * wo.z - n.z * wo.y).clamp(-1.0, 1.0)
    }
}

/// Scales `v` to unit length; returns `fallback` if `v` is zero or not finite. Scaled by its largest component first, so that no
/// finite length overflows.
#[inline]
fn unit_or(v: Vec3, fallback: Vec3) -> Vec3 {
    let largest = v.abs().max_element();
    if largest > 0.0 && v.is_finite() {
        (v / largest).normalize()
    } else {
        fallback
    }
}

/// Frames of fibres, one per lane: one frame repeated for eight directions ([`splat`](Self::splat)), or the frames of eight shading
/// points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiberFrame8 {
    /// Direction along each fibre, from root to tip, unit.
    pub u: Vec3x8,
    /// Direction of azimuth 0, unit.
    pub v: Vec3x8,
    /// Direction of azimuth pi/2, unit.
    pub w: Vec3x8,
}

impl FiberFrame8 {
    /// Repeats one frame in every lane.
    #[inline]
    #[must_use]
    pub fn splat(frame: &FiberFrame) -> Self {
        Self {
            u: Vec3x8::splat(frame.u),
            v: Vec3x8::splat(frame.v),
            w: Vec3x8::splat(frame.w),
        }
    }

    /// Makes the frames of eight hits from unit tangents and normals, lane by lane like [`FiberFrame::from_tangent_normal`].
    ///
    /// With `wo` as the normal, the azimuth of `wo` is 0 in every lane.
    ///
    /// - Shape: one hit per lane.
    /// - Domain: unit vectors. If the normal lies along the fibre, to within 1e-5 rad, `v` is any direction across the fibre.
    /// - Accuracy: orthonormal to 1e-6; `v` within 1e-4 of the result of the scalar call where normal and tangent are 0.01 rad
    ///   apart.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairis::{FiberFrame8, Vec3x8};
    /// let frames = FiberFrame8::from_tangents_normals(&Vec3x8::splat(Vec3::X), &Vec3x8::splat(Vec3::new(0.6, 0.8, 0.0)));
    /// assert_eq!((frames.v.lane(7), frames.w.lane(7)), (Vec3::Y, Vec3::Z));
    /// ```
    #[inline]
    #[must_use]
    pub fn from_tangents_normals(tangents: &Vec3x8, normals: &Vec3x8) -> Self {
        let across = reject8(normals, tangents);
        let along = across.dot(across).simd_lt(f32x8::splat(1e-10));
        let mut v = unit8(&across);
        if along.any() {
            let lanes = along.to_bitmask();
            let any = |lane: usize| tangents.lane(lane).any_orthonormal_vector();
            v = core::array::from_fn::<Vec3, 8, _>(|lane| {
                if lanes >> lane & 1 == 1 {
                    any(lane)
                } else {
                    v.lane(lane)
                }
            })
            .into();
        }
        // Repeated, because the first difference leaves up to 1e-2 of the tangent where the normal is almost along it.
        let v = unit8(&reject8(&v, tangents));
        let u = tangents;
        let w = Vec3x8::new(
            u.y * v.z - u.z * v.y,
            u.z * v.x - u.x * v.z,
            u.x * v.y - u.y * v.x,
        );
        Self { u: *u, v, w }
    }

    /// Makes the frames of eight hits from unit tangents, lane by lane like [`FiberFrame::from_tangent`].
    ///
    /// - Shape: one hit per lane.
    /// - Accuracy: orthonormal to 1e-6.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairis::{FiberFrame8, Vec3x8};
    /// let frames = FiberFrame8::from_tangents(&Vec3x8::splat(Vec3::Z));
    /// assert_eq!((frames.v.lane(7), frames.w.lane(7)), (Vec3::X, Vec3::Y));
    /// ```
    #[inline]
    #[must_use]
    pub fn from_tangents(tangents: &Vec3x8) -> Self {
        // Duff et al. 2017, in the order of glam's `any_orthonormal_pair`.
        let u = *tangents;
        let sign = f32x8::ONE.copysign(u.z);
        let a = -f32x8::ONE / (sign + u.z);
        let b = u.x * u.y * a;
        Self {
            u,
            v: Vec3x8::new(f32x8::ONE + sign * u.x * u.x * a, sign * b, -sign * u.x),
            w: Vec3x8::new(b, sign + u.y * u.y * a, -u.y),
        }
    }

    /// Returns the offsets across the fibres for unit vectors, lane by lane like [`FiberFrame::offset`].
    ///
    /// - Shape: one hit per lane.
    /// - Domain: unit vectors in the world. If either vector lies along the fibre, the offset is 0.
    #[inline]
    #[must_use]
    pub fn offset(&self, normals: &Vec3x8, wo: &Vec3x8) -> f32x8 {
        let across = |vector: &Vec3x8| {
            let local = self.to_local(vector);
            unit8(&Vec3x8::new(f32x8::ZERO, local.y, local.z))
        };
        let (n, wo) = (across(normals), across(wo));
        (n.y * wo.z - n.z * wo.y)
            .fast_max(-f32x8::ONE)
            .fast_min(f32x8::ONE)
    }

    /// Transforms vectors from the world to the fibres, each lane into its own frame.
    #[inline]
    #[must_use]
    pub fn to_local(&self, v: &Vec3x8) -> Vec3x8 {
        Vec3x::new(v.dot(self.u), v.dot(self.v), v.dot(self.w))
    }

    /// Transforms vectors from the fibres to the world, each lane out of its own frame.
    #[inline]
    #[must_use]
    pub fn to_world(&self, v: &Vec3x8) -> Vec3x8 {
        self.u
            .scale(v.x)
            .plus(self.v.scale(v.y))
            .plus(self.w.scale(v.z))
    }
}

impl From<[FiberFrame; 8]> for FiberFrame8 {
    #[inline]
    fn from(frames: [FiberFrame; 8]) -> Self {
        Self {
            u: frames.map(|f| f.u).into(),
            v: frames.map(|f| f.v).into(),
            w: frames.map(|f| f.w).into(),
        }
    }
}

/// Returns the part of `a` across the unit vector `u`.
#[inline]
fn reject8(a: &Vec3x8, u: &Vec3x8) -> Vec3x8 {
    a.plus(u.scale(-a.dot(*u)))
}

/// Scales each vector to unit length; a zero vector stays short.
#[inline]
fn unit8(a: &Vec3x8) -> Vec3x8 {
    a.scale(f32x8::splat(1.0) / a.dot(*a).max(f32x8::splat(1e-30)).sqrt())
}
