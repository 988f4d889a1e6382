//! Direct light by the paper's protocol: fixed camera rays, and many samples at each shading point.

use super::path::leave;
use super::profile::{Phase, lap};
use super::resampled::{Candidates, PER_TABLE, POOL, Place, Streams};
use super::{Mis, Settings, key, sees};
use crate::film::{Sums, Tile};
use crate::lights::Tables;
use crate::material::Prepared;
use crate::numbers::{Numbers, Sequence};
use crate::scene::{Met, Scene};
use crate::tree::{self, Ray};
use glam::Vec3;
use hairis::{FiberFrame, FiberFrame8, Hit};
use hairis_instruments::direction::cosine;

/// Seed of the camera rays, which all pictures share, so that they differ by their samples alone.
const CAMERA_SEED: u64 = 0x6361_6d65_7261;

/// Shading point: the hit of a camera ray on hair.
struct Point {
    hit: tree::Hit,
    origin: Vec3,
    frame: FiberFrame8,
    prepared: Prepared,
    /// Key of the point's uniform numbers.
    key: u64,
}

/// Number of samples that are drawn side by side: whole pools of candidates.
const STEP: usize = POOL as usize;

/// Adds estimates of the direct light of hair until each pixel has `samples`. A sample is the mean over the camera rays, each with
/// one light and one BSDF sample, or with one resampled ray. Pixels without hair are black, except for lights that the camera
/// sees.
///
/// The last pool of resampled rays is smaller unless the count is a multiple of [`POOL`]. A tile that ends in such a pool is
/// rendered again from the first sample.
pub(super) fn tile(
    scene: &Scene,
    tables: &Tables<'_>,
    settings: &Settings,
    tile: &mut Tile,
    samples: u32,
) {
    if tile.samples >= samples {
        return;
    }
    let resampled = settings.mis == Mis::Resampled;
    if resampled && !tile.samples.is_multiple_of(POOL) {
        tile.sums.fill(Sums::default());
        tile.samples = 0;
    }
    let mut candidates = Candidates::default();
    let mut points = Vec::new();
    for (pixel, sums) in tile.place.pixels().zip(&mut tile.sums) {
        let beside = points_of(scene, settings, pixel, &mut points);
        for first in (tile.samples..samples).step_by(STEP) {
            let mut radiances = [beside; STEP];
            let radiances = &mut radiances[..(samples - first).min(POOL) as usize];
            for point in &points {
                if resampled {
                    point.resampled(scene, tables, settings, first, &mut candidates, radiances);
                } else {
                    point.light(scene, settings, first, radiances);
                }
            }
            radiances
                .iter()
                .for_each(|radiance| sums.add(*radiance / settings.rays as f32));
            lap(Phase::Rest);
        }
    }
    tile.samples = samples;
}

/// Finds the points where the camera rays of a pixel meet hair. Returns the sum of the radiance along the other rays.
fn points_of(scene: &Scene, settings: &Settings, pixel: [u32; 2], points: &mut Vec<Point>) -> Vec3 {
    points.clear();
    let mut beside = Vec3::ZERO;
    for ray in 0..settings.rays {
        let [x, y, ..] = Numbers::new(Sequence::Sobol, CAMERA_SEED, key(pixel), ray).four();
        let camera_ray = scene.camera.ray(pixel[0] as f32 + x, pixel[1] as f32 + y);
        lap(Phase::Numbers);
        let met = scene.closest(&camera_ray);
        lap(Phase::Rays);
        match met {
            // Pixels have 14 bits a side, and rays 12, so that keys differ.
            Met::Hair(hit) => points.push(Point::new(
                scene,
                &camera_ray,
                hit,
                key(pixel) | u64::from(ray) << 16,
            )),
            met => beside += scene.see_from_camera(&camera_ray, &met).unwrap_or_default(),
        }
    }
    beside
}

impl Point {
    fn new(scene: &Scene, ray: &Ray, hit: tree::Hit, key: u64) -> Self {
        let wo = -ray.direction;
        let frame = FiberFrame::from_tangent_normal(scene.strands.tangent(hit.segment, hit.s), wo);
        let origin = scene.origin(ray, &hit);
        let (local, eight) = (
            Hit::new(frame.to_local(wo), hit.h),
            FiberFrame8::splat(&frame),
        );
        lap(Phase::Frames);
        let prepared = scene.hair_of(hit.strand).1.prepare(local);
        lap(Phase::Kernels);
        Self {
            hit,
            origin,
            frame: eight,
            prepared,
            key,
        }
    }

    /// Adds the radiance towards the camera of each sample from `first` on.
    fn light(&self, scene: &Scene, settings: &Settings, first: u32, radiances: &mut [Vec3]) {
        for (radiances, first) in radiances.chunks_mut(8).zip((first..).step_by(8)) {
            let mut xi_light = [[0.0; 8]; 3];
            let mut xi = [[0.0; 8]; 3];
            for (lane, sample) in (first..).take(radiances.len()).enumerate() {
                let mut numbers = Numbers::new(settings.sequence, settings.seed, self.key, sample);
                let [x, y, choice, _] = numbers.four();
                (xi_light[0][lane], xi_light[1][lane], xi_light[2][lane]) = (x, y, choice);
                let [lobe, theta, phi, _] = numbers.four();
                (xi[0][lane], xi[1][lane], xi[2][lane]) = (lobe, theta, phi);
            }
            lap(Phase::Numbers);
            if settings.mis != Mis::Bsdf {
                self.by_light(scene, settings, &xi_light, radiances);
            }
            if settings.mis != Mis::Light {
                self.by_bsdf(scene, settings, &xi, radiances);
            }
        }
    }

    /// Adds the light of a pool of rays, chosen from candidates. The light of each ray, times the count of rays, is a sample.
    fn resampled(
        &self,
        scene: &Scene,
        tables: &Tables<'_>,
        settings: &Settings,
        first: u32,
        candidates: &mut Candidates,
        radiances: &mut [Vec3],
    ) {
        let Self {
            origin,
            frame,
            prepared,
            ..
        } = self;
        let streams = Streams::new(&mut Numbers::new(
            settings.sequence,
            settings.seed,
            self.key,
            0,
        ));
        let table = tables.of_pass(first / PER_TABLE);
        let count = radiances.len() as f32;
        let place = Place {
            scene,
            table,
            origin: *origin,
            frame,
            prepared,
        };
        let mut radiances = radiances.iter_mut();
        candidates.pool(
            &place,
            &streams,
            first / POOL,
            radiances.len(),
            |candidate, radiance| {
                let sample = radiances.next();
                let (direction, cos, distance) =
                    (candidate.direction, candidate.cos, candidate.distance);
                if self.sees(scene, direction, cos, distance)
                    && let Some(sample) = sample
                {
                    *sample += count * radiance;
                }
                lap(Phase::Rays);
            },
        );
    }

    /// Returns true if nothing blocks the point in a direction of inclination `cos_theta`, up to a distance.
    #[inline]
    fn sees(&self, scene: &Scene, direction: Vec3, cos_theta: f32, distance: f32) -> bool {
        let ray = leave(
            scene,
            &self.hit,
            self.origin,
            direction,
            cos_theta,
            distance,
        );
        sees(scene, &ray)
    }

    fn by_light(
        &self,
        scene: &Scene,
        settings: &Settings,
        xi: &[[f32; 8]; 3],
        radiances: &mut [Vec3],
    ) {
        let lights = scene.sample_lights8(|_| self.origin, xi, None);
        lap(Phase::Light);
        let wi = self.frame.to_local(&lights.direction);
        lap(Phase::Frames);
        let (eval, cos) = (self.prepared.eval8(&wi), cosine(&wi).to_array());
        lap(Phase::Kernels);
        for (sum, (lane, cos)) in radiances.iter_mut().zip(cos.into_iter().enumerate()) {
            let Some(light) = lights.lane(lane, 1.0) else {
                continue;
            };
            let eval = eval.lane(lane);
            let weight = settings.mis.of_light(light.pdf, eval.pdf) * cos / light.pdf;
            let radiance = light.radiance * Vec3::from_array(eval.value) * weight;
            if radiance.max_element() > 0.0
                && self.sees(scene, light.direction, cos, light.distance)
            {
                *sum += radiance;
            }
        }
        lap(Phase::Rays);
    }

    fn by_bsdf(
        &self,
        scene: &Scene,
        settings: &Settings,
        xi: &[[f32; 8]; 3],
        radiances: &mut [Vec3],
    ) {
        let sample = self.prepared.sample8(xi);
        lap(Phase::Kernels);
        let (cos, directions) = (
            cosine(&sample.wi).to_array(),
            self.frame.to_world(&sample.wi),
        );
        lap(Phase::Frames);
        let lights = scene.lights_along(self.origin, &directions);
        lap(Phase::Light);
        for (sum, (lane, cos)) in radiances.iter_mut().zip(cos.into_iter().enumerate()) {
            let pdf = sample.pdf.as_array()[lane];
            if pdf <= 0.0 {
                continue;
            }
            let Some(light) = lights.lane(lane, 1.0) else {
                continue;
            };
            let weight = settings.mis.of_bsdf(pdf, light.pdf);
            let of_bsdf = Vec3::from_array([0, 1, 2].map(|c| sample.weight[c].as_array()[lane]));
            let radiance = light.radiance * of_bsdf * weight;
            if radiance.max_element() > 0.0
                && self.sees(scene, light.direction, cos, light.distance)
            {
                *sum += radiance;
            }
        }
        lap(Phase::Rays);
    }
}
