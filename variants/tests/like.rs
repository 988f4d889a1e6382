//! Parameters of other renderers, against the value of S by the formulas that each of them publishes.

use core::f64::consts::PI;
use hairis::params::Rule;
use hairis_reference::{Formulas, Reference, bessel_i0_scaled};
use hairis_variants::Values;
use hairis_variants::chiang::{Likeness, ScatteringChiang};

/// Fibre in the words of Chiang et al. 2016 and of pbrt, which all of these renderers share: what differs is how they come to it.
#[derive(Clone, Copy)]
struct Fiber {
    variances: [f64; 4],
    scales: [f64; 3],
    /// Angle by which each lobe turns `theta_o`, rad.
    turns: [f64; 4],
    eta: f64,
    sigma_a: [f64; 3],
    tints: [[f64; 3]; 4],
}

fn longitudinal(m: f64) -> f64 {
    (0.726 * m + 0.812 * m * m + 3.7 * m.powi(20)).powi(2)
}

fn azimuthal(n: f64) -> f64 {
    (PI / 8.0).sqrt() * (0.265 * n + 1.194 * n * n + 5.372 * n.powi(22))
}

/// The fit by which Chiang et al. invert the colour of a mass of hair.
fn of_color(color: [f64; 3], n: f64) -> [f64; 3] {
    let by = 5.969 - 0.215 * n + 2.532 * n.powi(2) - 10.73 * n.powi(3)
        + 5.574 * n.powi(4)
        + 0.245 * n.powi(5);
    color.map(|c| (c.ln() / by).powi(2))
}

fn of_pigments(unit: [[f64; 3]; 2], amounts: [f64; 2]) -> [f64; 3] {
    [0, 1, 2].map(|c| amounts[0] * unit[0][c] + amounts[1] * unit[1][c])
}

/// Sum of `A M N` over the lobes, as pbrt has it.
fn printed(fiber: &Fiber, theta_o: f64, theta_i: f64, phi: f64, h: f64) -> [f64; 3] {
    let (sin_o, cos_o, eta) = (theta_o.sin(), theta_o.cos(), fiber.eta);
    let cos_t = (1.0 - (sin_o / eta).powi(2)).sqrt();
    let sin_gamma_t = h * cos_o / (eta * eta - sin_o * sin_o).sqrt();
    let (gamma_o, gamma_t) = (h.asin(), sin_gamma_t.asin());
    let path = 2.0 * gamma_t.cos() / cos_t;
    let cos = cos_o * gamma_o.cos();
    let inner = (1.0 - (1.0 - cos * cos) / (eta * eta)).sqrt();
    let parallel = (eta * cos - inner) / (eta * cos + inner);
    let perpendicular = (cos - eta * inner) / (cos + eta * inner);
    let f = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    let lobe = |p: usize| {
        let (v, turned) = (fiber.variances[p], theta_o + fiber.turns[p]);
        let x = theta_i.cos() * turned.cos().abs() / v;
        let sines = theta_i.sin() * turned.sin() / v;
        let m = (x - sines - 1.0 / v).exp() * bessel_i0_scaled(x) / (v * (1.0 - (-2.0 / v).exp()));
        if p == 3 {
            return m * 0.5 / PI;
        }
        let s = fiber.scales[p];
        let centre = 2.0 * p as f64 * gamma_t - 2.0 * gamma_o + p as f64 * PI;
        let x = (phi - centre).sin().atan2((phi - centre).cos());
        let logistic = |x: f64| 1.0 / (1.0 + (-x / s).exp());
        let e = (-x.abs() / s).exp();
        m * e / (s * (1.0 + e).powi(2)) / (logistic(PI) - logistic(-PI))
    };
    [0, 1, 2].map(|c| {
        let t = (-fiber.sigma_a[c] * path).exp();
        let tt = (1.0 - f).powi(2) * t;
        let trt = tt * t * f;
        let attenuation = [f, tt, trt, trt * t * f / (1.0 - t * f)];
        (0..4)
            .map(|p| fiber.tints[p][c] * attenuation[p] * lobe(p))
            .sum()
    })
}

/// Compares the fibre of these values with the formulas of the renderer, at directions and offsets.
fn check(renderer: &str, set: impl Fn(Values) -> Values, fiber: &Fiber) {
    check_at(renderer, set, |_| *fiber);
}

/// Compares as [`check`] does, with a fibre that depends on `theta_o`.
fn check_at(renderer: &str, set: impl Fn(Values) -> Values, fiber: impl Fn(f64) -> Fiber) {
    let like = Likeness::find(renderer).expect("in the table");
    let params = like.params(&set(like.defaults())).expect("legal values");
    let constants = ScatteringChiang::formulas(&params);
    for (theta_o, theta_i, phi, h) in [
        (0.3, -0.2, 0.4, 0.2),
        (-0.8, 0.9, 2.8, -0.5),
        (0.0, 0.1, -1.3, 0.9),
        (1.1, -0.7, 3.1, 0.0_f64),
    ] {
        let wo = [f64::sin(theta_o), f64::cos(theta_o), 0.0];
        let (sin, cos) = f64::sin_cos(theta_i);
        let wi = [sin, cos * f64::cos(phi), cos * f64::sin(phi)];
        let (value, _) = ScatteringChiang::point(&constants, wo, h).eval_pdf(wi);
        let want = printed(&fiber(theta_o), theta_o, theta_i, phi, h);
        for c in 0..3 {
            let error = value[c] * cos / want[c] - 1.0;
            // Parameters are rounded to single precision, and the exponent of a narrow lobe magnifies that.
            assert!(
                error.abs() < 3e-5,
                "{renderer} {theta_o} {theta_i}: {error:e}"
            );
        }
    }
}

const WHITE: [[f64; 3]; 4] = [[1.0; 3]; 4];
const D_EON: [[f64; 3]; 2] = [[0.419, 0.697, 1.37], [0.187, 0.4, 1.05]];

#[test]
fn cycles() {
    let (random, by_roughness, by_color) = (0.8_f64, 0.3, 0.4);
    let factor = 1.0 + 2.0 * (random - 0.5) * by_roughness;
    let (v, s) = (0.35 * factor, 0.25 * factor);
    let melanin = 0.6 * (1.0 + 2.0 * (random - 0.5) * by_color);
    let quantity = -(1.0 - melanin).ln();
    let pigments = [[0.506, 0.841, 1.653], [0.343, 0.733, 1.924]];
    let pigment = of_pigments(pigments, [quantity * 0.3, quantity * 0.7]);
    let tint = of_color([0.9, 0.8, 0.4], s);
    let offset = 0.05;
    let fiber = Fiber {
        variances: [
            longitudinal((1.0 - 0.4) * v),
            0.25 * longitudinal(v),
            4.0 * longitudinal(v),
            4.0 * longitudinal(v),
        ],
        scales: [azimuthal(s); 3],
        // hair_alpha_angles
        turns: [-2.0 * offset, offset, 4.0 * offset, 0.0],
        eta: 1.5,
        sigma_a: [0, 1, 2].map(|c| pigment[c] + tint[c]),
        tints: WHITE,
    };
    let set = |values: Values| {
        values
            .with("roughness", &[0.35])
            .with("radial_roughness", &[0.25])
            .with("coat", &[0.4])
            .with("offset", &[0.05])
            .with("ior", &[1.5])
            .with("random", &[0.8])
            .with("random_roughness", &[0.3])
            .with("random_color", &[0.4])
            .with("melanin", &[0.6])
            .with("melanin_redness", &[0.7])
            .with("tint", &[0.9, 0.8, 0.4])
    };
    check("cycles", set, &fiber);
    let reflectance = Fiber {
        sigma_a: of_color([0.5, 0.3, 0.1], s),
        ..fiber
    };
    let set_color = |values: Values| set(values).with("color", &[0.5, 0.3, 0.1]);
    check("cycles", set_color, &reflectance);
    let absorption = Fiber {
        sigma_a: [0.3, 0.6, 1.2],
        ..reflectance
    };
    let set = |values: Values| set(values).with("absorption_coefficient", &[0.3, 0.6, 1.2]);
    check("cycles", set, &absorption);
}

#[test]
fn materialx() {
    let alpha = 0.53 * PI - PI / 2.0;
    let v = longitudinal(0.3);
    let colors = [[0.7_f64, 0.5, 0.2], [0.8, 0.6, 0.3]];
    let quantity = -(1.0_f64 - 0.7).ln();
    let (r, tt, trt) = ([0.9, 0.8, 0.7], [1.0, 0.9, 0.5], [0.2, 0.5, 1.0]);
    let fiber = Fiber {
        variances: [v, v * 0.6 * 0.6, v * 1.7 * 1.7, v * 1.7 * 1.7],
        scales: [azimuthal(0.4); 3],
        // mx_hair_alpha_angles turns theta_i by 2, -1 and -4 alpha, which is theta_o by as much the same way.
        turns: [2.0 * alpha, -alpha, -4.0 * alpha, 0.0],
        eta: 1.6,
        sigma_a: of_pigments(
            colors.map(|c| c.map(|c| -c.ln())),
            [quantity * 0.6, quantity * 0.4],
        ),
        tints: [r, tt, trt, trt],
    };
    let set = |values: Values| {
        values
            .with("longitudinal", &[0.3])
            .with("azimuthal", &[0.4])
            .with("scale_TT", &[0.6])
            .with("scale_TRT", &[1.7])
            .with("cuticle_angle", &[0.53])
            .with("ior", &[1.6])
            .with("tint_R", &[0.9, 0.8, 0.7])
            .with("tint_TT", &[1.0, 0.9, 0.5])
            .with("tint_TRT", &[0.2, 0.5, 1.0])
            .with("eumelanin_color", &[0.7, 0.5, 0.2])
            .with("pheomelanin_color", &[0.8, 0.6, 0.3])
            .with("melanin", &[0.7, 0.4])
    };
    check("materialx", set, &fiber);
}

#[test]
fn osl() {
    let (offset, lrough) = (-0.04, longitudinal(0.4));
    let fiber = Fiber {
        variances: [lrough, 0.25 * longitudinal(0.6), 4.0 * lrough, 4.0 * lrough],
        scales: [azimuthal(0.35); 3],
        turns: [-2.0 * offset, offset, 4.0 * offset, 0.0],
        eta: 1.55,
        sigma_a: [0.1, 0.4, 0.9],
        tints: [[0.5, 0.6, 0.7], [0.9, 0.2, 0.1], [1.0; 3], [1.0; 3]],
    };
    let set = |values: Values| {
        values
            .with("lroughness", &[0.4])
            .with("troughness", &[0.6])
            .with("aroughness", &[0.35])
            .with("offset", &[-0.04])
            .with("absorption", &[0.1, 0.4, 0.9])
            .with("R_tint", &[0.5, 0.6, 0.7])
            .with("TT_tint", &[0.9, 0.2, 0.1])
    };
    check("osl", set, &fiber);
    for scattering in [0.2_f32, 0.6, 1.0] {
        // variances
        let share = f64::from(scattering).powi(2).min(0.99);
        let scattered = |theta_o: f64| {
            let unscattered = (1.0 - share).powf(1.0 / theta_o.cos());
            let grown = |roughness: f64, lost: f64| (roughness + lost).min(1.0);
            let (tt, trt) = (1.0 - unscattered, 1.0 - unscattered * unscattered);
            let wide = 4.0 * longitudinal(grown(0.4, trt));
            Fiber {
                variances: [lrough, 0.25 * longitudinal(grown(0.6, tt)), wide, wide],
                scales: [
                    azimuthal(0.35),
                    azimuthal(grown(0.35, tt)),
                    azimuthal(grown(0.35, trt)),
                ],
                ..fiber
            }
        };
        let set = |values| set(values).with("scattering", &[scattering]);
        check_at("osl", set, scattered);
        let like = Likeness::find("osl").expect("in the table");
        let entry = like.entry(&set(like.defaults()));
        if cfg!(feature = "every-sampler") {
            assert_eq!(entry.expect("legal values").0.name(), "chiang-scattering");
        } else {
            let error = entry.expect_err("no entry for widths that depend on wo");
            assert_eq!(
                (error.field(), error.rule()),
                ("scattering", Rule::Range([0.0, 0.0]))
            );
        }
    }
}

#[test]
fn rtxcr() {
    let (alpha, v) = (3.0_f64.to_radians(), longitudinal(0.25));
    let pigments = [[0.506, 0.841, 1.653], [0.343, 0.733, 1.924]];
    let fiber = Fiber {
        variances: [v, 0.25 * v, 4.0 * v, 4.0 * v],
        scales: [azimuthal(0.3); 3],
        turns: [-2.0 * alpha, alpha, 4.0 * alpha, 0.0],
        eta: 1.5,
        sigma_a: of_color([0.5, 0.3, 0.1], 0.3),
        tints: WHITE,
    };
    let set = |values: Values| {
        values
            .with("longitudinalRoughness", &[0.25])
            .with("azimuthalRoughness", &[0.3])
            .with("cuticleAngleInDegrees", &[3.0])
            .with("ior", &[1.5])
            .with("baseColor", &[0.5, 0.3, 0.1])
    };
    check("rtxcr", set, &fiber);
    let wide = longitudinal(0.5);
    let separate = Fiber {
        variances: [v, longitudinal(0.2), wide, wide],
        scales: [azimuthal(0.3), azimuthal(0.4), azimuthal(0.2)],
        ..fiber
    };
    let set_separate = |values| {
        set(values)
            .with("longitudinalRoughnessTT", &[0.2])
            .with("longitudinalRoughnessTRT", &[0.5])
            .with("azimuthalRoughnessTT", &[0.4])
            .with("azimuthalRoughnessTRT", &[0.2])
    };
    check("rtxcr", set_separate, &separate);
    let melanin = |values| {
        set(values)
            .with("melanin", &[0.6])
            .with("melaninRedness", &[0.3])
    };
    let quantity = -(1.0_f64 - 0.6).ln();
    let normalized = Fiber {
        sigma_a: of_pigments(pigments, [0.7 * quantity, 0.3 * quantity]),
        ..fiber
    };
    check("rtxcr", melanin, &normalized);
    let quantity = 0.6 * 0.6 * 2.4;
    let physics = Fiber {
        sigma_a: of_pigments(pigments, [0.7 * quantity, 0.3 * quantity]),
        ..fiber
    };
    let set_physics = |values| melanin(values).with_word("absorptionModel", "physics");
    check("rtxcr", set_physics, &physics);
}

#[test]
fn pbrt_and_mitsuba() {
    let (alpha, v) = (3.0_f64.to_radians(), longitudinal(0.25));
    let fiber = Fiber {
        variances: [v, 0.25 * v, 4.0 * v, 4.0 * v],
        scales: [azimuthal(0.3); 3],
        turns: [-2.0 * alpha, alpha, 4.0 * alpha, 0.0],
        eta: 1.5,
        sigma_a: of_pigments(D_EON, [0.3, 0.9]),
        tints: WHITE,
    };
    let set = |values: Values| {
        values
            .with("beta_m", &[0.25])
            .with("alpha", &[3.0])
            .with("eta", &[1.5])
            .with("eumelanin", &[0.3])
            .with("pheomelanin", &[0.9])
    };
    check("pbrt", set, &fiber);
    let set_color = |values: Values| set(values).with("reflectance", &[0.5, 0.3, 0.1]);
    let colored = Fiber {
        sigma_a: of_color([0.5, 0.3, 0.1], 0.3),
        ..fiber
    };
    check("pbrt", set_color, &colored);
    let set = |values: Values| {
        values
            .with("longitudinal_roughness", &[0.25])
            .with("scale_tilt", &[3.0])
            .with("int_ior", &[1.65])
            .with("ext_ior", &[1.1])
            .with("sigma_a", &[0.2, 0.3, 0.7])
    };
    let of_mitsuba = Fiber {
        sigma_a: [0.2, 0.3, 0.7],
        ..colored
    };
    check("mitsuba", set, &of_mitsuba);
}

/// Every default is legal, and each field has a range that it states.
#[test]
fn defaults_and_refusals() {
    for like in Likeness::ALL {
        // Of OSL, roughness and absorption have no default, and hardly a field of RTXCR.
        let is_whole = !["osl", "rtxcr"].contains(&like.name);
        assert_eq!(
            like.params(&like.defaults()).is_ok(),
            is_whole,
            "{}",
            like.name
        );
        for field in like.fields.iter().filter(|field| field.rule.is_some()) {
            let bad = vec![-1e9; field.kind.width()];
            let refused = like.params(&like.defaults().with(field.name, &bad));
            assert_eq!(
                refused.expect_err(field.name).field(),
                field.name,
                "{}",
                like.name
            );
        }
    }
    let wide = Likeness::find("materialx").expect("in the table");
    let error = wide.params(&wide.defaults().with("scale_TRT", &[11.0]));
    assert_eq!(error.expect_err("too wide").field(), "width_m");
    assert!(Likeness::find("arnold").is_none());
}
