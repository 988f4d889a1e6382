//! Parameters: the presets and the artist's controls.

use core::f64::consts::{FRAC_PI_2, PI};
use hairis::params::{
    ArtistControls, Glints, HairDesc, Highlight, Pigments, RgbSpace, Rule, Transmission,
    melanin_absorption, transmittance,
};
use hairis::{HairParams, ParamError};
use hairis_conformance::published::quadrature::{panels, rule};
use hairis_reference::{HairReference, Reference, Shape};

#[test]
fn presets_pass_their_own_checks() {
    for (name, preset) in HairParams::presets() {
        assert_eq!(HairParams::new(preset.desc()), Ok(preset), "preset {name}");
    }
    assert_eq!(HairParams::default(), HairParams::brown());
    assert_eq!(HairDesc::default(), *HairParams::brown().desc());
}

/// Share of the light a fibre returns, by channel, averaged over the directions it comes from (Gaussian model).
fn mean_albedo(params: &HairParams) -> [f64; 3] {
    let p = params.desc().map(f64::from);
    let inner = FRAC_PI_2 - 1e-5;
    let phi = rule(&panels(0.0, PI, &[(PI, p.gamma_tt), (p.phi_g, p.gamma_g)]));
    let mut sum = [0.0; 3];
    for (theta_o, w_o) in rule(&[-inner, 0.0, inner]) {
        let hair = HairReference::prepare(&p, Shape::Gaussian, [theta_o.sin(), theta_o.cos(), 0.0]);
        let peaks = [0, 1, 2].map(|lobe| (2.0 * p.alpha[lobe] - theta_o, 2.0 * p.beta[lobe]));
        for (theta_i, w_i) in rule(&panels(-inner, inner, &peaks)) {
            let (sin, cos) = theta_i.sin_cos();
            let w = 2.0 * w_i * cos * cos * w_o * theta_o.cos().powi(2) / FRAC_PI_2;
            for &(phi, w_phi) in &phi {
                let value = hair.eval([sin, cos * phi.cos(), cos * phi.sin()]);
                sum = core::array::from_fn(|c| sum[c] + w * w_phi * value[c]);
            }
        }
    }
    sum
}

#[test]
fn presets_return_less_than_they_receive() {
    // As documented beside each preset.
    let documented = [
        ("bright", [3.91, 3.00, 2.09]),
        ("blond", [0.81, 0.62, 0.34]),
        ("brown", [0.48, 0.30, 0.19]),
        ("red", [0.70, 0.27, 0.13]),
        ("black", [0.12, 0.10, 0.09]),
        ("white", [0.87, 0.85, 0.83]),
    ];
    for ((name, preset), (expected_name, expected)) in
        HairParams::presets().into_iter().zip(documented)
    {
        assert_eq!(name, expected_name, "the order of the presets");
        let albedo = mean_albedo(&preset);
        println!("{name}: {albedo:.4?}");
        for (found, expected) in albedo.into_iter().zip(expected) {
            assert!(
                (found - expected).abs() < 0.006,
                "{name}: albedo {albedo:?}, documented {expected}"
            );
            assert!(
                found < 1.0 || name == "bright",
                "{name} returns more than it receives: {albedo:?}"
            );
        }
    }
}

/// Every number of a description.
fn numbers(d: &HairDesc) -> Vec<f32> {
    let scalars = [d.gamma_tt, d.gamma_g, d.phi_g, d.i_g];
    [d.alpha, d.beta, d.i_r, d.i_tt, d.i_trt]
        .concat()
        .into_iter()
        .chain(scalars)
        .collect()
}

#[test]
fn artist_defaults_are_the_default_hair() {
    let made = HairParams::from_artist(&ArtistControls::default()).unwrap();
    let default = numbers(&HairDesc::default());
    for (made, default) in numbers(made.desc()).into_iter().zip(default) {
        assert!((made / default - 1.0).abs() < 2e-7, "{made}, not {default}");
    }
}

/// `2 mean(cos gamma_t)`, by the midpoint rule over offsets across the fibre.
#[test]
fn light_passes_as_much_as_the_mean_passage_lets_it() {
    let cos = |i: u32| {
        let h = (f64::from(i) + 0.5) / 1e5;
        (1.0 - (h / 1.55) * (h / 1.55)).sqrt()
    };
    let passage = 2.0 * (0..100_000).map(cos).sum::<f64>() / 1e5;
    let [passed, ..] = transmittance([1.0; 3]).unwrap();
    assert!((f64::from(passed).ln() + passage).abs() < 1e-6, "{passage}");
}

#[test]
fn pigment_darkens_and_reddens() {
    let look = |amount, redness| {
        let controls = ArtistControls::default()
            .with_melanin(amount, redness)
            .unwrap();
        let desc = *HairParams::from_artist(&controls).unwrap().desc();
        (controls, desc)
    };
    let mut last = [f32::INFINITY; 6];
    for step in 0..=20_u8 {
        let (controls, desc) = look(f32::from(step) / 20.0, 0.3);
        let colors = [controls.transmission.color, controls.secondary.color].concat();
        assert!(
            colors.iter().all(|c| (0.0..=1.0).contains(c)),
            "{step}: {colors:?}"
        );
        let now: [f32; 6] = [desc.i_tt, desc.i_trt].concat().try_into().unwrap();
        assert!(
            now.iter().zip(last).all(|(now, last)| *now < last),
            "{step}"
        );
        last = now;
    }
    // No pigment lets all light pass, and red pigment takes less red for the green it takes.
    assert_eq!(look(0.0, 0.0).0.transmission.color, [1.0; 3]);
    let hue = |redness| {
        let [r, g, _] = look(0.6, redness).0.transmission.color;
        r.ln() / g.ln()
    };
    assert!(hue(0.0) > hue(0.5) && hue(0.5) > hue(1.0), "less red taken");
    // Half as much pigment as the brown of d'Eon et al. has the colours of the preset, to .06.
    let brown = transmittance(melanin_absorption([0.65, 0.0])).unwrap();
    let preset = HairDesc::default().i_tt.map(|i| i / 3.0);
    for (found, preset) in brown.into_iter().zip(preset) {
        assert!((found - preset).abs() < 0.06, "{brown:?}, not {preset}");
    }
    // Pigment of the concentrations that make hair brown, red and blond returns less than it receives.
    for melanin in [[1.3, 0.0], [0.25, 1.1], [0.3, 0.0], [8.0, 0.0]] {
        let controls = ArtistControls::default()
            .with_absorption(melanin_absorption(melanin))
            .unwrap();
        let albedo = mean_albedo(&HairParams::from_artist(&controls).unwrap());
        assert!(albedo.iter().all(|a| *a < 1.0), "{melanin:?}: {albedo:?}");
    }
    let refused = ArtistControls::default()
        .with_melanin(0.5, 1.5)
        .unwrap_err();
    assert_eq!(
        refused.to_string(),
        "melanin_amount[1] must be in [0, 1], got 1.5"
    );
}

#[test]
fn artist_controls_reach_their_parameters() {
    let controls = ArtistControls {
        primary: Highlight {
            color: [0.5, 1.0, 2.0],
            intensity: 0.5,
            shift_deg: -9.0,
            width_deg: 6.0,
        },
        transmission: Transmission {
            shift_deg: 4.5,
            width_deg: 3.0,
            azimuthal_width_deg: 20.0,
            ..Default::default()
        },
        secondary: Highlight {
            shift_deg: 13.5,
            width_deg: 12.0,
            ..Default::default()
        },
        glints: Glints {
            strength: 2.0,
            separation_deg: 80.0,
            azimuthal_width_deg: 15.0,
        },
    };
    let desc = *HairParams::from_artist(&controls).unwrap().desc();
    let angles = [
        (desc.alpha[0], -9.0),
        (desc.alpha[1], 4.5),
        (desc.alpha[2], 13.5),
        (desc.beta[0], 6.0),
        (desc.beta[1], 3.0),
        (desc.beta[2], 12.0),
        (desc.gamma_tt, 20.0),
        (desc.gamma_g, 15.0),
        (desc.phi_g, 40.0),
    ];
    for (radians, degrees) in angles {
        assert!(
            (radians.to_degrees() - degrees).abs() < 1e-5,
            "{radians} rad is not {degrees} degrees"
        );
    }
    assert_eq!(
        (desc.i_r, desc.i_g),
        ([0.25, 0.5, 1.0], 2.0),
        "color times intensity, and strength"
    );
}

#[test]
fn artist_ranges_hold_their_ends() {
    for (shift_deg, width_deg, separation_deg) in [(-90.0, 0.01, 0.0), (90.0, 180.0, 360.0)] {
        let highlight = Highlight {
            shift_deg,
            width_deg,
            ..Default::default()
        };
        let controls = ArtistControls {
            primary: highlight,
            transmission: Transmission {
                shift_deg,
                width_deg,
                azimuthal_width_deg: width_deg,
                ..Default::default()
            },
            secondary: highlight,
            glints: Glints {
                separation_deg,
                azimuthal_width_deg: width_deg,
                ..Default::default()
            },
        };
        let made = HairParams::from_artist(&controls);
        assert!(
            made.is_ok(),
            "shift {shift_deg} width {width_deg} separation {separation_deg}: {made:?}"
        );
    }
}

/// The refusal of an angle in degrees.
fn degrees(field: &'static str, value: f32, range: [f32; 2]) -> ParamError {
    ParamError::new(field, None, Rule::Degrees(range), value)
}

#[test]
fn artist_errors_name_the_control() {
    type Edit = fn(&mut ArtistControls);
    let cases: [(Edit, ParamError, &str); 8] = [
        (
            |c| c.secondary.width_deg = 0.0,
            degrees("secondary.width_deg", 0.0, [0.01, 180.0]),
            "secondary.width_deg must be an angle in [0.01, 180] degrees, got 0",
        ),
        (
            |c| c.primary.shift_deg = -91.0,
            degrees("primary.shift_deg", -91.0, [-90.0, 90.0]),
            "primary.shift_deg must be an angle in [-90, 90] degrees, got -91",
        ),
        (
            |c| c.glints.separation_deg = 400.0,
            degrees("glints.separation_deg", 400.0, [0.0, 360.0]),
            "glints.separation_deg must be an angle in [0, 360] degrees, got 400",
        ),
        (
            |c| c.transmission.azimuthal_width_deg = f32::INFINITY,
            degrees(
                "transmission.azimuthal_width_deg",
                f32::INFINITY,
                [0.01, 180.0],
            ),
            "transmission.azimuthal_width_deg must be an angle in [0.01, 180] degrees, got inf",
        ),
        (
            |c| c.transmission.color[1] = -0.5,
            ParamError::new("transmission.color", Some(1), Rule::NotNegative, -0.5),
            "transmission.color[1] must be finite and at least 0, got -0.5",
        ),
        (
            |c| c.primary.intensity = -1.0,
            ParamError::new("primary.intensity", None, Rule::NotNegative, -1.0),
            "primary.intensity must be finite and at least 0, got -1",
        ),
        (
            |c| c.glints.strength = -2.0,
            ParamError::new("glints.strength", None, Rule::NotNegative, -2.0),
            "glints.strength must be finite and at least 0, got -2",
        ),
        (
            |c| (c.primary.intensity, c.primary.color) = (f32::MAX, [2.0; 3]),
            ParamError::new("primary.color", Some(0), Rule::FiniteProduct, 2.0),
            "primary.color[0] must be so small that its product with the intensity is finite, got 2",
        ),
    ];
    for (edit, error, message) in cases {
        let mut controls = ArtistControls::default();
        edit(&mut controls);
        assert_eq!(
            HairParams::from_artist(&controls),
            Err(error),
            "the error of {message}"
        );
        assert_eq!(error.to_string(), message, "the message");
        assert!(
            message.starts_with(error.field()),
            "field {} of {message}",
            error.field()
        );
    }
    let nan = ArtistControls {
        primary: Highlight {
            shift_deg: f32::NAN,
            ..Default::default()
        },
        ..Default::default()
    };
    let error = HairParams::from_artist(&nan).unwrap_err();
    assert_eq!(error.field(), "primary.shift_deg", "NaN never passes");
}

/// Matrix from Rec. 709 to `ACEScg` as the configurations of `OpenColorIO` for ACES have it.
#[test]
fn spaces_of_colour_are_converted() {
    let expected = [
        [0.613_097, 0.339_523, 0.047_379],
        [0.070_194, 0.916_354, 0.013_452],
        [0.020_616, 0.109_570, 0.869_815],
    ];
    let (rec, aces) = (RgbSpace::REC_709, RgbSpace::ACES_CG);
    for (row, expected) in rec
        .to(&aces)
        .into_iter()
        .flatten()
        .zip(expected.as_flattened())
    {
        assert!((row - expected).abs() < 1e-6, "{row} and {expected}");
    }
    for (k, same) in rec.to(&rec).into_iter().flatten().enumerate() {
        assert!((same - f64::from(u8::from(k % 4 == 0))).abs() < 1e-12);
    }
}

#[test]
fn pigments_of_another_space_have_the_same_colours() -> Result<(), ParamError> {
    let (rec, aces) = (RgbSpace::REC_709, RgbSpace::ACES_CG);
    for (own, named) in [
        (Pigments::D_EON, Pigments::D_EON_ACES_CG),
        (Pigments::CYCLES, Pigments::CYCLES_ACES_CG),
    ] {
        let converted = own.converted(&rec, &aces)?;
        let back = named.converted(&aces, &rec)?;
        let units = |pigments: &Pigments| [pigments.eumelanin, pigments.pheomelanin].concat();
        for (found, expected) in [(converted, named), (back, own)] {
            for (a, b) in units(&found).into_iter().zip(units(&expected)) {
                assert!((a - b).abs() < 2e-6, "{a} and {b}");
            }
        }
    }
    // White hair stays white, and colours that a space does not have are clipped.
    let white = Pigments::from_colors([[1.0; 3]; 2])?.converted(&rec, &aces)?;
    assert!(white.eumelanin.iter().all(|sigma| *sigma < 1e-6));
    let green = Pigments::from_colors([[0.0, 1.0, 0.0]; 2])?.converted(&aces, &rec)?;
    assert!(green.eumelanin[0] > 60.0 && green.eumelanin[1] == 0.0);
    Ok(())
}

#[test]
fn a_width_factor_is_on_every_width() {
    let desc = *HairParams::brown().desc();
    let wide = desc.with_width_factor(2.0);
    let widths = |d: HairDesc| [d.beta[0], d.beta[1], d.beta[2], d.gamma_tt, d.gamma_g];
    assert_eq!(widths(wide), widths(desc).map(|width| 2.0 * width));
    assert_eq!(
        (wide.alpha, wide.phi_g, wide.i_g),
        (desc.alpha, desc.phi_g, desc.i_g)
    );
}
