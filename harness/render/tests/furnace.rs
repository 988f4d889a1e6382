//! Furnace tests: hair in a white sphere returns its albedo.

use crate::support::{film, hair, inclination, mean, scene};
use glam::Vec3;
use hairis_conformance::is_kept;
use hairis_instruments::stats::Moments;
use hairis_render::camera::Camera;
use hairis_render::film::Crop;
use hairis_render::hair::{Choice, Energy, default_sampler, samplers};
use hairis_render::material::{Hair, Sampling};
use hairis_render::numbers::Sequence;
use hairis_render::scene::{Met, Scene};
use hairis_render::scenes::Name;
use hairis_render::transport::{Mis, Settings, cut_off};
use hairis_render::tree::Meet;
use hairis_variants::ModelId;

/// Width and height of pictures of one strand.
const SIDE: u32 = 4;
const MIS: [Mis; 4] = [Mis::Light, Mis::Bsdf, Mis::Both, Mis::Resampled];

/// Returns the albedo of hair by the midpoint rule over the sphere of `wi`, independently of the samplers.
fn albedo(hair: &Hair, theta_o: f32, h: f32) -> f64 {
    use core::f32::consts::PI;
    let wo = Vec3::new(theta_o.sin(), theta_o.cos(), 0.0);
    let prepared = hair.prepare(hairis::Hit::new(wo, h));
    let (steps, turns) = (720_u16, 720_u16);
    let mut sum = 0.0;
    for i in 0..steps {
        let theta = ((f32::from(i) + 0.5) / f32::from(steps) - 0.5) * PI;
        for j in (0..turns).step_by(8) {
            let wi: [Vec3; 8] = core::array::from_fn(|lane| {
                let phi = (f32::from(j) + lane as f32 + 0.5) / f32::from(turns) * 2.0 * PI;
                Vec3::new(
                    theta.sin(),
                    theta.cos() * phi.cos(),
                    theta.cos() * phi.sin(),
                )
            });
            let green = prepared.eval8(&wi.into()).value[1].to_array();
            sum += f64::from(green.iter().sum::<f32>()) * f64::from(theta.cos().powi(2));
        }
    }
    let (d_theta, d_phi) = (
        core::f64::consts::PI / f64::from(steps),
        core::f64::consts::TAU / f64::from(turns),
    );
    sum * d_theta * d_phi
}

/// Returns the scene `furnace-one`, whose strand is seen at an inclination.
fn strand(hair: Hair, theta_o: f32) -> Scene {
    let mut one = scene(Name::FurnaceOne, hair, 1, SIDE);
    let eye = 100.0 * Vec3::new(theta_o.sin(), 0.0, theta_o.cos());
    one.camera = Camera::new(eye, Vec3::ZERO, 1.5, [SIDE; 2]);
    one
}

#[test]
fn every_pixel_of_a_strand_is_its_albedo_with_every_sampler_and_weighting() {
    const RUNS: u64 = 16;
    for (i, theta_o) in [0.0, 0.5, -1.0].into_iter().enumerate() {
        let mut one = strand(hair("gaussian", "matched", "white"), theta_o);
        let pixels: Vec<[u32; 2]> = Crop::whole([SIDE; 2]).pixels().collect();
        let expected: Vec<f64> = pixels
            .iter()
            .map(|[x, y]| albedo(&one.hair, inclination(&one, *x, *y), 0.0))
            .collect();
        for (j, sampler) in samplers("gaussian").into_iter().enumerate() {
            one.hair = hair("gaussian", sampler, "white");
            for (k, mis) in MIS.into_iter().enumerate() {
                if !is_kept(i + j + k) {
                    continue;
                }
                // Uniform directions, of the hair or of the white sphere alone, have the largest variance.
                let samples = if sampler == "uniform" || matches!(mis, Mis::Light) {
                    256
                } else {
                    64
                };
                let mut moments = vec![Moments::new(); pixels.len()];
                for seed in 0..RUNS {
                    let settings = Settings {
                        mis,
                        sequence: Sequence::Independent,
                        seed: 100 + seed,
                        ..Settings::default()
                    };
                    let picture = film(&one, &settings, samples).picture();
                    moments
                        .iter_mut()
                        .zip(&picture.pixels)
                        .for_each(|(moments, pixel)| moments.push(pixel[1]));
                }
                // Pixels differ by less than the width of a lobe: they share a variance, known from all of them.
                let variance =
                    moments.iter().map(Moments::variance).sum::<f64>() / moments.len() as f64;
                let error = (variance / RUNS as f64).sqrt();
                for (k, expected) in expected.iter().enumerate() {
                    let (got, what) = (
                        moments[k].mean(),
                        format!("{theta_o} {sampler} {mis:?} {:?}", pixels[k]),
                    );
                    let apart = (got - expected).abs();
                    // Single precision, and the pixel's width in inclinations, show where the noise is less.
                    assert!(
                        apart < 4.0 * error || apart < 1e-3 * expected,
                        "{what}: {got} ± {error} for {expected}"
                    );
                    assert!(error < 0.06 * expected, "{what}: {got} ± {error}");
                }
            }
        }
    }
}

#[test]
fn every_model_returns_its_albedo_near_field_ones_by_offset() {
    for id in ModelId::defaults_of_names() {
        let mut one = strand(hair(id.name(), "published", "default"), 0.4);
        // Off the centre, where the offset is large: 7 of a radius of 10.
        one.camera = Camera::new(
            Vec3::new(40.0, 7.0, 92.0),
            Vec3::new(0.0, 7.0, 0.0),
            0.5,
            [8, 8],
        );
        let Met::Hair(hit) = one.closest(&one.camera.ray(4.0, 4.0)) else {
            panic!("no hair in the middle")
        };
        assert!((hit.h.abs() - 0.7).abs() < 0.02, "h {}", hit.h);
        let expected = albedo(&one.hair, inclination(&one, 4, 4), hit.h);
        let got = mean(&one, &Settings::default(), 64, 16, 1);
        let close = (got.value / expected - 1.0).abs() < 2e-3;
        assert!(
            close || got.z_score(expected).abs() < 4.0,
            "{}: {got:?} for {expected}",
            id.name()
        );
        if id.is_near_field() {
            let other = albedo(&one.hair, inclination(&one, 4, 4), -hit.h);
            let middle = albedo(&one.hair, inclination(&one, 4, 4), 0.0);
            assert!(
                (middle / expected - 1.0).abs() > 5e-3,
                "the offset shows: {middle} {other} {expected}"
            );
        }
    }
}

/// Checks that a channel of pictures has the white sphere's mean, with a standard error below `most`.
fn check_invisible(scene: &Scene, settings: &Settings, channel: usize, most: f64) {
    let got = mean(scene, settings, 4, 16, channel);
    let (mis, roulette) = (settings.mis, settings.roulette);
    let exact = (got.value - 1.0).abs() < 1e-4;
    assert!(
        exact || got.z_score(1.0).abs() < 4.0,
        "{mis:?}, roulette {roulette}, channel {channel}: {got:?}"
    );
    assert!(got.standard_error < most, "{mis:?}: {got:?}");
}

#[test]
fn hair_that_absorbs_nothing_is_invisible() {
    let iso = scene(Name::FurnaceIso, Hair::Isotropic, 1500, 16);
    let hits = (0..16)
        .filter(|k| matches!(iso.closest(&iso.camera.ray(*k as f32, 8.0)), Met::Hair(_)))
        .count();
    assert!(hits > 8, "{hits} of 16 rays meet hair");
    for mis in MIS {
        for roulette in [false, true] {
            let settings = Settings {
                roulette,
                mis,
                ..Settings::default()
            };
            check_invisible(&iso, &settings, 1, 0.02);
        }
    }
}

/// Checks that every path of unscaled weights finds the white sphere, without roulette and with it, because
/// roulette ends no path that nothing has absorbed.
#[test]
fn no_pixel_of_hair_that_absorbs_nothing_has_noise() {
    let with_roulette = Settings {
        mis: Mis::Bsdf,
        ..Settings::default()
    };
    let endless = Settings {
        depth: Some(1000),
        roulette: false,
        ..with_roulette
    };
    for (strands, hair, settings) in [
        (1500, Hair::Isotropic, endless),
        (300, Hair::Isotropic, with_roulette),
        (1500, clear(), with_roulette),
    ] {
        let scene = scene(Name::FurnaceIso, hair, strands, 16);
        let picture = film(&scene, &settings, 8).picture();
        for (place, pixel) in picture.pixels.iter().enumerate() {
            let apart = pixel.map(|channel| (channel - 1.0).abs());
            assert!(
                apart.iter().all(|apart| *apart < 1e-4),
                "roulette {}, pixel {place}: {pixel:?}",
                settings.roulette
            );
        }
    }
}

/// Returns Chiang's fibre without absorption.
fn clear() -> Hair {
    let id = ModelId::Chiang;
    let values = id.defaults().with("sigma_a", &[0.0; 3]);
    let material = id.material(&values).expect("in range");
    Hair::Model(material, Sampling::Own, 1.0)
}

#[test]
fn clear_hair_is_invisible_whatever_counts() {
    let scene = scene(Name::FurnaceIso, clear(), 1500, 16);
    let mut tubes = scene.clone();
    tubes.tree = tubes.tree.with_meet(Meet::Surface);
    let all = MIS.map(|mis| (&scene, mis));
    for (scene, mis) in all.into_iter().chain([(&tubes, Mis::Both)]) {
        let settings = Settings {
            mis,
            ..Settings::default()
        };
        for channel in 0..3 {
            // The white sphere alone, sampled uniformly, is a poor guide to the narrow lobes.
            let most = if mis == Mis::Light { 0.06 } else { 0.02 };
            check_invisible(scene, &settings, channel, most);
        }
    }
}

#[test]
fn light_beyond_the_depth_is_estimated() {
    let scene = scene(Name::FurnaceIso, clear(), 1500, 16);
    let lost = |depth: Option<u32>, samples: u32| {
        let settings = Settings {
            depth,
            mis: Mis::Bsdf,
            ..Settings::default()
        };
        let film = film(&scene, &settings, samples);
        (film.picture().mean(), cut_off(&scene, &settings, &film))
    };
    assert_eq!(lost(None, 4).1, None, "paths of any length");
    // A picture of few samples, whose paths are all followed: the missing light to the last bit of
    // a sum, in every channel.
    let (seen, of_all) = lost(Some(8), 4);
    let of_all = of_all.expect("a depth");
    for (share, seen) in of_all.shares().iter().zip(seen) {
        assert!(
            (share.value - (1.0 - seen)).abs() < 1e-4,
            "{seen} {share:?}"
        );
        assert!(share.value > 0.1, "it shows: {share:?}");
    }
    assert!(of_all.is_notable());
    let line = of_all.to_string();
    assert!(
        line.starts_with("--depth 8 leaves out ") && !line.contains('\n'),
        "{line}"
    );
    // One of more samples than are followed.
    let (seen, of_some) = lost(Some(8), 256);
    for (share, seen) in of_some.expect("a depth").shares().iter().zip(seen) {
        let got = share.z_score(1.0 - seen).abs();
        assert!(got < 4.0 && share.standard_error < 5e-3, "{seen} {share:?}");
    }
    let (_, nothing) = lost(Some(10_000), 4);
    assert!(!nothing.expect("a depth").is_notable());
}

#[test]
fn presets_converge_and_scaled_hair_never_shines() {
    let scaled = |model: &str, preset: &str| {
        let choice = Choice::find(model, default_sampler(model), preset).expect("listed");
        let scaled = scene(
            Name::FurnaceIso,
            choice.hair(Energy::Scaled).expect("in range"),
            600,
            8,
        );
        for channel in 0..3 {
            let got = mean(&scaled, &Settings::default(), 8, 8, channel);
            assert!(
                got.value < 1.0 + 4.0 * got.standard_error + 1e-5,
                "{model} {preset}: {got:?}"
            );
        }
    };
    for id in ModelId::defaults_of_names() {
        id.presets()
            .for_each(|(preset, _)| scaled(id.name(), preset));
    }
    scaled("gaussian", "glossy");
    for preset in ["blond", "brown", "red", "black", "white"] {
        let choice = Choice::find("gaussian", "matched", preset).expect("listed");
        let [mean_albedo, _] = choice
            .hair(Energy::Raw)
            .expect("in range")
            .mean_and_worst_albedo();
        assert!(
            mean_albedo < hairis_render::hair::MOST_MEAN_ALBEDO || preset == "white",
            "{preset}: {mean_albedo}"
        );
    }
    // Paths of the lightest hair that renders as it is: the same numbers, so that the difference is what long paths add.
    let raw = scene(
        Name::FurnaceIso,
        hair("gaussian", "matched", "blond"),
        600,
        12,
    );
    let settings = |depth| Settings {
        depth,
        ..Settings::default()
    };
    let [short, long] =
        [Some(64), Some(128)].map(|depth| film(&raw, &settings(depth), 64).picture().mean()[0]);
    assert!((long - short).abs() < 1e-3, "depth 64 {short}, 128 {long}");
}
