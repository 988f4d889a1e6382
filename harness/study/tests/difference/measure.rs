//! Differences against closed forms, and of other resolutions.

use core::f64::consts::PI;
use hairis::HairParams;
use hairis::params::HairDesc;
use hairis_reference::Real;
use hairis_study::difference::blur::Blur;
use hairis_study::difference::blur::SIGMA_DEG;
use hairis_study::difference::lobes::{Kind, ViewedHair};
use hairis_study::difference::measure::*;
use hairis_study::difference::{LATITUDES, ORDER};
use hairis_study::study::Grid;

fn blur(size: usize) -> Blur {
    Blur::new(SIGMA_DEG.to_radians(), size, size)
}

fn hair(index: usize, order: usize) -> HairValues {
    let cell = Grid::FULL.cell(index);
    let params = cell.params().expect("accepted");
    HairValues::new(
        ViewedHair::new(&params, f64::from(cell.theta_o_deg).to_radians()),
        order,
    )
}

#[test]
fn a_model_does_not_differ_from_itself() {
    let found = hair(1700, ORDER).figures(&[Kind::GAUSSIAN], &blur(LATITUDES))[0];
    for (place, value) in found.numbers()[3..].iter().enumerate() {
        // The squares of L2 cancel to some 1e-16, their roots to 1e-8.
        assert!(*value < 1e-7, "{place}: {value}");
    }
}

#[test]
fn narrow_highlights_differ_as_their_bells_do() {
    // R alone, so narrow that nothing else changes across it: the norms are those of two bells on a line.
    let black = [0.0; 3];
    let desc = HairDesc {
        beta: [0.002; 3],
        i_tt: black,
        i_trt: black,
        ..*HairParams::bright().desc()
    };
    let hair = HairValues::new(
        ViewedHair::new(&HairParams::new(&desc).expect("accepted"), 0.3),
        ORDER,
    );
    for k in [1.0, 0.797_884_6, 1.177_41] {
        let got = hair.square_error(k).sqrt();
        // Integrals over the line, in widths: of g^2, of c^2 and of g c.
        let squares = [PI.sqrt(), 0.5 * PI * k];
        let cross = k * PI * (0.5 * k * k).exp() * Real::erfc(k / 2.0_f64.sqrt());
        let want = ((squares[0] + squares[1] - 2.0 * cross) / squares[0]).sqrt();
        assert!((got - want).abs() < 2e-4, "{k}: {got} {want}");
    }
}

#[test]
fn figures_do_not_depend_on_the_resolution() {
    let mut worst = [0.0_f64; NUMBERS - 1];
    // Narrow and wide hair, glints and none, from the side and along the fibre.
    for index in (0..Grid::FULL.len()).step_by(89) {
        // Parameters of its own, as far from those of the hair as fits are.
        let moved = Grid::FULL.cell(index).params().expect("accepted");
        let desc = moved.desc();
        let moved = HairParams::new(&HairDesc {
            alpha: desc.alpha.map(|alpha| alpha + 0.2 * desc.beta[1]),
            beta: desc.beta.map(|beta| 0.7 * beta),
            gamma_tt: 0.7 * desc.gamma_tt,
            phi_g: desc.phi_g + 0.3 * desc.gamma_g,
            gamma_g: 0.7 * desc.gamma_g,
            i_g: 1.3 * desc.i_g,
            ..*desc
        });
        let kinds = [
            Kind::cauchy(1.0),
            Kind::cauchy(0.797_884_6),
            Kind::cauchy(1.3),
            Kind::refitted(&moved.expect("accepted")),
        ];
        let coarse = hair(index, ORDER).figures(&kinds, &blur(LATITUDES));
        let fine = hair(index, 2 * ORDER).figures(&kinds, &blur(2 * LATITUDES));
        for (coarse, fine) in coarse.iter().zip(&fine) {
            // The first is the factor on the widths.
            let pairs = coarse.numbers().into_iter().zip(fine.numbers()).skip(1);
            for (place, (a, b)) in pairs.enumerate() {
                worst[place] = worst[place].max((a / b - 1.0).abs());
            }
        }
    }
    println!("largest changes on doubling the resolution: {worst:?}");
    assert!(worst.iter().all(|change| *change < 1e-3), "{worst:?}");
}
