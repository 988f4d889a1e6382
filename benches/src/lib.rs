//! What the benches share: inputs drawn from a fixed seed before any clock starts.

use hairis::{Bsdf, HairParams, Model, Vec3x8};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use wide::f32x8;

/// Packets of eight in one iteration: their inputs and outputs stay in the first two levels of cache.
pub const PACKETS: usize = 128;
/// Directions in one iteration.
pub const DIRECTIONS: usize = 8 * PACKETS;

/// A generator with the benches' seed.
#[must_use]
pub fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(0x6861_6972)
}

/// Random numbers for [`PACKETS`] packets of samples.
#[must_use]
pub fn xi_packets() -> Vec<[f32x8; 3]> {
    let mut rng = rng();
    (0..PACKETS).map(|_| hairis::random::xi8(&mut rng)).collect()
}

/// Directions uniform over the sphere, all different.
#[must_use]
pub fn direction_packets() -> Vec<Vec3x8> {
    let mut rng = rng();
    let direction = |rng: &mut ChaCha8Rng| {
        let [height, turn, _] = hairis::random::xi(rng);
        let u = 2.0 * height - 1.0;
        let (sin, cos) = (turn * core::f32::consts::TAU).sin_cos();
        let plane = (1.0 - u * u).sqrt();
        [u, plane * cos, plane * sin]
    };
    (0..PACKETS)
        .map(|_| {
            let rows: [[f32; 3]; 8] = core::array::from_fn(|_| direction(&mut rng));
            let column = |k: usize| f32x8::new(rows.map(|row| row[k]));
            Vec3x8::new(column(0), column(1), column(2))
        })
        .collect()
}

/// The components of packets as slices.
#[must_use]
pub fn columns(packets: &[[f32x8; 3]]) -> [Vec<f32>; 3] {
    core::array::from_fn(|k| packets.iter().flat_map(|packet| packet[k].to_array()).collect())
}

/// The materials of the presets.
#[must_use]
pub fn materials<M: Model<Params = HairParams>>(model: &M) -> Vec<Bsdf<M>> {
    HairParams::presets().iter().map(|(_, params)| Bsdf::new(model, params)).collect()
}
