//! Blocks of eight triangles, and the test of a ray against them.

use super::Boxes;
use super::block::{Leaf, bits};
use super::build::{build, slack};
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
        let t = dot(normal, a) / dot(normal, ray.direction);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lights::uniform_direction;
    use glam::{DVec3, Vec3};
    use hairis_instruments::sequence::{Independent, XiSource as _};

    /// A ball of triangles about a place, of radius 1.
    fn ball(rings: u32, centre: Vec3) -> Mesh {
        let around = 2 * rings;
        let place = |ring: u32, k: u32| {
            let theta = core::f32::consts::PI * ring as f32 / rings as f32;
            let phi = core::f32::consts::TAU * (k % around) as f32 / around as f32;
            let across = if ring.is_multiple_of(rings) {
                0.0
            } else {
                theta.sin()
            };
            centre + Vec3::new(across * phi.cos(), theta.cos(), across * phi.sin())
        };
        let places = (0..=rings).flat_map(|ring| (0..around).map(move |k| place(ring, k)));
        let number = |ring: u32, k: u32| ring * around + k % around;
        let quads = (0..rings).flat_map(|ring| (0..around).map(move |k| (ring, k)));
        let triangles = quads.flat_map(|(ring, k)| {
            let [a, b] = [number(ring, k), number(ring, k + 1)];
            let [c, d] = [number(ring + 1, k), number(ring + 1, k + 1)];
            [[a, b, c], [b, d, c]]
        });
        Mesh::new(places.collect(), triangles.collect()).expect("a ball")
    }

    /// Returns the distance in `f64`, and how far inside its edges the triangle is met, as parts of its
    /// heights.
    fn meet(corners: [Vec3; 3], ray: &Ray) -> (f64, f64) {
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let normal = (b - a).cross(c - a);
        let t = normal.dot(a - origin) / normal.dot(direction);
        let p = origin + t * direction;
        let side = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(normal) / normal.length_squared();
        (t, side(a, b).min(side(b, c)).min(side(c, a)))
    }

    #[test]
    fn the_tree_finds_what_a_search_of_all_finds() {
        let mesh = ball(24, Vec3::new(3.0, -2.0, 1.0));
        let tree = MeshTree::build(&mesh);
        let mut xi = Independent::new(2, 0);
        let (mut met, mut unclear) = (0, 0);
        for turn in 0..4000 {
            let centre = Vec3::new(3.0, -2.0, 1.0);
            let away = uniform_direction(xi.next_xi_f32());
            let origin = centre + [0.3, 5.0, 60.0][turn % 3] * away;
            let aim = centre + 1.1 * uniform_direction(xi.next_xi_f32());
            let ray = Ray {
                t_max: if turn % 5 == 0 { 4.0 } else { f32::INFINITY },
                ..Ray::new(origin, (aim - origin).normalize())
            };
            let all = (0..)
                .take(mesh.triangles())
                .map(|k| meet(mesh.corners(k), &ray));
            let ahead = all.filter(|(t, _)| *t > 0.0 && *t < f64::from(ray.t_max));
            let (sure, near): (Vec<_>, Vec<_>) = ahead
                .filter(|(_, inside)| *inside > -1e-3)
                .partition(|(_, inside)| *inside > 1e-3);
            let nearest = sure.iter().map(|hit| hit.0).fold(f64::INFINITY, f64::min);
            assert_eq!(tree.closest(&ray).is_some(), tree.occluded(&ray), "{ray:?}");
            match tree.closest(&ray) {
                Some((t, triangle)) if near.is_empty() => {
                    // Off the surface by some roundings of the distance: along a ray that grazes it by more.
                    let cos = f64::from(mesh.normal(triangle).dot(ray.direction).abs());
                    let off = cos * (f64::from(t) - nearest).abs();
                    let bound = 4.0 * f64::from(f32::EPSILON) * (1.0 + nearest);
                    assert!(off < bound, "{t} for {nearest}, where cos is {cos}");
                    met += 1;
                }
                None if near.is_empty() => assert!(sure.is_empty(), "{ray:?} is lost"),
                _ => unclear += 1,
            }
        }
        assert!(met > 2000 && unclear < 600, "{met} met, {unclear} at edges");
    }

    #[test]
    fn no_ray_slips_between_triangles() {
        for (rings, distance) in [(8, 3.0), (200, 3.0), (60, 90.0)] {
            let centre = Vec3::new(1.0, 7.0, -3.0);
            let mesh = ball(rings, centre);
            let tree = MeshTree::build(&mesh);
            let mut xi = Independent::new(5, u64::from(rings));
            for _ in 0..3000 {
                // From outside through corners and edges, and from inside anywhere.
                let [pick, along, ..] = xi.next_xi_f32::<3>();
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "below the count"
                )]
                let triangle = (0.999 * pick * mesh.triangles() as f32) as u32;
                let [a, b, _] = mesh.corners(triangle);
                let target = if along < 0.3 { a } else { a.lerp(b, along) };
                let outward = (target - centre).normalize();
                let tilt = 0.3 * uniform_direction(xi.next_xi_f32());
                let direction = (tilt - outward).normalize();
                let ray = Ray::new(target - distance * direction, direction);
                assert!(tree.occluded(&ray), "{ray:?} passes {target}");
                let inside = Ray::new(centre, uniform_direction(xi.next_xi_f32()));
                assert!(tree.occluded(&inside), "{inside:?} leaves");
            }
        }
    }
}
