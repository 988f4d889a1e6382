//! Axis-aligned bounding boxes.

use glam::Vec3;

/// Axis-aligned box between two corners. The empty box has `lo` above `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub lo: Vec3,
    /// Upper corner.
    pub hi: Vec3,
}

impl Bounds {
    /// Empty box, whose union with any other box is that other box.
    pub const EMPTY: Self = Self {
        lo: Vec3::INFINITY,
        hi: Vec3::NEG_INFINITY,
    };

    /// Returns true if the box holds no point, as [`EMPTY`](Self::EMPTY) does.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.lo.cmple(self.hi).all()
    }

    /// Returns the smallest box that holds both this box and another.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    /// Returns the smallest box that holds both this box and a point.
    #[inline]
    #[must_use]
    pub fn with(&self, point: Vec3) -> Self {
        Self {
            lo: self.lo.min(point),
            hi: self.hi.max(point),
        }
    }

    /// Returns the centre of the box, half way between its corners.
    #[inline]
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        0.5 * (self.lo + self.hi)
    }

    /// Returns the extent along each axis, which is 0 for the empty box.
    #[inline]
    #[must_use]
    pub fn size(&self) -> Vec3 {
        (self.hi - self.lo).max(Vec3::ZERO)
    }

    /// Returns half the area of the surface, which is 0 for the empty box.
    #[inline]
    #[must_use]
    pub fn half_area(&self) -> f32 {
        let size = self.size();
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}
