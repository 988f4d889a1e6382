//! Pinhole camera, which maps the points of a picture to rays.

use crate::tree::Ray;
use glam::{Quat, Vec3};

/// Pinhole camera that maps each point of a picture to a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: Vec3,
    forward: Vec3,
    right: Vec3,
    up: Vec3,
    /// Tangent of half the vertical angle of view.
    slope: f32,
    size: [u32; 2],
}

impl Camera {
    /// Returns a camera at `eye` that looks at `at`, with a vertical angle of view in degrees, for pictures of `size` pixels.
    /// Up in the picture is the world's y, or its z for a camera that looks along y.
    #[must_use]
    pub fn new(eye: Vec3, at: Vec3, view_deg: f32, size: [u32; 2]) -> Self {
        let forward = (at - eye).normalize_or(Vec3::NEG_Z);
        let right = forward
            .cross(Vec3::Y)
            .try_normalize()
            .unwrap_or_else(|| forward.cross(Vec3::Z).normalize());
        Self {
            eye,
            forward,
            right,
            up: right.cross(forward),
            slope: (0.5 * view_deg.to_radians()).tan(),
            size,
        }
    }

    /// Returns the camera after a turn about the vertical axis through a point, by an angle in degrees from +z towards +x.
    #[must_use]
    pub fn orbit(&self, about: Vec3, degrees: f32) -> Self {
        let turn = |v: Vec3| Quat::from_rotation_y(degrees.to_radians()) * v;
        let eye = about + turn(self.eye - about);
        Self {
            eye,
            forward: turn(self.forward),
            right: turn(self.right),
            up: turn(self.up),
            ..*self
        }
    }

    /// Returns the width and height of the picture in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the camera mirrored in the plane x = 0, which renders a mirrored scene as a mirrored picture.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mirror = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
        let (eye, forward, up) = (mirror(self.eye), mirror(self.forward), mirror(self.up));
        Self {
            eye,
            forward,
            up,
            right: -mirror(self.right),
            ..*self
        }
    }

    /// Returns the ray through a point of the picture, given in pixels from the upper left corner.
    #[inline]
    #[must_use]
    pub fn ray(&self, x: f32, y: f32) -> Ray {
        let [width, height] = self.size.map(|side| side as f32);
        let across = (2.0 * x - width) / height * self.slope;
        let upwards = (1.0 - 2.0 * y / height) * self.slope;
        Ray::new(
            self.eye,
            (self.forward + across * self.right + upwards * self.up).normalize(),
        )
    }
}
