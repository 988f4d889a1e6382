//! Nodes of eight boxes, and the test of a ray against them.

use super::block::bits;
use super::ray::Spread;
use crate::geometry::Bounds;
use hairis::simd::{Broadcast, Lanes, f32x8};

/// Eight boxes, lane by lane, and the child in each. Free lanes hold empty boxes, which nothing passes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Node {
    /// Lower, then upper bounds.
    bounds: [[f32x8; 3]; 2],
    children: [Child; 8],
}

/// Link to a node or to a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Child(u32);

impl Child {
    /// Node with which the search begins.
    pub(super) const ROOT: Self = Self(0);

    pub(super) fn node(index: usize) -> Self {
        Self(
            u32::try_from(index << 1)
                .expect("segments are counted in 31 bits, and nodes are fewer"),
        )
    }

    pub(super) fn block(index: usize) -> Self {
        Self(
            u32::try_from(index << 1 | 1)
                .expect("segments are counted in 31 bits, and blocks are fewer"),
        )
    }

    #[inline(always)]
    pub(super) fn is_block(self) -> bool {
        self.0 & 1 == 1
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        (self.0 >> 1) as usize
    }
}

impl Node {
    /// Creates a node of at most eight children.
    pub(super) fn new(children: &[(Bounds, Child)]) -> Self {
        let (mut lo, mut hi) = ([[f32::INFINITY; 8]; 3], [[f32::NEG_INFINITY; 8]; 3]);
        let mut links = [Child::ROOT; 8];
        for (lane, (bounds, child)) in children.iter().enumerate() {
            for axis in 0..3 {
                lo[axis][lane] = bounds.lo[axis];
                hi[axis][lane] = bounds.hi[axis];
            }
            links[lane] = *child;
        }
        Self {
            bounds: [lo.map(f32x8::new), hi.map(f32x8::new)],
            children: links,
        }
    }

    /// Returns the boxes that the ray passes before `limit`: lanes as bits, and the distances at which the ray enters them.
    #[inline(always)]
    pub(super) fn pass<L: Lanes<Stored = f32x8>>(
        &self,
        ray: &Spread<L>,
        limit: f32,
    ) -> (u32, f32x8) {
        let mut near = L::splat(0.0);
        let mut far = L::splat(limit);
        let mut axis = 0;
        while axis < 3 {
            let sign = ray.negative[axis];
            let enter: L = self.bounds[sign][axis].lanes();
            let leave: L = self.bounds[1 - sign][axis].lanes();
            near = enter
                .mul_sub(ray.inverse[axis], ray.origin_inverse[axis])
                .max(near);
            far = leave
                .mul_sub(ray.inverse[axis], ray.origin_inverse[axis])
                .min(far);
            axis += 1;
        }
        (bits::<L>(near.lt(far * ROUNDING)), near.store())
    }

    #[inline(always)]
    pub(super) fn child(&self, lane: usize) -> Child {
        self.children[lane]
    }
}

/// Factor by which far sides are moved away, so that no box is missed by rounding: 1 + 2^-20.
const ROUNDING: f32 = 1.0 + 1.0 / 1_048_576.0;
