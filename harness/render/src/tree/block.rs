//! Blocks of eight segments, and the test of a ray against them.

use super::ray::{Hit, Meet, Ray, Spread};
use super::split::Primitive;
use crate::geometry::{Bounds, Strands};
use glam::Vec3;
use hairis::simd::{Broadcast, Lanes, f32x8, lanes3};

/// Eight segments, lane by lane. Free lanes start at NaN, which nothing meets.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Block {
    start: [f32x8; 3],
    edge: [f32x8; 3],
    radius: f32x8,
    /// Growth of the radius towards the other end.
    widening: f32x8,
    number: [u32; 8],
    strand: [u32; 8],
}

/// Content of the leaves of a tree: eight segments or triangles.
pub(super) trait Leaf {
    /// Hit of one of the primitives.
    type Hit;

    /// Returns the primitives that the ray meets before `limit`: lanes as bits, distances, and places along
    /// the primitives.
    fn meet<L: Lanes<Stored = f32x8>>(&self, ray: &Spread<L>, limit: f32) -> (u32, [f32x8; 2]);

    /// Returns true if the primitive is of the strand that the ray leaves, at a distance that the ray ignores.
    fn skipped(&self, lane: usize, t: f32, ray: &Ray) -> bool;

    /// Returns the number of the primitive.
    fn number(&self, lane: usize) -> u32;

    /// Completes a hit of which distance and place are known.
    fn hit(&self, lane: usize, ray: &Ray, t: f32, s: f32) -> Self::Hit;
}

/// Returns the slack of boxes against rounding, for rays that start within a few times the size of the scene.
pub(super) fn slack(bounds: &Bounds) -> f32 {
    if bounds.is_empty() {
        0.0
    } else {
        bounds.lo.abs().max(bounds.hi.abs()).max_element() / (1 << 21) as f32
    }
}

/// Returns the boxes of all segments. A ray that passes an end within its radius meets the segment, so
/// that the box is that of spheres about both ends, with some slack.
pub(super) fn primitives(strands: &Strands) -> Vec<Primitive> {
    let slack = slack(&strands.bounds());
    let sphere = |k, s| {
        let (centre, radius): (Vec3, f32) = (strands.position(k, s), strands.radius(k, s) + slack);
        Bounds {
            lo: centre - radius,
            hi: centre + radius,
        }
    };
    let box_of = |k| sphere(k, 0.0).union(&sphere(k, 1.0));
    strands
        .numbers()
        .map(|(strand, number)| Primitive {
            bounds: box_of(number),
            strand,
            number,
        })
        .collect()
}

impl Block {
    /// Creates a block of at most eight segments.
    pub(super) fn new(strands: &Strands, segments: &[Primitive]) -> Self {
        let (mut start, mut edge) = ([[f32::NAN; 8]; 3], [[0.0; 8]; 3]);
        let (mut radius, mut widening) = ([0.0; 8], [0.0; 8]);
        let (mut number, mut strand) = ([u32::MAX; 8], [u32::MAX; 8]);
        for (lane, segment) in segments.iter().enumerate() {
            let (of, k) = (segment.strand, segment.number);
            let from = strands.position(k, 0.0);
            let along = strands.position(k, 1.0) - from;
            for axis in 0..3 {
                start[axis][lane] = from[axis];
                edge[axis][lane] = along[axis];
            }
            radius[lane] = strands.radius(k, 0.0);
            widening[lane] = strands.radius(k, 1.0) - radius[lane];
            (number[lane], strand[lane]) = (k, of);
        }
        let [start, edge] = [start, edge].map(|vectors| vectors.map(f32x8::new));
        Self {
            start,
            edge,
            radius: f32x8::new(radius),
            widening: f32x8::new(widening),
            number,
            strand,
        }
    }
}

impl Leaf for Block {
    type Hit = Hit;

    /// Returns the segments whose axis the ray passes nearer than the radius there, before `limit`: lanes as bits, distances, and places
    /// along the segments.
    #[inline(always)]
    fn meet<L: Lanes<Stored = f32x8>>(&self, ray: &Spread<L>, limit: f32) -> (u32, [f32x8; 2]) {
        let [dx, dy, dz] = ray.direction;
        let (start, edge): ([L; 3], [L; 3]) = (lanes3(&self.start), lanes3(&self.edge));
        let from = [
            start[0] - ray.origin[0],
            start[1] - ray.origin[1],
            start[2] - ray.origin[2],
        ];
        let from_along = from[0].mul_add(dx, from[1].mul_add(dy, from[2] * dz));
        let edge_along = edge[0].mul_add(dx, edge[1].mul_add(dy, edge[2] * dz));
        // Start and edge without their parts along the ray, the first with its sign turned.
        let start = [
            from_along.mul_sub(dx, from[0]),
            from_along.mul_sub(dy, from[1]),
            from_along.mul_sub(dz, from[2]),
        ];
        let edge = [
            edge[0] - edge_along * dx,
            edge[1] - edge_along * dy,
            edge[2] - edge_along * dz,
        ];
        // Place on the segment that is nearest to the ray.
        let edge_sq = edge[0].mul_add(edge[0], edge[1].mul_add(edge[1], edge[2] * edge[2]));
        let start_edge = start[0].mul_add(edge[0], start[1].mul_add(edge[1], start[2] * edge[2]));
        let on_line = L::quotient(start_edge, edge_sq.max(L::splat(1e-30)));
        let s = on_line.max(L::splat(0.0)).min(L::splat(1.0));
        let distance_sq_at = |s: L| {
            let axis = [
                s.mul_sub(edge[0], start[0]),
                s.mul_sub(edge[1], start[1]),
                s.mul_sub(edge[2], start[2]),
            ];
            axis[0].mul_add(axis[0], axis[1].mul_add(axis[1], axis[2] * axis[2]))
        };
        let distance_sq = distance_sq_at(s);
        let radius = s.mul_add(self.widening.lanes(), self.radius.lanes());
        let mut t = s.mul_add(edge_along, from_along);
        let mut met = distance_sq.lt(radius * radius);
        if ray.meet == Meet::Surface {
            let along_sq = edge_along.mul_add(edge_along, edge_sq);
            // A tube without ends is entered half a chord before the place nearest to its line, on which all its segments agree.
            let inside = radius
                .mul_sub(radius, distance_sq_at(on_line))
                .max(L::splat(0.0));
            let half = L::quotient(inside * along_sq, edge_sq.max(L::splat(1e-30))).sqrt();
            let enters = on_line.mul_add(edge_along, from_along) - half;
            met = L::and(met, L::splat(0.0).lt(enters));
            // The segment is entered there, or through the plane at one of its ends.
            let foot = on_line - L::quotient(half * edge_along, along_sq);
            let end = foot.max(L::splat(0.0)).min(L::splat(1.0));
            let is_beyond = L::splat(0.0).lt((end - foot).abs());
            let plane = enters + L::quotient((end - foot) * along_sq, edge_along);
            // A ray that has passed the plane meets the round end, at the place nearest to it.
            let at_end = L::select(plane.lt(enters), t, plane.min(t));
            t = L::select(is_beyond, at_end, enters);
        }
        let within = L::and(L::splat(0.0).lt(t), t.lt(L::splat(limit)));
        let met = L::and(met, within);
        (bits::<L>(met), [t.store(), s.store()])
    }

    #[inline(always)]
    fn skipped(&self, lane: usize, t: f32, ray: &Ray) -> bool {
        ray.skip
            .is_some_and(|skip| skip.strand == self.strand[lane] && t < skip.before)
    }

    #[inline(always)]
    fn number(&self, lane: usize) -> u32 {
        self.number[lane]
    }

    #[inline]
    fn hit(&self, lane: usize, ray: &Ray, t: f32, s: f32) -> Hit {
        let vector = |of: &[f32x8; 3]| Vec3::from(of.map(|lanes| lanes.as_array()[lane]));
        let edge = vector(&self.edge);
        let radius = self.radius.as_array()[lane] + s * self.widening.as_array()[lane];
        let from_axis = ray.origin - (vector(&self.start) + s * edge);
        // A ray along the axis has no side.
        let side = edge.cross(ray.direction).normalize_or_zero();
        let h = (from_axis.dot(side) / radius).clamp(-1.0, 1.0);
        Hit {
            t,
            segment: self.number[lane],
            strand: self.strand[lane],
            s,
            h,
        }
    }
}

/// Returns the lanes of a mask as bits.
#[inline(always)]
pub(super) fn bits<L: Lanes<Stored = f32x8>>(mask: L::Mask) -> u32 {
    L::keep(mask, L::splat(-1.0)).store().to_bitmask()
}
