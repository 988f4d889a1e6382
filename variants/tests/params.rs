//! Parameters: what is refused, the artist's helpers, and the presets.

use hairis::ParamError;
use hairis::params::Rule;
use hairis_variants::chiang::{ChiangDesc, ChiangParams, Shifts};
use hairis_variants::kajiya_kay::{Form, KajiyaKayDesc, KajiyaKayParams};

const FORBIDDEN: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// Checks that a field accepts both ends of its range and refuses what is beyond, by name and value.
fn assert_range(
    field: &str,
    [least, most]: [f32; 2],
    build: impl Fn(f32) -> Result<(), ParamError>,
) {
    for value in [least, most, 0.5 * (least + most)] {
        assert_eq!(build(value), Ok(()), "{field} {value}");
    }
    for value in FORBIDDEN
        .into_iter()
        .chain([least.next_down(), most.next_up()])
    {
        match build(value) {
            Err(error) => {
                let rule = Rule::Range([least, most]);
                assert_eq!((error.field(), error.rule()), (field, rule), "{value}");
                assert_eq!(error.value().to_bits(), value.to_bits(), "{field}");
            }
            other => panic!("{field} {value}: {other:?}"),
        }
    }
}

/// Checks that a colour accepts 0 and the largest float and refuses the rest, by name, channel and value.
fn assert_rgb(field: &str, build: impl Fn([f32; 3]) -> Result<(), ParamError>) {
    assert_eq!(build([0.0, f32::MAX, 1.0]), Ok(()), "{field}");
    for value in FORBIDDEN.into_iter().chain([-f32::MIN_POSITIVE]) {
        match build([1.0, value, -1.0]) {
            Err(error) => {
                assert_eq!((error.field(), error.number()), (field, Some(1)), "{value}");
                assert_eq!(error.value().to_bits(), value.to_bits(), "{field}");
            }
            other => panic!("{field} {value}: {other:?}"),
        }
    }
}

#[test]
fn kajiya_kay_refuses_by_field_and_value() {
    let desc = KajiyaKayDesc::default();
    let new = |desc| KajiyaKayParams::new(&desc).map(|_| ());
    assert_range("exponent", [1.0, 1e4], |exponent| {
        new(KajiyaKayDesc { exponent, ..desc })
    });
    assert_rgb("kd", |kd| new(KajiyaKayDesc { kd, ..desc }));
    assert_rgb("ks", |ks| new(KajiyaKayDesc { ks, ..desc }));
    let refused = new(KajiyaKayDesc {
        exponent: 0.5,
        ..desc
    })
    .unwrap_err();
    assert_eq!(refused.field(), "exponent", "the field at fault");
    assert_eq!(
        refused.to_string(),
        "exponent must be in [1, 10000], got 0.5",
        "the message"
    );
}

#[test]
fn chiang_refuses_by_field_and_value() {
    let desc = ChiangDesc::default();
    let new = |desc| ChiangParams::new(&desc).map(|_| ());
    assert_range("beta_m", [1e-3, 1.0], |beta_m| {
        new(ChiangDesc { beta_m, ..desc })
    });
    assert_range("beta_n", [1e-3, 1.0], |beta_n| {
        new(ChiangDesc { beta_n, ..desc })
    });
    let quarter = core::f32::consts::FRAC_PI_4;
    assert_range("tilt", [-quarter, quarter], |tilt| {
        new(ChiangDesc { tilt, ..desc })
    });
    assert_range("eta", [1.0, 4.0], |eta| new(ChiangDesc { eta, ..desc }));
    assert_rgb("sigma_a", |sigma_a| new(ChiangDesc { sigma_a, ..desc }));
}

#[test]
fn helpers_refuse_by_field_and_value() {
    let desc = ChiangDesc::default();
    assert_range("melanin_amount", [0.0, 1.0], |x| {
        desc.with_melanin_amount(x, 0.5).map(|_| ())
    });
    assert_range("melanin_amount", [0.0, 1.0], |x| {
        desc.with_melanin_amount(0.5, x).map(|_| ())
    });
    assert_range("color", [0.0, 1.0], |x| {
        desc.with_color([0.5, 0.5, x]).map(|_| ())
    });
    for value in FORBIDDEN.into_iter().chain([-1e-3]) {
        for (field, result) in [
            ("melanin", desc.with_melanin(value, 0.1)),
            ("melanin", desc.with_melanin(0.1, value)),
            (
                "factor",
                KajiyaKayParams::default().scaled(value).map(|_| desc),
            ),
        ] {
            assert_eq!(result.unwrap_err().field(), field, "{value}");
        }
        let width = KajiyaKayDesc::default().with_width_deg(value);
        assert!(
            width.is_err_and(|error| error.field() == "width_deg"),
            "{value}: {width:?}"
        );
    }
    let unset = ChiangDesc {
        beta_n: f32::NAN,
        ..desc
    }
    .with_color([0.5; 3]);
    assert!(
        unset.is_err_and(|error| error.field() == "beta_n"),
        "{unset:?}"
    );
    assert!(
        KajiyaKayParams::new(&KajiyaKayDesc {
            kd: [f32::MAX; 3],
            ..KajiyaKayDesc::default()
        })
        .unwrap()
        .scaled(2.0)
        .is_err(),
        "a product that overflows"
    );
}

#[test]
fn every_result_of_a_helper_passes_the_checks() {
    let desc = ChiangDesc::default();
    let ends = [0.0, 1.0, 0.5, f32::MIN_POSITIVE];
    for (a, b) in ends.into_iter().flat_map(|a| ends.map(|b| (a, b))) {
        ChiangParams::new(&desc.with_melanin_amount(a, b).unwrap()).unwrap();
        for beta_n in [1e-3, 0.3, 1.0] {
            let coloured = ChiangDesc { beta_n, ..desc }
                .with_color([a, b, 0.2])
                .unwrap();
            ChiangParams::new(&coloured).unwrap();
        }
    }
    ChiangParams::new(&desc.with_melanin(f32::MAX, f32::MAX).unwrap()).unwrap();
    for width in [0.675, 1.0, 7.5, 60.0] {
        let desc = KajiyaKayDesc::default().with_width_deg(width).unwrap();
        assert_eq!(
            *KajiyaKayParams::new(&desc).unwrap().desc(),
            desc,
            "{width} degrees"
        );
        assert!(
            (desc.width_deg() / width - 1.0).abs() < 1e-6,
            "{width} degrees came back as {}",
            desc.width_deg()
        );
    }
}

#[test]
fn presets_pass_their_own_checks() {
    for (name, preset) in KajiyaKayParams::presets() {
        assert_eq!(
            KajiyaKayParams::new(preset.desc()),
            Ok(preset),
            "preset {name}"
        );
        for channel in 0..3 {
            assert!(
                preset.desc().kd[channel] + preset.desc().ks[channel] < 1.0,
                "preset {name} gains energy"
            );
        }
    }
    for (name, preset) in ChiangParams::presets() {
        assert_eq!(
            ChiangParams::new(preset.desc()),
            Ok(preset),
            "preset {name}"
        );
    }
    assert_eq!(
        *ChiangParams::default().desc(),
        ChiangDesc::default(),
        "the default fibre"
    );
    let melanin = ChiangDesc::default().with_melanin(1.3, 0.2).unwrap();
    assert_eq!(melanin, ChiangDesc::default(), "the default's melanin");
    assert_eq!(
        KajiyaKayDesc::default().form,
        Form::Reciprocal,
        "the default form"
    );
    assert_eq!(
        ChiangDesc::default().shifts,
        Shifts::DEon,
        "the default shifts"
    );
}

#[test]
fn a_colour_comes_back_from_its_absorption() {
    // Measured: 1.2e-7.
    let half = ChiangDesc::default().with_color([0.5; 3]).unwrap();
    assert!(
        (half.sigma_a[0] - 0.013_856_5).abs() < 1e-6,
        "color .5 at beta_n .3: sigma_a {:?}",
        half.sigma_a
    );
    for (color, beta_n) in [0.001, 0.02, 0.5, 0.9, 1.0]
        .into_iter()
        .flat_map(|c| [1e-3, 0.3, 0.7, 1.0].map(|b| (c, b)))
    {
        let desc = ChiangDesc {
            beta_n,
            ..ChiangDesc::default()
        }
        .with_color([color; 3])
        .unwrap();
        assert!(
            (desc.color()[1] / color - 1.0).abs() < 2e-6,
            "{color} at beta_n {beta_n} came back as {:?}",
            desc.color()
        );
    }
    let dark = ChiangDesc::default().with_color([0.0; 3]).unwrap();
    assert_eq!(
        dark,
        ChiangDesc::default().with_color([1e-3; 3]).unwrap(),
        "black counts as 1e-3"
    );
}

#[test]
fn derived_quantities_have_the_stated_figures() {
    let desc = ChiangDesc::default();
    // sqrt(v0) at .3: .726 * .3 + .812 * .09 = .29088 rad.
    assert!(
        (desc.width_deg() - 16.666_2).abs() < 1e-3,
        "width of beta_m .3: {}",
        desc.width_deg()
    );
    assert!(
        (desc.azimuthal_scale() - 0.117_159_8).abs() < 1e-6,
        "scale of beta_n .3: {}",
        desc.azimuthal_scale()
    );
    let small = ChiangDesc {
        shifts: Shifts::SmallAngle,
        eta: 1.5,
        ..desc
    };
    assert_eq!(
        small.shifts_rad(),
        desc.shifts_rad(),
        "both rules agree at an index of 1.5"
    );
    let tilts = ChiangDesc { eta: 2.0, ..small }
        .shifts_rad()
        .map(|shift| shift / desc.tilt);
    assert_eq!(tilts, [-2.0, 2.0, 6.0, 0.0], "2 p eta - 2");
    let exponents = [
        (1.0, 60.0),
        (10.0, 21.0),
        (80.0, 7.5),
        (300.0, 3.9),
        (1000.0, 2.1),
    ];
    for (exponent, width) in exponents {
        let found = KajiyaKayDesc {
            exponent,
            ..KajiyaKayDesc::default()
        }
        .width_deg();
        assert!(
            (found - width).abs() < 0.1,
            "exponent {exponent}: {found} degrees"
        );
    }
    let red = ChiangParams::red().desc().sigma_a;
    assert!(
        (red[0] - 0.310_45).abs() < 1e-6 && (red[2] - 1.4975).abs() < 1e-6,
        "red: {red:?}"
    );
}
