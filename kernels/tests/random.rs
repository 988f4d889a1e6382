//! Uniform numbers from a generator.

use hairis::random::{xi, xi8};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

#[test]
fn uniform_numbers_are_24_bits_below_1() {
    let mut rng = ChaCha8Rng::seed_from_u64(24);
    let numbers: Vec<f32> = (0..4096).flat_map(|_| xi(&mut rng)).collect();
    let is_grid = |x: &f32| (x * 16_777_216.0).fract() == 0.0;
    assert!(numbers.iter().all(|x| (0.0..1.0).contains(x) && is_grid(x)));
    let tenths = numbers.iter().filter(|x| **x < 0.1).count();
    assert!(
        (1100..1360).contains(&tenths),
        "{tenths} of 12288 below 0.1"
    );
    assert!(
        numbers.iter().any(|x| x * 8_388_608.0 % 1.0 != 0.0),
        "the last bit is drawn"
    );
}

#[test]
fn eight_samples_are_drawn_lane_by_lane() {
    let [mut one, mut eight] = [7; 2].map(ChaCha8Rng::seed_from_u64);
    let [x, y, z] = xi8(&mut eight).map(|axis| axis.to_array());
    for ((x, y), z) in x.into_iter().zip(y).zip(z) {
        assert_eq!(xi(&mut one), [x, y, z]);
    }
}
