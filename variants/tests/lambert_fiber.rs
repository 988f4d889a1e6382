//! The example model, written on public traits alone: it runs, is what its formula says, and passes the suite.

#[path = "../examples/lambert_fiber/main.rs"]
mod example;

use crate::support::{Draws, direction, double};
use example::{CONE, Fiber, LambertFiber};
use glam::Vec3;
use hairis::{Hit, Lobe, LobeMask, Material};
use hairis_conformance::proptest::prelude::*;
use hairis_conformance::{AnyMaterial, Claims, Materials, Subject, strategies};

const DIFFUSE: Lobe = Lobe::slot(0);

/// The example under the suite that every model passes.
struct LambertFibers;

impl Subject for LambertFibers {
    type Model = LambertFiber;

    fn model(&self) -> LambertFiber {
        LambertFiber
    }

    fn materials(&self) -> Materials<Self> {
        let black = [0.0; 3];
        vec![
            ("everyday", FIBER),
            (
                "narrow",
                Fiber {
                    width: 0.01,
                    ..FIBER
                },
            ),
            (
                "wide",
                Fiber {
                    width: 1.0,
                    ..FIBER
                },
            ),
            (
                "black",
                Fiber {
                    kd: black,
                    ks: black,
                    width: 0.1,
                },
            ),
        ]
    }

    fn white(&self) -> Materials<Self> {
        vec![(
            "diffuse alone",
            Fiber {
                kd: [1.0; 3],
                ks: [0.0; 3],
                width: 0.1,
            },
        )]
    }

    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<Fiber<f32>>>> {
        let rgb = || strategies::intensities(1e30);
        let fields = (rgb(), rgb(), strategies::range([1e-3, 1.0]));
        Some(
            fields
                .prop_map(|(kd, ks, width)| Fiber { kd, ks, width }.into())
                .boxed(),
        )
    }

    fn claims(&self) -> Claims {
        // The provided albedo is a lattice's: that of the cone has an azimuth.
        // The cone is sampled by the sine of the inclination: next to the axis the cosine has half of its digits.
        Claims {
            reciprocal: Some(2e-6),
            furnace: Some(1e-6),
            albedo: 2e-3,
            direction: 2e-5,
            ..Claims::default()
        }
    }

    /// Lobe by lobe the weight is `4 kd cos / (pi p)`, or `ks cos span / (pi p)`: `p` is the share of the lobe.
    fn weight_bound(&self, params: &Fiber<f32>, _hit: &Hit, lobes: LobeMask) -> Option<f64> {
        let sum = |color: [f32; 3]| color.iter().map(|x| f64::from(*x)).sum::<f64>();
        let most = |color: [f32; 3]| f64::from(color.into_iter().fold(0.0, f32::max));
        let lit = |lobe, color: [f32; 3]| {
            if lobes.contains(lobe) {
                color
            } else {
                [0.0; 3]
            }
        };
        let (kd, ks) = (lit(DIFFUSE, params.kd), lit(CONE, params.ks));
        let total = sum(kd) + sum(ks);
        let ratio = |color, by: f64| {
            if sum(color) > 0.0 {
                by * most(color) * total / sum(color)
            } else {
                0.0
            }
        };
        (total > 0.0).then(|| ratio(kd, 4.0 / core::f64::consts::PI).max(ratio(ks, 1.0)))
    }
}

hairis_conformance::conformance!(suite, LambertFibers);

const FIBER: Fiber<f32> = Fiber {
    kd: [0.4, 0.3, 0.2],
    ks: [0.5, 0.4, 0.6],
    width: 0.1,
};

#[test]
fn the_example_runs() {
    example::main();
}

#[test]
fn it_is_what_its_formula_says() {
    let mut draws = Draws(71);
    let material = Material::new(&LambertFiber, &FIBER);
    for _ in 0..2000 {
        let mut any = || direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
        let (wo, wi) = (any(), any());
        let off = double(wo)[0] + double(wi)[0];
        let w = f64::from(FIBER.width);
        let pi_sq = core::f64::consts::PI.powi(2);
        let got = material.prepare(wo).eval(wi);
        for c in 0..3 {
            let cone = f64::from(FIBER.ks[c]) * w / (2.0 * pi_sq * (off * off + w * w));
            let want = f64::from(FIBER.kd[c]) / pi_sq + cone;
            assert!(
                (f64::from(got[c]) / want - 1.0).abs() < 5e-6,
                "{got:?} want {want} at {wo:?} {wi:?}"
            );
        }
    }
}

#[test]
fn what_is_no_direction_has_no_density() {
    let material = Material::new(&LambertFiber, &FIBER);
    let (largest, least) = (Vec3::splat(f32::MAX), Vec3::splat(1e-44));
    for wo in [Vec3::ZERO, Vec3::X, Vec3::Y, largest, least] {
        for wi in [Vec3::X, Vec3::ZERO, largest, least] {
            let e = material.prepare(wo).eval_pdf(wi);
            assert_eq!(e.pdf, 0.0, "{wo:?} {wi:?}: {e:?}");
        }
    }
    let scale = material.conserving_scale();
    assert!(scale > 0.0 && scale <= 1.0, "scale {scale}");
}
