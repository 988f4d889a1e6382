//! Tests of the directional albedo against quadrature of the reference, and of the scale that keeps it at most 1.

use super::Tested;
use super::handles::Material;
use super::quadrature::{integrate, panels};
use super::support::{Draws, Kind, Point, direction, for_each_point, narrow, packet, parameters};
use crate::comparison::LargestError;
use crate::size::{cases, is_kept};
use core::f64::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::params::HairDesc;
use hairis::simd::Level;
use hairis::{HairParams, Lobe, PerLobe};
use hairis_reference::{Reference, Shape};

/// Integrates each lobe's value times the cosine, as a product of two line integrals, because the lobes are products.
fn integrals(reference: &dyn Reference<f64>, point: &Point) -> PerLobe<f64> {
    let p = &point.p;
    let l = |lobe: Lobe| lobe.index().min(2);
    let at = |lobe: Lobe, theta: f64, phi: f64| {
        let (sin, cos) = theta.sin_cos();
        let azimuth = point.phi_o - phi;
        reference.lobe_values([sin, cos * azimuth.cos(), cos * azimuth.sin()])[lobe]
    };
    let mut all = PerLobe::default();
    for lobe in Lobe::FOUR {
        let centre = 2.0 * p.alpha[l(lobe)] - point.theta_o;
        let theta_0 = centre.clamp(-1.4, 1.4);
        let phi_0 = [0.0, PI, 0.0, p.phi_g][lobe.index()];
        // Towards the pole opposite to wo, the cosine of theta_d has a scale of its own.
        let to_pole = FRAC_PI_2 - point.theta_o.abs();
        let bells = [
            (centre, 2.0 * p.beta[l(lobe)]),
            (-FRAC_PI_2, to_pole),
            (FRAC_PI_2, to_pole),
        ];
        let theta = panels(-FRAC_PI_2 + 1e-5, FRAC_PI_2 - 1e-5, &bells);
        let phi = panels(0.0, PI, &[(p.phi_g, p.gamma_g), (PI, p.gamma_tt)]);
        let inclination = integrate(&theta, |theta| at(lobe, theta, phi_0) * theta.cos().powi(2));
        let azimuth = 2.0 * integrate(&phi, |phi| at(lobe, theta_0, phi));
        // A lobe so far off the sphere that even its largest value is 0 returns nothing.
        let largest = at(lobe, theta_0, phi_0);
        all[lobe] = if largest > 0.0 {
            inclination * azimuth / largest
        } else {
            0.0
        };
    }
    all
}

pub fn albedo_is_the_integral(tested: &Tested) {
    let mut worst = LargestError::default();
    let mut turn = 0;
    for kind in [Kind::Grid, Kind::Narrow, Kind::Wide] {
        for_each_point(tested, kind, |material, reference, point| {
            turn += 1;
            if kind == Kind::Grid && turn % 7 != 0 {
                return;
            }
            let got = material.prepare(point.wo).albedo();
            let want = integrals(reference, point);
            let d = point.params.desc();
            let colors = PerLobe::padded([d.i_r, d.i_tt, d.i_trt], d.i_trt);
            for lobe in Lobe::FOUR {
                for c in 0..3 {
                    let want = want[lobe] * f64::from(colors[lobe][c]);
                    // A lobe that lies off the sphere returns next to nothing.
                    worst.see(
                        (f64::from(got[lobe][c]) - want).abs() / want.max(1e-3),
                        || {
                            format!(
                                "{kind:?} {lobe:?} got {} want {want} theta_o {} {:?}",
                                got[lobe][c], point.theta_o, d
                            )
                        },
                    );
                }
            }
        });
    }
    worst.check("albedo against quadrature", tested.rows.albedo);
}

/// Returns materials of any widths and shifts, and materials for which quadrature or scans have failed before.
fn any_widths() -> Vec<HairParams> {
    let mut draws = Draws(33);
    let default = *HairParams::bright().desc();
    let black = [0.0; 3];
    let small = HairDesc {
        alpha: [-1.494; 3],
        ..*HairParams::bright().desc()
    };
    let small = HairDesc {
        beta: [0.0847; 3],
        ..small
    };
    let bright = HairDesc {
        alpha: [default.alpha[0], 1.356_512_9, default.alpha[2]],
        beta: [default.beta[0], 3.96e-4, default.beta[2]],
        i_tt: [7318.0; 3],
        i_r: black,
        i_trt: black,
        ..default
    };
    let grazing = HairDesc {
        alpha: [default.alpha[0], default.alpha[1], 0.0],
        beta: [default.beta[0], default.beta[1], 1e-4],
        gamma_tt: 1e-4,
        gamma_g: 1e-4,
        ..*HairParams::bright().desc()
    };
    let grazing = HairDesc {
        i_trt: [3283.0, 1565.0, 5134.0],
        i_g: 0.848,
        phi_g: 0.0,
        ..grazing
    };
    let grazing = HairDesc {
        i_r: black,
        i_tt: black,
        ..grazing
    };
    let known = [small, bright, grazing].map(|desc| HairParams::new(&desc).unwrap());
    known
        .into_iter()
        .chain((0..cases(60)).map(|_| draws.params(1e4)))
        .collect()
}

/// Returns distances of `wo` from a pole, closer and closer and on it, with the side of the pole.
fn any_inclinations() -> impl Iterator<Item = (f64, f64)> {
    let near = (0..24).map(|i| 0.5 * f64::exp(-0.62 * f64::from(i)));
    near.chain((0..12).map(|i| FRAC_PI_2 - 0.09 * f64::from(i)))
        .chain([0.0])
        .flat_map(|off| [(off, 1.0), (off, -1.0)])
}

/// Returns the rounded direction at this distance from a pole, and its inclination.
fn off_pole((off, side): (f64, f64)) -> (Vec3, f64) {
    let wo = Vec3::new(narrow(side * off.cos()), narrow(off.sin()), 0.0);
    (wo, f64::from(wo.x).atan2(f64::from(wo.y)))
}

/// Returns the albedo of each lobe without its colour, from the formulas of its two factors. It is equally exact for lobes of any width,
/// seen from any inclination.
pub fn exact(shape: Shape, p: &HairDesc<f64>, theta_o: f64) -> PerLobe<f64> {
    let to_pole = FRAC_PI_2 - theta_o.abs();
    let inclination = [0, 1, 2].map(|l| {
        let centre = 2.0 * p.alpha[l] - theta_o;
        let poles = [-FRAC_PI_2, FRAC_PI_2].map(|pole| [(pole, to_pole.max(1e-9)), (pole, 1e-9)]);
        let bells = [&[(centre, 2.0 * p.beta[l])], poles.as_flattened()].concat();
        integrate(&panels(-FRAC_PI_2, FRAC_PI_2, &bells), |theta_i| {
            let bell = shape.bell(p.beta[l], 0.5 * (theta_i + theta_o) - p.alpha[l]);
            let cos_theta_d = (0.5 * (theta_i - theta_o)).cos();
            bell * (theta_i.cos() / cos_theta_d.max(1e-300)).powi(2)
        })
    });
    let azimuth = |centre: f64, width: f64| {
        2.0 * integrate(&panels(0.0, PI, &[(centre, width)]), |phi| {
            shape.bell(width, phi - centre)
        })
    };
    let [r, tt, trt] = inclination;
    let lobes = [
        4.0 * r,
        azimuth(PI, p.gamma_tt) * tt,
        4.0 * trt,
        azimuth(p.phi_g, p.gamma_g) * p.i_g * trt,
    ];
    PerLobe::padded(lobes, 0.0)
}

/// Error of half an inclination in the kernels, in rad: a unit in the last place of angles from 0.5 to 1.
const ANGLE: f64 = 0.5 * f32::EPSILON as f64;

/// Returns the error of a lobe's albedo without its colour, relative to at least 1e-9. Of an error above `allowed`, what the rounding of the
/// angle explains is left out: it decides how much of a narrow lobe at a pole lies on the sphere.
pub fn unexplained(
    (shape, p, theta_o): (Shape, &HairDesc<f64>, f64),
    (lobe, got): (Lobe, f64),
    allowed: f64,
) -> f64 {
    let want = exact(shape, p, theta_o)[lobe];
    // A lobe that lies off the sphere returns next to nothing.
    let of = |distance: f64| distance.abs() / want.max(1e-9);
    let error = of(got - want);
    if error <= allowed {
        return error;
    }
    let turned = [-ANGLE, ANGLE].map(|by| {
        let alpha = p.alpha.map(|alpha| alpha + by);
        exact(shape, &HairDesc { alpha, ..*p }, theta_o)[lobe]
    });
    let [least, most] = [turned[0].min(turned[1]), turned[0].max(turned[1])];
    of(got - got.clamp(least, most))
}

/// Returns materials of narrow lobes whose centres lie up to six widths from a pole, within it and beyond, as seen from this inclination.
fn at_a_pole(theta_o: f64) -> impl Iterator<Item = HairParams> {
    [1e-4, 1e-3, 1e-2].into_iter().flat_map(move |beta| {
        (-12..=12).map(move |i| {
            let beyond = 0.25 * PI - 0.5 * theta_o.abs() + 0.5 * f64::from(i) * beta;
            let alpha = narrow(beyond * -theta_o.signum());
            let desc = HairDesc {
                alpha: [alpha; 3],
                beta: [narrow(beta); 3],
                ..*HairParams::bright().desc()
            };
            HairParams::new(&desc).unwrap()
        })
    })
}

pub fn albedo_of_any_width_is_the_integral(tested: &Tested) {
    let mut worst = LargestError::default();
    let any_widths = any_widths();
    for (model, factor) in tested.forms() {
        let mut see = |params: &HairParams, at: (f64, f64)| {
            let (material, p) = (Material::new(model, params), parameters(params, factor));
            let (wo, theta_o) = off_pole(at);
            let got = material.prepare(wo).albedo();
            let d = params.desc();
            let colors = PerLobe::padded([d.i_r, d.i_tt, d.i_trt], d.i_trt);
            for lobe in Lobe::FOUR.into_iter().filter(|lobe| colors[*lobe][0] > 0.0) {
                let got = f64::from(got[lobe][0]) / f64::from(colors[lobe][0]);
                let formulas = (tested.formulas.shape, &p, theta_o);
                let error = unexplained(formulas, (lobe, got), tested.rows.albedo_any);
                worst.see(error, || {
                    format!("{lobe:?} got {got} theta_o {theta_o} {d:?}")
                });
            }
        };
        let seen = any_inclinations()
            .chain([(FRAC_PI_2 - 1.495, -1.0)])
            .filter(|(off, _)| *off > 1e-5);
        for (turn, at) in seen.enumerate() {
            any_widths.iter().for_each(|params| see(params, at));
            let at_a_pole = at_a_pole(off_pole(at).1).enumerate();
            let some = at_a_pole.filter(|(index, _)| is_kept(index + turn));
            some.for_each(|(_, params)| see(&params, at));
        }
    }
    worst.check(
        "albedo of any width against quadrature",
        tested.rows.albedo_any,
    );
}

pub fn conserving_hair_returns_at_most_what_it_receives(tested: &Tested) {
    let (mut worst, mut lanes) = (LargestError::default(), LargestError::default());
    let sums = |PerLobe(lobes): PerLobe<[f32; 3]>| {
        [0, 1, 2].map(|c| lobes.iter().map(|lobe| f64::from(lobe[c])).sum::<f64>())
    };
    let presets: Vec<HairParams> = HairParams::presets()
        .into_iter()
        .map(|(_, params)| params)
        .collect();
    for (model, factor) in tested.forms() {
        for params in any_widths().into_iter().chain(presets.clone()) {
            let raw = Material::new(model, &params);
            let (p, d) = (parameters(&params, factor), params.desc());
            for at in any_inclinations().filter(|(off, _)| *off > 1e-5) {
                let (wo, theta_o) = off_pole(at);
                let PerLobe([r, tt, trt, glint, _]) = exact(tested.formulas.shape, &p, theta_o);
                // Sums computed by the material, and by an integral at the hit.
                let fitted = sums(model.conserving_albedo(&params, wo.into()));
                let integrated = sums(raw.prepare(wo).conserving().albedo());
                for (c, got) in (0..3).cycle().zip(fitted.into_iter().chain(integrated)) {
                    let [i_r, i_tt, i_trt] = [d.i_r[c], d.i_tt[c], d.i_trt[c]].map(f64::from);
                    let want = (r * i_r + tt * i_tt + (trt + glint) * i_trt).min(1.0);
                    worst.see((got - want).abs() / want.max(1e-6), || {
                        format!("{got} for {want}: {theta_o} {d:?}")
                    });
                }
                for level in Level::available() {
                    let eight = raw
                        .with_level(level)
                        .prepare8(&packet(&[wo]))
                        .with_level(level)
                        .conserving()
                        .lane(5);
                    for (eight, one) in sums(eight.albedo()).into_iter().zip(integrated) {
                        lanes.see((eight - one).abs() / one.max(1e-6), || {
                            format!("{eight} of eight, {one}: {theta_o} {d:?}")
                        });
                    }
                }
            }
        }
    }
    worst.check(
        "albedo of hair that conserves against the smaller of quadrature and 1",
        1e-3,
    );
    lanes.check(
        "albedo of hair that conserves, eight lanes against one",
        1e-4,
    );
}

pub fn max_albedo_bounds_lobes_of_any_width(tested: &Tested) {
    let (mut above, mut scaled) = (LargestError::default(), LargestError::default());
    for (model, factor) in tested.forms() {
        for params in any_widths() {
            let p = parameters(&params, factor);
            let d = params.desc();
            let most = f64::from(Material::new(model, &params).max_albedo());
            let mut seen = 0.0_f64;
            for at in any_inclinations() {
                let PerLobe([r, tt, trt, glint, _]) =
                    exact(tested.formulas.shape, &p, off_pole(at).1);
                for c in 0..3 {
                    let [i_r, i_tt, i_trt] = [d.i_r[c], d.i_tt[c], d.i_trt[c]].map(f64::from);
                    seen = seen.max(r * i_r + tt * i_tt + (trt + glint) * i_trt);
                }
            }
            if seen > 1e-30 {
                above.see(seen / most, || format!("{seen} of {most}: {params:?}"));
                scaled.see(most / seen, || format!("{most} for {seen}: {params:?}"));
            }
        }
    }
    above.check("albedo over max_albedo", 1.0);
    scaled.check("max_albedo over the largest seen", 1.02);
}

/// Returns the largest albedo on a scan of `steps` inclinations.
fn scanned(material: &Material<'_>, steps: u32) -> f32 {
    let mut most = 0.0_f32;
    for i in 0..=steps {
        let theta = -FRAC_PI_2 + PI * f64::from(i) / f64::from(steps);
        let albedo = material.prepare(direction(theta, 0.0)).albedo();
        for c in 0..3 {
            most = most.max(albedo.0.iter().map(|lobe| lobe[c]).sum());
        }
    }
    most
}

pub fn max_albedo_bounds_a_scan_ten_times_as_fine(tested: &Tested) {
    let mut draws = Draws(31);
    let random: Vec<HairParams> = (0..cases(24)).map(|_| draws.params(10.0)).collect();
    for (model, _) in tested.forms() {
        for params in HairParams::presets()
            .into_iter()
            .map(|(_, p)| p)
            .chain(random.clone())
        {
            let material = Material::new(model, &params);
            let (most, seen) = (material.max_albedo(), scanned(&material, 1800));
            assert!(
                seen <= most,
                "{seen} is above max_albedo {most}: {params:?}"
            );
            assert!(
                most <= seen * 1.02,
                "max_albedo {most} is no least bound of {seen}: {params:?}"
            );
        }
    }
}

pub fn scaled_hair_returns_at_most_what_it_receives(tested: &Tested) {
    let mut draws = Draws(32);
    let random: Vec<HairParams> = (0..cases(24)).map(|_| draws.params(10.0)).collect();
    let mut scaled_down = 0;
    for (model, _) in tested.forms() {
        for params in HairParams::presets()
            .into_iter()
            .map(|(_, p)| p)
            .chain(random.clone())
        {
            let scale = Material::new(model, &params).conserving_scale();
            scaled_down += usize::from(scale < 1.0);
            assert!(scale > 0.0 && scale <= 1.0, "scale {scale}: {params:?}");
            let most = scanned(&Material::new(model, &params.scaled(scale).unwrap()), 1800);
            assert!(
                most <= 1.0,
                "scaled by {scale} it still returns {most}: {params:?}"
            );
            assert!(
                scale == 1.0 || most > 0.97,
                "scaled by {scale} more than need be, to {most}: {params:?}"
            );
        }
    }
    assert!(
        scaled_down > cases(5).min(5),
        "only {scaled_down} materials needed a scale"
    );
}
