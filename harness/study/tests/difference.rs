//! Differences in look over a grid.

mod best;
mod blur;
mod lobes;
mod measure;
mod output;
mod refit;

use hairis_harness::journal::Journal;
use hairis_harness::subject::ModelKind;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::quadrature::{SphereIntegrator, Tolerance};
use hairis_reference::{HairReference, Reference};
use hairis_study::difference::blur::Blur;
use hairis_study::difference::lobes::Kind;
use hairis_study::difference::*;
use hairis_study::study::Grid;
use std::sync::LazyLock;

/// Differences over the short grid, computed once for all tests.
pub(crate) static QUICK: LazyLock<Difference> = LazyLock::new(|| {
    Difference::over(Grid::QUICK, &Journal::default(), &|_, _| ()).expect("accepted")
});

#[test]
fn the_best_factors_are_the_best_in_their_norm() {
    let found = &*QUICK;
    assert_eq!(found.rows.len(), Grid::QUICK.len() * Width::ALL.len());
    let squares = |width| {
        found
            .of(width)
            .map(|row| row.figures.plain.l2.powi(2))
            .sum::<f64>()
    };
    for width in [Width::Paper, Width::HalfWidth, Width::Area] {
        assert!(
            squares(Width::BestOfGrid) < squares(width),
            "over the grid, {width:?}"
        );
    }
    for rows in found.rows.chunks(Width::ALL.len()) {
        let [others @ .., best, _] = rows else {
            panic!("no rows")
        };
        for other in others {
            assert!(
                best.figures.plain.l2 <= other.figures.plain.l2 + 1e-9,
                "{best:?} {other:?}"
            );
        }
    }
}

#[test]
fn no_refit_is_further_away_than_a_factor() {
    let found = &*QUICK;
    let views = Grid::QUICK.theta_o_deg.len() * Width::ALL.len();
    for rows in found.rows.chunks(views) {
        // Light that is reflected elsewhere, from all inclinations.
        let distance = |width: Width| -> f64 {
            let rows = rows.iter().filter(|row| row.width == width);
            let light = rows.map(|row| row.figures.plain.l1 * row.figures.albedo_gaussian);
            light.sum()
        };
        let refitted = distance(Width::Refitted);
        for width in [
            Width::Paper,
            Width::HalfWidth,
            Width::Area,
            Width::BestOfGrid,
        ] {
            assert!(refitted < distance(width), "{width:?} {:?}", rows[0].cell);
        }
    }
}

#[test]
fn figures_are_those_of_the_reference_by_another_quadrature() {
    let cell = Grid::QUICK.cell(17);
    let (params, theta_o) = (
        cell.params().expect("accepted"),
        f64::from(cell.theta_o_deg).to_radians(),
    );
    let found = hair(&cell)
        .expect("accepted")
        .figures(&[Kind::cauchy(1.0)], &Blur::new(0.2, 32, 32))[0];
    let wo = fibre_direction(theta_o, 0.0)
        .as_vec3()
        .as_dvec3()
        .to_array();
    let [gaussian, cauchy] = ModelKind::ALL.map(|model| {
        HairReference::<f64>::prepare(&params.desc().map(f64::from), model.shape(), wo)
    });
    let scale = found.albedo_gaussian / found.albedo_cauchy;
    let desc = params.desc();
    let mut sphere = SphereIntegrator::new().with_tolerance(Tolerance {
        max_panels: 4_000,
        ..Tolerance::relative(1e-5)
    });
    for (alpha, beta) in [
        (desc.alpha[0], desc.beta[0]),
        (desc.alpha[1], desc.beta[1]),
        (desc.alpha[2], desc.beta[2]),
    ] {
        sphere = sphere.theta_lobe(f64::from(2.0 * alpha) - theta_o, f64::from(2.0 * beta));
    }
    let r = sphere.integrate(|theta, phi| {
        let wi = fibre_direction(theta, phi).to_array();
        let [a, b] =
            [gaussian.eval(wi), cauchy.eval(wi)].map(|s| theta.cos() * s.iter().sum::<f64>() / 3.0);
        [
            a,
            b,
            (a - b).abs(),
            (a - b).powi(2),
            (a - scale * b).abs(),
            (a - scale * b).powi(2),
            a * a,
        ]
    });
    let [a, b, l1, square, shape_l1, shape_square, norm] = r.value;
    let pairs = [
        (found.albedo_gaussian, a),
        (found.albedo_cauchy, b),
        (found.plain.l1, l1 / a),
        (found.plain.l2, (square / norm).sqrt()),
        (found.shape.l1, shape_l1 / a),
        (found.shape.l2, (shape_square / norm).sqrt()),
    ];
    for (place, (got, want)) in pairs.into_iter().enumerate() {
        assert!((got / want - 1.0).abs() < 5e-4, "{place}: {got} {want}");
    }
}
