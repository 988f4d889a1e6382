//! Scalp of the head: the hairline, roots spread within it, and the directions in which hair is combed.

use super::bust::{self, CRANIUM};
use super::style::Style;
use crate::geometry::{Random, golden_spiral};
use core::f32::consts::{FRAC_PI_2, PI};
use glam::Vec3;

/// Hairline: angles from the middle of the forehead around to the nape and elevations above the middle of the cranium, in degrees.
const HAIRLINE: [[f32; 2]; 9] = [
    [0.0, 40.0],
    [25.0, 41.0],
    [42.0, 44.0],
    [58.0, 24.0],
    [70.0, -2.0],
    [84.0, 4.0],
    [105.0, 4.0],
    [125.0, -24.0],
    [180.0, -40.0],
];
/// Width in degrees over which the hairline thins out.
const EDGE: f32 = 7.0;
/// Direction of the whorl, from which hair falls to all sides: the rear end of the parting.
const WHORL: Vec3 = Vec3::new(0.12, 0.85, -0.51);
/// Elevation of the front end of the parting in degrees.
const PARTING: f32 = 38.0;

/// Root of a strand on the scalp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Root {
    /// Position in centimetres.
    pub(super) position: Vec3,
    /// Unit normal of the scalp.
    pub(super) normal: Vec3,
    /// Unit direction from the middle of the cranium.
    pub(super) direction: Vec3,
}

/// Returns the elevation above the hairline in degrees of a direction from the middle of the cranium, negative where no hair grows.
pub(super) fn above_hairline(direction: Vec3) -> f32 {
    let azimuth = libm::atan2f(direction.x.abs(), direction.z).to_degrees();
    let elevation = libm::asinf(direction.y.clamp(-1.0, 1.0)).to_degrees();
    let upper = HAIRLINE
        .partition_point(|[angle, _]| *angle < azimuth)
        .clamp(1, 8);
    let [[from, low], [to, high]] = [HAIRLINE[upper - 1], HAIRLINE[upper]];
    let part = (azimuth - from) / (to - from);
    elevation - (low + part * part * (3.0 - 2.0 * part) * (high - low))
}

/// Returns the root in a direction from the middle of the cranium.
pub(super) fn root(direction: Vec3) -> Root {
    let mut far = 20.0;
    // The distance is approximate, so that full steps might pass the surface.
    for _ in 0..40 {
        far -= 0.8 * bust::without_ears(CRANIUM + far * direction);
    }
    let position = CRANIUM + far * direction;
    Root {
        position,
        normal: bust::normal(bust::without_ears, position),
        direction,
    }
}

/// Spreads roots evenly over the scalp, on a golden spiral with jitter. They thin out at the hairline.
pub(super) fn roots(count: usize, random: &mut Random) -> Vec<Root> {
    // Hair covers about two fifths of the sphere: draw a few directions more than needed, and leave out some of them evenly.
    let mut drawn = 5 * count / 2 + 100;
    loop {
        let inside: Vec<Vec3> = (0..drawn)
            .filter_map(|index| {
                let direction = spiral(index, drawn, random.uniform());
                let thinned = EDGE * random.uniform().powi(2);
                (above_hairline(direction) > thinned).then_some(direction)
            })
            .collect();
        if inside.len() >= count {
            return (0..count)
                .map(|k| root(inside[k * inside.len() / count]))
                .collect();
        }
        drawn += drawn / 8;
    }
}

/// Returns a direction: `index` of `count` on a golden spiral, jittered.
fn spiral(index: usize, count: usize, jitter: f32) -> Vec3 {
    let y = 1.0 - 2.0 * (index as f32 + jitter) / count as f32;
    golden_spiral(index, y)
}

/// Returns the unit direction along the scalp in which hair is combed at a root: away from the parting, a great circle from the
/// front to the whorl, back from the forehead, and down. `jitter` in cm moves the parting, whose line is never quite straight.
pub(super) fn comb(style: &Style, root: &Root, jitter: f32) -> Vec3 {
    let (azimuth, elevation) = (style.parting.to_radians(), PARTING.to_radians());
    let front = Vec3::new(
        libm::cosf(elevation) * libm::sinf(azimuth),
        libm::sinf(elevation),
        libm::cosf(elevation) * libm::cosf(azimuth),
    );
    let whorl = WHORL.normalize();
    let pole = front.cross(whorl).normalize();
    let shifted = (root.direction + 0.1 * jitter * pole).normalize();
    // Nearest point of the arc: by the angle from its front end.
    let ahead = pole.cross(front);
    let angle = libm::atan2f(shifted.dot(ahead), shifted.dot(front));
    let length = libm::acosf(front.dot(whorl));
    let angle = if angle < -FRAC_PI_2 { PI } else { angle }.clamp(0.0, length);
    let nearest = libm::cosf(angle) * front + libm::sinf(angle) * ahead;
    let away = (shifted - nearest).normalize_or(Vec3::NEG_Z);
    // Around the whorl hair turns.
    let swirl =
        0.6 * root.normal.cross(away) * libm::expf(-10.0 * root.direction.distance_squared(whorl));
    let forward = root.direction.z.max(0.0);
    (away + swirl + forward * Vec3::new(0.0, -0.2, -0.8) + 0.4 * Vec3::NEG_Y)
        .reject_from_normalized(root.normal)
        .normalize_or(Vec3::NEG_Y)
}
