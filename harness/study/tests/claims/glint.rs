//! Glints.

use core::f64::consts::{FRAC_PI_2, PI};
use hairis::HairParams;
use hairis::params::HairDesc;
use hairis_harness::subject::ModelKind;
use hairis_study::claims::glint::*;
use hairis_study::claims::hair::Hair;

#[test]
fn the_printed_density_exceeds_one_by_what_lies_beyond() {
    let base = *HairParams::bright().desc();
    let params = HairParams::new(&HairDesc {
        phi_g: 0.61,
        gamma_g: 0.17,
        ..base
    })
    .expect("accepted");
    let arc = |end: f64| ((end - 0.61) / 0.17_f64).atan();
    let want = (arc(PI) - arc(0.0)) / (arc(FRAC_PI_2) - arc(0.0)) - 1.0;
    let got = excess(&params);
    assert!(
        (got.value - want).abs() < 1e-6 && (got.value - 0.04).abs() < 5e-3,
        "{got:?} {want}"
    );
}

#[test]
fn every_decade_adds_the_same_and_nothing_when_glints_reach_the_end() {
    let params = *glints(false).expect("accepted").last().expect("some");
    let hair = Hair::new(ModelKind::Cauchy, &params, 0.0);
    let [[first, first_whole], [last, last_whole]] = [1e-5, 1e-8].map(|gap| decade(&hair, gap));
    assert!(
        (last.value / first.value - 1.0).abs() < 0.01 && last.value > 1e-3,
        "{first:?} {last:?}"
    );
    assert!(
        last_whole.value < 2e-3 * first_whole.value,
        "{first_whole:?} {last_whole:?}"
    );
    let [[near, _], [far, _]] = [1e-8, 1e-7].map(|gap| up_to(&hair, gap));
    assert!(
        (near.value - far.value - last.value).abs() < 1e-5,
        "{near:?} {far:?} {last:?}"
    );
}
