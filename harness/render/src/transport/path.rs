//! Paths of any length, and direct light as the shortest of them.

use super::profile::{Phase, lap};
use super::wave::{Path, Shadow, Wave};
use super::{Integrator, Mis, PASS, Settings, resampled, sees};
use crate::lights::Tables;
use crate::scene::{Met, Scene};
use crate::tree::{self, Ray, Skip};
use core::f32::consts::{PI, TAU};
use glam::Vec3;
use hairis::simd::f32x8;
use hairis::{FiberFrame8, Hit8, Vec3x8};
use hairis_instruments::direction::cosine;

/// Number of scatterings before paths may end at random.
const FIRST_ROULETTE: u32 = 4;

/// Follows all paths of a wave to their ends, or to the depth.
pub(super) fn run(scene: &Scene, tables: &Tables<'_>, settings: &Settings, wave: &mut Wave) {
    let depth = if settings.integrator == Integrator::Direct {
        Some(1)
    } else {
        settings.depth
    };
    lap(Phase::Numbers);
    trace(scene, settings, wave, true);
    scatter(scene, tables, settings, wave, 0, depth);
}

/// Continues the paths of a wave that [`run`] has followed to a depth, to their ends. Only light
/// beyond the depth counts.
pub(super) fn run_beyond(
    scene: &Scene,
    tables: &Tables<'_>,
    settings: &Settings,
    wave: &mut Wave,
    depth: u32,
) {
    wave.forget();
    scatter(scene, tables, settings, wave, depth, None);
}

/// Scatters paths that have met something, after `first` scatterings, until they have ended or have
/// `depth` scatterings.
fn scatter(
    scene: &Scene,
    tables: &Tables<'_>,
    settings: &Settings,
    wave: &mut Wave,
    first: u32,
    depth: Option<u32>,
) {
    for scatterings in first.. {
        if Some(scatterings) == depth {
            break;
        }
        wave.shadows.clear();
        surfaces(scene, settings, wave);
        hair(scene, tables, settings, wave);
        for k in 0..wave.shadows.len() {
            let shadow = wave.shadows[k];
            if sees(scene, &shadow.ray) {
                wave.add(shadow.slot, shadow.radiance);
            }
        }
        lap(Phase::Rays);
        end_some(wave, settings.roulette && scatterings >= FIRST_ROULETTE);
        if wave.paths.is_empty() {
            break;
        }
        trace(scene, settings, wave, false);
    }
}

/// Finds the object that every ray meets, and adds the light along the ray.
fn trace(scene: &Scene, settings: &Settings, wave: &mut Wave, is_first: bool) {
    wave.met.clear();
    wave.met
        .extend(wave.paths.iter().map(|path| scene.closest(&path.ray)));
    lap(Phase::Rays);
    for k in 0..wave.paths.len() {
        let path = wave.paths[k];
        if is_first {
            wave.add(
                path.slot,
                scene
                    .see_from_camera(&path.ray, &wave.met[k])
                    .unwrap_or_default(),
            );
            continue;
        }
        let Some(seen) = scene.see(&path.ray, &wave.met[k]) else {
            continue;
        };
        let weight = settings.mis.of_bsdf(path.pdf, seen.pdf);
        wave.add(path.slot, path.throughput * seen.radiance * weight);
    }
    lap(Phase::Light);
}

/// Scatters paths at surfaces, puts the hits of hair into the queue, and ends the paths that go no further.
pub(super) fn surfaces(scene: &Scene, settings: &Settings, wave: &mut Wave) {
    wave.hits.clear();
    for (k, (path, met)) in (0..).zip(wave.paths.iter_mut().zip(&wave.met)) {
        match met {
            Met::Hair(_) if path.from_hair && !settings.multiple => path.alive = false,
            Met::Hair(hit) => wave.hits.push((k, *hit)),
            Met::Surface(point, normal, albedo) => {
                let origin = *point + scene.gap * *normal;
                wave.shadows
                    .extend(reflect(scene, settings, path, origin, *normal, *albedo));
            }
            Met::Nothing | Met::Light(_) => path.alive = false,
        }
    }
    lap(Phase::Rest);
}

/// Scatters a path at a surface by Lambert's law: returns the light that the surface receives, and sets the path's next ray.
fn reflect(
    scene: &Scene,
    settings: &Settings,
    path: &mut Path,
    origin: Vec3,
    normal: Vec3,
    albedo: Vec3,
) -> Option<Shadow> {
    path.throughput *= albedo;
    let [x, y, choice, _] = path.numbers.four();
    let light = (settings.mis != Mis::Bsdf)
        .then(|| scene.sample_light(origin, [x, y, choice]))
        .flatten();
    let shadow = light.and_then(|light| {
        let pdf = light.direction.dot(normal) / PI;
        let weight = settings.mis.of_light(light.pdf, pdf) * pdf / light.pdf;
        let ray = Ray {
            t_max: light.distance,
            ..Ray::new(origin, light.direction)
        };
        let radiance = path.throughput * light.radiance * weight;
        (pdf > 0.0).then_some(Shadow {
            ray,
            radiance,
            slot: path.slot,
        })
    });
    let [x, y, _, roulette] = path.numbers.four();
    let (sin, cos) = (TAU * y).sin_cos();
    let (a, b) = normal.any_orthonormal_pair();
    let direction = (x.sqrt() * (cos * a + sin * b) + (1.0 - x).sqrt() * normal).normalize();
    path.pdf = direction.dot(normal) / PI;
    path.alive = path.pdf > 0.0;
    path.ray = Ray::new(origin, direction);
    path.from_hair = false;
    path.roulette = roulette;
    shadow
}

/// Packet of eight hits of a queue, with their frames and origins. Lanes that have no hit repeat the first.
pub(super) struct Packet {
    pub(super) frames: FiberFrame8,
    pub(super) origins: [Vec3; 8],
    pub(super) hits: Hit8,
}

impl Packet {
    #[inline(always)]
    pub(super) fn new(scene: &Scene, paths: &[Path], packet: &[(u32, tree::Hit)]) -> Self {
        let lanes = |lane: usize| packet.get(lane).unwrap_or(&packet[0]);
        let at = |lane: usize| (&paths[lanes(lane).0 as usize], lanes(lane).1);
        let wo: [Vec3; 8] = core::array::from_fn(|lane| -at(lane).0.ray.direction);
        let tangents: [Vec3; 8] =
            core::array::from_fn(|lane| scene.strands.tangent(at(lane).1.segment, at(lane).1.s));
        let wo = Vec3x8::from(wo);
        let frames = FiberFrame8::from_tangents_normals(&tangents.into(), &wo);
        let h = f32x8::new(core::array::from_fn(|lane| at(lane).1.h));
        let origins = core::array::from_fn(|lane| scene.origin(&at(lane).0.ray, &at(lane).1));
        let hits = Hit8::new(frames.to_local(&wo), h);
        Self {
            frames,
            origins,
            hits,
        }
    }
}

/// Scatters paths at hair, eight hits of a material at a time. Lanes of the last packet that have no hit repeat its first.
fn hair(scene: &Scene, tables: &Tables<'_>, settings: &Settings, wave: &mut Wave) {
    let Wave {
        paths,
        hits,
        shadows,
        ..
    } = wave;
    if !scene.others.is_empty() {
        hits.sort_by_key(|(_, hit)| scene.hair_of(hit.strand).0);
    }
    let is_same = |a: &(u32, tree::Hit), b: &(u32, tree::Hit)| {
        scene.hair_of(a.1.strand).0 == scene.hair_of(b.1.strand).0
    };
    for packet in hits.chunk_by(is_same).flat_map(|same| same.chunks(8)) {
        let Packet {
            frames,
            origins,
            hits,
        } = Packet::new(scene, paths, packet);
        let lanes = |lane: usize| packet.get(lane).unwrap_or(&packet[0]);
        lap(Phase::Frames);
        let prepared = scene.hair_of(packet[0].1.strand).1.prepare8(&hits);
        lap(Phase::Kernels);

        // Uniform numbers, and directions towards lights.
        let mut numbers = [[0.0; 4]; 8];
        let mut xi = [[0.0; 8]; 3];
        for (lane, (index, _)) in packet.iter().enumerate() {
            let path = &mut paths[*index as usize];
            numbers[lane] = path.numbers.four();
            let [lobe, theta, phi, roulette] = path.numbers.four();
            (xi[0][lane], xi[1][lane], xi[2][lane], path.roulette) = (lobe, theta, phi, roulette);
        }

        lap(Phase::Numbers);

        // Light that the lights add.
        if settings.mis == Mis::Resampled {
            let sample = |lane: usize| paths[lanes(lane).0 as usize].numbers.sample();
            let tables = core::array::from_fn(|lane| tables.of_pass(sample(lane) / PASS));
            let chosen =
                resampled::of_lights(scene, &tables, &origins, &frames, &prepared, &numbers);
            for ((index, hit), (lane, chosen)) in packet.iter().zip(chosen.into_iter().enumerate())
            {
                let Some((candidate, radiance)) = chosen else {
                    continue;
                };
                let path = &paths[*index as usize];
                let ray = leave(
                    scene,
                    hit,
                    origins[lane],
                    candidate.direction,
                    candidate.cos,
                    candidate.distance,
                );
                shadows.push(Shadow {
                    ray,
                    radiance: path.throughput * radiance,
                    slot: path.slot,
                });
            }
        } else if settings.mis != Mis::Bsdf {
            let xi = [0, 1, 2].map(|axis| numbers.map(|four| four[axis]));
            let lights = scene.sample_lights8(|lane| origins[lane], &xi, None);
            lap(Phase::Light);
            let wi = frames.to_local(&lights.direction);
            lap(Phase::Frames);
            let (eval, cos) = (prepared.eval8(&wi), cosine(&wi).to_array());
            lap(Phase::Kernels);
            for (lane, (index, hit)) in packet.iter().enumerate() {
                let Some(light) = lights.lane(lane, 1.0) else {
                    continue;
                };
                let path = &paths[*index as usize];
                let eval = eval.lane(lane);
                let weight = settings.mis.of_light(light.pdf, eval.pdf) * cos[lane] / light.pdf;
                let radiance =
                    path.throughput * light.radiance * Vec3::from_array(eval.value) * weight;
                if radiance.max_element() > 0.0 {
                    let ray = leave(
                        scene,
                        hit,
                        origins[lane],
                        light.direction,
                        cos[lane],
                        light.distance,
                    );
                    shadows.push(Shadow {
                        ray,
                        radiance,
                        slot: path.slot,
                    });
                }
            }
        }

        lap(Phase::Rest);

        // The paths' next rays.
        let sample = prepared.sample8(&xi);
        lap(Phase::Kernels);
        let (directions, cos) = (frames.to_world(&sample.wi), cosine(&sample.wi).to_array());
        for (lane, (index, hit)) in packet.iter().enumerate() {
            let path = &mut paths[*index as usize];
            let at = |lanes: &f32x8| lanes.as_array()[lane];
            path.pdf = at(&sample.pdf);
            path.alive = path.pdf > 0.0;
            path.throughput *= Vec3::from_array([0, 1, 2].map(|c| at(&sample.weight[c])));
            path.ray = leave(
                scene,
                hit,
                origins[lane],
                directions.lane(lane).normalize_or(Vec3::Y),
                cos[lane],
                f32::INFINITY,
            );
            path.from_hair = true;
        }
        lap(Phase::Frames);
    }
}

/// Returns a ray that leaves a fibre, in a direction of inclination `cos_theta`, and ends at a distance.
#[inline]
pub(super) fn leave(
    scene: &Scene,
    hit: &tree::Hit,
    origin: Vec3,
    direction: Vec3,
    cos_theta: f32,
    distance: f32,
) -> Ray {
    let radius = scene.strands.radius(hit.segment, hit.s);
    Ray {
        t_max: distance,
        skip: Some(Skip::leaving(
            hit.strand,
            radius,
            cos_theta,
            scene.tree.meet(),
        )),
        ..Ray::new(origin, direction)
    }
}

/// Removes paths that have ended. With `roulette`, keeps the throughputs of the others close to that
/// of a camera ray, which is 1: a path whose largest channel `t` is
///
/// - below 1 survives with probability `t`, and its throughput is divided by `t`. A path that nothing
///   has absorbed never ends at random, and survival never raises a channel above 1. A cap on the
///   probability would multiply throughputs without end, with infinite variance where fewer paths leave
///   hair per scattering than the cap ends;
/// - 2 or more continues as `floor(t)` paths of equal parts, as far as the camera ray's
///   [`MOST_PARTS`](super::wave::MOST_PARTS) allow. Weights of a sampler are 1 on average, but over scatterings without end
///   their products have infinite variance.
///
/// Both rules are relative to the camera ray and not to the scattering before, which would keep what
/// one weight has raised and end what the next lowers.
pub(super) fn end_some(wave: &mut Wave, roulette: bool) {
    let Wave { paths, parts, .. } = wave;
    paths.retain_mut(|path| {
        let most = path.throughput.max_element();
        if !path.alive || !most.is_finite() || most <= 0.0 {
            return false;
        }
        if roulette && most < 1.0 {
            path.throughput /= most;
            return path.roulette < most;
        }
        if roulette && most >= 2.0 {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "the cast saturates"
            )]
            let count = (most as u32).min(path.parts);
            path.throughput /= count as f32;
            path.parts /= count;
            parts.extend((1..count).map(|part| Path {
                numbers: path.numbers.part(part),
                ..*path
            }));
        }
        true
    });
    paths.append(parts);
}
