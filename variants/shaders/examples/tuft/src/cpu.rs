//! CPU counterpart of the path tracer in `tuft.wgsl`, line by line, on top of the library.

use crate::{SAMPLES, SIDE};
use glam::{Vec2, Vec3};
use hairis::{FiberFrame, Gaussian, Hit, Matched, Material};

const BOUNCES: usize = 6;
const RADIUS: f32 = 0.012;
const SUN: Vec3 = Vec3::new(0.507_673_1, 0.609_207_7, 0.609_207_7);
const SUNLIGHT: f32 = 5.0;

/// Permuted congruential generator of random numbers.
pub(crate) struct Random(pub(crate) u32);

impl Random {
    /// Draws a number in `[0, 1)`.
    pub(crate) fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((self.0 >> ((self.0 >> 28) + 4)) ^ self.0).wrapping_mul(277_803_737);
        (((word >> 22) ^ word) >> 8) as f32 / 16_777_216.0
    }

    pub(crate) fn three(&mut self) -> [f32; 3] {
        [self.unit(), self.unit(), self.unit()]
    }
}

/// Returns the distance to the nearest hair along a ray, with the hair's tangent and the normal.
fn meet(hairs: &[(Vec3, Vec3)], origin: Vec3, ray: Vec3) -> Option<(f32, Vec3, Vec3)> {
    let mut nearest: Option<(f32, Vec3, Vec3)> = None;
    for &(root, tangent) in hairs {
        let across = |v: Vec3| v - v.dot(tangent) * tangent;
        let offset = origin - root;
        let (d, o) = (across(ray), across(offset));
        let (a, b, c) = (d.dot(d), d.dot(o), o.dot(o) - RADIUS * RADIUS);
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 || c <= 0.0 {
            continue;
        }
        let t = (-b - discriminant.sqrt()) / a;
        let along = (offset + t * ray).dot(tangent);
        if t > 0.0 && (0.0..1.0).contains(&along) && nearest.is_none_or(|(near, ..)| t < near) {
            nearest = Some((t, tangent, across(o + t * d).normalize()));
        }
    }
    nearest
}

fn sky(ray: Vec3) -> Vec3 {
    Vec3::new(0.3, 0.4, 0.6) * (0.6 + 0.4 * ray.y)
}

/// Draws the picture: the sum of the samples of each pixel in linear RGB, row by row.
pub(crate) fn draw(material: &Material<Matched<Gaussian>>, hairs: &[(Vec3, Vec3)]) -> Vec<Vec3> {
    let sample = |pixel: usize, sample: usize| {
        let seed = u32::try_from(pixel * SAMPLES + sample).expect("few pixels");
        let mut random = Random(seed.wrapping_mul(9781).wrapping_add(1));
        let x = ((pixel % SIDE) as f32 + random.unit()) / SIDE as f32 - 0.5;
        let y = ((pixel / SIDE) as f32 + random.unit()) / SIDE as f32 - 0.5;
        let mut origin = Vec3::new(0.0, 0.8, 4.0);
        let mut ray = Vec3::new(0.5 * x, -0.5 * y - 0.08, -1.0).normalize();
        let (mut light, mut throughput) = (Vec3::ZERO, Vec3::ONE);
        for _ in 0..BOUNCES {
            let Some((t, tangent, normal)) = meet(hairs, origin, ray) else {
                light += throughput * sky(ray);
                break;
            };
            origin += t * ray + 1e-4 * normal;
            let frame = FiberFrame {
                u: tangent,
                v: normal,
                w: tangent.cross(normal),
            };
            let (wo, wi) = (frame.to_local(-ray), frame.to_local(SUN));
            let h = wo.z / Vec2::new(wo.y, wo.z).length().max(1e-20);
            let bsdf = material.prepare(Hit::new(wo, h));
            let xi = random.three();
            if meet(hairs, origin, SUN).is_none() {
                let value = Vec3::from(bsdf.eval(wi));
                light += throughput * value * FiberFrame::cos_theta(wi) * SUNLIGHT;
            }
            let Some(sample) = bsdf.sample(xi) else {
                break; // discarded: the path carries no light
            };
            throughput *= Vec3::from(sample.weight);
            ray = frame.to_world(sample.wi);
        }
        light
    };
    (0..SIDE * SIDE)
        .map(|pixel| (0..SAMPLES).map(|i| sample(pixel, i)).sum())
        .collect()
}
