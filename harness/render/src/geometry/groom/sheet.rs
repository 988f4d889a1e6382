//! Sheet of parallel strands, for the scene of the shading points.

use super::Groom;
use super::random::{Random, Stream};
use glam::Vec3;

/// Depth and width of the sheet in centimetres, and the height of its middle above the ends.
const DEPTH: f32 = 1.0;
const WIDTH: f32 = 12.0;
const ARCH: f32 = 1.2;
/// Range by which roots differ along x, in centimetres.
const STAGGER: f32 = 2.0;
/// Deviation of the amplitude of waves across, in centimetres.
const WAVE: f32 = 0.05;

/// Returns the nodes of a strand, from root to tip.
pub(super) fn strand(groom: &Groom, strand: usize) -> Vec<Vec3> {
    let mut random = Random::new(groom.seed, Stream::Strand(strand));
    let y = -DEPTH * random.uniform();
    let z = WIDTH * (random.uniform() - 0.5);
    let x = STAGGER * (random.uniform() - 0.5) - 0.5 * groom.length;
    let (rise, sway, phase) = (
        WAVE * random.normal(),
        WAVE * random.normal(),
        random.phase(),
    );
    (0..groom.nodes)
        .map(|k| {
            let s = k as f32 / (groom.nodes - 1) as f32;
            let arch = ARCH * (2.0 * s - 1.0) * (2.0 * s - 1.0);
            let up =
                rise * libm::sinf(phase + 5.0 * s) - arch + 0.2 * groom.frizz * random.normal();
            let aside = sway * libm::cosf(phase + 6.0 * s) + 0.2 * groom.frizz * random.normal();
            Vec3::new(x + groom.length * s, y + up, z + aside)
        })
        .collect()
}
