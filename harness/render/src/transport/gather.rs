//! The paper's protocol for direct light: fixed camera rays, and many samples at each shading point.

use super::path::leave;
use super::profile::{Phase, lap};
use super::resampled::{Candidates, Place, Streams};
use super::{Mis, Settings, key, sees};
use crate::film::Tile;
use crate::lights::{Table, Tables};
use crate::material::Prepared;
use crate::numbers::{Numbers, Sequence};
use crate::scene::{Met, Scene};
use crate::tree::{self, Ray};
use glam::Vec3;
use hairis::{FiberFrame, FiberFrame8, Hit};
use hairis_harness::sampler::cosine;

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
pub(super) fn tile(scene: &Scene, tables: &Tables<'_>, settings: &Settings, tile: &mut Tile, samples: u32) {
    let mut candidates = Candidates::default();
    for (pixel, sums) in tile.place.pixels().zip(&mut tile.sums) {
        *sums = Default::default();
        for ray in 0..settings.rays {
            let [x, y, ..] = Numbers::new(Sequence::Sobol, CAMERA_SEED, key(pixel), ray).four();
            let ray_of = scene.camera.ray(pixel[0] as f32 + x, pixel[1] as f32 + y);
            lap(Phase::Numbers);
            let met = scene.closest(&ray_of);
            lap(Phase::Rays);
            match met {
                Met::Hair(hit) => {
                    let point = Point::new(scene, &ray_of, hit);
                    let first = ray * samples;
                    sums.add(if settings.mis == Mis::Resampled {
                        let mut numbers = Numbers::new(settings.sequence, settings.seed, key(pixel), first);
                        point.resampled(scene, tables.of_pass(0), &Streams::new(&mut numbers), samples, &mut candidates)
                    } else {
                        point.light(scene, settings, key(pixel), first..first + samples) / samples as f32
                    });
                }
                met => sums.add(scene.see_from_camera(&ray_of, &met).unwrap_or_default()),
            }
            lap(Phase::Rest);
        }
    }
    tile.samples = settings.rays;
}

impl Point {
    fn new(scene: &Scene, ray: &Ray, hit: tree::Hit) -> Self {
        let wo = -ray.direction;
        let frame = FiberFrame::from_tangent_normal(scene.strands.tangent(hit.segment, hit.s), wo);
        let origin = scene.strands.position(hit.segment, hit.s);
        let (local, eight) = (Hit::new(frame.to_local(wo), hit.h), FiberFrame8::splat(&frame));
        lap(Phase::Frames);
        let prepared = scene.hair.prepare(local);
        lap(Phase::Kernels);
        Self { hit, origin, frame: eight, prepared }
    }

    /// Sum over samples of the radiance towards the camera.
    fn light(&self, scene: &Scene, settings: &Settings, pixel: u64, samples: core::ops::Range<u32>) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut next = samples.start;
        while next < samples.end {
            let count = (samples.end - next).min(8) as usize;
            let mut xi_light = [[0.0; 8]; 3];
            let mut xi = [[0.0; 8]; 3];
            for (lane, sample) in (next..samples.end).take(8).enumerate() {
                let mut numbers = Numbers::new(settings.sequence, settings.seed, pixel, sample);
                let [x, y, choice, _] = numbers.four();
                (xi_light[0][lane], xi_light[1][lane], xi_light[2][lane]) = (x, y, choice);
                let [lobe, theta, phi, _] = numbers.four();
                (xi[0][lane], xi[1][lane], xi[2][lane]) = (lobe, theta, phi);
            }
            lap(Phase::Numbers);
            if settings.mis != Mis::Bsdf {
                sum += self.by_light(scene, settings, &xi_light, count);
            }
            if settings.mis != Mis::Light {
                sum += self.by_bsdf(scene, settings, &xi, count);
            }
            next += 8.min(samples.end - next);
        }
        sum
    }

    /// Light of as many rays as samples, chosen from candidates.
    fn resampled(
        &self,
        scene: &Scene,
        table: Option<&Table>,
        streams: &Streams,
        rays: u32,
        candidates: &mut Candidates,
    ) -> Vec3 {
        let Self { origin, frame, prepared, .. } = self;
        let mut sum = Vec3::ZERO;
        candidates.pools(
            &Place { scene, table, origin: *origin, frame, prepared },
            streams,
            rays,
            |candidate, radiance| {
                let ray = leave(scene, &self.hit, *origin, candidate.direction, candidate.cos);
                if sees(scene, &Ray { t_max: candidate.distance, ..ray }) {
                    sum += radiance;
                }
                lap(Phase::Rays);
            },
        );
        sum
    }

    fn by_light(&self, scene: &Scene, settings: &Settings, xi: &[[f32; 8]; 3], count: usize) -> Vec3 {
        let lights = scene.sample_lights8(|_| self.origin, xi, None);
        lap(Phase::Light);
        let wi = self.frame.to_local(&lights.direction);
        lap(Phase::Frames);
        let (eval, cos) = (self.prepared.eval8(&wi), cosine(&wi).to_array());
        lap(Phase::Kernels);
        let mut sum = Vec3::ZERO;
        for (lane, cos) in cos.into_iter().enumerate().take(count) {
            let Some(light) = lights.lane(lane, 1.0) else { continue };
            let eval = eval.lane(lane);
            let weight = settings.mis.of_light(light.pdf, eval.pdf) * cos / light.pdf;
            let radiance = light.radiance * Vec3::from_array(eval.value) * weight;
            let ray = leave(scene, &self.hit, self.origin, light.direction, cos);
            if radiance.max_element() > 0.0 && sees(scene, &Ray { t_max: light.distance, ..ray }) {
                sum += radiance;
            }
        }
        lap(Phase::Rays);
        sum
    }

    fn by_bsdf(&self, scene: &Scene, settings: &Settings, xi: &[[f32; 8]; 3], count: usize) -> Vec3 {
        let sample = self.prepared.sample8(xi);
        lap(Phase::Kernels);
        let (cos, directions) = (cosine(&sample.wi).to_array(), self.frame.to_world(&sample.wi));
        lap(Phase::Frames);
        let lights = scene.lights_along(self.origin, &directions);
        lap(Phase::Light);
        let mut sum = Vec3::ZERO;
        for (lane, cos) in cos.into_iter().enumerate().take(count) {
            let pdf = sample.pdf.as_array()[lane];
            if pdf <= 0.0 {
                continue;
            }
            let Some(light) = lights.lane(lane, 1.0) else { continue };
            let weight = settings.mis.of_bsdf(pdf, light.pdf);
            let of_bsdf = Vec3::from_array([0, 1, 2].map(|c| sample.weight[c].as_array()[lane]));
            let radiance = light.radiance * of_bsdf * weight;
            let ray = leave(scene, &self.hit, self.origin, light.direction, cos);
            if radiance.max_element() > 0.0 && sees(scene, &Ray { t_max: light.distance, ..ray }) {
                sum += radiance;
            }
        }
        lap(Phase::Rays);
        sum
    }
}
