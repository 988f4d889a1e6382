//! The tracer of fibres: energy, reciprocity, and closed forms of the smooth cylinder.

use crate::fibers::support::direction;
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use hairis_conformance::{cases, statistics};
use hairis_reference::truth::{Fiber, Histogram, Lobe, Medulla};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng};

mod medulla;
mod surface;

const BATCHES: usize = 16;

fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    move || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Everything at once: rough, tilted, elliptic, with a medulla, and absorbing in two channels.
fn general() -> Fiber {
    Fiber {
        roughness: 0.3,
        tilt: 0.1,
        aspect: 0.6,
        rotation: Some(0.5),
        sigma_a: [0.0, 0.3, 2.0],
        medulla: Medulla {
            ratio: 0.5,
            sigma_a: [0.0, 0.6, 0.0],
            sigma_s: 1.5,
            g: 0.4,
        },
        ..Fiber::default()
    }
}

/// Traces `paths` with `HAIRIS_CASES=1`.
fn traced(fiber: &Fiber, wo: [f64; 3], paths: usize, size: [usize; 2]) -> Histogram {
    let (mut light, mut xi) = (Histogram::new(size), uniform(7));
    let batch = u32::try_from(cases(paths).div_ceil(BATCHES)).unwrap();
    for _ in 0..BATCHES {
        light.add(batch, &mut || fiber.trace(wo, &mut xi));
    }
    light
}

fn assert_near([mean, error]: [f64; 2], expected: f64, slack: f64, name: &str) {
    println!("{name}: {mean:.6} +- {error:.6}, expected {expected:.6}");
    assert!(
        (mean - expected).abs() <= 4.5 * error + slack && error < 0.1 * expected.max(0.05),
        "{name}: {mean} +- {error}, expected {expected}"
    );
}

/// Draws a direction of a cell by the light that meets the fibre from a uniform surrounding.
fn incident(fiber: &Fiber, [theta, phi]: [[f64; 2]; 2], xi: &mut impl FnMut() -> f64) -> [f64; 3] {
    loop {
        let mut between = |[low, high]: [f64; 2]| low + (high - low) * xi();
        let (theta, phi) = (between(theta), between(phi));
        let width = fiber.width(phi - fiber.rotation.unwrap());
        if xi() < theta.cos().powi(2) * width * fiber.aspect.sqrt() {
            return direction(theta, phi);
        }
    }
}

/// Light that meets the fibre from a cell, by midpoints of the azimuth.
fn flux(fiber: &Fiber, light: &Histogram, cell: usize) -> f64 {
    let [_, [from, to]] = light.ends(cell);
    let width = |n: u32| {
        let phi = from + (to - from) * (f64::from(n) + 0.5) / 64.0;
        fiber.width(phi - fiber.rotation.unwrap())
    };
    light.measure(cell) * (0..64).map(width).sum::<f64>() / 64.0
}

#[test]
fn a_clear_fibre_returns_all_light_and_an_absorbing_one_less() {
    for roughness in [0.0, 1e-3, 0.3, 1.0] {
        for tilt in [0.0, 0.1, -0.4] {
            let fiber = Fiber {
                roughness,
                tilt,
                ..general()
            };
            let mut xi = uniform(1);
            let (mut sums, count) = ([0.0; 3], cases(4000));
            for n in 0..count {
                let theta = [0.0, 0.5, -1.2, 1.56][n % 4];
                let exit = fiber.trace(direction(theta, 0.3), &mut xi);
                let length = exit.map_or(1.0, |exit| exit.wi.iter().map(|x| x * x).sum());
                assert!((length - 1.0).abs() < 1e-9, "a unit vector, got {length}");
                for (sum, weight) in sums
                    .iter_mut()
                    .zip(exit.map_or([0.0; 3], |exit| exit.weight))
                {
                    *sum += weight / count as f64;
                }
            }
            let name = format!("roughness {roughness}, tilt {tilt}: {sums:?}");
            // The faintest channel decides on the end of a path, so that the clear one is never lost.
            assert!((sums[0] - 1.0).abs() < 1e-9, "clear, {name}");
            assert!(sums[1] < 0.95 && sums[2] < sums[1], "absorbing, {name}");
        }
    }
}

/// A surrounding of the same radiance everywhere is left as it is: Snell, Fresnel, Smith, the scales and the medulla balance in every
/// direction.
#[test]
fn a_uniform_surrounding_stays_uniform() {
    let sphere = [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]];
    let light = Histogram::new([18, 12]);
    let medulla = Medulla {
        ratio: 0.0,
        ..general().medulla
    };
    for (fiber, name) in [
        (general(), "all at once"),
        (
            Fiber {
                roughness: 0.0,
                tilt: 0.3,
                medulla,
                ..general()
            },
            "smooth scales",
        ),
        (
            Fiber {
                roughness: 1.0,
                tilt: 0.0,
                medulla,
                ..general()
            },
            "rough",
        ),
    ] {
        let mut xi = uniform(2);
        let cells = 18 * 12;
        let mut observed = vec![0; cells];
        let count = cases(250_000);
        for _ in 0..count {
            let wo = incident(&fiber, sphere, &mut xi);
            let exit = fiber.trace(wo, &mut xi);
            if let Some(exit) = exit {
                observed[light.cell(exit.wi)] += 1;
            }
        }
        let shares: Vec<f64> = (0..cells).map(|cell| flux(&fiber, &light, cell)).collect();
        let total: f64 = shares.iter().sum();
        let seen: u64 = observed.iter().sum();
        let expected: Vec<f64> = shares.iter().map(|x| x / total * seen as f64).collect();
        let p = statistics::chi_square(&observed, &expected, 5.0).p_value;
        println!("{name}: p {p:.3}");
        assert!(p > 1e-4, "{name}: p {p:e}");
    }
}

#[test]
fn every_lobe_is_reciprocal() {
    let (fiber, mut xi) = (general(), uniform(3));
    // Cells on both sides of the normal plane, in front of the fibre, beside it and behind it.
    let cells = [9, 14, 21, 27];
    let paths = u32::try_from(cases(160_000).div_ceil(BATCHES)).unwrap();
    let tables = cells.map(|cell| {
        let mut light = Histogram::new([6, 6]);
        let ends = light.ends(cell);
        for _ in 0..BATCHES {
            light.add(paths, &mut || {
                let wo = incident(&fiber, ends, &mut xi);
                fiber.trace(wo, &mut xi)
            });
        }
        light
    });
    let mut worst = 0.0_f64;
    for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
        for lobe in Lobe::ALL {
            for channel in [0, 1] {
                let one_way = |from: usize, to: usize| {
                    let into = |cell, part| f64::from(cell == cells[to] && part == lobe);
                    let flux = flux(&fiber, &tables[from], cells[from]);
                    tables[from].estimate(channel, into).map(|x| flux * x)
                };
                let ([a, a_error], [b, b_error]) = (one_way(i, j), one_way(j, i));
                let deviations = (a - b) / a_error.hypot(b_error).max(1e-5);
                worst = worst.max(deviations.abs());
                assert!(
                    deviations.abs() < 4.5,
                    "{lobe:?} {i} {j}: {a} +- {a_error}, {b} +- {b_error}"
                );
            }
        }
    }
    println!("reciprocity: {worst:.2} deviations at most");
}

/// Twisted hair is the mean over its rotations, by the width that each shows.
#[test]
fn a_rotation_is_drawn_by_the_light_that_it_meets() {
    let twisted = Fiber {
        aspect: 0.3,
        sigma_a: [1.0; 3],
        ..Fiber::default()
    };
    let passed = |fiber: &Fiber, paths| {
        let light = traced(fiber, direction(0.2, 0.4), paths, [1, 1]);
        light.estimate(0, |_, lobe| f64::from(lobe == Lobe::Tt))
    };
    let (mut sum, mut squares, mut widths) = (0.0, 0.0, 0.0);
    for n in 0..16 {
        let rotation = PI * f64::from(n) / 16.0;
        let width = twisted.width(0.4 - rotation);
        let fixed = Fiber {
            rotation: Some(rotation),
            ..twisted
        };
        let [mean, error] = passed(&fixed, 20_000);
        widths += width;
        sum += width * mean;
        squares += (width * error).powi(2);
    }
    let [mean, error] = passed(&twisted, 160_000);
    let error = error.hypot(squares.sqrt() / widths);
    assert_near([mean, error], sum / widths, 0.0, "twisted");
}

/// Lights of R, TT, TRT and the rest of the smooth cylinder by the offset, and where they go: Marschner et al. 2003, with Fresnel's equations at
/// the effective indices for either polarisation, and the absorption along the chord.
fn closed_form(fiber: &Fiber, theta: f64, h: f64) -> [[f64; 2]; 4] {
    let (sin, eta) = (theta.sin(), fiber.eta);
    let root = (eta * eta - sin * sin).sqrt();
    let [eta_s, eta_p] = [root / theta.cos(), eta * eta * theta.cos() / root];
    let (gamma_i, gamma_t) = (h.asin(), (h / eta_s).asin());
    let (cos_i, cos_t) = (gamma_i.cos(), gamma_t.cos());
    let s = (cos_i - eta_s * cos_t) / (cos_i + eta_s * cos_t);
    let p = (eta_p * cos_i - cos_t) / (eta_p * cos_i + cos_t);
    let f = 0.5 * (s * s + p * p);
    let cos_theta_t = (1.0 - sin * sin / (eta * eta)).sqrt();
    let depth = 2.0 * cos_t / cos_theta_t * fiber.sigma_a[0];
    let t = (-depth).exp();
    let all_further = (1.0 - f) * (1.0 - f) * t * f * f * t * t / (1.0 - f * t);
    let phi = |p: f64| (2.0 * p * gamma_t - 2.0 * gamma_i + p * PI).rem_euclid(TAU);
    let passed = (1.0 - f) * (1.0 - f) * t;
    [
        [f, phi(0.0)],
        [passed, phi(1.0)],
        [passed * f * t, phi(2.0)],
        [all_further, 0.0],
    ]
}

#[test]
fn the_smooth_cylinder_has_its_closed_form() {
    const SECTORS: usize = 24;
    const NODES: u32 = 60_000;
    let h = |n: u32| 2.0 * (f64::from(n) + 0.5) / f64::from(NODES) - 1.0;
    let fiber = Fiber {
        sigma_a: [0.4; 3],
        ..Fiber::default()
    };
    for theta in [0.0, 0.6, -1.2] {
        let light = traced(&fiber, direction(theta, 0.0), 400_000, [1, SECTORS]);
        let mut expected = [[0.0; SECTORS]; 4];
        for n in 0..NODES {
            for (sums, [share, phi]) in expected.iter_mut().zip(closed_form(&fiber, theta, h(n))) {
                let sector = light.cell(direction(0.0, phi));
                sums[sector] += share / f64::from(NODES);
            }
        }
        for (lobe, expected) in Lobe::ALL.into_iter().zip(expected) {
            let energy = light.estimate(0, |_, part| f64::from(part == lobe));
            let name = format!("{lobe:?} at {theta}");
            assert_near(energy, expected.iter().sum(), 0.0, &name);
            for (sector, expected) in expected
                .into_iter()
                .enumerate()
                .filter(|_| lobe != Lobe::Rest)
            {
                let found =
                    light.estimate(0, |cell, part| f64::from(part == lobe && cell == sector));
                assert_near(found, expected, 1e-5, &format!("{name}, sector {sector}"));
            }
        }
    }
    // The faintest paths go on by chance.
    let dark = Fiber {
        sigma_a: [6.0; 3],
        ..fiber
    };
    let light = traced(&dark, direction(0.6, 0.0), 400_000, [1, 1]);
    let passed = (0..NODES).map(|n| closed_form(&dark, 0.6, h(n))[1][0]);
    let found = light.estimate(0, |_, lobe| f64::from(lobe == Lobe::Tt));
    assert_near(
        found,
        passed.sum::<f64>() / f64::from(NODES),
        0.0,
        "dark TT",
    );
    let mut xi = uniform(4);
    for theta in [0.0, 0.6, -1.2_f64] {
        for _ in 0..1000 {
            let exit = fiber.trace(direction(theta, 1.0), &mut xi);
            let gap = exit.map_or(0.0, |exit| exit.wi[0] + theta.sin());
            assert!(gap.abs() < 1e-12, "off the specular cone by {gap}");
        }
    }
}
