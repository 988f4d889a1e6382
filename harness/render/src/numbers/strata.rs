//! Jittered points, one in each cell of a grid, in random order.

use super::{half, unit};
use hairis_instruments::sequence::mix;

/// Cells along each axis of a grid.
const SIDE: usize = 4;
/// Number of samples that fill the grid once; it is shuffled anew for the next ones.
pub const CELLS: usize = SIDE * SIDE;

/// Returns two coordinates of a sample. Any `CELLS` successive samples, from a multiple of `CELLS` on, have one point in each cell.
///
/// - `key` is a hash of the seed, the pixel and the pair of coordinates.
/// - Each point is uniform on its own, because every cell is equally likely, so that estimates are unbiased.
#[must_use]
pub fn pair(key: u64, sample: u32) -> [f32; 2] {
    let cell = cell(
        mix(key ^ (sample as usize / CELLS) as u64),
        sample as usize % CELLS,
    );
    let jitter = mix(mix(key) ^ u64::from(sample));
    let place = |cell: usize, jitter: f32| (cell as f32 + jitter) * (1.0 / SIDE as f32);
    // The jitter has 22 bits, so that the sum is exact and below 1.
    let jitter = [jitter >> 32, jitter].map(|bits| unit(half(bits) & !0x3ff));
    [place(cell % SIDE, jitter[0]), place(cell / SIDE, jitter[1])]
}

/// Returns entry `index` of a random order of the cells, by Fisher and Yates's shuffle.
///
/// # Panics
///
/// Panics if `index` is not below [`CELLS`].
#[must_use]
pub fn cell(mut bits: u64, index: usize) -> usize {
    let mut order: [usize; CELLS] = core::array::from_fn(|k| k);
    for last in (1..order.len()).rev() {
        bits = mix(bits);
        let other = (u64::from(half(bits)) * (last as u64 + 1)) >> 32;
        order.swap(last, other as usize);
    }
    order[index]
}
