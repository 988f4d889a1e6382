//! The rough surface of a traced fibre, against the integrals of one bounce.

use super::{assert_near, uniform};
use crate::fibers::support::direction;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis_conformance::cases;
use hairis_reference::truth::{Exit, Fiber, Histogram, Lobe, Surface};

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Normal of the facet that scatters from `a` to `b`, both of which point away from it, with `b` in a medium `eta` times as dense; 1 reflects.
fn facet(a: [f64; 3], b: [f64; 3], eta: f64) -> [f64; 3] {
    let sum: [f64; 3] = core::array::from_fn(|k| a[k] + eta * b[k]);
    let length = dot(sum, sum).sqrt().copysign(dot(sum, a));
    sum.map(|x| x / length)
}

fn reflectance(cos: f64, eta: f64) -> f64 {
    let square = 1.0 - (1.0 - cos * cos) / (eta * eta);
    if square < 0.0 {
        return 1.0;
    }
    let cos_t = square.sqrt();
    let s = (cos - eta * cos_t) / (cos + eta * cos_t);
    let p = (eta * cos - cos_t) / (eta * cos + cos_t);
    0.5 * (s * s + p * p)
}

/// Density of GGX and Smith's Lambda at this cosine.
fn ggx(alpha: f64, cos: f64) -> [f64; 2] {
    let square = alpha * alpha;
    let density = square / (PI * (1.0 + cos * cos * (square - 1.0)).powi(2));
    let lambda = 0.5 * ((1.0 + square * (1.0 / (cos * cos) - 1.0)).sqrt() - 1.0);
    [density, lambda]
}

/// Integrates over the solid angle of a cell by midpoints.
fn integral(light: &Histogram, cell: usize, side: u32, density: &dyn Fn([f64; 3]) -> f64) -> f64 {
    let [[low, high], [from, to]] = light.ends(cell);
    let middle = |n: u32| (f64::from(n) + 0.5) / f64::from(side);
    let area = (high - low) * (to - from) / f64::from(side * side);
    let cells = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
    let values = cells.map(|(i, j)| {
        let theta = low + (high - low) * middle(i);
        theta.cos() * density(direction(theta, from + (to - from) * middle(j)))
    });
    area * values.sum::<f64>()
}

/// Light of one bounce follows the densities of Walter et al. 2007 with the shadowing of correlated heights: `1 / (1 + a + b)` in reflection, and
/// the beta function of `1 + a` and `1 + b` in transmission.
#[test]
fn one_bounce_of_a_rough_surface_has_its_density() {
    let (alpha, normal) = (0.6, [0.0, 0.0, 1.0]);
    for (eta, from) in [(1.5, 1.2), (1.5, 0.5), (1.0 / 1.5, 1.0_f64)] {
        let surface = Surface::new(1.5, alpha, 0.0);
        let outside = eta > 1.0;
        let side = if outside { 1.0 } else { -1.0 };
        let wi = [from.sin(), 0.0, side * from.cos()];
        let (mut xi, mut light) = (uniform(6), Histogram::new([6, 8]));
        for _ in 0..16 {
            light.add(u32::try_from(cases(300_000) / 16).unwrap(), &mut || {
                let mut numbers = 0;
                let (to, is_out) = surface.cross(&normal, &wi.map(|x| -x), outside, &mut || {
                    numbers += 1;
                    xi()
                });
                let exit = Exit {
                    wi: to,
                    lobe: if is_out == outside { Lobe::R } else { Lobe::Tt },
                    weight: [1.0; 3],
                };
                (numbers == 5).then_some(exit)
            });
        }
        let density = |wo: [f64; 3]| {
            let cos_o = side * dot(wo, normal);
            let m = facet(wi, wo, if cos_o > 0.0 { 1.0 } else { eta });
            let [cos, to, up] = [dot(m, wi), dot(m, wo), side * dot(m, normal)];
            let f = reflectance(cos, eta);
            let is_possible = cos > 0.0 && to * cos_o > 0.0 && up > 0.0 && (cos_o > 0.0 || f < 1.0);
            if !is_possible {
                return 0.0;
            }
            let ([d, _], cos_i) = (ggx(alpha, up), from.cos());
            let [a, b] = [cos_i, cos_o].map(|cos| ggx(alpha, cos)[1]);
            if cos_o > 0.0 {
                return f * d / (1.0 + a + b) / (4.0 * cos_i);
            }
            let beta = libm::lgamma(1.0 + a) + libm::lgamma(1.0 + b) - libm::lgamma(2.0 + a + b);
            let jacobian = eta * eta * to.abs() / (cos + eta * to).powi(2);
            (1.0 - f) * d * beta.exp() * cos * jacobian / cos_i
        };
        for cell in 0..48 {
            let expected = integral(&light, cell, 24, &density);
            let found = light.estimate(0, |at, _| f64::from(at == cell));
            let name = format!("from {from} at {eta}, cell {cell}");
            assert_near(found, expected, 2e-4, &name);
        }
    }
}

/// Opaque fibre, of which R alone is left.
fn opaque(roughness: f64, tilt: f64) -> Fiber {
    Fiber {
        roughness,
        tilt,
        sigma_a: [1e4; 3],
        rotation: Some(0.0),
        ..Fiber::default()
    }
}

/// R after one bounce is Torrance and Sparrow's integral over the lit side.
#[test]
fn reflection_of_a_rough_fibre_is_its_integral() {
    let (theta, fiber, size) = (0.3_f64, opaque(0.15, 0.0), [18, 8]);
    let wo = direction(theta, 0.0);
    let (mut xi, mut light) = (uniform(9), Histogram::new(size));
    for _ in 0..16 {
        light.add(u32::try_from(cases(1_000_000) / 16).unwrap(), &mut || {
            let mut numbers = 0;
            let exit = fiber.trace(wo, &mut || {
                numbers += 1;
                xi()
            });
            // One for the offset, and five of the surface.
            exit.filter(|_| numbers == 6)
        });
    }
    let density = |wi: [f64; 3]| {
        let m = facet(wi, wo, 1.0);
        let fresnel = reflectance(dot(m, wo), fiber.eta);
        let at = |gamma: f64| {
            let n = direction(0.0, gamma);
            let [to, from, up] = [wi, wo, m].map(|w| dot(n, w));
            if to <= 0.0 || from <= 0.0 {
                return 0.0;
            }
            let [[d, _], [_, a], [_, b]] = [up, to, from].map(|cos| ggx(fiber.roughness, cos));
            fresnel * d / (1.0 + a + b) / (4.0 * theta.cos())
        };
        0.5 * over_angles(at)
    };
    let mut checked = 0;
    for cell in 0..size[0] * size[1] {
        let expected = integral(&light, cell, 8, &density);
        if expected > 2e-3 {
            checked += 1;
            let found = light.estimate(0, |at, _| f64::from(at == cell));
            assert_near(found, expected, 0.0, &format!("cell {cell}"));
        }
    }
    assert!(checked >= 10, "only {checked} cells have light");
}

/// Integrates over the lit side by midpoints of the angle.
fn over_angles(f: impl Fn(f64) -> f64) -> f64 {
    let steps = 120;
    let width = PI / f64::from(steps);
    let angles = (0..steps).map(|n| (f64::from(n) + 0.5) * width - FRAC_PI_2);
    width * angles.map(f).sum::<f64>()
}

/// Light that smooth scales mirror once is that which meets scales and no riser, and leaves by no riser: about normals at an inclination of
/// `-tilt`.
#[test]
fn smooth_scales_mirror_what_risers_leave() {
    for (theta, tilt) in [(0.3, 0.05), (-0.6, 0.05), (0.5, -0.2), (0.0, 0.3_f64)] {
        let fiber = opaque(0.0, tilt);
        let wo = direction(theta, 0.0);
        let (mut xi, mut light) = (uniform(8), Histogram::new([1, 1]));
        for _ in 0..16 {
            light.add(u32::try_from(cases(100_000) / 16).unwrap(), &mut || {
                let exit = fiber.trace(wo, &mut xi)?;
                let m = facet(exit.wi, wo, 1.0);
                ((m[0] + tilt.sin()).abs() < 1e-9).then_some(exit)
            });
        }
        let expected = 0.5
            * over_angles(|gamma| {
                let (plain, scale) = (direction(0.0, gamma), direction(-tilt, gamma));
                let cos = dot(scale, wo);
                let wi: [f64; 3] = core::array::from_fn(|k| 2.0 * cos * scale[k] - wo[k]);
                // Projected areas of the fibre, the scales and the risers.
                let areas = |w: [f64; 3]| {
                    let riser = tilt.tan().abs() * (w[0] * tilt.signum()).max(0.0);
                    [dot(plain, w), dot(scale, w) / tilt.cos(), riser]
                };
                let ([_, on, aside], [out, by, before]) = (areas(wo), areas(wi));
                let is_mirrored = on > 0.0 && out > 0.0;
                let share = on / (on + aside) * out / (by + before);
                gamma.cos() * f64::from(is_mirrored) * share * reflectance(cos, fiber.eta)
            });
        let found = light.estimate(0, |_, _| 1.0);
        assert_near(found, expected, 1e-4, &format!("at {theta}, tilt {tilt}"));
    }
}
