//! Uniform numbers from a random-number generator. The kernels take plain numbers, so that any sequence works.

use rand_core::Rng;
use wide::f32x8;

/// Draws three uniform numbers in `[0, 1 - 2^-24]`, for one sample.
#[inline]
#[must_use]
pub fn xi<R: Rng + ?Sized>(rng: &mut R) -> [f32; 3] {
    [unit(rng), unit(rng), unit(rng)]
}

/// Draws three uniform numbers per lane, for eight samples: first the three numbers of lane 0.
#[inline]
#[must_use]
pub fn xi8<R: Rng + ?Sized>(rng: &mut R) -> [f32x8; 3] {
    let mut lanes = [[0.0; 8]; 3];
    for lane in 0..8 {
        for (row, x) in lanes.iter_mut().zip(xi(rng)) {
            row[lane] = x;
        }
    }
    lanes.map(f32x8::new)
}

/// Draws 24 bits as a fraction: every value is a multiple of `2^-24`, and 1 is not among them.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "24 bits fit a float exactly")]
fn unit<R: Rng + ?Sized>(rng: &mut R) -> f32 {
    (rng.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
}
