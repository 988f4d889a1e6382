//! One test per erratum of the second source (variants/ERRATA.md): a check that the mended form passes and the printed form
//! fails.

use super::chiang::{ChiangFiber, clear, inclinations, prepare};
use super::support::{DEG, direction, points, rule, sum};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::Lobe;
use hairis_reference::{
    ChiangFormulas, ChiangReference, KajiyaKayReference, Reference, Selection, bessel_i0_scaled,
    cosine_power_integral, errata,
};
use hairis_variants::KajiyaKayDesc;
use hairis_variants::KajiyaKayParams;
use hairis_variants::chiang::{ChiangDesc, ChiangParams};

/// The integral over the sphere of a function of the inclination.
fn over_sphere(f: impl Fn(f64) -> f64) -> f64 {
    2.0 * PI
        * sum(&rule(-FRAC_PI_2, FRAC_PI_2, &[], &[-0.5, 0.0, 0.5]), |t| {
            f(t) * t.cos()
        })
}

#[test]
fn e1_cones_lie_opposite_the_fixed_direction() {
    // Smooth fibres keep the inclination: without tilt every lobe lies at its mirror image.
    for theta_o in [0.2, -0.7, 1.2] {
        let fiber = prepare(&clear(0.05, 0.3, 0.0), theta_o, 0.3);
        for lobe in Lobe::FOUR {
            assert!(
                (fiber.cone(lobe) + theta_o).abs() < 1e-15,
                "{lobe:?} at {theta_o}"
            );
        }
        let printed_tt = theta_o;
        let [mended, printed] = [-theta_o, printed_tt].map(|t| fiber.longitudinal(Lobe::TT, t));
        assert!(
            printed < 1e-6 * mended,
            "M of TT at the printed cone: {printed}, at its mirror image {mended}"
        );
    }
    // The other three signs follow those of R, for an alpha of the opposite sign to the tilt here.
    let alpha = -2.0 * DEG;
    let tilted = prepare(&clear(0.05, 0.3, 2.0), 0.5, 0.3);
    let cones = [-0.5 + 2.0 * alpha, -0.5 - alpha, -0.5 - 4.0 * alpha];
    for (lobe, cone) in Lobe::FOUR.into_iter().zip(cones) {
        assert!(
            (tilted.cone(lobe) - cone).abs() < 1e-15,
            "{lobe:?}: {}",
            tilted.cone(lobe)
        );
    }
}

#[test]
fn e2_no_side_of_a_fibre_is_dark() {
    let fiber = KajiyaKayReference::<f64>::prepare(
        &KajiyaKayParams::default().desc().map(f64::from),
        direction(0.3, 0.0),
    );
    let sides = [0.0, 0.3, 0.5, 0.7, 1.0]
        .map(|turn| fiber.lobes(direction(0.2, turn * 2.0 * PI)).0[0].value);
    assert!(
        sides
            .iter()
            .all(|side| (side / sides[0] - 1.0).abs() < 1e-15),
        "the tangent knows no side: {sides:?}"
    );
    // Blinn and Phong's with the normal towards the viewer: half the azimuths are dark.
    let lit = |phi: f64| (0.2_f64.cos() * phi.cos()).max(0.0);
    assert!(
        lit(PI) == 0.0 && lit(0.0) > 0.9,
        "max(0, n.l) has a dark side"
    );
}

#[test]
fn e3_the_cosine_enters_once() {
    // S = kd / pi^2, and the integral's own cosine is the sine of the angle between tangent and light.
    let once = over_sphere(|t| t.cos() / (PI * PI));
    let twice = over_sphere(|t| errata::diffuse(1.0, t) * t.cos());
    assert!(
        (once - 1.0).abs() < 1e-10,
        "the share of kd that comes back: {once}"
    );
    assert!(
        (twice - 8.0 / (3.0 * PI)).abs() < 1e-10,
        "with a cosine in S as well: {twice}"
    );
    // With it S would not be reciprocal either: it would depend on the light's inclination alone.
    let p = KajiyaKayDesc {
        ks: [0.0; 3],
        ..KajiyaKayParams::default().desc().map(f64::from)
    };
    let value = |theta_o: f64, theta_i: f64| {
        KajiyaKayReference::prepare(&p, direction(theta_o, 0.0)).eval(direction(theta_i, 1.0))[0]
    };
    assert!(
        (value(0.2, 1.0) - value(1.0, 0.2)).abs() < 1e-15,
        "reciprocal"
    );
}

#[test]
fn e4_the_highlight_is_opposite_the_viewer() {
    let (theta_o, mirror) = (0.6_f64, -0.6_f64);
    // (t.l)(t.e) + sin(t, l) sin(t, e), with both directions away from the fibre.
    let printed = |theta_i: f64| errata::highlight_cosine(theta_i, theta_o);
    let mended = |theta_i: f64| theta_i.cos() * theta_o.cos() - theta_i.sin() * theta_o.sin();
    assert!(
        (mended(mirror) - 1.0).abs() < 1e-15,
        "peaks on the cone of mirror directions"
    );
    assert!(
        (printed(theta_o) - 1.0).abs() < 1e-15 && printed(mirror) < 0.4,
        "as printed it peaks at the viewer"
    );
    let p = KajiyaKayDesc {
        kd: [0.0; 3],
        ..KajiyaKayParams::default().desc().map(f64::from)
    };
    let fiber = KajiyaKayReference::<f64>::prepare(&p, direction(theta_o, 0.0));
    let [at_mirror, at_viewer] = [mirror, theta_o].map(|t| fiber.eval(direction(t, 0.0))[0]);
    assert!(
        at_viewer < 1e-10 * at_mirror,
        "the formulas' highlight: {at_mirror}, {at_viewer}"
    );
}

#[test]
fn e5_the_constants_gain_energy() {
    // Kd sin(t, l) + Ks c^p with Kd = .4 and Ks = .6, at theta_o = 0.
    let diffuse = over_sphere(|t| 0.4 * t.cos());
    assert!((diffuse - 3.948).abs() < 1e-3, "diffuse: {diffuse}");
    for (exponent, expected) in [(80.0, 1.047), (10.0, 2.785)] {
        let specular = over_sphere(|t| 0.6 * t.cos().powf(exponent));
        assert!(
            (specular - expected).abs() < 1e-3,
            "exponent {exponent}: {specular}"
        );
        assert!(
            diffuse + specular > 4.9,
            "the fibre returns {} times the light",
            diffuse + specular
        );
        // Normalised, kd + ks = 1 returns 1.
        let norm = 2.0 * PI * cosine_power_integral(exponent + 1.0);
        assert!(
            (diffuse * 0.4 / (0.4 * PI * PI) + specular / norm - 1.0).abs() < 1e-6,
            "exponent {exponent}"
        );
    }
}

#[test]
fn e6_theta_d_is_half_the_difference_and_v_a_longitudinal_variance() {
    // On the cone theta_i = -theta_o the angle of incidence is theta_o = half the difference.
    let (theta_o, eta) = (60.0 * DEG, 1.55_f64);
    let reflectance = |theta_d: f64| {
        let cos = theta_d.cos();
        let inner = (eta * eta - 1.0 + cos * cos).sqrt();
        0.5 * (((cos - inner) / (cos + inner)).powi(2)
            + ((eta * eta * cos - inner) / (eta * eta * cos + inner)).powi(2))
    };
    let [half, whole] = [0.5, 1.0].map(|part| reflectance(part * (theta_o - -theta_o)));
    let fiber = prepare(&clear(0.3, 0.3, 0.0), theta_o, 0.0);
    assert!(
        (half - fiber.fresnel()).abs() < 1e-15,
        "half the difference: {half}"
    );
    assert!(
        (whole / 438.0 - 1.0).abs() < 0.01,
        "the whole difference reflects {whole} times the light"
    );
    // u = v ln(e^(1/v) - 2 xi sinh(1/v)) is one less a number whose mean and deviation are v, not 1.
    let v = 0.05_f64;
    let count = 20_000;
    let u = |n: i32| {
        v * ((1.0 / v).exp() - 2.0 * (f64::from(n) + 0.5) / f64::from(count) * (1.0 / v).sinh())
            .ln()
    };
    let mean = (0..count).map(|n| 1.0 - u(n)).sum::<f64>() / f64::from(count);
    assert!((mean / v - 1.0).abs() < 1e-3, "mean of 1 - u: {mean}");
}

#[test]
fn e7_the_density_of_the_inclination_is_m_cos() {
    let p = clear(0.3, 0.3, 0.0);
    for (theta_o, expected) in [(0.0, 0.9587), (60.0, 0.5523), (80.0, 0.3797)] {
        let fiber = prepare(&p, theta_o * DEG, 0.0);
        let rule = inclinations(&p, &fiber, FRAC_PI_2);
        let mass = |power| {
            sum(&rule, |t| {
                fiber.longitudinal(Lobe::R, t) * t.cos().powi(power)
            })
        };
        assert!(
            (mass(1) - 1.0).abs() < 1e-12,
            "our M is a density in steradians"
        );
        // M cos^2 of an M that carries 1 / cos, read as a density in steradians.
        let printed = mass(2);
        println!("E7: theta_o {theta_o}: {printed:.4}");
        assert!(
            (printed - expected).abs() < 1e-3,
            "theta_o {theta_o}: {printed}"
        );
    }
}

#[test]
fn e8_the_printed_u_overflows() {
    let printed = |xi: f32, v: f32| errata::cone_sample(v, xi);
    let cone = |beta_m: f32, xi: f32| {
        let params = ChiangParams::new(&ChiangDesc {
            beta_m,
            ..ChiangDesc::default()
        })
        .unwrap();
        let fiber =
            ChiangReference::<f32>::prepare(params.desc(), Selection::Mean, [0.0, 1.0, 0.0], 0.0);
        (
            fiber.sample_cone(Lobe::TT, xi),
            fiber.sample_cone(Lobe::R, xi),
            params.desc().longitudinal_variance(),
        )
    };
    let (_, _, v) = cone(0.24, 0.5);
    assert!(printed(0.3, 0.25 * v).is_finite(), "TT at .24");
    for beta_m in [0.001, 0.1, 0.22] {
        let (tt, r, v) = cone(beta_m, 0.3);
        assert!(
            !printed(0.3, 0.25 * v).is_finite(),
            "TT at {beta_m}: {}",
            printed(0.3, 0.25 * v)
        );
        assert!(tt > 0.0 && r > tt, "mended: {tt} {r}");
        assert!(
            beta_m > 0.12 || !printed(0.3, v).is_finite(),
            "R at {beta_m}"
        );
    }
    let fiber = prepare(&clear(0.7, 0.3, 0.0), 0.0, 0.0);
    let v = clear(0.7, 0.3, 0.0).variances()[Lobe::R];
    let u = errata::cone_sample(v, 0.3);
    assert!(
        (1.0 - u - fiber.sample_cone(Lobe::R, 0.3)).abs() < 1e-14,
        "where it does not overflow both agree"
    );
}

#[test]
fn e9_the_azimuth_is_not_drawn_from_the_claimed_density() {
    // A lobe by A(p, h) and the azimuth by the same h; claimed is N averaged over uniform h, "A replaced with 1".
    let nodes = rule(-1.0, 1.0, &[(1.0, 1e-3), (-1.0, 1e-3)], &[]);
    let fibers: Vec<_> = nodes
        .iter()
        .map(|&(h, w)| (prepare(&clear(0.3, 0.3, 0.0), 0.0, h), w))
        .collect();
    for (lobe, least, most) in [(Lobe::R, 0.621, 6.93), (Lobe::TT, 0.307, 1.054)] {
        let share: f64 = fibers
            .iter()
            .map(|(fiber, w)| w * fiber.albedo()[lobe][0])
            .sum();
        let ratio = |phi: f64| {
            let [drawn, claimed] = [true, false].map(|weighed| -> f64 {
                let weight = |fiber: &ChiangFiber| {
                    if weighed {
                        fiber.albedo()[lobe][0] / share
                    } else {
                        0.5
                    }
                };
                fibers
                    .iter()
                    .map(|(fiber, w)| w * weight(fiber) * fiber.azimuthal(lobe, phi))
                    .sum()
            });
            drawn / claimed
        };
        let ratios: Vec<f64> = (0..=360).map(|n| ratio(f64::from(n) * DEG)).collect();
        let [low, high] = [
            ratios.iter().copied().fold(f64::MAX, f64::min),
            ratios.iter().copied().fold(0.0, f64::max),
        ];
        println!("E9: {lobe:?} drawn over claimed {low:.3} to {high:.3}");
        assert!(
            (low / least - 1.0).abs() < 0.01 && (high / most - 1.0).abs() < 0.01,
            "{lobe:?}: {low} to {high}"
        );
    }
}

#[test]
fn e10_the_weight_needs_the_density_of_all_lobes() {
    let p = ChiangParams::brown().desc().map(f64::from);
    let fiber = prepare(&p, 0.5, 0.4);
    let (albedo, chosen) = (fiber.albedo(), fiber.probabilities());
    let returned: [f64; 3] = core::array::from_fn(|c| albedo.0.iter().map(|a| a[c]).sum());
    // The printed weight A(p, h): its mean has each lobe once more.
    let printed: [f64; 3] = core::array::from_fn(|c| {
        Lobe::FOUR
            .into_iter()
            .map(|l| chosen[l] * albedo[l][c])
            .sum()
    });
    println!("E10: albedo {returned:.4?}, mean of the printed weight {printed:.4?}");
    assert!(
        (0..3).all(|c| printed[c] < 0.8 * returned[c]),
        "the printed weight is biased: {printed:?} of {returned:?}"
    );
    let (mut mean, mut most, mut alone) = ([0.0; 3], 0.0_f64, 0.0_f64);
    let count = 20_000;
    for drawn in points(count).map(|xi| fiber.sample(xi)) {
        let lobe = drawn.lobe.unwrap();
        let cos = drawn.wi[1].hypot(drawn.wi[2]);
        // The value of all lobes over the density of the one that was chosen.
        let own = chosen[lobe] * fiber.lobes(drawn.wi)[lobe].pdf;
        for ((mean, weight), value) in mean.iter_mut().zip(drawn.weight).zip(drawn.value) {
            *mean += weight / f64::from(count);
            most = most.max(weight);
            alone = alone.max(value * cos / own);
        }
    }
    assert!(
        (0..3).all(|c| (mean[c] / returned[c] - 1.0).abs() < 0.01),
        "ours is not: {mean:?}"
    );
    println!("E10: largest weight {most:.3}; by the chosen lobe alone {alone:.1}");
    assert!(
        most <= returned.iter().sum::<f64>(),
        "bounded by 3 times the mean: {most}"
    );
    assert!(alone > 20.0, "by the density of the chosen lobe: {alone}");
}

#[test]
fn e11_the_path_is_a_chord() {
    for (h, theta_o) in [(0.0, 0.0), (0.5, 0.4), (-0.9, 1.2)] {
        let fiber = prepare(&clear(0.3, 0.3, 0.0), theta_o, h);
        // The refracted ray in three dimensions, by Snell's law, to where it leaves the unit cylinder.
        let normal = [0.0, 1.0, 0.0];
        let gamma = f64::asin(h);
        let wi = [
            -theta_o.sin(),
            -theta_o.cos() * gamma.cos(),
            -theta_o.cos() * gamma.sin(),
        ];
        let cos_in: f64 = wi[1].abs();
        let cos_t = (1.0 - (1.0 - cos_in * cos_in) / (1.55 * 1.55)).sqrt();
        let t: [f64; 3] =
            core::array::from_fn(|i| wi[i] / 1.55 + (cos_in / 1.55 - cos_t) * normal[i]);
        let chord = -2.0 * t[1] / (t[1] * t[1] + t[2] * t[2]);
        assert!(
            (fiber.path_length() - chord).abs() < 1e-14,
            "h {h} theta_o {theta_o}: {chord}"
        );
    }
    let sigma = f64::from(ChiangParams::brown().desc().sigma_a[1]);
    let [mended, printed] =
        [2.0, errata::path_length(0.0)].map(|length: f64| (-sigma * length).exp());
    assert!(
        (mended - 0.163).abs() < 1e-3,
        "green of brown hair along a diameter: {mended}"
    );
    assert!(
        (printed - 0.027).abs() < 1e-3,
        "after 2 + 2 cos 2 gamma_t: {printed}"
    );
}

#[test]
fn e12_three_lobes_lose_light() {
    let nodes = rule(-1.0, 1.0, &[(1.0, 1e-4), (-1.0, 1e-4)], &[]);
    for (theta_o, expected) in [(0.0, 0.0076), (85.0, 0.1406)] {
        let p = clear(0.3, 0.3, 0.0);
        let lost = 0.5
            * sum(&nodes, |h| {
                1.0 - prepare(&p, theta_o * DEG, h).albedo().0[..3]
                    .iter()
                    .map(|a| a[0])
                    .sum::<f64>()
            });
        assert!((lost - expected).abs() < 1e-4, "theta_o {theta_o}: {lost}");
        let whole = 0.5
            * sum(&nodes, |h| {
                prepare(&p, theta_o * DEG, h)
                    .albedo()
                    .0
                    .iter()
                    .map(|a| a[0])
                    .sum::<f64>()
            });
        assert!(
            (whole - 1.0).abs() < 1e-12,
            "with the rest nothing is lost: {whole}"
        );
    }
}

#[test]
fn elsewhere_i0_is_cut_short() {
    // Ten terms of the power series up to 12, and ln I0 with half of 1/(8x) beyond, as several renderers have them.
    let [below, above] =
        [12.0, 12.0_f64.next_up()].map(|x| errata::bessel_i0_scaled(x) / bessel_i0_scaled(x) - 1.0);
    println!("I0 elsewhere at 12: {below:.4} below, {above:.4} above");
    assert!((below + 0.020).abs() < 2e-3, "ten terms at 12: {below}");
    assert!(
        (above + 0.0057).abs() < 5e-4,
        "half of 1/(8x) at 12: {above}"
    );
    // The energy of TT with it, at beta_m .5.
    let p = clear(0.5, 0.3, 0.0);
    let fiber = prepare(&p, 0.2, 0.0);
    let v = p.variances()[Lobe::TT];
    let mass = sum(&inclinations(&p, &fiber, FRAC_PI_2), |t| {
        let x = t.cos() * 0.2_f64.cos() / v;
        let theirs = errata::bessel_i0_scaled(x) / bessel_i0_scaled(x);
        fiber.longitudinal(Lobe::TT, t) * t.cos() * theirs
    });
    println!("energy of TT elsewhere: {mass:.4}");
    assert!(mass < 0.995, "energy is lost: {mass}");
}

#[test]
fn elsewhere_tilt_follows_sampling() {
    // A cone drawn without tilt and turned by the shift afterwards, with the density of before the turn: a ring about the
    // fibre has become shorter, or longer, and the density is off by the ratio of both cosines.
    let (theta_o, tilt) = (60.0 * DEG, 2.0);
    let p = clear(0.05, 0.3, tilt);
    let [straight, tilted] = [&clear(0.05, 0.3, 0.0), &p].map(|p| prepare(p, theta_o, 0.0));
    let (shift, rule) = (-2.0 * tilt * DEG, inclinations(&p, &tilted, FRAC_PI_2));
    let theirs = sum(&rule, |t| {
        straight.longitudinal(Lobe::R, t - shift) * t.cos()
    });
    let ours = sum(&rule, |t| tilted.longitudinal(Lobe::R, t) * t.cos());
    let cosines = (-theta_o + shift).cos() / theta_o.cos();
    println!("mass of R with the tilt after sampling: {theirs:.4}, ratio of cosines {cosines:.4}");
    assert!((ours - 1.0).abs() < 1e-12, "ours integrates to 1: {ours}");
    assert!(
        (theirs / cosines - 1.0).abs() < 0.01,
        "the density after the turn: {theirs}, {cosines}"
    );
    assert!(
        (1.0 / theirs - 1.14).abs() < 0.01,
        "drawn over claimed: {}",
        1.0 / theirs
    );
}

#[test]
fn elsewhere_an_inverse_pi_too_many() {
    // sum of A M N / pi, as a specification had it: M and N are normalised already.
    let p = clear(0.3, 0.3, 2.0);
    let fiber = prepare(&p, 0.4, 0.3);
    let (theta, phi) = (
        inclinations(&p, &fiber, FRAC_PI_2),
        super::chiang::azimuths(&p, &fiber),
    );
    let returned: f64 = Lobe::FOUR
        .into_iter()
        .map(|lobe| {
            let m = sum(&theta, |t| fiber.longitudinal(lobe, t) * t.cos());
            fiber.albedo()[lobe][0] * m * sum(&phi, |phi| fiber.azimuthal(lobe, phi))
        })
        .sum();
    assert!(
        (returned - 1.0).abs() < 1e-11,
        "clear hair returns all light: {returned}"
    );
    let printed = returned / PI;
    assert!(
        0.31 < printed && printed < 0.33,
        "with 1 / pi two thirds are lost: {printed}"
    );
}
