//! Rectangles in any frame, which serve as walls and as lights.

use super::{LightSample, Seen};
use clap::ValueEnum;
use core::f64::consts::PI;
use glam::{DVec3, Vec3};
use hairis_instruments::light::rounded;

/// Solid angle, in sr, below which the difference of the corners' angles keeps no digits: points are then drawn by area.
const SMALL: f64 = 1e-7;

/// How directions towards rectangles are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum RectangleSampling {
    /// Uniform in solid angle
    #[default]
    SolidAngle,
    /// Points uniform over the area
    Area,
}

/// Rectangle in any frame. It emits on the side of its normal, and reflects on both sides.
///
/// ```
/// use glam::Vec3;
/// use hairis_render::lights::{Rectangle, RectangleSampling};
/// let lamp = Rectangle::light(Vec3::new(-1.0, 1.0, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z, Vec3::ONE);
/// assert_eq!(lamp.normal(), Vec3::NEG_Y);
/// let sixth = 4.0 * core::f32::consts::PI / 6.0; // a face of a cube, from its centre
/// let view = lamp.view(Vec3::ZERO, RectangleSampling::SolidAngle).expect("in front");
/// assert!((1.0 / view.pdf(Vec3::Y) - sixth).abs() < 1e-5);
/// // By area: the squared distance over the area and the cosine at the lamp.
/// let view = lamp.view(Vec3::ZERO, RectangleSampling::Area).expect("in front");
/// assert!((view.pdf(Vec3::Y) - 0.25).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    corner: Vec3,
    edges: [Vec3; 2],
    normal: Vec3,
    /// Radiance that the rectangle emits.
    pub emission: Vec3,
    /// Share of the light that the rectangle reflects, by Lambert's law.
    pub albedo: Vec3,
}

/// Rectangle as seen from a point, in the frame of the rectangle with the point as origin.
#[derive(Clone, Copy, Debug)]
pub struct View {
    emission: Vec3,
    axes: [DVec3; 3],
    lo: [f64; 2],
    hi: [f64; 2],
    /// Distance of the plane from the point, above 0.
    height: f64,
    /// Projection on the unit sphere; `None` if points are drawn by area.
    projected: Option<Projected>,
}

/// Rectangle projected onto the unit sphere.
#[derive(Clone, Copy, Debug)]
struct Projected {
    solid_angle: f64,
    /// Two pi less the angles at the two corners of low x.
    start: f64,
    /// Heights of the normals of the planes through the sides of low and high y.
    normals: [f64; 2],
}

impl Rectangle {
    /// Creates a light from a corner, two edges at a right angle, and a radiance. The light shines to the side of the origin.
    #[must_use]
    pub fn light(corner: Vec3, edge_a: Vec3, edge_b: Vec3, emission: Vec3) -> Self {
        Self {
            emission,
            ..Self::wall(corner, edge_a, edge_b, Vec3::ZERO)
        }
    }

    /// Creates a wall that reflects, from a corner and two edges at a right angle. Its normal is on the side of the origin.
    #[must_use]
    pub fn wall(corner: Vec3, edge_a: Vec3, edge_b: Vec3, albedo: Vec3) -> Self {
        let normal = edge_a.cross(edge_b).normalize();
        let normal = if normal.dot(corner) > 0.0 {
            -normal
        } else {
            normal
        };
        Self {
            corner,
            edges: [edge_a, edge_b],
            normal,
            emission: Vec3::ZERO,
            albedo,
        }
    }

    /// Turns the normal to the side of a point.
    #[must_use]
    pub fn facing(self, point: Vec3) -> Self {
        let normal = if self.normal.dot(point - self.corner) < 0.0 {
            -self.normal
        } else {
            self.normal
        };
        Self { normal, ..self }
    }

    /// Returns the corner from which the edges start.
    #[must_use]
    pub fn corner(&self) -> Vec3 {
        self.corner
    }

    /// Returns the edges that start at the corner.
    #[must_use]
    pub fn edges(&self) -> [Vec3; 2] {
        self.edges
    }

    /// Returns the unit normal, which is on the side that emits.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Returns the rectangle mirrored in the plane x = 0.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mirror = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
        let corner = self.corner + self.edges[0];
        let edges = [-mirror(self.edges[0]), mirror(self.edges[1])];
        Self {
            corner: mirror(corner),
            edges,
            normal: mirror(self.normal),
            ..*self
        }
    }

    /// Returns the distance along a ray, if the ray meets the rectangle beyond `t_min`.
    #[inline]
    #[must_use]
    pub fn meet(&self, origin: Vec3, direction: Vec3, t_min: f32) -> Option<f32> {
        let towards = direction.dot(self.normal);
        let t = (self.corner - origin).dot(self.normal) / towards;
        let place = origin + t * direction - self.corner;
        let within = |edge: Vec3| (0.0..=edge.length_squared()).contains(&place.dot(edge));
        (t > t_min && t < f32::INFINITY && within(self.edges[0]) && within(self.edges[1]))
            .then_some(t)
    }

    /// Returns the view from a point, which all directions drawn there share, or `None` from behind.
    #[must_use]
    pub fn view(&self, origin: Vec3, sampling: RectangleSampling) -> Option<View> {
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
        let projected = match sampling {
            RectangleSampling::SolidAngle => Projected::new(lo, hi, height),
            RectangleSampling::Area => None,
        };
        Some(View {
            emission: self.emission,
            axes,
            lo,
            hi,
            height,
            projected,
        })
    }
}

/// Returns the length of a vector whose squares are far from overflow.
#[inline]
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

impl Projected {
    /// Projects a rectangle onto the unit sphere, or returns `None` if its solid angle is small.
    ///
    /// - Source: Urena, Fajardo and King 2013.
    fn new(lo: [f64; 2], hi: [f64; 2], height: f64) -> Option<Self> {
        // Components of the normals of the planes through the origin and a side.
        let slope = |side: f64| side / length(side, height);
        let ([x0, y0], [x1, y1]) = (lo.map(slope), hi.map(slope));
        // The spherical rectangle's angles, whose sum exceeds 2 pi by its area.
        let angles = [
            (x1 * y0).acos(),
            (-x1 * y1).acos(),
            (x0 * y1).acos(),
            (-x0 * y0).acos(),
        ];
        let start = 2.0 * PI - angles[2] - angles[3];
        let solid_angle = angles[0] + angles[1] - start;
        (solid_angle > SMALL).then_some(Self {
            solid_angle,
            start,
            normals: [-y0, y1],
        })
    }
}

impl View {
    /// Returns the density of a direction that meets the rectangle, per steradian.
    #[inline]
    #[must_use]
    pub fn pdf(&self, direction: Vec3) -> f32 {
        self.pdf_at(-direction.as_dvec3().dot(self.axes[2]))
    }

    /// Returns the density of a direction at a cosine to the normal, per steradian. By area it is `distance^2 / (area cosine)`.
    #[inline]
    fn pdf_at(&self, cosine: f64) -> f32 {
        rounded(match &self.projected {
            Some(projected) => 1.0 / projected.solid_angle,
            None if cosine > 0.0 => {
                let area = (self.hi[0] - self.lo[0]) * (self.hi[1] - self.lo[1]);
                (self.height * self.height / (area * cosine.powi(3))).min(f32::MAX.into())
            }
            None => 0.0,
        })
    }

    /// Returns the radiance and the density of a ray that meets the rectangle.
    #[inline]
    #[must_use]
    pub fn see(&self, direction: Vec3) -> Seen {
        Seen {
            radiance: self.emission,
            pdf: self.pdf(direction),
        }
    }

    /// Draws a direction towards the rectangle from two uniform numbers.
    #[must_use]
    pub fn sample(&self, xi: [f32; 2]) -> LightSample {
        let [x, y] = self.point(xi.map(f64::from));
        let towards = x * self.axes[0] + y * self.axes[1] - self.height * self.axes[2];
        let distance = towards.length();
        LightSample {
            direction: (towards / distance).as_vec3(),
            distance: rounded(distance),
            radiance: self.emission,
            pdf: self.pdf_at(self.height / distance),
        }
    }

    /// Draws a point of the rectangle, in its frame.
    fn point(&self, xi: [f64; 2]) -> [f64; 2] {
        let Some(Projected {
            solid_angle,
            start,
            normals: [below, above],
        }) = self.projected
        else {
            return [0, 1].map(|k| self.lo[k] + xi[k] * (self.hi[k] - self.lo[k]));
        };
        // The x up to which the solid angle is its share `xi`.
        let (sin, cos) = (xi[0] * solid_angle + start).sin_cos();
        let f = (cos * below - above) / sin;
        let c = (1.0_f64.copysign(f) / length(f, below)).clamp(-1.0, 1.0);
        let x = (c * self.height / (1.0 - c * c).sqrt()).clamp(self.lo[0], self.hi[0]);
        // Across, the sine of the angle to the plane of x and the height is uniform.
        let distance = length(x, self.height);
        let sine = |y: f64| y / length(y, distance);
        let s = sine(self.lo[1]) + xi[1] * (sine(self.hi[1]) - sine(self.lo[1]));
        let y = (s * distance / (1.0 - s * s).max(f64::MIN_POSITIVE).sqrt())
            .clamp(self.lo[1], self.hi[1]);
        [x, y]
    }
}
