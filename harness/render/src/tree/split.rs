//! Division of a set of segments by the binned surface area heuristic.

use crate::geometry::Bounds;
use glam::Vec3;
use rayon::prelude::*;

/// Segment or triangle over which a tree is built. Triangles are of no strand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Primitive {
    pub(super) bounds: Bounds,
    pub(super) strand: u32,
    pub(super) number: u32,
}

/// Number of bins per axis.
const BINS: usize = 16;
/// Largest number of segments for which cost is counted in blocks, because halves that fill whole blocks are cheaper.
const COUNT_BLOCKS: usize = 64;
/// Number of primitives above which several threads examine a set. Minima, maxima and counts are the same in any order.
const PARALLEL: usize = 1 << 15;

/// Bounds of a set of segments, and of their centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) bounds: Bounds,
    centres: Bounds,
}

impl Extent {
    const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        centres: Bounds::EMPTY,
    };

    /// Returns the extent of `primitives`.
    pub(super) fn of(primitives: &[Primitive]) -> Self {
        if primitives.len() > PARALLEL {
            let chunks = primitives.par_chunks(PARALLEL / 4);
            return chunks.map(Self::of).reduce(
                || Self::EMPTY,
                |a, b| Self {
                    bounds: a.bounds.union(&b.bounds),
                    centres: a.centres.union(&b.centres),
                },
            );
        }
        primitives
            .iter()
            .fold(Self::EMPTY, |extent, primitive| Self {
                bounds: extent.bounds.union(&primitive.bounds),
                centres: extent.centres.with(primitive.bounds.centre()),
            })
    }
}

/// Bounds of the segments of a bin, and their number.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        count: 0,
    };

    fn and(&self, other: &Self) -> Self {
        Self {
            bounds: self.bounds.union(&other.bounds),
            count: self.count + other.count,
        }
    }

    fn cost(&self, in_blocks: bool) -> f32 {
        let count = if in_blocks {
            self.count.div_ceil(8)
        } else {
            self.count
        };
        self.bounds.half_area() * count as f32
    }
}

/// Bins of centres along each axis.
struct Bins([[Bin; BINS]; 3]);

impl Bins {
    const EMPTY: Self = Self([[Bin::EMPTY; BINS]; 3]);

    fn of(primitives: &[Primitive], scale: &Scale) -> Self {
        if primitives.len() > PARALLEL {
            let chunks = primitives.par_chunks(PARALLEL / 4);
            return chunks
                .map(|chunk| Self::of(chunk, scale))
                .reduce(|| Self::EMPTY, |a, b| a.and(&b));
        }
        let mut bins = Self::EMPTY;
        for primitive in primitives {
            for (bins, place) in bins.0.iter_mut().zip(scale.bins(primitive)) {
                let bin = &mut bins[place];
                *bin = bin.and(&Bin {
                    bounds: primitive.bounds,
                    count: 1,
                });
            }
        }
        bins
    }

    fn and(&self, other: &Self) -> Self {
        Self(core::array::from_fn(|axis| {
            core::array::from_fn(|i| self.0[axis][i].and(&other.0[axis][i]))
        }))
    }

    /// Returns the cheapest place to divide: the axis, and the first bin of the upper half. `None` if all centres are in one bin.
    fn cheapest(&self, in_blocks: bool) -> Option<(usize, usize)> {
        let mut best = None;
        let mut least = f32::INFINITY;
        for (axis, bins) in self.0.iter().enumerate() {
            let mut upper = [Bin::EMPTY; BINS];
            let mut sum = Bin::EMPTY;
            for i in (1..BINS).rev() {
                sum = sum.and(&bins[i]);
                upper[i] = sum;
            }
            let mut lower = Bin::EMPTY;
            for i in 1..BINS {
                lower = lower.and(&bins[i - 1]);
                let cost = lower.cost(in_blocks) + upper[i].cost(in_blocks);
                if lower.count > 0 && upper[i].count > 0 && cost < least {
                    (least, best) = (cost, Some((axis, i)));
                }
            }
        }
        best
    }
}

/// Map from centres to bins.
struct Scale {
    lo: Vec3,
    /// Bins per centimetre; 0 along axes without extent.
    bins: Vec3,
}

impl Scale {
    fn of(extent: &Extent) -> Self {
        let size = extent.centres.size();
        // A little less than all, so that the largest centre is in the last bin.
        let bins = Vec3::from_array(size.to_array().map(|x| {
            if x > 1e-20 {
                BINS as f32 * 0.9999 / x
            } else {
                0.0
            }
        }));
        Self {
            lo: extent.centres.lo,
            bins,
        }
    }

    fn bins(&self, primitive: &Primitive) -> [usize; 3] {
        let place = (primitive.bounds.centre() - self.lo) * self.bins;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "bins are cut to whole numbers, from 0"
        )]
        place.to_array().map(|x| (x as usize).min(BINS - 1))
    }
}

/// Orders `primitives`, more than eight, in two parts, and returns the length of the first, which is neither 0 nor all.
pub(super) fn split(primitives: &mut [Primitive], extent: &Extent) -> usize {
    let scale = Scale::of(extent);
    let bins = Bins::of(primitives, &scale);
    match bins.cheapest(primitives.len() <= COUNT_BLOCKS) {
        Some((axis, bin)) => partition(primitives, |primitive| scale.bins(primitive)[axis] < bin),
        None => middle(primitives.len()),
    }
}

/// Returns the middle of more than eight segments, such that the first half fills its blocks.
pub(super) fn middle(segments: usize) -> usize {
    (segments / 2).next_multiple_of(8)
}

/// Moves the primitives that are lower to the front, and returns their number.
fn partition(primitives: &mut [Primitive], lower: impl Fn(&Primitive) -> bool) -> usize {
    let (mut i, mut end) = (0, primitives.len());
    while i < end {
        if lower(&primitives[i]) {
            i += 1;
        } else {
            end -= 1;
            primitives.swap(i, end);
        }
    }
    i
}
