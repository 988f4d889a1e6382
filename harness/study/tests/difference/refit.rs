//! Numbers of a refit in a journal.

use hairis_study::difference::refit::*;
use hairis_variants::ModelId;

#[test]
fn every_number_comes_back() {
    for (_, preset) in ModelId::Gaussian.presets() {
        assert_eq!(values(&numbers(&preset)), preset);
        assert!(numbers(&preset).iter().all(|x| x.is_finite()));
    }
}
