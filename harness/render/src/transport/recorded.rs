//! Paths whose light is recorded as a polynomial in the scattering at hair, to be evaluated for many materials.

use super::path::{Packet, end_some, leave, surfaces};
use super::wave::{Shadow, Wave};
use super::{Mis, Settings, sees};
use crate::film::Crop;
use crate::scene::Scene;
use glam::Vec3;
use hairis::Vec3x8;
use hairis_instruments::direction::cosine;

/// Largest number of scatterings at hair of a term.
const MOST: usize = 2;
/// Entry of [`Term::at`] where there is no scattering.
const NONE: u32 = u32::MAX;

/// Light of a path: `factor` times the BSDF S at each of the path's scatterings at hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Index of the pixel in the crop.
    pub pixel: u32,
    /// Product of everything but S, linear RGB: light, cosines, albedos of surfaces, and weights over densities.
    pub factor: Vec3,
    at: [u32; MOST],
}

impl Term {
    /// Iterates over the scatterings at hair, one or two, as indices of the recorded directions.
    pub fn scatterings(&self) -> impl Iterator<Item = usize> + Clone {
        let places = self.at.into_iter().take_while(|at| *at != NONE);
        places.map(|at| at as usize)
    }
}

/// Recorded paths of a part of a picture, as sums over the samples of each pixel.
///
/// The directions, the densities and the weights of multiple importance sampling are those of one material. They stay as they are for
/// other materials, so that the sums are unbiased for any material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorded {
    /// Light that hair has not scattered, a sum per pixel, row by row.
    pub beside: Vec<[f64; 3]>,
    /// Light that hair has scattered once or twice.
    pub terms: Vec<Term>,
    /// Directions to the viewer in the frame of the fibre, by component: u, v, w.
    pub wo: [Vec<f32>; 3],
    /// Offsets of the hits across the fibre.
    pub h: Vec<f32>,
    /// Directions to the light in the frame of the fibre, by component: u, v, w.
    pub wi: [Vec<f32>; 3],
}

/// A pair of directions at a hit: `wo`, `h` and `wi`.
#[derive(Clone, Copy, Default)]
struct Pair {
    numbers: [f32; 7],
    /// Index of the pair, once a term has it.
    place: Option<u32>,
}

impl Pair {
    fn new(wo: Vec3, h: f32, wi: Vec3) -> Self {
        let ([a, b, c], [d, e, f]) = (wo.to_array(), wi.to_array());
        Self {
            numbers: [a, b, c, h, d, e, f],
            place: None,
        }
    }
}

/// Scatterings at hair of a path so far.
#[derive(Clone, Copy, Default)]
struct Chain {
    pairs: [Pair; MOST],
    len: usize,
}

impl Chain {
    fn push(&mut self, pair: Pair) {
        self.pairs[self.len] = pair;
        self.len += 1;
    }
}

impl Recorded {
    /// Adds light that has come along a chain.
    fn add(&mut self, pixel: usize, factor: Vec3, chain: &mut Chain) {
        // Light that overflows is left out, as in the renderer.
        if factor.max_element() <= 0.0 || !factor.is_finite() {
            return;
        }
        if chain.len == 0 {
            for (sum, channel) in self.beside[pixel].iter_mut().zip(factor.to_array()) {
                *sum += f64::from(channel);
            }
            return;
        }
        let mut at = [NONE; MOST];
        for (at, pair) in at.iter_mut().zip(&mut chain.pairs[..chain.len]) {
            *at = *pair.place.get_or_insert_with(|| self.place(&pair.numbers));
        }
        self.terms.push(Term {
            pixel: u32::try_from(pixel).expect("a pixel of a tile"),
            factor,
            at,
        });
    }

    /// Appends a pair of directions, and returns its index.
    fn place(&mut self, numbers: &[f32; 7]) -> u32 {
        let place = u32::try_from(self.h.len()).expect("fewer than 2^32 directions");
        let (wo, h, wi) = (&mut self.wo, &mut self.h, &mut self.wi);
        let columns = wo.iter_mut().chain([h]).chain(wi.iter_mut());
        for (column, number) in columns.zip(numbers) {
            column.push(*number);
        }
        place
    }
}

/// Records the paths of a part of a picture, with at most `settings.depth` scatterings, or two without a depth. Directions are drawn by
/// the sampler of the scene's hair, whose energy must be raw.
///
/// With the material of the scene, the sums are those of a film that was rendered with these settings, except for rounding.
///
/// # Panics
///
/// Panics if `settings` has a depth above 2 or resampled light.
#[must_use]
pub fn record(scene: &Scene, settings: &Settings, crop: Crop, samples: u32) -> Recorded {
    assert!(
        settings.mis != Mis::Resampled,
        "resampled light cannot be recorded"
    );
    let most = u32::try_from(MOST).expect("a small count");
    let depth = settings.depth.unwrap_or(most);
    assert!(depth <= most, "at most two scatterings");
    let mut recorded = Recorded {
        beside: vec![[0.0; 3]; crop.len()],
        ..Recorded::default()
    };
    let mut wave = Wave::default();
    let of_pixel = |pixel| (0..samples).map(move |sample| (pixel, sample));
    wave.start(scene, settings, crop.pixels().flat_map(of_pixel));
    let mut chains = vec![Chain::default(); wave.paths.len()];
    let pixel = |slot: u32| (slot / samples) as usize;
    for scatterings in 0..=depth {
        wave.met.clear();
        wave.met
            .extend(wave.paths.iter().map(|path| scene.closest(&path.ray)));
        for (path, met) in wave.paths.iter().zip(&wave.met) {
            let chain = &mut chains[path.slot as usize];
            if scatterings == 0 {
                let radiance = scene.see_from_camera(&path.ray, met).unwrap_or_default();
                recorded.add(pixel(path.slot), radiance, chain);
            } else if let Some(seen) = scene.see(&path.ray, met) {
                let weight = settings.mis.of_bsdf(path.pdf, seen.pdf);
                let factor = path.throughput * seen.radiance * weight;
                recorded.add(pixel(path.slot), factor, chain);
            }
        }
        if scatterings == depth {
            break;
        }
        wave.shadows.clear();
        surfaces(scene, settings, &mut wave);
        let mut add = |shadow: &Shadow, chain: &mut Chain| {
            if sees(scene, &shadow.ray) {
                recorded.add(pixel(shadow.slot), shadow.radiance, chain);
            }
        };
        for shadow in &wave.shadows {
            add(shadow, &mut chains[shadow.slot as usize]);
        }
        hair(scene, settings, &mut wave, &mut chains, &mut add);
        end_some(&mut wave, false);
    }
    recorded
}

/// Scatters paths at hair. Throughputs are without S, and `add` takes light along a chain.
fn hair(
    scene: &Scene,
    settings: &Settings,
    wave: &mut Wave,
    chains: &mut [Chain],
    add: &mut dyn FnMut(&Shadow, &mut Chain),
) {
    let Wave { paths, hits, .. } = wave;
    for packet in hits.chunks(8) {
        let Packet {
            frames,
            origins,
            hits,
        } = Packet::new(scene, paths, packet);
        let prepared = scene.hair.prepare8(&hits);
        let pair = |lane: usize, wi: &Vec3x8| {
            Pair::new(hits.wo.lane(lane), hits.h.as_array()[lane], wi.lane(lane))
        };
        let (mut xi_light, mut xi) = ([[0.0; 8]; 3], [[0.0; 8]; 3]);
        for (lane, (index, _)) in packet.iter().enumerate() {
            let path = &mut paths[*index as usize];
            for to in [&mut xi_light, &mut xi] {
                let [a, b, c, _] = path.numbers.four();
                (to[0][lane], to[1][lane], to[2][lane]) = (a, b, c);
            }
        }
        if settings.mis != Mis::Bsdf {
            let lights = scene.sample_lights8(|lane| origins[lane], &xi_light, None);
            let wi = frames.to_local(&lights.direction);
            let (eval, cos) = (prepared.eval8(&wi), cosine(&wi).to_array());
            for (lane, (index, hit)) in packet.iter().enumerate() {
                let Some(light) = lights.lane(lane, 1.0) else {
                    continue;
                };
                let path = &paths[*index as usize];
                let pdf = eval.pdf.as_array()[lane];
                let weight = settings.mis.of_light(light.pdf, pdf) * cos[lane] / light.pdf;
                let radiance = path.throughput * light.radiance * weight;
                let mut chain = chains[path.slot as usize];
                chain.push(pair(lane, &wi));
                let ray = leave(
                    scene,
                    hit,
                    origins[lane],
                    light.direction,
                    cos[lane],
                    light.distance,
                );
                let slot = path.slot;
                let shadow = Shadow {
                    ray,
                    radiance,
                    slot,
                };
                if radiance.max_element() > 0.0 {
                    add(&shadow, &mut chain);
                }
                // Keep the indices of the scatterings before this one.
                let first = chains[slot as usize].len;
                chains[slot as usize].pairs[..first].copy_from_slice(&chain.pairs[..first]);
            }
        }
        let sample = prepared.sample8(&xi);
        let (directions, cos) = (frames.to_world(&sample.wi), cosine(&sample.wi).to_array());
        for (lane, (index, hit)) in packet.iter().enumerate() {
            let path = &mut paths[*index as usize];
            path.pdf = sample.pdf.as_array()[lane];
            path.alive = path.pdf > 0.0;
            path.throughput *= cos[lane] / path.pdf;
            path.ray = leave(
                scene,
                hit,
                origins[lane],
                directions.lane(lane).normalize_or(Vec3::Y),
                cos[lane],
                f32::INFINITY,
            );
            path.from_hair = true;
            chains[path.slot as usize].push(pair(lane, &sample.wi));
        }
    }
}
