//! One segment, and whether a ray meets it.

use super::{Hit, Ray};
use crate::geometry::Strands;
use glam::Vec3;

/// A truncated cone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    start: Vec3,
    edge: Vec3,
    radius: f32,
    /// How much larger the radius is at the other end.
    widening: f32,
    number: u32,
    strand: u32,
}

impl Segment {
    pub(super) fn new(strands: &Strands, strand: u32, number: u32) -> Self {
        let (start, radius) = (strands.position(number, 0.0), strands.radius(number, 0.0));
        let edge = strands.position(number, 1.0) - start;
        Self { start, edge, radius, widening: strands.radius(number, 1.0) - radius, number, strand }
    }

    /// Where the ray passes nearer to the axis than the radius there.
    pub(super) fn meet(&self, ray: &Ray) -> Option<Hit> {
        let from = self.start - ray.origin;
        let (along, edge_along) = (from.dot(ray.direction), self.edge.dot(ray.direction));
        // Start and edge without their parts along the ray.
        let (start, edge) = (from - along * ray.direction, self.edge - edge_along * ray.direction);
        let s = (-start.dot(edge) / edge.length_squared().max(1e-30)).clamp(0.0, 1.0);
        let axis = start + s * edge;
        let radius = self.radius + s * self.widening;
        let t = along + s * edge_along;
        let skipped = ray.skip.is_some_and(|skip| skip.strand == self.strand && t < skip.before);
        let met = axis.length_squared() < radius * radius && t > 0.0 && t < ray.t_max && !skipped;
        met.then(|| {
            let side = self.edge.cross(ray.direction).normalize_or_zero();
            let h = (-axis.dot(side) / radius).clamp(-1.0, 1.0);
            Hit { t, segment: self.number, strand: self.strand, s, h }
        })
    }
}
