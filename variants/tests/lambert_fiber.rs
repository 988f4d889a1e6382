//! The example model, written on public traits alone: it runs, its lobes add up, its weights are bounded, and every
//! service of the crate works on it.

#[path = "../examples/lambert_fiber/main.rs"]
mod example;

use crate::support::{Draws, direction, double, lanes_of, packet};
use example::{CONE, Fiber, LambertFiber, pdf_integral};
use glam::Vec3;
use hairis::columns::EvalColumns;
use hairis::simd::Level;
use hairis::{Hit, Lobe, LobeMask, Material, Material8};
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
fn the_density_integrates_to_one() {
    for width in [0.01, 0.1, 1.0] {
        for theta in [0.0, 0.7, -1.5] {
            let prepared = Material::new(&LambertFiber, &Fiber { width, ..FIBER })
                .prepare(direction(theta, 0.3));
            for lobes in [
                LobeMask::ALL,
                LobeMask::of(&[DIFFUSE]),
                LobeMask::of(&[CONE]),
            ] {
                let integral = pdf_integral(&prepared.with_lobes(lobes));
                assert!(
                    (integral - 1.0).abs() < 2e-4,
                    "{lobes:?} width {width} theta {theta}: {integral}"
                );
            }
            assert_eq!(
                prepared.with_lobes(LobeMask::NONE).pdf(Vec3::Y),
                0.0,
                "no lobe, no density"
            );
        }
    }
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
        let back = material.prepare(wi).eval(wo);
        for c in 0..3 {
            let cone = f64::from(FIBER.ks[c]) * w / (2.0 * pi_sq * (off * off + w * w));
            let want = f64::from(FIBER.kd[c]) / pi_sq + cone;
            assert!(
                (f64::from(got[c]) / want - 1.0).abs() < 5e-6,
                "{got:?} want {want} at {wo:?} {wi:?}"
            );
            assert!(
                (back[c] / got[c] - 1.0).abs() < 5e-6,
                "reciprocity at {wo:?} {wi:?}"
            );
        }
    }
}

#[test]
fn weights_are_bounded_and_estimate_the_albedo() {
    // Lobe by lobe the weight is 4 kd cos / (pi p), or ks cos span / (pi p): p is the share of the lobe.
    let shares = [0.9 / 2.4, 1.5 / 2.4];
    let mut draws = Draws(72);
    for theta in [0.0, 0.9, -1.4] {
        let prepared = Material::new(&LambertFiber, &FIBER).prepare(direction(theta, 1.0));
        let mut sum = 0.0;
        let count = 1 << 16;
        let limit =
            (4.0 * FIBER.kd[0] / core::f32::consts::PI / shares[0]).max(FIBER.ks[0] / shares[1]);
        for _ in 0..count / 8 {
            let eight = prepared.sample8(&lanes_of(&core::array::from_fn(|_| draws.xi3())));
            for s in (0..8).filter_map(|lane| eight.lane(lane)) {
                assert!(
                    s.weight[0] <= limit * 1.000_01,
                    "weight {} above {limit}",
                    s.weight[0]
                );
                sum += f64::from(s.weight[0]);
            }
        }
        let (mean, albedo) = (sum / f64::from(count), prepared.albedo());
        let want = f64::from(albedo[DIFFUSE][0] + albedo[CONE][0]);
        // Weights are below 1.4: the standard error of 65 536 is below 0.003.
        assert!(
            (mean - want).abs() < 0.008,
            "theta {theta}: mean weight {mean}, albedo {want}"
        );
    }
}

#[test]
fn the_cdf_of_the_cone_is_xi() {
    let (theta, width) = (0.6_f64, f64::from(FIBER.width));
    let wo = direction(theta, 0.0);
    let prepared = Material::new(&LambertFiber, &FIBER)
        .prepare(wo)
        .with_lobes(LobeMask::of(&[CONE]));
    let angle = |sin: f64| ((sin + double(wo)[0]) / width).atan();
    let mut draws = Draws(73);
    for _ in 0..2000 {
        let xi = draws.xi3();
        let Some(s) = prepared.sample(xi) else {
            continue;
        };
        let cdf = (angle(double(s.wi)[0]) - angle(-1.0)) / (angle(1.0) - angle(-1.0));
        assert!(
            (cdf - f64::from(xi[1])).abs() < 2e-6,
            "xi {} cdf {cdf}",
            xi[1]
        );
    }
}

#[test]
fn every_service_of_the_crate_works_on_it() {
    let mut draws = Draws(74);
    let fibers: [_; 8] = core::array::from_fn(|_| {
        let width = crate::support::narrow(draws.scale(0.01, 1.0));
        Material::new(
            &LambertFiber,
            &Fiber {
                kd: draws.xi3(),
                ks: draws.xi3(),
                width,
            },
        )
    });
    let mut any = || direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
    let (wo, wi): ([_; 8], [_; 8]) = (
        core::array::from_fn(|_| any()),
        core::array::from_fn(|_| any()),
    );
    for level in Level::available() {
        let eight = Material8::pack(fibers.each_ref())
            .with_level(level)
            .prepare8(&packet(&wo));
        let evals = eight.with_level(level).eval_pdf8(&packet(&wi));
        for lane in 0..8 {
            let one = eight.lane(lane);
            // Packets, batches and lanes give the same bits.
            assert_eq!(
                one.with_level(level).eval_pdf8(&packet(&wi)).lane(lane),
                evals.lane(lane),
                "{level} lane {lane}"
            );
            let columns = wi.map(|v| v.x).to_vec();
            let (v, w) = (wi.map(|v| v.y).to_vec(), wi.map(|v| v.z).to_vec());
            let mut out = [[0.0; 8]; 4];
            let [r, g, b, pdf] = &mut out;
            one.with_level(level)
                .eval_columns(
                    [&columns, &v, &w],
                    EvalColumns {
                        value: Some([r, g, b]),
                        pdf: Some(pdf),
                    },
                )
                .unwrap();
            assert_eq!(
                out[3][lane].to_bits(),
                evals.lane(lane).pdf.to_bits(),
                "{level} batch, lane {lane}"
            );
            let lobes = one.lobes(wi[lane]);
            let sum = lobes[DIFFUSE].value * lobes[DIFFUSE].color[0]
                + lobes[CONE].value * lobes[CONE].color[0];
            assert!(
                (sum / evals.lane(lane).value[0] - 1.0).abs() < 2e-6,
                "{level} lane {lane}: lobes sum to {sum}"
            );
            assert_eq!(lobes[Lobe::slot(3)].pdf, 0.0, "a slot without a lobe");
        }
    }
    let scale = fibers[0].conserving_scale();
    assert!(scale > 0.0 && scale <= 1.0, "scale {scale}");
}

#[test]
fn it_is_total() {
    let prepared = |wo| Material::new(&LambertFiber, &FIBER).prepare(wo);
    for wo in [
        Vec3::ZERO,
        Vec3::X,
        Vec3::splat(f32::MAX),
        Vec3::splat(1e-44),
        Vec3::new(0.0, 1e-20, 0.0),
    ] {
        for wi in [
            Vec3::X,
            Vec3::ZERO,
            Vec3::splat(f32::MAX),
            Vec3::splat(1e-44),
            Vec3::Y,
        ] {
            let e = prepared(wo).eval_pdf(wi);
            assert!(
                e.pdf.is_finite() && e.value[0].is_finite() && e.pdf >= 0.0,
                "{wo:?} {wi:?}: {e:?}"
            );
            assert!(
                wi == Vec3::Y || e.pdf == 0.0,
                "no direction, yet a density: {wo:?} {wi:?}: {e:?}"
            );
        }
        for xi in [0.0, 0.5, 1.0 - f32::EPSILON / 2.0] {
            if let Some(s) = prepared(wo).sample([xi, xi, xi]) {
                assert!(
                    s.weight[0].is_finite() && (s.wi.length() - 1.0).abs() < 1e-6,
                    "{wo:?} {xi}: {s:?}"
                );
            }
        }
    }
}
