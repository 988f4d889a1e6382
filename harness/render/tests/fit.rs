//! Materials recovered from pictures.

mod variables;

use crate::support::{film, scene};
use glam::Vec3;
use hairis_conformance::cases;
use hairis_instruments::light::Constant;
use hairis_instruments::record;
use hairis_instruments::stats::Moments;
use hairis_render::film::{Crop, Picture};
use hairis_render::fit::{FitSettings, Objective, Target, Variables, fit, halves};
use hairis_render::hair::{Choice, Energy, default_sampler};
use hairis_render::lights::Sky;
use hairis_render::scene::Scene;
use hairis_render::scenes::Name;
use hairis_render::transport::{self, Integrator, Mis, Settings, record};
use hairis_variants::{Field, Kind, ModelId, Values};
use std::fs;

/// Settings of the paths that fits follow.
fn paths(depth: u32, seed: u64) -> Settings {
    Settings {
        integrator: Integrator::Path,
        depth: Some(depth),
        seed,
        ..Settings::default()
    }
}

fn choice(model: &str, preset: &str) -> Choice {
    Choice::find(model, default_sampler(model), preset).expect("listed")
}

/// Returns a small picture's scene with a lamp and a sky.
fn small(name: Name, hair: &Choice, side: u32) -> Scene {
    let hair = hair.hair(Energy::Raw).expect("in range");
    let mut scene = scene(name, hair, 2000, side);
    if scene.sky.is_black() {
        scene.sky = Sky::from(Constant);
    }
    scene
}

/// Checks that recorded paths are those of the renderer: with the material that drew them, their light is the picture, for every kind of
/// light and surface, and with both ways to sample them.
#[test]
fn recorded_paths_are_those_of_the_renderer() {
    for (name, model) in [
        (Name::Head, "gaussian"),
        (Name::Box, "chiang"),
        (Name::BoxSingle, "kajiya-kay"),
        (Name::Env, "cauchy"),
    ] {
        let hair = choice(model, "default");
        let scene = small(name, &hair, 16);
        let material = hair.id.material(&hair.values).expect("in range");
        for (depth, mis) in [
            (1, Mis::Both),
            (2, Mis::Both),
            (2, Mis::Light),
            (2, Mis::Bsdf),
        ] {
            let settings = Settings {
                mis,
                multiple: name != Name::BoxSingle,
                ..paths(depth, 5)
            };
            let samples = 3;
            let rendered = film(&scene, &settings, samples).picture();
            let crop = Crop::whole(scene.camera.size());
            let recorded = record(&scene, &settings, crop, samples);
            let scattered = |k: usize| {
                let [wo, wi] =
                    [&recorded.wo, &recorded.wi].map(|d| Vec3::new(d[0][k], d[1][k], d[2][k]));
                let bsdf = material.prepare(hairis::Hit::new(wo, recorded.h[k]));
                bsdf.eval_pdf(wi).value.map(f64::from)
            };
            let mut sums = recorded.beside.clone();
            for term in &recorded.terms {
                let mut light = term.factor.to_array().map(f64::from);
                for k in term.scatterings() {
                    let value = scattered(k);
                    (0..3).for_each(|c| light[c] *= value[c]);
                }
                (0..3).for_each(|c| sums[term.pixel as usize][c] += light[c]);
            }
            let mut scattering = 0;
            for (sum, rendered) in sums.iter().zip(&rendered.pixels) {
                for c in 0..3 {
                    let (sum, rendered) = (sum[c] / f64::from(samples), rendered[c]);
                    assert!(
                        (sum - rendered).abs() <= 2e-5 * rendered.max(1e-3),
                        "{name:?} {mis:?} {depth}: {sum} for {rendered}"
                    );
                }
            }
            for term in &recorded.terms {
                scattering = scattering.max(term.scatterings().count());
            }
            let most = if depth == 2 && name != Name::BoxSingle {
                2
            } else {
                1
            };
            assert_eq!(scattering, most, "{name:?} {mis:?} {depth}");
        }
    }
}

/// Returns a preset of every model, and the preset with each field that may stand in for another.
fn looks() -> Vec<Choice> {
    let mut looks = Vec::new();
    for id in ModelId::defaults_of_names() {
        let presets: Vec<_> = id.presets().take(3).collect();
        let mut preset = choice(id.name(), presets.last().expect("a preset").0);
        // Tints and colours of 1 are the end of their range, where a difference has one side.
        let ends = |field: &&Field| field.is_extra() || field.name == "diffuse_color";
        for field in id.fields().iter().filter(ends) {
            let inside: Vec<f32> = (preset.values.numbers(field.name).iter())
                .map(|x| 0.9 * x)
                .collect();
            if !matches!(field.kind, Kind::Word(_)) {
                preset.values = preset.values.with(field.name, &inside);
            }
        }
        let in_place = id
            .fields()
            .iter()
            .filter(|field| field.instead_of.is_some());
        looks.extend(in_place.map(|field| {
            Choice {
                values: preset
                    .values
                    .with(field.name, &[0.6, 0.4, 0.5][..field.kind.width()]),
                ..preset.clone()
            }
        }));
        looks.push(preset);
    }
    looks
}

/// Checks the gradient of the picture's distance against central differences with the same paths, for every parameter of every model.
#[test]
fn gradients_are_those_of_differences() {
    for hair in looks() {
        let id = hair.id;
        let scene = small(Name::Head, &hair, 24);
        let crop = Crop::whole(scene.camera.size());
        let grey = Picture {
            size: scene.camera.size(),
            pixels: film(&scene, &paths(2, 9), 8)
                .picture()
                .pixels
                .iter()
                .map(|pixel| pixel.map(|channel| 0.5 * channel + 0.2))
                .collect(),
        };
        let fields: Vec<String> = hair
            .values
            .fields()
            .iter()
            .map(|field| field.name.to_owned())
            .collect();
        let target = Target::new(&grey, crop, scene.camera.size()).expect("light");
        let variables = Variables::new(&hair.values, &[], &fields);
        let objective = Objective::new(target, hair.id, variables.clone());
        let paths = halves(&scene, &paths(2, 7), crop, 2);
        let x = vec![0.0; variables.len()];
        let distance = |x: &[f64]| objective.slope(&paths, x).expect("in range").distance;
        let found = objective.slope(&paths, &x).expect("in range").gradient;
        let largest = found.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (k, name) in variables.names().iter().enumerate() {
            let moved = |by: f64| {
                let mut x = x.clone();
                x[k] += by;
                distance(&x)
            };
            // Of fourth order, with a step that is long enough for single precision; half of it where a lobe is narrow, as R of d'Eon's far
            // field is at its edge.
            let [off, difference] = [4e-3, 2e-3]
                .map(|h| {
                    let near = moved(h) - moved(-h);
                    let far = moved(2.0 * h) - moved(-2.0 * h);
                    let difference = (8.0 * near - far) / (12.0 * h);
                    let off = (found[k] - difference).abs() / (difference.abs() + 0.01 * largest);
                    [off, difference]
                })
                .into_iter()
                .min_by(|a, b| a[0].total_cmp(&b[0]))
                .expect("two steps");
            println!(
                "{} {name}: {:.6e} {difference:.6e} {off:.1e}",
                id.name(),
                found[k]
            );
            assert!(
                off < 5e-4,
                "{} {name}: {} for {difference}",
                id.name(),
                found[k]
            );
        }
    }
}

/// Returns a close view of hair under lamps, with so few strands that each covers a pixel: part of a picture of four times the side.
fn close(hair: &Choice, strands: usize, side: u32) -> (Scene, Crop) {
    let hair = hair.hair(Energy::Raw).expect("in range");
    let scene = scene(Name::Lamps, hair, strands, 4 * side);
    let crop = Crop {
        x: 3 * side / 2,
        y: 3 * side / 4,
        width: side,
        height: side,
    };
    (scene, crop)
}

/// Returns hair whose shifts, widths and colours are off by factors of 0.7 or 1.3, as the bits of `signs` select.
fn off(hair: &Choice, signs: u64) -> Choice {
    let variables = Variables::new(&hair.values, &[], &[]);
    let factor = |k: usize| if signs >> k & 1 == 0 { 0.7_f64 } else { 1.3 };
    let x: Vec<f64> = (0..variables.len()).map(|k| factor(k).ln()).collect();
    // Colours are factors on TT.
    Choice {
        values: variables.values(&x),
        ..hair.clone()
    }
}

/// Numbers from which the factors are read: a shift, a width and the colour of TT.
const READ: [(&str, &str, usize); 5] = [
    ("alpha.R", "alpha", 0),
    ("beta.R", "beta", 0),
    ("i_tt.r", "i_tt", 0),
    ("i_tt.g", "i_tt", 1),
    ("i_tt.b", "i_tt", 2),
];

/// Picture of a preset, and the material it was rendered with.
struct Shown {
    truth: Choice,
    scene: Scene,
    target: Target,
}

fn shown(preset: &str, [strands, side, samples]: [u32; 3]) -> Shown {
    let truth = choice("gaussian", preset);
    let (scene, crop) = close(&truth, strands as usize, side);
    let picture = transport::film(&scene, &paths(2, 1000), crop, samples).picture();
    let target = Target::new(&picture, crop, scene.camera.size()).expect("light");
    Shown {
        truth,
        scene,
        target,
    }
}

/// Fits the hair of a picture from far away, and returns how far each number is off, relative to the truth, at the start and at the
/// end, with the standard error that the fit states.
fn recover(shown: &Shown, settings: &FitSettings) -> Vec<[f64; 3]> {
    let Shown {
        truth,
        scene,
        target,
    } = shown;
    let start = off(truth, settings.seed.wrapping_mul(0b01101));
    let found = fit(scene, &start, target, settings, &|_| ()).expect("fitted");
    let one = |(name, field, place): &(&str, &str, usize)| {
        let number = |values: &Values| f64::from(values.numbers(field)[*place]);
        let true_number = number(&truth.values);
        let relative = |values| number(values) / true_number - 1.0;
        let at = found.names.iter().position(|one| one == name);
        let error = found.errors[at.expect("a number that is fitted")] / true_number.abs();
        [relative(&start.values), relative(&found.values), error]
    };
    READ.iter().map(one).collect()
}

/// Returns a number of samples, of which there are `samples` in CI.
fn count(samples: u32) -> u32 {
    u32::try_from(cases(samples as usize)).expect("no more than in CI")
}

#[test]
fn a_picture_gives_its_material_back() {
    let settings = FitSettings {
        iterations: 12,
        samples: count(48),
        ..FitSettings::default()
    };
    let found = recover(&shown("red", [300, 96, count(512)]), &settings);
    for ([start, end, error], (name, ..)) in found.iter().zip(READ) {
        println!("{name}: {start:+.3} to {end:+.4}, {error:.4}");
    }
    // Errors are those of the samples: 0.03 with as many as in CI.
    let most = 0.03 * (48.0 / f64::from(settings.samples)).sqrt();
    for ([start, end, error], (name, ..)) in found.into_iter().zip(READ) {
        assert!(start.abs() > 0.25, "{name} begins at {start}");
        assert!(
            end.abs() < 0.03 && error < most,
            "{name}: {end} with an error of {error}"
        );
    }
}

/// Checks that a fit moves the colour that it starts from to that of a picture, and that a number without effect leaves others their errors.
#[test]
fn a_picture_gives_a_colour_back() {
    const TRUTH: [f32; 3] = [0.05, 0.02, 0.01];
    let base = choice("chiang", "default");
    let with = |name, numbers: &[f32]| Choice {
        values: base.values.with(name, numbers),
        ..base.clone()
    };
    let (scene, crop) = close(&with("color", &TRUTH), 300, 48);
    let picture = transport::film(&scene, &paths(2, 1000), crop, 256).picture();
    let target = Target::new(&picture, crop, scene.camera.size()).expect("light");
    let settings = FitSettings {
        fixed: ["beta_m", "beta_n", "tilt"].map(str::to_owned).into(),
        iterations: 8,
        samples: 16,
        ..FitSettings::default()
    };
    let run = |start, settings| fit(&scene, &start, &target, settings, &|_| ()).expect("fitted");
    let found = run(with("color", &[0.08, 0.014, 0.007]), &settings);
    assert_eq!(found.names, ["color.r", "color.g", "color.b"]);
    for (k, truth) in TRUTH.into_iter().map(f64::from).enumerate() {
        let [number, error] = [&found.numbers, &found.errors].map(|all| all[k] / truth);
        println!("{}: {number:.3}, {error:.3}", found.names[k]);
        assert!(
            (number - 1.0).abs() < 0.2 && error < 0.2,
            "{number} of the truth, with an error of {error}"
        );
    }
    // The largest amount is cut off, and has no effect from a little below on.
    let start = with("melanin_amount", &[1.0, 0.3]);
    let settings = FitSettings {
        fixed: Vec::new(),
        iterations: 3,
        ..settings.clone()
    };
    let cut = run(start, &settings);
    for (name, error) in cut.names.iter().zip(&cut.errors) {
        assert_eq!(
            error.is_finite(),
            name != "melanin_amount.amount",
            "{name}: {error}"
        );
    }
}

/// Recovers every preset from one picture, with five seeds and starts. Prints the errors, and writes them with `HAIRIS_RECORD=write`.
#[test]
#[ignore = "slow: 8 minutes on two idle cores"]
fn pictures_give_every_preset_back() {
    let presets: Vec<&str> = ModelId::Gaussian.presets().map(|(name, _)| name).collect();
    let pictures: Vec<Shown> = presets
        .iter()
        .map(|one| shown(one, [3000, 256, 128]))
        .collect();
    let (mut rows, mut ends) = (
        Vec::new(),
        vec![vec![Vec::new(); READ.len()]; presets.len()],
    );
    for seed in 1..=5 {
        for ((preset, picture), ends) in presets.iter().zip(&pictures).zip(&mut ends) {
            let settings = FitSettings {
                seed,
                ..FitSettings::default()
            };
            let found = recover(picture, &settings);
            for ((ends, (name, ..)), [start, end, error]) in ends.iter_mut().zip(READ).zip(found) {
                ends.push(end);
                let row = format!("{preset},{seed},{name},{start:.4},{end:.5},{error:.5}");
                println!("{row}");
                rows.push(row);
            }
        }
        if record::is_asked() {
            write_record(&rows);
        }
    }
    let mut far = Vec::new();
    for (preset, ends) in presets.iter().zip(ends) {
        for (ends, (name, ..)) in ends.into_iter().zip(READ) {
            let mean = ends.into_iter().collect::<Moments>().mean_estimate();
            println!(
                "{preset} {name}: {:+.4} ± {:.4}",
                mean.value, mean.standard_error
            );
            if mean.value.abs() >= 0.03 {
                far.push(format!("{preset} {name}"));
            }
        }
    }
    assert!(far.is_empty(), "further than 3% from the truth: {far:?}");
}

/// Writes the rows so far, after each seed.
fn write_record(rows: &[String]) {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../benches/records/pictures.csv"
    );
    let machine = hairis_instruments::machine!();
    let text = format!(
        "# CPU: any\n# {}\n# fits of 96 samples to one picture per preset of 256 x 256 pixels and 128 samples\n\
         # start, end: difference from the truth before and after, relative; error: the standard error that the fit states\n\
         preset,seed,number,start,end,error\n{}\n",
        machine.summary(),
        rows.join("\n")
    );
    fs::write(path, text).expect("written");
}
