//! Colours that are asked against those that the formulas show.

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt::Write as _;
use hairis_conformance::cases;
use hairis_reference::reference;
use hairis_variants::color::{ColorError, ColorOf};
use hairis_variants::{ChiangDesc, ModelId, Values};

/// Models with a colour, each with the material that gets it.
fn subjects() -> [(ModelId, Values); 3] {
    [ModelId::Chiang, ModelId::DEon, ModelId::Gaussian].map(|id| {
        let (_, brown) = id.presets().find(|(name, _)| *name == "brown").unwrap();
        (id, brown)
    })
}

/// Integrates the albedo of the formulas at normal incidence over the width of a fibre, in double precision.
fn albedo(id: ModelId, values: &Values) -> [f64; 3] {
    let offsets = if id.is_near_field() { 400 } else { 1 };
    let (mut sums, mut shares) = ([0.0; 3], 0.0);
    for offset in 0..offsets {
        let around = (f64::from(offset) + 0.5) / f64::from(offsets) * PI - FRAC_PI_2;
        let point = reference::<f64>(id, values, [0.0, 1.0, 0.0], around.sin()).unwrap();
        shares += around.cos();
        for lobe in point.albedo().0 {
            for (sum, channel) in sums.iter_mut().zip(lobe) {
                *sum += around.cos() * channel;
            }
        }
    }
    sums.map(|sum| sum / shares)
}

/// Errors of a colour, by channel.
#[derive(Default)]
struct Errors {
    worst: f64,
    squares: f64,
    count: u32,
}

impl Errors {
    fn add(&mut self, asked: [f32; 3], shown: [f64; 3]) {
        for (asked, shown) in asked.into_iter().zip(shown) {
            let error = (shown - f64::from(asked)).abs();
            self.worst = self.worst.max(error);
            self.squares += error * error;
            self.count += 1;
        }
    }

    fn rms(&self) -> f64 {
        (self.squares / f64::from(self.count)).sqrt()
    }
}

/// Colours of which each channel has so many different values, between the darkest and the lightest that hair shows, in other orders. As channels
/// are independent, they stand for a grid with as many steps on each side.
fn spread([black, white]: [[f32; 3]; 2], steps: u16) -> impl Iterator<Item = [f32; 3]> {
    (0..steps).map(move |step| {
        core::array::from_fn(|c| {
            let step = [step, steps - 1 - step, (step + steps / 3) % steps][c];
            let share = (f32::from(step) + 0.5) / f32::from(steps);
            black[c] + (white[c] - black[c]) * share
        })
    })
}

/// Asks for colours. Returns the darkest and the lightest colour, and the errors: of a fibre by the formulas, of a mass by its
/// curve.
fn asked(id: ModelId, base: &Values, of: ColorOf, steps: u16) -> ([[f32; 3]; 2], Errors) {
    let ends = [[0.0; 3], [1.0; 3]].map(|end| {
        let values = id.with_color(base, end, of).unwrap();
        id.shown_color(&values, of).unwrap()
    });
    let mut errors = Errors::default();
    for color in spread(ends, steps) {
        let values = id.with_color(base, color, of).unwrap();
        let shown = match of {
            ColorOf::Fibre => albedo(id, &values),
            _ => id.shown_color(&values, of).unwrap().map(f64::from),
        };
        errors.add(color, shown);
    }
    (ends, errors)
}

const RECORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../benches/records/color.csv");

/// Largest errors of a fibre by the formulas, which are those of quadrature by samples, and of a mass by its curve, which are those of roundings,
/// magnified near white by the root that the curve takes of the absorbed light. The record has those measured over a grid of a hundred steps.
const BOUNDS: [f64; 2] = [1.2e-3, 3e-5];

#[test]
fn hair_shows_the_colour_that_is_asked() {
    let record = std::fs::read_to_string(RECORD).unwrap();
    let steps = if cases(4) < 4 { 2 } else { 3 };
    for (id, base) in subjects() {
        for (of, bound) in [ColorOf::Fibre, ColorOf::Mass].into_iter().zip(BOUNDS) {
            let (ends, errors) = asked(id, &base, of, steps);
            let (worst, rms) = (errors.worst, errors.rms());
            println!("{id:?} {of:?}: {worst:.1e}, rms {rms:.1e}");
            assert!(worst < bound, "{id:?} {of:?}: {worst}");
            // The record holds: errors of fewer colours are not larger, and the ends are the same.
            let key = format!("{},{},", id.name(), of.word());
            let row = record.lines().find_map(|line| line.strip_prefix(&*key));
            let row: Vec<f64> = row
                .unwrap()
                .split(',')
                .map(|x| x.parse().unwrap())
                .collect();
            assert!(worst < 1.2 * row[0], "{key} {worst} of {row:?}");
            for (end, recorded) in ends.iter().zip(&row[2..]) {
                let off = f64::from(end[0]) - recorded;
                assert!(off.abs() < 1e-3, "{key} {ends:?} of {row:?}");
            }
        }
    }
}

/// Without this, a bracket would not hold one solution.
#[test]
fn colours_fall_with_absorption() {
    for (id, base) in subjects() {
        for of in [ColorOf::Fibre, ColorOf::Mass] {
            let mut before = [f32::INFINITY; 3];
            for step in 0..6_u8 {
                // Shares that a pigment lets through: none is absorbed by white hair, and next to all by black hair.
                let through = 1.0 - f32::from(step) / 6.0;
                let values = if base.index("sigma_a").is_some() {
                    let sigma_a = [1.0, 2.0, 4.0].map(|by| -by * through.ln());
                    base.with("sigma_a", &sigma_a)
                } else {
                    let passed = [1.0, 2.0, 4.0].map(|by| through.powf(by));
                    base.with("i_tt", &passed.map(|share| 3.0 * share))
                        .with("i_trt", &passed.map(|share| 0.1 * share * share))
                };
                let shown = id.shown_color(&values, of).unwrap();
                for (shown, before) in shown.iter().zip(before) {
                    assert!(*shown < before, "{id:?} {of:?} at {through}: {shown:?}");
                }
                before = shown;
            }
        }
    }
}

#[test]
fn every_colour_is_the_nearest_or_an_error() {
    for (id, base) in subjects() {
        let of = ColorOf::Fibre;
        let show = |color: [f32; 3]| {
            let values = id.with_color(&base, color, of).unwrap();
            id.shown_color(&values, of).unwrap()
        };
        let ([dark, low, _], [light, high, _]) = (show([0.0, 1e-6, 0.3]), show([1.0, 1e30, 0.3]));
        assert!(dark == low && dark > 0.0 && dark < 0.1, "{id:?}: {dark}");
        assert!((light - high).abs() < 1e-5 && light > 0.99 && light < 1.0001);
        for wrong in [f32::NAN, -0.1, f32::INFINITY] {
            let refused = id.with_color(&base, [0.5, wrong, 0.5], of);
            let Err(ColorError::Param(error)) = refused else {
                panic!("{id:?} takes {wrong}: {refused:?}")
            };
            assert_eq!((error.field(), error.number()), ("color", Some(1)));
        }
        // Values are checked as those of a material.
        let first = base.fields()[0].name;
        let broken = base.with(first, &vec![f32::NAN; base.numbers(first).len()]);
        let refused = id.with_color(&broken, [0.5; 3], ColorOf::Mass);
        assert!(
            matches!(refused, Err(ColorError::Param(_))),
            "{id:?}: {refused:?}"
        );
    }
    let kajiya_kay = ModelId::KajiyaKay;
    let refused = kajiya_kay.with_color(&kajiya_kay.defaults(), [0.5; 3], ColorOf::Fibre);
    assert_eq!(
        refused.unwrap_err().to_string(),
        "color_of must be a sense that kajiya-kay has, got \"fibre\""
    );
    let black_pigment = ModelId::Gaussian.defaults().with("i_tt", &[0.0; 3]);
    let dark = black_pigment.with("i_trt", &[0.0; 3]);
    let values = ModelId::Gaussian.with_color(&dark, [0.5; 3], ColorOf::Fibre);
    assert_eq!(values, Ok(dark), "R alone has one colour");
    let bright = ModelId::Gaussian.defaults().with("i_tt", &[f32::MAX; 3]);
    let values = ModelId::Gaussian.with_color(
        &bright.with("i_trt", &[f32::MAX; 3]),
        [0.5; 3],
        ColorOf::Fibre,
    );
    let numbers: [f32; 3] = values.unwrap().get("i_tt");
    assert!(
        numbers.iter().all(|i| i.is_finite() && *i >= 0.0),
        "{numbers:?}"
    );
}

#[test]
fn the_published_fit_is_chiangs_alone() {
    let id = ModelId::Chiang;
    let color = [0.6, 0.3, 0.1];
    let values = id
        .with_color(&id.defaults(), color, ColorOf::Chiang)
        .unwrap();
    let desc = ChiangDesc::default().with_color(color).unwrap();
    assert_eq!(values, id.defaults().with("sigma_a", &desc.sigma_a));
    let shown = id.shown_color(&values, ColorOf::Chiang).unwrap();
    assert!((0..3).all(|c| (shown[c] - color[c]).abs() < 1e-5));
    for other in [ModelId::DEon, ModelId::Gaussian] {
        let refused = other.with_color(&other.defaults(), color, ColorOf::Chiang);
        assert_eq!(refused, Err(ColorError::Model(other, ColorOf::Chiang)));
    }
    assert_eq!(
        ColorOf::ALL.map(|of| ColorOf::find(of.word())),
        ColorOf::ALL.map(Some)
    );
}

/// Derivatives against differences of asked colours.
#[test]
fn derivatives_are_those_of_the_inversion() {
    let color = [0.45, 0.3, 0.15];
    for (id, base) in subjects() {
        let (field, number) = match id {
            ModelId::Chiang => ("beta_n", 0),
            ModelId::DEon => ("roughness", 0),
            _ => ("beta", 1),
        };
        let of = if id == ModelId::Chiang {
            ColorOf::Mass
        } else {
            ColorOf::Fibre
        };
        let absorption = |color, factor: f32| -> [f32; 3] {
            let mut numbers = base.numbers(field).to_vec();
            numbers[number] *= factor;
            let values = id
                .with_color(&base.with(field, &numbers), color, of)
                .unwrap();
            if id == ModelId::Gaussian {
                values.get::<3>("i_tt").map(|i| -i.ln())
            } else {
                values.get("sigma_a")
            }
        };
        let values = id.with_color(&base, color, of).unwrap();
        let by = id.color_derivatives(&values, of, (field, number)).unwrap();
        let step = 0.01;
        let (more, less) = (
            absorption(color.map(|c| c * (1.0 + step)), 1.0),
            absorption(color.map(|c| c * (1.0 - step)), 1.0),
        );
        let (wider, narrower) = (absorption(color, 1.0 + step), absorption(color, 1.0 - step));
        let width = base.numbers(field)[number];
        for c in 0..3 {
            let by_color = (more[c] - less[c]) / (2.0 * step * color[c]);
            let by_number = (wider[c] - narrower[c]) / (2.0 * step * width);
            println!("{id:?}: {by:?} for {by_color} and {by_number}");
            assert!((by.by_color[c] - by_color).abs() < 0.01 * by_color.abs());
            // A colour of one fibre hardly depends on widths, where the model conserves energy.
            let scale = by_number.abs().max(0.05);
            assert!((by.by_number[c] - by_number).abs() < 0.01 * scale);
        }
        assert_eq!(
            id.color_derivatives(&values, of, ("length", 0)),
            Err(ColorError::Field)
        );
        let black = id.with_color(&base, [0.0; 3], of).unwrap();
        let by = id.color_derivatives(&black, of, (field, number)).unwrap();
        assert!(
            by.by_color
                .iter()
                .chain(&by.by_number)
                .all(|by| by.is_finite())
        );
    }
}

#[test]
fn channels_are_independent() {
    for (id, base) in subjects() {
        let shown = |color| {
            let values = id.with_color(&base, color, ColorOf::Fibre).unwrap();
            let field = if id == ModelId::Gaussian {
                "i_tt"
            } else {
                "sigma_a"
            };
            values.get::<3>(field)
        };
        let together = shown([0.6, 0.3, 0.1]);
        for (c, grey) in [0.6, 0.3, 0.1].into_iter().enumerate() {
            let alone = shown([grey; 3])[c];
            let error = (alone - together[c]).abs();
            assert!(
                error < 1e-4 * alone,
                "{id:?} {c}: {alone} for {}",
                together[c]
            );
        }
    }
}

/// Writes the record of colours with `HAIRIS_RECORD=write`.
#[test]
#[ignore = "slow: two minutes on an idle core"]
fn record_of_asked_colours() {
    let mut text = String::from(
        "# CPU: any\n# errors of asked colours on a grid of 100 x 100 x 100: of a fibre by the formulas in double precision, of a mass by its curve\n\
         model,sense,largest,rms,darkest,lightest\n",
    );
    for (id, base) in subjects() {
        for (of, bound) in [ColorOf::Fibre, ColorOf::Mass].into_iter().zip(BOUNDS) {
            let ([dark, light], errors) = asked(id, &base, of, 100);
            let (name, word, rms, worst) = (id.name(), of.word(), errors.rms(), errors.worst);
            let (dark, light) = (dark[0], light[0]);
            writeln!(
                text,
                "{name},{word},{worst:.1e},{rms:.1e},{dark:.4},{light:.4}"
            )
            .unwrap();
            assert!(worst < bound, "{text}");
        }
    }
    println!("{text}");
    if std::env::var("HAIRIS_RECORD").is_ok_and(|word| word == "write") {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../benches/records/color.csv");
        std::fs::write(path, text).unwrap();
    }
}
