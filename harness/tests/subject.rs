//! Random hair.

use hairis::HairParams;
use hairis_harness::subject::*;
use hairis_instruments::sequence::Independent;

#[test]
fn random_hair_is_accepted_and_differs() {
    let mut xi = Independent::new(3, 0);
    let hair: Vec<HairParams> = (0..1_000)
        .map(|_| random_hair(&mut xi).expect("within range"))
        .collect();
    assert!(
        hair.windows(2).all(|pair| pair[0] != pair[1]),
        "two draws are the same hair"
    );
}
