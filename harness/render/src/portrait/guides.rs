//! Growth of strands: from the scalp, over the head and down, without waves and curls.

use super::bust;
use super::scalp::{Root, comb};
use super::style::Style;
use crate::geometry::Random;
use glam::Vec3;

/// Distance from the scalp, in centimetres, over which strands rise into their layer.
const RISE: f32 = 9.0;
/// Distance from the root, in centimetres, over which hair keeps the direction in which it is combed.
const COMBED: f32 = 7.0;
/// Bends per centimetre: of free hair towards the body, and of hair beside the face to the back.
const CLING: f32 = 0.05;
const SWEEP: f32 = 0.25;
/// Distance in centimetres from its layer at which hair is free, and from the plane behind the ears at which hair is in front.
const FREE: f32 = 4.0;
/// Plane behind the ears, along z in centimetres.
const BEHIND: f32 = -2.0;
/// Range of the heights of roots in centimetres: lower roots lie below the hair of higher ones.
const ROOTS: [f32; 2] = [-7.0, 9.5];
/// Least distance of hair from the skin in centimetres.
pub(super) const CLEARANCE: f32 = 0.08;

/// Traits in which a strand, or the guide of a clump, differs from its neighbours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Traits {
    /// Shift of the parting in centimetres.
    pub(super) parting: f32,
    /// Layer above the scalp, from 0 on the skin to 1 on top.
    pub(super) layer: f32,
    /// Constant bend per centimetre.
    pub(super) bend: Vec3,
    /// Direction in which the root leans, besides that of the comb.
    pub(super) lean: Vec3,
    /// Factor on gravity.
    pub(super) gravity: f32,
}

impl Traits {
    /// Draws the traits of a guide at a root.
    pub(super) fn draw(style: &Style, root: &Root, random: &mut Random) -> Self {
        let [lowest, highest] = ROOTS;
        let height = (root.position.y - lowest) / (highest - lowest);
        Self {
            // No parting of curls is a line.
            parting: (0.2 + style.curl_radius * style.roundness) * random.normal_cut(),
            layer: (0.15 + 0.75 * height + 0.12 * random.normal_cut()).clamp(0.0, 1.0),
            bend: 0.012 * Vec3::new(random.normal_cut(), 0.0, random.normal_cut()),
            lean: Vec3::ZERO,
            gravity: 1.0 + 0.15 * random.normal_cut(),
        }
    }
}

/// Grows a strand of at most `length` cm with a node every [`Style::step`], cut at the height `hem`.
pub(super) fn grow(
    style: &Style,
    root: &Root,
    traits: &Traits,
    length: f32,
    hem: f32,
) -> Vec<Vec3> {
    let step = style.step();
    let combed = comb(style, root, traits.parting);
    let mut position = root.position;
    let lean = style.lift * root.normal + (1.0 - style.lift) * combed + traits.lean;
    let mut direction = lean.normalize_or(root.normal);
    direction = (direction - (direction.dot(root.normal) - 0.1).min(0.0) * root.normal).normalize();
    let mut nodes = vec![position];
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few hundred nodes at most"
    )]
    let count = (length / step).round().max(2.0) as usize;
    for k in 1..=count {
        let s = k as f32 * step;
        let fade = libm::expf(-s / COMBED);
        let rise = (s / RISE).min(1.0);
        let depth = CLEARANCE + style.volume * traits.layer * rise * (2.0 - rise);
        let distance = bust::under_hair(position);
        let normal = bust::normal(bust::under_hair, position);
        // Hair that hangs free clings to the neck, and hair beside the face is swept back behind the ears.
        let free = ((distance - depth) / FREE).clamp(0.0, 1.0);
        let front = ((position.z - BEHIND) / FREE).clamp(0.0, 1.0);
        let pull = style.gravity * traits.gravity * (1.0 - 0.6 * fade) * Vec3::NEG_Y
            + 0.25 * fade * combed
            - CLING * free * normal
            + SWEEP * front * Vec3::NEG_Z
            + traits.bend;
        direction = (direction + step * pull).normalize();
        position += step * direction;
        let distance = bust::under_hair(position);
        if distance < depth {
            let normal = bust::normal(bust::under_hair, position);
            position += (depth - distance) * normal;
            // Slide along the layer, and keep the speed.
            let inwards = direction.dot(normal).min(0.0);
            direction = (direction - inwards * normal).normalize_or(Vec3::NEG_Y);
        }
        nodes.push(position);
        if position.y < hem {
            break;
        }
    }
    nodes
}
