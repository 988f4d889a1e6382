//! Energies of lobes.

use hairis_study::claims::bounded::largest;
use hairis_study::claims::energy::*;
use hairis_study::claims::hair::theta_h_interval;

#[test]
fn errors_are_the_tails_of_the_normal_distribution() {
    // One and two deviations on either side of the centre: 31.73% and 4.55% lie beyond.
    for (reach, beyond) in [
        (1.0_f64, 0.317_310_507_862_914),
        (2.0, 0.045_500_263_896_358),
    ] {
        let end = (10.0 * reach).to_radians();
        let got = error(0.0, 10.0, [-end, end]);
        assert!(
            (got.value - beyond).abs() < 1e-10 && got.error < 1e-9,
            "{got:?}"
        );
    }
}

#[test]
fn the_largest_error_is_at_the_ends_of_the_shifts() {
    let interval = theta_h_interval(0.0);
    for beta in [5.0, 15.0, 30.0] {
        let ends = largest([-ALPHA, ALPHA].map(|alpha| error(alpha, beta, interval)));
        let inside = largest((-19..=19).map(|alpha| error(f64::from(alpha), beta, interval)));
        assert!(inside.value < ends.value, "{beta}: {inside:?} {ends:?}");
    }
}
