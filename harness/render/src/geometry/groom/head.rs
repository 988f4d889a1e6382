//! Hair on a head: roots on an ellipsoid, clumps, curls.

use super::random::{Random, Stream};
use super::{Groom, HEAD};
use crate::geometry::spiral::golden_spiral;
use core::f32::consts::TAU;
use glam::Vec3;

/// Share of the height of the ellipsoid, from the top, that has hair.
const COVERED: f32 = 0.625;
/// Factor on the ellipsoid outside of which strands stay.
const CLEARANCE: f32 = 1.02;
/// Depth of the layers of combed strands above that, relative to the ellipsoid.
const DEPTH: f32 = 0.06;
/// Parting of combed strands, as x on the unit sphere; strands fall to either side.
const PARTING: f32 = 0.25;
/// Length of guides, relative to that of strands.
const GUIDE_LENGTH: f32 = 1.05;

/// Clumps of a head of hair, ready for strands to be grown.
#[derive(Clone, Debug)]
pub(super) struct HeadGroom {
    groom: Groom,
    clumps: Vec<Clump>,
}

#[derive(Clone, Debug)]
struct Clump {
    /// Root of the guide on the unit sphere.
    root: Vec3,
    guide: Vec<Vec3>,
    phase: f32,
    curl_length: f32,
}

impl HeadGroom {
    pub(super) fn new(groom: Groom) -> Self {
        let clump = |index| {
            let mut random = Random::new(groom.seed, Stream::Clump(index));
            let root = root(index, groom.clumps, &mut random);
            Clump {
                root,
                guide: fall(
                    &groom,
                    root,
                    side(root),
                    GUIDE_LENGTH * groom.length,
                    0.03,
                    &mut random,
                ),
                phase: random.phase(),
                curl_length: groom.curl_length * (1.0 + 0.15 * random.normal_cut()),
            }
        };
        Self {
            groom,
            clumps: (0..groom.clumps).map(clump).collect(),
        }
    }

    /// Returns the nodes of a strand, from root to tip.
    pub(super) fn strand(&self, strand: usize) -> Vec<Vec3> {
        let groom = &self.groom;
        let mut random = Random::new(groom.seed, Stream::Strand(strand));
        let root = root(strand, groom.strands, &mut random);
        let length = groom.length * (1.0 + groom.length_spread * random.normal_cut());
        let clump = self.nearest(root);
        // Use the side of the clump, because a strand drawn to a guide on the other side would go through the head.
        let mut nodes = fall(
            groom,
            root,
            side(clump.root),
            length,
            0.06 + groom.frizz,
            &mut random,
        );
        let phase = clump.phase + 0.5 * random.normal();
        let curl_radius = groom.curl_radius * (1.0 + 0.2 * random.normal_cut());
        let step = length / (groom.nodes - 1) as f32;
        for (k, node) in nodes.iter_mut().enumerate().skip(1) {
            let s = k as f32 / (groom.nodes - 1) as f32;
            let guide = clump.guide[k];
            let (side, other) = (guide - clump.guide[k - 1])
                .normalize()
                .any_orthonormal_pair();
            let angle = phase + TAU * k as f32 * step / clump.curl_length;
            let curl = curl_radius * (4.0 * s).min(1.0);
            let frizz = Vec3::new(random.normal(), random.normal(), random.normal());
            *node = node.lerp(guide, groom.clump * libm::powf(s, 0.7))
                + curl * (libm::cosf(angle) * side + libm::sinf(angle) * other)
                + 0.5 * groom.frizz * s * frizz;
        }
        nodes
    }

    /// Finds the clump with the nearest root. Roots descend in y with their number, so that few of them are compared.
    fn nearest(&self, root: Vec3) -> &Clump {
        let below = self.clumps.partition_point(|clump| clump.root.y > root.y);
        let (upper, lower) = self.clumps.split_at(below);
        let mut best = (f32::INFINITY, &self.clumps[0]);
        let sides: [&mut dyn Iterator<Item = &Clump>; 2] =
            [&mut upper.iter().rev(), &mut lower.iter()];
        for clumps in sides {
            for clump in clumps {
                let distance = root.distance_squared(clump.root);
                if distance < best.0 {
                    best = (distance, clump);
                }
                if (root.y - clump.root.y) * (root.y - clump.root.y) > best.0 {
                    break;
                }
            }
        }
        best.1
    }
}

/// Returns a root on the unit sphere: `index` of `count` on a golden spiral, jittered.
fn root(index: usize, count: usize, random: &mut Random) -> Vec3 {
    let y = 1.0 - 2.0 * COVERED * (index as f32 + random.uniform()) / count as f32;
    golden_spiral(index, y)
}

/// Returns the side of the parting to which combed hair falls: 1 or -1, along x.
fn side(root: Vec3) -> f32 {
    (root.x - PARTING).signum()
}

/// Returns the nodes of a strand that leaves the head along its normal, or combed, and bends down around the head.
fn fall(
    groom: &Groom,
    root: Vec3,
    side: f32,
    length: f32,
    waviness: f32,
    random: &mut Random,
) -> Vec<Vec3> {
    let step = length / (groom.nodes - 1) as f32;
    let aside = 0.015 * Vec3::new(-root.z, 0.0, root.x);
    let phases = Vec3::new(random.phase(), random.phase(), random.phase());
    let mut position = root * HEAD;
    let normal = (root / HEAD).normalize();
    let from_parting = side * root.y.max(0.0).powi(2) * Vec3::X;
    let away = (from_parting + Vec3::NEG_Y)
        .reject_from_normalized(normal)
        .normalize_or_zero();
    let mut direction = (groom.lift * normal + (1.0 - groom.lift) * away).normalize();
    let shell = (CLEARANCE + DEPTH * (1.0 - groom.lift) * random.uniform()) * HEAD;
    let mut nodes = vec![position];
    for k in 1..groom.nodes {
        let s = k as f32 * step;
        let wave = (phases + s * Vec3::new(1.7, 2.3, 2.9))
            .to_array()
            .map(libm::sinf);
        let pull = groom.gravity * Vec3::NEG_Y + aside + waviness * Vec3::from_array(wave);
        direction = (direction + step * pull).normalize();
        position += step * direction;
        let inside = position / shell;
        if inside.length_squared() < 1.0 {
            let pushed = inside.normalize() * shell;
            direction = (direction + (pushed - position) / step).normalize();
            position = pushed;
        }
        nodes.push(position);
    }
    nodes
}
