//! The medulla of a traced fibre, against the fibre without it, chords and quadrature.

use super::{assert_near, closed_form, general, traced, uniform};
use crate::fibers::support::direction;
use core::f64::consts::PI;
use hairis_conformance::cases;
use hairis_reference::truth::{Fiber, Lobe, Medulla};

#[test]
fn a_medulla_without_extinction_of_its_own_changes_nothing() {
    let plain = Fiber {
        medulla: Medulla::default(),
        ..general()
    };
    let same = Fiber {
        medulla: Medulla {
            ratio: 0.7,
            sigma_a: plain.sigma_a,
            ..Medulla::default()
        },
        ..plain
    };
    let [mut one, mut other] = [uniform(5), uniform(5)];
    for n in 0..cases(20_000) {
        let wo = direction(0.4, n as f64);
        let [a, b] = [plain.trace(wo, &mut one), same.trace(wo, &mut other)];
        assert_eq!(a.map(|exit| exit.lobe), b.map(|exit| exit.lobe), "path {n}");
        if let (Some(a), Some(b)) = (a, b) {
            let numbers =
                a.wi.into_iter()
                    .chain(a.weight)
                    .zip(b.wi.into_iter().chain(b.weight));
            for (a, b) in numbers {
                assert!((a - b).abs() < 1e-9, "path {n}: {a} and {b}");
            }
        }
    }
}

/// Mean over the offsets of what TT keeps, by midpoints.
fn over_offsets(f: impl Fn(f64) -> f64) -> f64 {
    const NODES: u32 = 20_000;
    let offsets = (0..NODES).map(|n| 2.0 * (f64::from(n) + 0.5) / f64::from(NODES) - 1.0);
    offsets.map(f).sum::<f64>() / f64::from(NODES)
}

#[test]
fn an_absorbing_medulla_shortens_tt_by_its_chord() {
    let theta = 0.5_f64;
    let fiber = Fiber {
        medulla: Medulla {
            ratio: 0.6,
            sigma_a: [1.2; 3],
            ..Medulla::default()
        },
        ..Fiber::default()
    };
    let light = traced(&fiber, direction(theta, 0.2), 100_000, [1, 1]);
    let sin_t = theta.sin() / 1.55;
    let cos_t = (1.0 - sin_t * sin_t).sqrt();
    let expected = over_offsets(|h| {
        // The chord's distance from the axis, by the effective index.
        let near = h / (1.55 * cos_t / theta.cos());
        let chord = 2.0 * (0.36 - near * near).max(0.0).sqrt() / cos_t;
        let clear = Fiber::default();
        closed_form(&clear, theta, h)[1][0] * (-1.2 * chord).exp()
    });
    let found = light.estimate(0, |_, lobe| f64::from(lobe == Lobe::Tt));
    assert_near(found, expected, 0.0, "TT");
}

/// Without a surface, the share of light that the medulla scatters follows from its chords at any depth.
#[test]
fn a_medulla_scatters_what_its_chords_have() {
    let theta = 0.7_f64;
    let fiber = Fiber {
        eta: 1.0,
        medulla: Medulla {
            ratio: 0.5,
            sigma_s: 3.0,
            g: 0.3,
            ..Medulla::default()
        },
        ..Fiber::default()
    };
    let light = traced(&fiber, direction(theta, -1.0), 100_000, [1, 1]);
    let expected = over_offsets(|h| {
        let chord = 2.0 * (0.25 - h * h).max(0.0).sqrt() / theta.cos();
        1.0 - (-3.0 * chord).exp()
    });
    let found = light.estimate(0, |_, lobe| f64::from(lobe == Lobe::Scattered));
    assert_near(found, expected, 0.0, "scattered");
}

/// Light that a thin medulla scatters once, and that both media absorb before and after: an integral over offset, chord and directions.
#[test]
fn a_thin_medulla_scatters_once() {
    const SIDE: u32 = 36;
    let (theta, ratio, sigma_s, g) = (0.4_f64, 0.5_f64, 0.02, 0.5);
    let (cortex, medulla) = (0.8, 1.6);
    let fiber = Fiber {
        eta: 1.0,
        sigma_a: [0.0, cortex, 0.0],
        medulla: Medulla {
            ratio,
            sigma_a: [0.0, medulla, 0.0],
            sigma_s,
            g,
        },
        ..Fiber::default()
    };
    let wo = direction(theta, 0.0);
    let light = traced(&fiber, wo, 1_600_000, [6, 6]);
    // Lengths in the normal plane from a point of the medulla to its edge and to that of the fibre.
    let lengths = |x: f64, y: f64, phi: f64| {
        let half = x * phi.cos() + y * phi.sin();
        let to = |r: f64| (half * half + r * r - x * x - y * y).sqrt() - half;
        [to(ratio), to(1.0)]
    };
    let depth = |[inner, outer]: [f64; 2]| medulla * inner + cortex * (outer - inner);
    let mut expected = vec![[0.0; 2]; 36];
    let middle = |n: u32| 2.0 * (f64::from(n) + 0.5) / f64::from(SIDE) - 1.0;
    let rows: Vec<[f64; 2]> = (0..SIDE)
        .flat_map(|i| (0..SIDE).map(move |j| [middle(i), middle(j)]))
        .collect();
    let count = rows.len() as f64;
    for [sin, phi] in &rows {
        let to = direction(sin.asin(), PI * phi);
        let cos = -(0..3).map(|k| to[k] * wo[k]).sum::<f64>();
        let phase = (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cos).powf(1.5) / (4.0 * PI);
        for [a, b] in &rows {
            // A point of the medulla, by offset and place along the chord.
            let y = ratio * a;
            let half = (ratio * ratio - y * y).sqrt();
            let x = half * b;
            let before = depth(lengths(x, y, 0.0)) / theta.cos();
            let after = depth(lengths(x, y, PI * phi)) / (1.0 - sin * sin).sqrt();
            let area = ratio * half * 4.0 / count;
            let solid = 4.0 * PI / count;
            let share = 0.5 * sigma_s / theta.cos() * area * phase * solid;
            let sums = &mut expected[light.cell(to)];
            for (sum, weight) in sums.iter_mut().zip([1.0, (-before - after).exp()]) {
                *sum += share * weight;
            }
        }
    }
    for channel in [0, 1] {
        let total: f64 = expected.iter().map(|sums| sums[channel]).sum();
        for (name, of) in [
            ("all", None),
            ("backwards", Some(true)),
            ("forwards", Some(false)),
        ] {
            let part = |cell: usize| {
                of.is_none_or(|back| {
                    back == (light.ends(cell)[1][1].abs() < 1.1
                        || light.ends(cell)[1][0].abs() < 1.1)
                })
            };
            let found = light.estimate(channel, |cell, lobe| {
                f64::from(lobe == Lobe::Scattered && part(cell))
            });
            let expected: f64 = (0..36)
                .filter(|cell| part(*cell))
                .map(|cell| expected[cell][channel])
                .sum();
            // A second scattering has the depth of a radius of the medulla.
            assert_near(
                found,
                expected,
                0.02 * expected,
                &format!("{name} of {total:.4}"),
            );
        }
    }
}
