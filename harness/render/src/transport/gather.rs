//! The paper's protocol for direct light: fixed camera rays, and many samples at each shading point.

use super::path::leave;
use super::resampled::Candidates;
use super::{Mis, Settings, key};
use crate::film::Tile;
use crate::material::Prepared;
use crate::numbers::{Numbers, Sequence};
use crate::scene::{Met, Scene};
use crate::tree::{self, Ray};
use glam::Vec3;
use hairis::{FiberFrame, FiberFrame8, Hit, Vec3x8};

/// Seed of the camera rays: one for all pictures, so that they differ by their samples alone.
const CAMERA_SEED: u64 = 0x6361_6d65_7261;

/// Where a camera ray met hair.
struct Point {
    hit: tree::Hit,
    origin: Vec3,
    frame: FiberFrame8,
    prepared: Prepared,
}

/// Estimates the direct light of hair at `samples` light and as many BSDF samples per camera ray. What is no hair is
/// black, but for lights that the camera sees.
pub(super) fn tile(scene: &Scene, settings: &Settings, tile: &mut Tile, samples: u32) {
    let mut candidates = Candidates::default();
    for (pixel, sums) in tile.place.pixels().zip(&mut tile.sums) {
        *sums = Default::default();
        for ray in 0..settings.rays {
            let [x, y, ..] = Numbers::new(Sequence::Sobol, CAMERA_SEED, key(pixel), ray).four();
            let ray_of = scene.camera.ray(pixel[0] as f32 + x, pixel[1] as f32 + y);
            match scene.closest(&ray_of) {
                Met::Hair(hit) => {
                    let point = Point::new(scene, &ray_of, hit);
                    let first = ray * samples;
                    sums.add(if settings.mis == Mis::Resampled {
                        let numbers = Numbers::new(settings.sequence, settings.seed, key(pixel), first);
                        point.resampled(scene, numbers, samples, &mut candidates)
                    } else {
                        point.light(scene, settings, key(pixel), first..first + samples) / samples as f32
                    });
                }
                met => sums.add(scene.see(&ray_of, &met).map_or(Vec3::ZERO, |seen| seen.radiance)),
            }
        }
    }
    tile.samples = settings.rays;
}

impl Point {
    fn new(scene: &Scene, ray: &Ray, hit: tree::Hit) -> Self {
        let wo = -ray.direction;
        let frame = FiberFrame::from_tangent_normal(scene.strands.tangent(hit.segment, hit.s), wo);
        let prepared = scene.hair.prepare(Hit::new(frame.to_local(wo), hit.h));
        let origin = scene.strands.position(hit.segment, hit.s);
        Self { hit, origin, frame: FiberFrame8::splat(&frame), prepared }
    }

    /// Sum over samples of the radiance towards the camera.
    fn light(&self, scene: &Scene, settings: &Settings, pixel: u64, samples: core::ops::Range<u32>) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut next = samples.start;
        while next < samples.end {
            let count = (samples.end - next).min(8) as usize;
            let mut xi_light = [[0.0; 3]; 8];
            let mut xi = [[0.0; 8]; 3];
            for (lane, sample) in (next..samples.end).take(8).enumerate() {
                let mut numbers = Numbers::new(settings.sequence, settings.seed, pixel, sample);
                let [x, y, choice, _] = numbers.four();
                xi_light[lane] = [x, y, choice];
                let [lobe, theta, phi, _] = numbers.four();
                (xi[0][lane], xi[1][lane], xi[2][lane]) = (lobe, theta, phi);
            }
            if settings.mis != Mis::Bsdf {
                sum += self.by_light(scene, settings, &xi_light[..count]);
            }
            if settings.mis != Mis::Light {
                sum += self.by_bsdf(scene, settings, &xi, count);
            }
            next += 8.min(samples.end - next);
        }
        sum
    }

    /// Light of as many rays as samples, chosen from candidates.
    fn resampled(&self, scene: &Scene, mut numbers: Numbers, rays: u32, candidates: &mut Candidates) -> Vec3 {
        candidates.draw(scene, self.origin, &self.frame, &self.prepared, &mut numbers, rays);
        let mut sum = Vec3::ZERO;
        for (candidate, radiance) in candidates.choose(rays) {
            let ray = leave(scene, &self.hit, self.origin, candidate.direction, candidate.cos);
            if !scene.blocked(&Ray { t_max: candidate.distance, ..ray }) {
                sum += radiance;
            }
        }
        sum
    }

    fn by_light(&self, scene: &Scene, settings: &Settings, xi: &[[f32; 3]]) -> Vec3 {
        let mut lights = [None; 8];
        for (light, xi) in lights.iter_mut().zip(xi) {
            *light = scene.sample_light(self.origin, *xi);
        }
        let towards = lights.map(|light| light.map_or(Vec3::Y, |light| light.direction));
        let wi = self.frame.to_local(&Vec3x8::from(towards));
        let (eval, cos) = (self.prepared.eval8(&wi), crate::material::cosine(&wi).to_array());
        let mut sum = Vec3::ZERO;
        for (lane, light) in lights.iter().enumerate() {
            let Some(light) = light else { continue };
            let eval = eval.lane(lane);
            let weight = settings.mis.of_light(light.pdf, eval.pdf) * cos[lane] / light.pdf;
            let radiance = light.radiance * Vec3::from_array(eval.value) * weight;
            let ray = leave(scene, &self.hit, self.origin, light.direction, cos[lane]);
            if radiance.max_element() > 0.0 && !scene.blocked(&Ray { t_max: light.distance, ..ray }) {
                sum += radiance;
            }
        }
        sum
    }

    fn by_bsdf(&self, scene: &Scene, settings: &Settings, xi: &[[f32; 8]; 3], count: usize) -> Vec3 {
        let sample = self.prepared.sample8(xi);
        let (directions, cos) = (self.frame.to_world(&sample.wi), crate::material::cosine(&sample.wi).to_array());
        let mut sum = Vec3::ZERO;
        for (lane, cos) in cos.into_iter().enumerate().take(count) {
            let pdf = sample.pdf.as_array()[lane];
            if pdf <= 0.0 {
                continue;
            }
            let direction = directions.lane(lane).normalize_or(Vec3::Y);
            let Some((seen, distance)) = scene.light_along(self.origin, direction) else { continue };
            let weight = settings.mis.of_bsdf(pdf, seen.pdf);
            let of_bsdf = Vec3::from_array([0, 1, 2].map(|c| sample.weight[c].as_array()[lane]));
            let radiance = seen.radiance * of_bsdf * weight;
            let ray = leave(scene, &self.hit, self.origin, direction, cos);
            if radiance.max_element() > 0.0 && !scene.blocked(&Ray { t_max: distance, ..ray }) {
                sum += radiance;
            }
        }
        sum
    }
}
