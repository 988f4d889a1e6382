//! Properties of the Cauchy variant alone: its factors, and weights that do not vary with the azimuth.

use crate::support::{Draws, direction};
use hairis::model::Bell;
use hairis::params::HairDesc;
use hairis::params::Rule;
use hairis::{HairParams, Lobe, LobeMask, Material, ParamError, Published};
use hairis_variants::{AllCauchy, Cauchy};

#[test]
fn width_factors_match_what_they_are_named_for() {
    let named = [
        (Cauchy::PAPER, 1.0),
        (Cauchy::HALF_WIDTH, (2.0 * 2.0_f32.ln()).sqrt()),
    ];
    for (bell, factor) in named
        .into_iter()
        .chain([(Cauchy::AREA, core::f32::consts::FRAC_2_PI.sqrt())])
    {
        assert!(
            (bell.width_factor() - factor).abs() < 1e-6,
            "{bell:?} should be {factor}"
        );
        assert_eq!(
            Cauchy::with_width_factor(bell.width_factor()),
            Ok(bell),
            "{bell:?}"
        );
    }
    assert_eq!(
        AllCauchy::default(),
        Published(Cauchy::PAPER),
        "the default"
    );
}

const FACTORS: Rule = Rule::Range([0.5, 4.0]);

#[test]
fn width_factors_out_of_range_are_refused() {
    for factor in [0.0, 0.499, 4.01, -1.0, f32::INFINITY, 1e30] {
        let refused = Cauchy::with_width_factor(factor);
        assert_eq!(
            refused,
            Err(ParamError::new("width_factor", None, FACTORS, factor)),
            "{factor}"
        );
    }
    let refused = Cauchy::with_width_factor(f32::NAN);
    assert!(
        refused.is_err_and(|error| error.value().is_nan()),
        "the error holds NaN"
    );
    for factor in [0.5, 4.0] {
        assert!(
            Cauchy::with_width_factor(factor).is_ok(),
            "{factor} is legal"
        );
    }
}

#[test]
fn a_factor_is_the_same_as_wider_parameters() {
    let d = *HairParams::bright().desc();
    let wide = HairDesc {
        beta: d.beta.map(|beta| beta * 2.0),
        gamma_tt: d.gamma_tt * 2.0,
        gamma_g: d.gamma_g * 2.0,
        ..d
    };
    let wide = Material::new(&Cauchy::PAPER.model(), &HairParams::new(&wide).unwrap());
    let factor = Material::new(
        &Cauchy::with_width_factor(2.0).unwrap().model(),
        &HairParams::bright(),
    );
    assert_eq!(
        format!("{wide:?}"),
        format!("{factor:?}"),
        "twice the widths, or a factor of two"
    );
}

#[test]
fn a_lobe_alone_has_weights_of_w_alone() {
    // The sampler's density is the lobe but for W: at one theta the weight is one number, whatever the azimuth.
    let mut draws = Draws(61);
    let bsdf =
        Material::new(&Cauchy::PAPER.model(), &HairParams::bright()).prepare(direction(0.5, 1.0));
    for lobe in Lobe::FOUR {
        let alone = bsdf.with_lobes(LobeMask::of(&[lobe]));
        for _ in 0..200 {
            let xi_theta = draws.xi();
            let mut weights = (0..8)
                .filter_map(|_| alone.sample([0.0, xi_theta, draws.xi()]))
                .map(|s| s.weight[0]);
            let first = weights.next().unwrap();
            assert!(first > 0.0, "{lobe:?} at xi {xi_theta}");
            for weight in weights {
                assert!(
                    (weight / first - 1.0).abs() < 2e-6,
                    "{lobe:?} at xi {xi_theta}: {first} and {weight}"
                );
            }
        }
    }
}
