//! Blocks of eight triangles, and the test of a ray against them.

use super::Boxes;
use super::block::{Leaf, bits, slack};
use super::build::build;
use super::ray::{Ray, Spread};
use super::split::Primitive;
use crate::geometry::{Bounds, Mesh};
use hairis::simd::{Lanes, f32x8, lanes3};

/// Tree of boxes over the triangles of a mesh, which finds the triangles that rays meet from either side.
#[derive(Clone, Debug)]
pub struct MeshTree(Boxes<Triangles>);

impl MeshTree {
    /// Builds the tree over all triangles. The tree is the same for any number of threads.
    #[must_use]
    pub fn build(mesh: &Mesh) -> Self {
        let slack = slack(&mesh.bounds());
        let primitive = |number: u32| {
            let corners = mesh.corners(number);
            let bounds = corners.into_iter().fold(Bounds::EMPTY, |b, p| b.with(p));
            Primitive {
                bounds: Bounds {
                    lo: bounds.lo - slack,
                    hi: bounds.hi + slack,
                },
                strand: u32::MAX,
                number,
            }
        };
        let primitives = (0..).take(mesh.triangles()).map(primitive).collect();
        Self(Boxes::new(build(primitives, |block| {
            Triangles::new(mesh, block)
        })))
    }

    /// Returns the distance and the number of the nearest triangle that the ray meets. Among equally near
    /// triangles, the one with the lowest number is returned.
    #[inline]
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<(f32, u32)> {
        self.0.closest(ray)
    }

    /// Returns true if the ray meets any triangle.
    #[inline]
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray)
    }
}

/// Eight triangles, lane by lane. Free lanes are at NaN, which nothing meets.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Triangles {
    corners: [[f32x8; 3]; 3],
    number: [u32; 8],
}

impl Triangles {
    fn new(mesh: &Mesh, triangles: &[Primitive]) -> Self {
        let mut corners = [[[f32::NAN; 8]; 3]; 3];
        let mut number = [u32::MAX; 8];
        for (lane, triangle) in triangles.iter().enumerate() {
            number[lane] = triangle.number;
            for (lanes, corner) in corners.iter_mut().zip(mesh.corners(triangle.number)) {
                for (lanes, place) in lanes.iter_mut().zip(corner.to_array()) {
                    lanes[lane] = place;
                }
            }
        }
        Self {
            corners: corners.map(|corner| corner.map(f32x8::new)),
            number,
        }
    }
}

/// Returns `a x b`, which is exactly the opposite of `b x a`, because nothing is fused.
#[inline(always)]
fn cross<L: Lanes>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
fn dot<L: Lanes>(a: [L; 3], b: [L; 3]) -> L {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

impl Leaf for Triangles {
    type Hit = (f32, u32);

    /// Finds on which side of the three edges the ray passes. Two triangles find exactly opposite numbers
    /// at an edge that they share, so that no ray slips between them.
    #[inline(always)]
    fn meet<L: Lanes<Stored = f32x8>>(&self, ray: &Spread<L>, limit: f32) -> (u32, [f32x8; 2]) {
        let from = |corner: &[f32x8; 3]| -> [L; 3] {
            let [x, y, z]: [L; 3] = lanes3(corner);
            [x - ray.origin[0], y - ray.origin[1], z - ray.origin[2]]
        };
        let [a, b, c] = [
            from(&self.corners[0]),
            from(&self.corners[1]),
            from(&self.corners[2]),
        ];
        // The parts across the ray are as short as the triangle: products of the whole vectors would have
        // rounding errors larger than a small triangle far away.
        let across = |v: [L; 3]| {
            let along = dot(ray.direction, v);
            [
                v[0] - ray.direction[0] * along,
                v[1] - ray.direction[1] * along,
                v[2] - ray.direction[2] * along,
            ]
        };
        let [p, q, r] = [across(a), across(b), across(c)];
        let sides = [
            dot(ray.direction, cross(p, q)),
            dot(ray.direction, cross(q, r)),
            dot(ray.direction, cross(r, p)),
        ];
        let least = sides[0].min(sides[1]).min(sides[2]);
        let most = sides[0].max(sides[1]).max(sides[2]);
        // Use the corners themselves, because corners relative to the ray's origin have lost digits of small triangles.
        let edge = |to: &[f32x8; 3]| -> [L; 3] {
            let (to, from): ([L; 3], [L; 3]) = (lanes3(to), lanes3(&self.corners[0]));
            [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
        };
        let normal = cross(edge(&self.corners[1]), edge(&self.corners[2]));
        let t = L::quotient(dot(normal, a), dot(normal, ray.direction));
        let within = L::and(L::splat(0.0).lt(t), t.lt(L::splat(limit)));
        // No two sides have opposite signs.
        let inside = L::splat(-f32::MIN_POSITIVE).lt(least.max(L::splat(0.0) - most));
        (bits::<L>(L::and(inside, within)), [t.store(), t.store()])
    }

    #[inline(always)]
    fn skipped(&self, _lane: usize, _t: f32, _ray: &Ray) -> bool {
        false
    }

    #[inline(always)]
    fn number(&self, lane: usize) -> u32 {
        self.number[lane]
    }

    #[inline]
    fn hit(&self, lane: usize, _ray: &Ray, t: f32, _s: f32) -> (f32, u32) {
        (t, self.number[lane])
    }
}
