//! Strands of a hairstyle: clumps, waves, curls, frizz and flyaways on grown guides.

use super::bust;
use super::guides::{CLEARANCE, Traits, grow};
use super::scalp::{Root, roots};
use super::style::Style;
use crate::geometry::{Random, Stream};
use core::f32::consts::TAU;
use glam::Vec3;
use rayon::prelude::*;

/// Distances from the root in centimetres after which clumps, and waves and curls, have their full effect.
const CLUMPED: f32 = 12.0;
const SETTLED: f32 = 6.0;
/// Standard deviation of the directions of roots, along each axis.
const ROOTS_LEAN: f32 = 0.1;
/// Standard deviation of the bends of flyaways in excess of those of their clump, along each axis, per centimetre.
const FLYAWAY_BEND: f32 = 0.02;
/// Node with its radius, in centimetres.
pub(super) type Node = (Vec3, f32);

/// Guide of a clump.
#[derive(Clone, Debug)]
struct Clump {
    root: Vec3,
    traits: Traits,
    guide: Vec<Vec3>,
    /// Frames across the guide, which turn with it as little as they can.
    sides: Vec<[Vec3; 2]>,
    /// Phase of waves and curls in rad, and the factors on their radius and their length. Curls are wound to either side.
    phase: f32,
    radius: f32,
    turns: f32,
}

/// Grows the strands of a hairstyle, `count` of them.
pub(super) fn strands(style: &Style, count: usize) -> Vec<Vec<Node>> {
    let random = |stream| Random::new(style.seed, stream);
    let locks: Vec<(Root, Vec<Vec3>)> = roots(style.locks, &mut random(Stream::Roots(2)))
        .into_par_iter()
        .enumerate()
        .map(|(index, root)| {
            let mut random = random(Stream::Clump(index));
            let traits = Traits::draw(style, &root, &mut random);
            (
                root,
                grow(style, &root, &traits, 1.2 * style.length, style.hem - 4.0),
            )
        })
        .collect();
    let clumps: Vec<Clump> = roots(style.clumps, &mut random(Stream::Roots(1)))
        .into_par_iter()
        .enumerate()
        .map(|(index, root)| {
            let mut random = random(Stream::Clump(style.locks + index));
            Clump::new(style, root, &locks, &mut random)
        })
        .collect();
    roots(count, &mut random(Stream::Roots(0)))
        .into_par_iter()
        .enumerate()
        .map(|(index, root)| {
            let mut random = random(Stream::Strand(index));
            let clump = nearest(clumps.iter().map(|clump| clump.root), root.position);
            strand(style, &root, &clumps[clump], &mut random)
        })
        .collect()
}

/// Returns the index of the nearest of some places.
fn nearest(places: impl Iterator<Item = Vec3>, place: Vec3) -> usize {
    let far = |other: Vec3| other.distance_squared(place);
    let least = places
        .map(far)
        .enumerate()
        .min_by(|a, b| a.1.total_cmp(&b.1));
    least.map_or(0, |(index, _)| index)
}

impl Clump {
    fn new(style: &Style, root: Root, locks: &[(Root, Vec<Vec3>)], random: &mut Random) -> Self {
        let traits = Traits::draw(style, &root, random);
        let mut guide = grow(style, &root, &traits, 1.2 * style.length, style.hem - 4.0);
        let lock = nearest(locks.iter().map(|(root, _)| root.position), root.position);
        draw(&mut guide, &locks[lock].1, style.step(), style.lock);
        // Smooth over the scalp, so that neighbours wave in step.
        let common = (root.position * Vec3::new(0.31, 0.17, 0.23)).element_sum()
            + libm::sinf(0.45 * root.position.x + 1.0) * libm::cosf(0.4 * root.position.z);
        let side = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        Self {
            root: root.position,
            traits,
            sides: sides(&guide),
            guide,
            phase: style.coherence * common + (1.0 - style.coherence) * random.phase(),
            radius: 1.0 + 0.25 * random.normal_cut(),
            turns: (1.0 + 0.12 * (1.0 - 0.7 * style.coherence) * random.normal_cut())
                * if style.roundness > 0.9 { side } else { 1.0 },
        }
    }
}

/// Draws a strand to a guide, fully at the tip. Beyond the end of the guide the strand keeps its shape.
fn draw(strand: &mut [Vec3], guide: &[Vec3], step: f32, degree: f32) {
    let mut shift = Vec3::ZERO;
    for (k, node) in strand.iter_mut().enumerate() {
        if let Some(target) = guide.get(k) {
            shift = degree * smooth(k as f32 * step / CLUMPED) * (*target - *node);
        }
        *node += shift;
    }
}

/// Returns a number that rises smoothly from 0 to 1 between the arguments 0 and 1.
fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Returns two directions across each node of a curve, which turn about it as little as they can.
fn sides(curve: &[Vec3]) -> Vec<[Vec3; 2]> {
    let mut side = Vec3::ZERO;
    (0..curve.len())
        .map(|k| {
            let along = (curve[(k + 1).min(curve.len() - 1)] - curve[k.saturating_sub(1)])
                .normalize_or(Vec3::NEG_Y);
            side = side
                .reject_from_normalized(along)
                .try_normalize()
                .unwrap_or_else(|| along.any_orthonormal_vector());
            [side, along.cross(side)]
        })
        .collect()
}

/// Grows a strand of a clump.
fn strand(style: &Style, root: &Root, clump: &Clump, random: &mut Random) -> Vec<Node> {
    let step = style.step();
    let flies = random.uniform() < style.flyaways;
    let spread = 1.0 + style.length_spread * random.normal_cut();
    // Many hairs that fly away are broken or young.
    let broken = if flies {
        0.3 + 0.7 * random.uniform()
    } else {
        1.0
    };
    let length = style.length * spread * broken;
    let hem = style.hem + 1.2 * random.normal_cut();
    let mut traits = clump.traits;
    traits.layer = (traits.layer + 0.06 * random.normal_cut()).clamp(0.0, 1.0);
    traits.lean = ROOTS_LEAN * scatter(random);
    if flies {
        traits.bend += FLYAWAY_BEND * scatter(random);
        traits.layer *= 1.1;
        traits.gravity *= 0.6;
    }
    let mut nodes = grow(style, root, &traits, length, hem);
    let own = random.normal_cut();
    let degree = style.clump * (1.0 - 0.2 * own.abs()) * if flies { 0.25 } else { 1.0 };
    draw(&mut nodes, &clump.guide, step, degree.clamp(0.0, 1.0));

    let curl = style.curl_radius * clump.radius * (1.0 + 0.06 * random.normal_cut());
    let phase = clump.phase + 0.12 * random.normal_cut();
    let frizz = style.frizz * if flies { 3.0 } else { 1.0 };
    let noise = Noise::new(random);
    let last = clump.sides.len() - 1;
    let count = nodes.len() as f32 - 1.0;
    for (k, node) in nodes.iter_mut().enumerate().skip(1) {
        let s = k as f32 * step;
        let [side, other] = clump.sides[k.min(last)];
        let angle = phase + clump.turns * TAU * s / style.curl_length;
        let settled = smooth(s / SETTLED);
        let radius = curl * settled;
        *node += radius * (libm::cosf(angle) * side + style.roundness * libm::sinf(angle) * other)
            + frizz * (0.25 + 0.75 * k as f32 / count) * settled * noise.at(s);
        *node = outside(*node);
    }
    let thickness = style.radius * (1.0 + style.radius_spread * random.normal_cut());
    let radius = |k: usize| {
        let s = k as f32 / count;
        thickness * (1.0 - style.taper * s * s * s)
    };
    (0..)
        .map(radius)
        .zip(nodes)
        .map(|(radius, node)| (node, radius))
        .collect()
}

/// Draws a vector of deviation 1 along each axis.
fn scatter(random: &mut Random) -> Vec3 {
    let [x, y, z] = core::array::from_fn(|_| random.normal_cut());
    Vec3::new(x, y, z)
}

/// Returns the place, or the nearest that keeps its distance from the skin. Steps are repeated, because distances are approximate.
fn outside(mut place: Vec3) -> Vec3 {
    for _ in 0..12 {
        let missing = CLEARANCE - bust::distance(place);
        if missing <= 0.0 {
            break;
        }
        place += (missing + 0.01) * bust::normal(bust::distance, place);
    }
    place
}

/// Smooth random curve: two waves along each axis.
struct Noise([[f32; 3]; 6]);

impl Noise {
    fn new(random: &mut Random) -> Self {
        Self(core::array::from_fn(|_| {
            let length = 1.5 + 6.0 * random.uniform();
            [random.normal_cut(), TAU / length, random.phase()]
        }))
    }

    /// Returns the shift at a distance from the root in centimetres, of deviation 1 along each axis.
    fn at(&self, s: f32) -> Vec3 {
        let wave = |[height, rate, phase]: [f32; 3]| height * libm::sinf(rate * s + phase);
        Vec3::from_array([0, 2, 4].map(|k| wave(self.0[k]) + wave(self.0[k + 1])))
    }
}
