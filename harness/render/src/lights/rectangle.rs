//! Rectangles: walls, and lights that are sampled by solid angle.

use super::LightSample;
use core::f64::consts::PI;
use glam::{DVec3, Vec3};
use hairis_harness::light::rounded;

/// Below this solid angle, in sr, the difference of its corners' angles keeps no digits: points are drawn by area.
const SMALL: f64 = 1e-7;

/// A rectangle in any frame. It emits on the side of its normal, and reflects on both.
///
/// ```
/// use glam::Vec3;
/// use hairis_render::lights::Rectangle;
/// let lamp = Rectangle::light(Vec3::new(-1.0, 1.0, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z, Vec3::ONE);
/// assert_eq!(lamp.normal(), Vec3::NEG_Y);
/// let sixth = 4.0 * core::f32::consts::PI / 6.0; // a face of a cube, from its centre
/// assert!((1.0 / lamp.pdf(Vec3::ZERO) - sixth).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    corner: Vec3,
    edges: [Vec3; 2],
    normal: Vec3,
    /// Radiance that it emits.
    pub emission: Vec3,
    /// Share of the light that it reflects, as Lambert's law says.
    pub albedo: Vec3,
}

/// A rectangle as it is seen from a point: in its own frame, with the point as origin.
#[derive(Clone, Copy, Debug)]
pub struct View {
    emission: Vec3,
    axes: [DVec3; 3],
    lo: [f64; 2],
    hi: [f64; 2],
    /// Distance of the plane, above 0.
    height: f64,
    solid_angle: f64,
    /// `2 pi` less the angles at the two corners of low x.
    start: f64,
    /// Heights of the normals of the planes through the sides of low and high y.
    normals: [f64; 2],
}

impl Rectangle {
    /// A light with a corner, two edges at a right angle, and a radiance. It shines to the side of the origin.
    #[must_use]
    pub fn light(corner: Vec3, edge_a: Vec3, edge_b: Vec3, emission: Vec3) -> Self {
        Self { emission, ..Self::wall(corner, edge_a, edge_b, Vec3::ZERO) }
    }

    /// A wall that reflects. Its normal is on the side of the origin.
    #[must_use]
    pub fn wall(corner: Vec3, edge_a: Vec3, edge_b: Vec3, albedo: Vec3) -> Self {
        let normal = edge_a.cross(edge_b).normalize();
        let normal = if normal.dot(corner) > 0.0 { -normal } else { normal };
        Self { corner, edges: [edge_a, edge_b], normal, emission: Vec3::ZERO, albedo }
    }

    /// The same rectangle, its normal on the side of a point.
    #[must_use]
    pub fn facing(self, point: Vec3) -> Self {
        let normal = if self.normal.dot(point - self.corner) < 0.0 { -self.normal } else { self.normal };
        Self { normal, ..self }
    }

    /// Unit normal, on the side that emits.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Mirrored in the plane x = 0.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mirror = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
        let corner = self.corner + self.edges[0];
        let edges = [-mirror(self.edges[0]), mirror(self.edges[1])];
        Self { corner: mirror(corner), edges, normal: mirror(self.normal), ..*self }
    }

    /// Distance along a ray, if it meets the rectangle beyond `t_min`.
    #[inline]
    #[must_use]
    pub fn meet(&self, origin: Vec3, direction: Vec3, t_min: f32) -> Option<f32> {
        let towards = direction.dot(self.normal);
        let t = (self.corner - origin).dot(self.normal) / towards;
        let place = origin + t * direction - self.corner;
        let within = |edge: Vec3| (0.0..=edge.length_squared()).contains(&place.dot(edge));
        (t > t_min && t < f32::INFINITY && within(self.edges[0]) && within(self.edges[1])).then_some(t)
    }

    /// Density of a direction that meets it, per steradian: 1 over the solid angle. 0 from behind.
    #[must_use]
    pub fn pdf(&self, origin: Vec3) -> f32 {
        self.view(origin).map_or(0.0, |view| view.pdf())
    }

    /// A direction drawn from two uniform numbers, uniform in solid angle; `None` from behind.
    ///
    /// - Source: Urena, Fajardo and King 2013.
    #[must_use]
    pub fn sample(&self, origin: Vec3, xi: [f32; 2]) -> Option<LightSample> {
        Some(self.view(origin)?.sample(xi))
    }

    /// How it is seen from a point: several directions from there cost half as much so. `None` from behind.
    #[must_use]
    pub fn view(&self, origin: Vec3) -> Option<View> {
        let corner = (self.corner - origin).as_dvec3();
        let edges = self.edges.map(Vec3::as_dvec3);
        let normal = self.normal.as_dvec3();
        let height = -corner.dot(normal);
        if height.is_nan() || height <= 0.0 {
            return None;
        }
        let lengths = edges.map(DVec3::length);
        let axes = [edges[0] / lengths[0], edges[1] / lengths[1], normal];
        let lo = [corner.dot(axes[0]), corner.dot(axes[1])];
        let hi = [lo[0] + lengths[0], lo[1] + lengths[1]];
        // Components of the normals of the planes through the origin and a side.
        let slope = |side: f64| side / length(side, height);
        let ([x0, y0], [x1, y1]) = (lo.map(slope), hi.map(slope));
        // The spherical rectangle's angles, whose sum exceeds 2 pi by its area.
        let angles = [(x1 * y0).acos(), (-x1 * y1).acos(), (x0 * y1).acos(), (-x0 * y0).acos()];
        let start = 2.0 * PI - angles[2] - angles[3];
        let solid_angle = angles[0] + angles[1] - start;
        let solid_angle = if solid_angle > SMALL {
            solid_angle
        } else {
            let centre = DVec3::new(0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]), height);
            (lengths[0] * lengths[1] * height / centre.length().powi(3)).min(SMALL)
        };
        Some(View { emission: self.emission, axes, lo, hi, height, solid_angle, start, normals: [-y0, y1] })
    }
}

/// Length of a vector whose squares are far from overflow.
#[inline]
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

impl View {
    /// Density of a direction, per steradian.
    #[inline]
    #[must_use]
    pub fn pdf(&self) -> f32 {
        rounded(1.0 / self.solid_angle)
    }

    /// A direction drawn from two uniform numbers, uniform in solid angle.
    #[must_use]
    pub fn sample(&self, xi: [f32; 2]) -> LightSample {
        let [x, y] = self.point(xi.map(f64::from));
        let towards = x * self.axes[0] + y * self.axes[1] - self.height * self.axes[2];
        let distance = towards.length();
        LightSample {
            direction: (towards / distance).as_vec3(),
            distance: rounded(distance),
            radiance: self.emission,
            pdf: self.pdf(),
        }
    }

    /// A point of the rectangle, in its frame.
    fn point(&self, xi: [f64; 2]) -> [f64; 2] {
        if self.solid_angle <= SMALL {
            return [0, 1].map(|k| self.lo[k] + xi[k] * (self.hi[k] - self.lo[k]));
        }
        // The x up to which the solid angle is its share `xi`.
        let [below, above] = self.normals;
        let (sin, cos) = (xi[0] * self.solid_angle + self.start).sin_cos();
        let f = (cos * below - above) / sin;
        let c = (1.0_f64.copysign(f) / length(f, below)).clamp(-1.0, 1.0);
        let x = (c * self.height / (1.0 - c * c).sqrt()).clamp(self.lo[0], self.hi[0]);
        // Across, the sine of the angle to the plane of x and the height is uniform.
        let distance = length(x, self.height);
        let sine = |y: f64| y / length(y, distance);
        let s = sine(self.lo[1]) + xi[1] * (sine(self.hi[1]) - sine(self.lo[1]));
        let y = (s * distance / (1.0 - s * s).max(f64::MIN_POSITIVE).sqrt()).clamp(self.lo[1], self.hi[1]);
        [x, y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_conformance::statistics::chi_square;
    use hairis_harness::sequence::{Independent, XiSource as _};

    fn tilted() -> Rectangle {
        let (a, b) = (Vec3::new(3.0, 1.0, 0.0), Vec3::new(-1.0, 3.0, 2.0).cross(Vec3::new(3.0, 1.0, 0.0)).normalize());
        Rectangle::light(Vec3::new(-2.0, 2.0, 1.0), a, 1.5 * b, Vec3::ONE)
    }

    #[test]
    fn the_solid_angle_is_the_integral_over_the_area() {
        for origin in [Vec3::ZERO, Vec3::new(-1.0, 0.5, 0.7), Vec3::new(0.0, -300.0, 10.0)] {
            let lamp = tilted();
            let [a, b] = lamp.edges;
            let mut sum = 0.0;
            let steps = 400;
            for i in 0..steps {
                for j in 0..steps {
                    let part = |k: u16| (f32::from(k) + 0.5) / f32::from(steps);
                    let towards = lamp.corner + part(i) * a + part(j) * b - origin;
                    let cos = f64::from(-towards.normalize().dot(lamp.normal));
                    sum += cos / f64::from(towards.length_squared());
                }
            }
            let area = f64::from(a.length() * b.length());
            let expected = sum * area / f64::from(steps).powi(2);
            let got = 1.0 / f64::from(lamp.pdf(origin));
            assert!((got / expected - 1.0).abs() < 2e-4, "{origin}: {got} for {expected}");
        }
    }

    #[test]
    fn samples_are_uniform_in_solid_angle() {
        // Share of the solid angle of a part of the rectangle, and of samples that fall on it.
        let lamp = tilted();
        let origin = Vec3::new(-1.0, 0.5, 0.7);
        let mut expected = Vec::new();
        for i in 0..6 {
            for j in 0..6 {
                let part = |k: u16| f32::from(k) / 6.0;
                let corner = lamp.corner + part(i) * lamp.edges[0] + part(j) * lamp.edges[1];
                let part = Rectangle { corner, edges: lamp.edges.map(|edge| edge / 6.0), ..lamp };
                expected.push(60_000.0 * f64::from(lamp.pdf(origin) / part.pdf(origin)));
            }
        }
        let mut counts = vec![0; 36];
        let mut xi = Independent::new(5, 0);
        for _ in 0..60_000 {
            let sample = lamp.sample(origin, xi.next_xi_f32()).expect("in front");
            let place = origin + sample.distance * sample.direction - lamp.corner;
            let cell =
                |edge: Vec3| (0..6_usize).rev().find(|k| place.dot(edge) / edge.length_squared() * 6.0 >= *k as f32);
            counts[6 * cell(lamp.edges[0]).unwrap_or(0) + cell(lamp.edges[1]).unwrap_or(0)] += 1;
            // Rounding may put a sample of the rim outside.
            let on_rim = [lamp.edges[0], lamp.edges[1]].iter().any(|edge| {
                let share = place.dot(*edge) / edge.length_squared();
                share.min(1.0 - share) < 1e-5
            });
            let met = lamp.meet(origin, sample.direction, 0.0);
            assert!(on_rim || met.is_some_and(|t| (t / sample.distance - 1.0).abs() < 1e-4), "{sample:?} misses");
        }
        let p = chi_square(&counts, &expected, 5.0).p_value;
        assert!(p > 1e-3, "p {p}");
    }

    #[test]
    fn a_light_is_black_from_behind_and_mirrors() {
        let lamp = tilted();
        let behind = lamp.corner - 5.0 * lamp.normal;
        assert!(lamp.sample(behind, [0.5; 2]).is_none() && lamp.pdf(behind) == 0.0);
        let mirrored = lamp.mirrored();
        let mirror = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
        let a = lamp.sample(Vec3::X, [0.3, 0.6]).expect("in front");
        let b = mirrored.sample(Vec3::NEG_X, [0.7, 0.6]).expect("in front");
        assert!((mirror(a.direction) - b.direction).length() < 1e-5, "{a:?} {b:?}");
        assert!((mirrored.pdf(mirror(Vec3::X)) / lamp.pdf(Vec3::X) - 1.0).abs() < 1e-5);
    }
}
