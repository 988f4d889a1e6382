//! Heads on which hair grows: ellipsoids and meshes of skin.

use crate::geometry::{Bounds, Mesh};
use crate::tree::{MeshTree, Ray};
use glam::Vec3;
use hairis::Vec3x8;
use hairis::simd::f32x8;

/// Head that reflects light by Lambert's law.
#[derive(Clone, Debug)]
pub struct Head {
    /// Surface of the head.
    pub shape: Shape,
    /// Share of the light that the head reflects.
    pub albedo: Vec3,
}

/// Surface of a head: an ellipsoid or a mesh.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Ellipsoid, which rays meet from outside.
    Ellipsoid(Ellipsoid),
    /// Triangles, which rays meet from either side.
    Mesh(Box<(Mesh, MeshTree)>),
}

impl Head {
    /// Albedo of skin, which heads have unless it is changed.
    pub const SKIN: Vec3 = Vec3::new(0.45, 0.32, 0.25);

    /// Creates a head from an ellipsoid, with the albedo of skin.
    #[must_use]
    pub fn ellipsoid(ellipsoid: Ellipsoid) -> Self {
        Self {
            shape: Shape::Ellipsoid(ellipsoid),
            albedo: Self::SKIN,
        }
    }

    /// Creates a head from a mesh, with the albedo of skin, and builds the tree of the mesh.
    #[must_use]
    pub fn mesh(mesh: Mesh) -> Self {
        let tree = MeshTree::build(&mesh);
        Self {
            shape: Shape::Mesh(Box::new((mesh, tree))),
            albedo: Self::SKIN,
        }
    }

    /// Returns the number of triangles, which is 0 for an ellipsoid.
    #[must_use]
    pub fn triangles(&self) -> usize {
        match &self.shape {
            Shape::Ellipsoid(_) => 0,
            Shape::Mesh(mesh) => mesh.0.triangles(),
        }
    }

    /// Returns the smallest box that holds the head.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        match &self.shape {
            Shape::Ellipsoid(Ellipsoid { centre, radii }) => Bounds {
                lo: *centre - *radii,
                hi: *centre + *radii,
            },
            Shape::Mesh(mesh) => mesh.0.bounds(),
        }
    }

    /// Returns the distance along a ray to the head, and the unit normal there on the side of the ray.
    #[inline]
    #[must_use]
    pub fn meet(&self, ray: &Ray) -> Option<(f32, Vec3)> {
        match &self.shape {
            Shape::Ellipsoid(ellipsoid) => {
                let t = ellipsoid.meet(ray.origin, ray.direction, 0.0)?;
                let normal = || ellipsoid.normal(ray.origin + t * ray.direction);
                (t < ray.t_max).then(|| (t, normal()))
            }
            Shape::Mesh(mesh) => {
                let (t, triangle) = mesh.1.closest(ray)?;
                let behind = mesh.0.normal(triangle).dot(ray.direction) > 0.0;
                let normal = mesh
                    .0
                    .shading_normal(triangle, ray.origin + t * ray.direction);
                Some((t, if behind { -normal } else { normal }))
            }
        }
    }

    /// Returns true if a ray meets the head before the ray ends.
    #[inline]
    #[must_use]
    pub fn blocks(&self, ray: &Ray) -> bool {
        match &self.shape {
            Shape::Ellipsoid(ellipsoid) => ellipsoid
                .meet(ray.origin, ray.direction, 0.0)
                .is_some_and(|t| t < ray.t_max),
            Shape::Mesh(mesh) => mesh.1.occluded(ray),
        }
    }
}

/// Ellipsoid along the axes, which rays meet from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Centre of the ellipsoid.
    pub centre: Vec3,
    /// Half lengths of the ellipsoid's axes.
    pub radii: Vec3,
}

impl Ellipsoid {
    /// Returns the distance along a ray, if the ray meets the ellipsoid from outside beyond `t_min`.
    #[inline]
    #[must_use]
    pub fn meet(&self, origin: Vec3, direction: Vec3, t_min: f32) -> Option<f32> {
        let (origin, direction) = ((origin - self.centre) / self.radii, direction / self.radii);
        let (a, b) = (direction.length_squared(), origin.dot(direction));
        let discriminant = b * b - a * (origin.length_squared() - 1.0);
        let t = (-b - discriminant.max(0.0).sqrt()) / a;
        (discriminant >= 0.0 && t > t_min).then_some(t)
    }

    /// Tests eight rays from a point up to their ends. Returns a mask that agrees bit for bit with
    /// [`meet`](Self::meet).
    #[inline]
    #[must_use]
    pub fn blocks8(&self, origin: Vec3, direction: &Vec3x8, t_max: &f32x8) -> f32x8 {
        let c = f32x8::splat;
        let origin = (origin - self.centre) / self.radii;
        let Vec3x8 { x, y, z } = *direction;
        let (x, y, z) = (
            x / c(self.radii.x),
            y / c(self.radii.y),
            z / c(self.radii.z),
        );
        let (a, b) = (
            x * x + y * y + z * z,
            c(origin.x) * x + c(origin.y) * y + c(origin.z) * z,
        );
        let discriminant = b * b - a * c(origin.length_squared() - 1.0);
        let t = (-b - discriminant.max(c(0.0)).sqrt()) / a;
        discriminant.simd_ge(c(0.0)) & t.simd_gt(c(0.0)) & t.simd_lt(*t_max)
    }

    /// Returns the unit normal at a point of the surface.
    #[inline]
    #[must_use]
    pub fn normal(&self, point: Vec3) -> Vec3 {
        ((point - self.centre) / (self.radii * self.radii)).normalize()
    }
}
