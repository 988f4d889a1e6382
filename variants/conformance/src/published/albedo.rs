//! The directional albedo against quadrature of the textbook, and the scale that keeps it at most 1.

use super::quadrature::{integrate, panels};
use super::support::{Draws, Kind, Point, Worst, direction, for_each_point};
use super::{Published, Twin};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::{Bsdf, HairParams, Lobe, Model, PerLobe};

/// Integral of each lobe's value times the cosine: a product of two line integrals, as the lobes are products.
fn integrals(textbook: &Twin, point: &Point) -> PerLobe<f64> {
    let p = &point.p;
    let l = |lobe: Lobe| lobe.index().min(2);
    let at = |lobe: Lobe, theta: f64, phi: f64| {
        let (sin, cos) = theta.sin_cos();
        let azimuth = point.phi_o - phi;
        textbook.lobe_values([sin, cos * azimuth.cos(), cos * azimuth.sin()])[lobe]
    };
    let mut all = PerLobe::default();
    for lobe in Lobe::ALL {
        let centre = 2.0 * p.alpha[l(lobe)] - point.theta_o;
        let theta_0 = centre.clamp(-1.4, 1.4);
        let phi_0 = [0.0, PI, 0.0, p.phi_g][lobe.index()];
        // Towards the pole opposite to wo the cosine of theta_d has a scale of its own.
        let to_pole = FRAC_PI_2 - point.theta_o.abs();
        let bells = [(centre, 2.0 * p.beta[l(lobe)]), (-FRAC_PI_2, to_pole), (FRAC_PI_2, to_pole)];
        let theta = panels(-FRAC_PI_2 + 1e-5, FRAC_PI_2 - 1e-5, &bells);
        let phi = panels(0.0, PI, &[(p.phi_g, p.gamma_g), (PI, p.gamma_tt)]);
        let longitude = integrate(&theta, |theta| at(lobe, theta, phi_0) * theta.cos().powi(2));
        let azimuth = 2.0 * integrate(&phi, |phi| at(lobe, theta_0, phi));
        // A lobe so far off the sphere that even its largest value is 0 returns nothing.
        let largest = at(lobe, theta_0, phi_0);
        all[lobe] = if largest > 0.0 { longitude * azimuth / largest } else { 0.0 };
    }
    all
}

pub fn albedo_is_the_integral<S: Published>() {
    let mut worst = Worst::default();
    let mut turn = 0;
    for kind in [Kind::Grid, Kind::Narrow, Kind::Wide] {
        for_each_point::<S>(kind, |bsdf, textbook, point| {
            turn += 1;
            if kind == Kind::Grid && turn % 7 != 0 {
                return;
            }
            let got = bsdf.prepare(point.wo).albedo();
            let want = integrals(textbook, point);
            let d = point.params.desc();
            let colors = PerLobe([d.intensity_r, d.intensity_tt, d.intensity_trt, d.intensity_trt]);
            for lobe in Lobe::ALL {
                for c in 0..3 {
                    let want = want[lobe] * f64::from(colors[lobe][c]);
                    // A lobe that lies off the sphere returns next to nothing.
                    worst.see((f64::from(got[lobe][c]) - want).abs() / want.max(1e-3), || {
                        format!("{kind:?} {lobe:?} got {} want {want} theta_o {} {:?}", got[lobe][c], point.theta_o, d)
                    });
                }
            }
        });
    }
    worst.check("albedo against quadrature", S::ROWS.albedo);
}

/// The largest albedo on a scan of `steps` inclinations.
fn scanned<M: Model>(bsdf: &Bsdf<M>, steps: u32) -> f32 {
    let mut most = 0.0_f32;
    for i in 0..=steps {
        let theta = -FRAC_PI_2 + PI * f64::from(i) / f64::from(steps);
        let albedo = bsdf.prepare(direction(theta, 0.0)).albedo();
        for c in 0..3 {
            most = most.max(albedo.0.iter().map(|lobe| lobe[c]).sum());
        }
    }
    most
}

pub fn max_albedo_bounds_a_scan_ten_times_as_fine<S: Published>() {
    let mut draws = Draws(31);
    let random: Vec<HairParams> = (0..24).map(|_| draws.params(10.0)).collect();
    for (model, _) in S::forms() {
        for params in HairParams::presets().into_iter().map(|(_, p)| p).chain(random.clone()) {
            let bsdf = Bsdf::new(&model, &params);
            let (most, seen) = (bsdf.max_albedo(), scanned(&bsdf, 1800));
            assert!(seen <= most, "{seen} is above max_albedo {most}: {params:?}");
            assert!(most <= seen * 1.02, "max_albedo {most} is no least bound of {seen}: {params:?}");
        }
    }
}

pub fn scaled_hair_returns_at_most_what_it_receives<S: Published>() {
    let mut draws = Draws(32);
    let random: Vec<HairParams> = (0..24).map(|_| draws.params(10.0)).collect();
    let mut scaled_down = 0;
    for (model, _) in S::forms() {
        for params in HairParams::presets().into_iter().map(|(_, p)| p).chain(random.clone()) {
            let scale = Bsdf::new(&model, &params).conserving_scale();
            scaled_down += usize::from(scale < 1.0);
            assert!(scale > 0.0 && scale <= 1.0, "scale {scale}: {params:?}");
            let most = scanned(&Bsdf::new(&model, &params.scaled(scale).unwrap()), 1800);
            assert!(most <= 1.0, "scaled by {scale} it still returns {most}: {params:?}");
            assert!(scale == 1.0 || most > 0.97, "scaled by {scale} more than need be, to {most}: {params:?}");
        }
    }
    assert!(scaled_down > 5, "only {scaled_down} materials needed a scale");
}
