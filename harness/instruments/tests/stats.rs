//! Tests of `stats`.

mod moments;
mod spread;

use hairis_instruments::stats::sidak;

#[test]
fn sidak_is_between_alpha_over_n_and_alpha() {
    assert!((sidak(0.05, 1) - 0.05).abs() < 1e-16);
    assert!((sidak(0.05, 10) - 0.005_116_196_891_823_743).abs() < 1e-15);
    assert!((sidak(0.01, 1_000_000) / 1e-8 - 1.005_033_6).abs() < 1e-6);
    assert!((sidak(0.01, 0) - 0.01).abs() < 1e-16);
}
