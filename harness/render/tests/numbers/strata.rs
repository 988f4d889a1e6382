//! Tests of `numbers::strata`.

use hairis_instruments::sequence::mix;
use hairis_render::numbers::strata::{CELLS, cell, pair};

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
