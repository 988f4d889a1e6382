//! Figures that are drawn from the kernels alone.

use hairis::HairParams;
use hairis_harness::figures::*;
use hairis_instruments::markup::well_formed;
use hairis_instruments::report::Drawing;
use hairis_instruments::sequence::{SequenceKind, XiSource as _};
use hairis_variants::Cauchy;

fn default_hair() -> HairParams {
    HairParams::new(HairParams::bright().desc()).expect("the default is legal")
}

fn all() -> Vec<Drawing> {
    let params = default_hair();
    let theta_o = 20.0_f64.to_radians();
    let mut numbers = SequenceKind::Halton.source(1, 0, 3, 2000);
    let xi: Vec<[f32; 3]> = (0..2000).map(|_| numbers.next_xi_f32()).collect();
    let samples = sample_distributions(&params, theta_o, &xi);
    let [area, peak] = bells();
    vec![
        area,
        peak,
        samples,
        polar(&params, theta_o, &[("Cauchy", Cauchy::PAPER)]),
    ]
}

#[test]
fn bells_have_area_one() {
    for (name, at, area) in BELLS {
        for end in [0.5, 2.0, 9.0] {
            let h = end / 2000.0;
            let sum: f64 = (-2000..2000)
                .map(|i| h * at((f64::from(i) + 0.5) * h))
                .sum();
            assert!(
                (sum - area(end)).abs() < 1e-6,
                "{name} to {end}: {sum} {}",
                area(end)
            );
        }
    }
}

#[test]
fn figures_are_drawings_of_moderate_size() {
    for figure in all() {
        well_formed(&figure.svg).expect("the drawing nests");
        assert!(
            !figure.svg.contains("NaN") && !figure.caption.is_empty(),
            "{}",
            figure.caption
        );
        assert!(
            figure.svg.len() < 600_000,
            "{} bytes: {}",
            figure.svg.len(),
            figure.caption
        );
    }
}
