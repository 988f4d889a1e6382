//! Boxes along the axes.

use glam::Vec3;

/// A box along the axes. The empty one has `lo` above `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub lo: Vec3,
    /// Upper corner.
    pub hi: Vec3,
}

impl Bounds {
    /// Holds nothing.
    pub const EMPTY: Self = Self {
        lo: Vec3::INFINITY,
        hi: Vec3::NEG_INFINITY,
    };

    /// Whether it holds nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.lo.cmple(self.hi).all()
    }

    /// The smallest box that holds both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    /// The smallest box that holds it and a point.
    #[inline]
    #[must_use]
    pub fn with(&self, point: Vec3) -> Self {
        Self {
            lo: self.lo.min(point),
            hi: self.hi.max(point),
        }
    }

    /// Centre.
    #[inline]
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        0.5 * (self.lo + self.hi)
    }

    /// Extent along each axis; of the empty box 0.
    #[inline]
    #[must_use]
    pub fn size(&self) -> Vec3 {
        (self.hi - self.lo).max(Vec3::ZERO)
    }

    /// Half the area of the surface; of the empty box 0.
    #[inline]
    #[must_use]
    pub fn half_area(&self) -> f32 {
        let size = self.size();
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}
