//! Tests of `numbers`.

mod even;
mod strata;

use hairis_conformance::statistics::chi_square;
use hairis_render::numbers::{Numbers, SOBOL_POINTS, Sequence};

const ALL: [Sequence; 4] = [
    Sequence::Independent,
    Sequence::Halton,
    Sequence::Sobol,
    Sequence::Stratified,
];

#[test]
fn every_pair_of_every_group_is_uniform() {
    const PAIRS: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [0, 3]];
    for sequence in ALL {
        for group in 0..5 {
            let mut cells = [[0_u64; 64]; PAIRS.len()];
            for (pixel, sample) in
                (0..64).flat_map(|pixel| (0..100).map(move |sample| (pixel, sample)))
            {
                let mut numbers = Numbers::new(sequence, 3, pixel, sample);
                let four = (0..=group).map(|_| numbers.four()).last().expect("a group");
                assert!(four.iter().all(|x| (0.0..1.0).contains(x)), "{four:?}");
                let cell = |x: f32| (0..8).rev().find(|i| x * 8.0 >= *i as f32).unwrap_or(0);
                for (cells, [a, b]) in cells.iter_mut().zip(PAIRS) {
                    cells[cell(four[a]) * 8 + cell(four[b])] += 1;
                }
            }
            for (cells, pair) in cells.iter().zip(PAIRS) {
                let p = chi_square(cells, &[100.0; 64], 5.0).p_value;
                assert!(
                    p > 1e-4,
                    "{sequence:?}, group {group}, dimensions {pair:?}: p {p}"
                );
            }
        }
    }
}

#[test]
fn samples_pixels_seeds_and_groups_differ() {
    for sequence in ALL {
        let four = |seed, pixel, sample| Numbers::new(sequence, seed, pixel, sample).four();
        assert_eq!(four(1, 2, 3), four(1, 2, 3));
        let others = [four(2, 2, 3), four(1, 3, 3), four(1, 2, 4)];
        assert!(
            others.iter().all(|other| *other != four(1, 2, 3)),
            "{sequence:?}"
        );
        let mut numbers = Numbers::new(sequence, 1, 2, 3);
        assert_ne!(numbers.four(), numbers.four(), "{sequence:?}");
    }
    assert_ne!(
        Numbers::new(Sequence::Sobol, 1, 2, 0).four(),
        Numbers::new(Sequence::Sobol, 1, 2, SOBOL_POINTS).four()
    );
}
