//! The piecewise-linear function of the cdf that follows W, and its inverse, on one side of the cdf's middle.

use crate::Lanes;

/// Distances from the nearer end at which the pieces meet, by the number of segments a side: found by minimising the
/// variance over the grid of the efficiency figures. The last is the middle, which both sides share.
const NODES: [[f32; 5]; 3] = [[0.0, 0.06, 0.5, 0.5, 0.5], [0.0, 0.023, 0.135, 0.5, 0.5], [0.0, 0.012, 0.06, 0.2, 0.5]];

/// Where W is taken for the height at the very end, where it is 0.
pub(super) const NEAR_END: f32 = 1e-3;

/// The share of its neighbour's height that the height at the end is at least: it bounds the weights there.
pub(super) const END_SHARE: f32 = 0.25;

/// Node `j` of `segments` a side, 0 to `segments`.
#[inline(always)]
pub(super) const fn node(segments: usize, j: usize) -> f32 {
    assert!(segments >= 2 && segments <= 4, "2, 3 or 4 segments a side");
    NODES[segments - 2][j]
}

/// Heights of one side at its nodes, from the end inwards, and in the middle.
#[derive(Clone, Copy)]
pub(super) struct Side<L, const N: usize> {
    pub(super) outer: [L; N],
    pub(super) middle: L,
}

impl<L: Lanes, const N: usize> Side<L, N> {
    /// Height at node `j`.
    #[inline(always)]
    pub(super) fn at_node(&self, j: usize) -> L {
        if j < N { self.outer[j] } else { self.middle }
    }

    /// Height at distance `v` from the end: a sum of positive terms, exact at the nodes however the heights differ.
    #[inline(always)]
    pub(super) fn at(&self, v: L) -> L {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        // How much of each segment lies below v.
        let mut passed = one.min(v * L::splat(1.0 / node(N, 1)));
        let mut height = (one - passed) * self.outer[0];
        let mut j = 1;
        while j < N {
            let inv = 1.0 / (node(N, j + 1) - node(N, j));
            let next = v.mul_add(L::splat(inv), L::splat(-inv * node(N, j)));
            let next = zero.max(next.min(one));
            height = (passed - next).mul_add(self.outer[j], height);
            passed = next;
            j += 1;
        }
        passed.mul_add(self.middle, height)
    }

    /// Area below the side.
    #[inline(always)]
    pub(super) fn area(&self) -> L {
        // Each height times half of what its two segments take.
        let mut sum = self.outer[0] * L::splat(0.5 * node(N, 1));
        let mut j = 1;
        while j < N {
            sum = self.outer[j].mul_add(L::splat(0.5 * (node(N, j + 1) - node(N, j - 1))), sum);
            j += 1;
        }
        self.middle.mul_add(L::splat(0.5 * (node(N, N) - node(N, N - 1))), sum)
    }

    /// The distance from the end below which the area is `area`.
    #[inline(always)]
    pub(super) fn invert(&self, area: L) -> L {
        let c = L::splat;
        let (zero, half) = (c(0.0), c(0.5));
        // The segment: its start, length, heights, and what is left of the area.
        let mut start = zero;
        let (mut length, mut inv_length) = (c(node(N, 1)), c(1.0 / node(N, 1)));
        let (mut from, mut to) = (self.outer[0], self.at_node(1));
        let mut rest = area;
        let mut below = (from + to) * (length * half);
        let mut j = 1;
        while j < N {
            let (a, b) = (node(N, j), node(N, j + 1));
            let inside = area.lt(below);
            start = L::select(inside, start, c(a));
            length = L::select(inside, length, c(b - a));
            inv_length = L::select(inside, inv_length, c(1.0 / (b - a)));
            let (left, right) = (self.outer[j], self.at_node(j + 1));
            from = L::select(inside, from, left);
            to = L::select(inside, to, right);
            rest = L::select(inside, rest, area - below);
            below = (left + right).mul_add(c(0.5 * (b - a)), below);
            j += 1;
        }
        let slope = (to - from) * inv_length;
        let root = zero.max(from.mul_add(from, (slope + slope) * rest)).sqrt();
        start + zero.max((rest + rest) / (from + root)).min(length)
    }
}
