//! Products of lobes against the reference and the kernels.

use core::f64::consts::PI;
use hairis::{Gaussian, Material, Published};
use hairis_harness::subject::random_hair;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::sequence::Independent;
use hairis_reference::{HairReference, Reference};
use hairis_study::difference::lobes::*;
use hairis_study::study::Grid;
use hairis_variants::Cauchy;

#[test]
fn the_products_are_the_reference() {
    let mut xi = Independent::new(11, 0);
    for _ in 0..200 {
        let hair = random_hair(&mut xi).expect("within range");
        let theta_o = 1.5 * (2.0 * xi.next_f64() - 1.0);
        let view = ViewedHair::new(&hair, theta_o);
        for kind in [Kind::GAUSSIAN, Kind::cauchy(1.0), Kind::cauchy(0.8)] {
            let parameters = hair.desc().map(f64::from).with_width_factor(kind.factor);
            let oracle = HairReference::prepare(
                &parameters,
                kind.shape,
                fibre_direction(theta_o, 0.3).to_array(),
            );
            let (theta_i, phi) = (
                1.55 * (2.0 * xi.next_f64() - 1.0),
                PI * (2.0 * xi.next_f64() - 1.0),
            );
            let (along, around) = (view.along(kind, theta_i), view.around(kind, phi));
            let got: f64 = along.iter().zip(around).map(|(a, b)| a * b).sum();
            let s = oracle.eval(fibre_direction(theta_i, 0.3 - phi).to_array());
            let want = theta_i.cos() * s.iter().sum::<f64>() / 3.0;
            assert!(
                (got - want).abs() <= 1e-11 * want + 1e-13,
                "{kind:?} at {theta_i} {phi}: {got} {want}"
            );
        }
    }
}

#[test]
fn albedos_are_those_of_the_kernels() {
    for index in (0..Grid::QUICK.len()).step_by(5) {
        let cell = Grid::QUICK.cell(index);
        let (params, theta_o) = (
            cell.params().expect("accepted"),
            f64::from(cell.theta_o_deg).to_radians(),
        );
        let wo = fibre_direction(theta_o, 0.0);
        let view = ViewedHair::new(&params, theta_o);
        let rule = view.rule(8);
        let kernels = [
            (
                Kind::GAUSSIAN,
                Material::new(&Published(Gaussian), &params)
                    .prepare(wo.as_vec3())
                    .albedo(),
            ),
            (
                Kind::cauchy(1.0),
                Material::new(&Cauchy::PAPER.model(), &params)
                    .prepare(wo.as_vec3())
                    .albedo(),
            ),
        ];
        for (kind, lobes) in kernels {
            let want = lobes
                .0
                .as_flattened()
                .iter()
                .map(|c| f64::from(*c))
                .sum::<f64>()
                / 3.0;
            let got = rule.albedo(&rule.values(&view, kind));
            assert!(
                (got / want - 1.0).abs() < 1e-4,
                "cell {index} {kind:?}: {got} {want}"
            );
        }
    }
}
