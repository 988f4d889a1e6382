//! Dual scattering: direct light at the hair that the camera sees, through the fibres that it crosses, and what comes back from those
//! behind, after `hairis::dual_scattering`. No path is followed.

use super::path::leave;
use super::profile::{Phase, lap};
use super::{Integrator, Settings, key};
use crate::film::Tile;
use crate::lights::{LightSample, uniform_direction};
use crate::material::Hair;
use crate::numbers::Numbers;
use crate::scene::{Met, Scene};
use crate::tree::{self, Ray, Skip};
use core::f32::consts::PI;
use glam::Vec3;
use hairis::dual_scattering::{Crossed, DualScattering, GAIN};
use hairis::{FiberFrame, Hit, Vec3x8};

/// Share of the light below which no further fibre is counted.
const DARK: f32 = 1e-3;

/// Constants of the materials of a scene, in the order of [`Scene::hair_of`].
pub(super) struct Materials(Vec<DualScattering<f32>>);

impl Materials {
    /// Measures the materials of a scene; of other integrators than [`Integrator::Dual`] none.
    pub(super) fn new(scene: &Scene, integrator: Integrator) -> Self {
        if integrator != Integrator::Dual {
            return Self(Vec::new());
        }
        let others = scene.others.iter().map(|(_, hair)| hair);
        Self(
            core::iter::once(&scene.hair)
                .chain(others)
                .map(measured)
                .collect(),
        )
    }

    fn of(&self, scene: &Scene, strand: u32) -> &DualScattering<f32> {
        &self.0[scene.hair_of(strand).0]
    }
}

fn measured(hair: &Hair) -> DualScattering<f32> {
    let Hair::Model(material, _, factor) = hair else {
        // Evenly into all directions: the weights are 1.
        return DualScattering::measured(1, &mut |_, _, xi, out| {
            let (Some(wi), Some(weight)) = (out.wi, out.weight) else {
                return;
            };
            weight.into_iter().for_each(|channel| channel.fill(1.0));
            for k in 0..xi[0].len() {
                let direction = uniform_direction([xi[1][k], xi[2][k]]).to_array();
                (0..3).for_each(|axis| wi[axis][k] = direction[axis]);
            }
        });
    };
    let mut dual = material.dual_scattering();
    dual.scale(*factor);
    dual
}

/// Adds samples to a tile until each pixel has `samples`, each with one ray to a light.
pub(super) fn tile(
    scene: &Scene,
    materials: &Materials,
    settings: &Settings,
    tile: &mut Tile,
    samples: u32,
) {
    for (pixel, sums) in tile.place.pixels().zip(&mut tile.sums) {
        for sample in tile.samples..samples {
            let mut numbers = Numbers::new(settings.sequence, settings.seed, key(pixel), sample);
            let [x, y, ..] = numbers.four();
            let ray = scene.camera.ray(pixel[0] as f32 + x, pixel[1] as f32 + y);
            let [x, y, choice, _] = numbers.four();
            lap(Phase::Numbers);
            let met = scene.closest(&ray);
            lap(Phase::Rays);
            let radiance = match met {
                Met::Hair(hit) => hair(scene, materials, &ray, &hit, [x, y, choice]),
                Met::Surface(point, normal, albedo) => {
                    let origin = point + scene.gap * normal;
                    albedo * surface(scene, materials, origin, normal, [x, y, choice])
                }
                met => scene.see_from_camera(&ray, &met).unwrap_or_default(),
            };
            sums.add(radiance);
            lap(Phase::Rest);
        }
    }
    tile.samples = tile.samples.max(samples);
}

/// Returns the radiance of hair towards the camera.
fn hair(scene: &Scene, materials: &Materials, ray: &Ray, hit: &tree::Hit, xi: [f32; 3]) -> Vec3 {
    let wo = -ray.direction;
    let frame = FiberFrame::from_tangent_normal(scene.strands.tangent(hit.segment, hit.s), wo);
    let origin = scene.origin(ray, hit);
    let Some(light) = scene.sample_light(origin, xi) else {
        return Vec3::ZERO;
    };
    let (wi, wo) = (frame.to_local(light.direction), frame.to_local(wo));
    let cos = wi.y.hypot(wi.z);
    let shadow = leave(scene, hit, origin, light.direction, cos, light.distance);
    let Some(crossed) = crossed(scene, materials, shadow) else {
        return Vec3::ZERO;
    };
    let prepared = scene.hair_of(hit.strand).1.prepare(Hit::new(wo, hit.h));
    let single = prepared.eval8(&Vec3x8::splat(wi)).lane(0).value;
    let dual = materials.of(scene, hit.strand);
    let value = dual.shade(wo.into(), wi.into(), single, &crossed, [GAIN; 2]);
    lap(Phase::Kernels);
    light.radiance * Vec3::from_array(value) * (cos / light.pdf)
}

/// Returns the light that a surface receives, over pi.
fn surface(scene: &Scene, materials: &Materials, origin: Vec3, normal: Vec3, xi: [f32; 3]) -> Vec3 {
    let Some(light) = scene.sample_light(origin, xi) else {
        return Vec3::ZERO;
    };
    let LightSample {
        direction,
        distance,
        radiance,
        pdf,
    } = light;
    let cos = direction.dot(normal);
    if cos <= 0.0 {
        return Vec3::ZERO;
    }
    let ray = Ray {
        t_max: distance,
        ..Ray::new(origin, direction)
    };
    crossed(scene, materials, ray).map_or(Vec3::ZERO, |crossed| {
        let through = Vec3::splat(crossed.direct) + GAIN * Vec3::from_array(crossed.scattered);
        radiance * through * (cos / (PI * pdf))
    })
}

/// Returns what the fibres along a ray to a light do to it, or `None` if something else blocks it. Each strand counts once in a row.
fn crossed(scene: &Scene, materials: &Materials, mut ray: Ray) -> Option<Crossed> {
    if scene.blocked_by_surfaces(&ray) {
        return None;
    }
    let mut crossed = Crossed::clear();
    while let Some(hit) = scene.tree.closest(&ray) {
        let sin = scene.strands.tangent(hit.segment, hit.s).dot(ray.direction);
        let sin = sin.clamp(-1.0, 1.0);
        let fibre = materials.of(scene, hit.strand).averages(sin.asin());
        crossed = crossed.through(&fibre);
        if crossed.scattered.iter().all(|share| *share < DARK) {
            break;
        }
        let radius = scene.strands.radius(hit.segment, hit.s);
        let cos = (1.0 - sin * sin).sqrt();
        ray.skip = Some(Skip::leaving(hit.strand, radius, cos, scene.tree.meet()));
        ray.origin += hit.t * ray.direction;
        ray.t_max -= hit.t;
    }
    lap(Phase::Rays);
    Some(crossed)
}
