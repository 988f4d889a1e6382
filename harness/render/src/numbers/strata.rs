//! Jittered points, one in each cell of a grid, in random order.

use super::{half, unit};
use hairis_instruments::sequence::mix;

/// Cells along each axis of a grid.
const SIDE: usize = 4;
/// Number of samples that fill the grid once; it is shuffled anew for the next ones.
const CELLS: usize = SIDE * SIDE;

/// Returns two coordinates of a sample. Any `CELLS` successive samples, from a multiple of `CELLS` on, have one point in each cell.
///
/// - `key` is a hash of the seed, the pixel and the pair of coordinates.
/// - Each point is uniform on its own, because every cell is equally likely, so that estimates are unbiased.
pub(super) fn pair(key: u64, sample: u32) -> [f32; 2] {
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
fn cell(mut bits: u64, index: usize) -> usize {
    let mut order: [usize; CELLS] = core::array::from_fn(|k| k);
    for last in (1..order.len()).rev() {
        bits = mix(bits);
        let other = (u64::from(half(bits)) * (last as u64 + 1)) >> 32;
        order.swap(last, other as usize);
    }
    order[index]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cell_has_one_of_sixteen_samples() {
        for (key, block) in (0..50).flat_map(|key| [0, 1, 4095].map(|block| (key, block))) {
            let mut counts = [0; CELLS];
            for sample in 16 * block..16 * (block + 1) {
                let [x, y] = pair(mix(key), sample).map(|x| {
                    assert!((0.0..1.0).contains(&x), "{x}");
                    (0..4)
                        .rev()
                        .find(|cell| x * 4.0 >= *cell as f32)
                        .unwrap_or(0)
                });
                counts[4 * y + x] += 1;
            }
            assert_eq!(counts, [1; CELLS], "key {key}, block {block}");
        }
    }

    #[test]
    fn every_order_of_two_samples_is_as_likely() {
        // Samples 0 and 1 are in two different cells: 240 ordered pairs.
        let mut counts = [[0_u32; 16]; 16];
        for key in 0..240_000 {
            let [a, b] = [0, 1].map(|sample| cell(mix(key), sample));
            counts[a][b] += 1;
        }
        for (a, b) in (0..16).flat_map(|a| (0..16).map(move |b| (a, b))) {
            let range = if a == b { 0..=0 } else { 850..=1150 };
            assert!(range.contains(&counts[a][b]), "{a} {b}: {}", counts[a][b]);
        }
    }
}
