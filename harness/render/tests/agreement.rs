//! Comparison of pictures that must agree, whatever they are rendered with.

use crate::support::{distance, film, hair, mean, scene};
use glam::Vec3;
use hairis_conformance::is_kept;
use hairis_render::camera::Camera;
use hairis_render::geometry::Strands;
use hairis_render::hair::samplers;
use hairis_render::lights::{Rectangle, RectangleSampling};
use hairis_render::material::{Hair, Sampling};
use hairis_render::numbers::Sequence;
use hairis_render::scene::Scene;
use hairis_render::scenes::Name;
use hairis_render::transport::{Integrator, Mis, Settings};
use hairis_render::tree::Tree;
use hairis_variants::ModelId;

/// Number of seeds of each mean.
const RUNS: u64 = 16;

#[test]
fn samplers_weightings_and_sequences_agree() {
    let cases = [
        (Name::AreaSoft, Integrator::Gather, "default", 400, 16),
        (Name::AreaHead, Integrator::Direct, "brown", 1500, 16),
        (Name::Env, Integrator::Gather, "brown", 1500, 8),
        (Name::Box, Integrator::Path, "brown", 1500, 8),
        (Name::Area, Integrator::Gather, "glossy", 400, 16),
        (Name::BoxSingle, Integrator::Path, "brown", 800, 8),
        (Name::Head, Integrator::Path, "brown", 800, 8),
        (Name::FurnaceOne, Integrator::Path, "brown", 1, 8),
        (Name::FurnaceIso, Integrator::Path, "brown", 400, 8),
    ];
    for (k, (name, integrator, preset, strands, samples)) in cases.into_iter().enumerate() {
        let mut one = scene(name, hair("gaussian", "matched", preset), strands, 16);
        let multiple = name.defaults().multiple;
        let base = Settings {
            integrator,
            multiple,
            seed: 1,
            ..Settings::default()
        };
        let expected = mean(&one, &base, 2 * samples, RUNS, 1);
        // Other checks are kept on each scene.
        let (mut seed, mut number) = (1, k);
        let mut check = |one: &Scene, what: &str, settings: Settings| {
            seed += 1;
            number += 1;
            if !is_kept(number) {
                return;
            }
            let got = mean(one, &Settings { seed, ..settings }, samples, RUNS, 1);
            let apart = distance(&got, &expected);
            assert!(
                apart < 4.0,
                "{name:?}, {what}: {got:?} for {expected:?}, {apart} standard errors apart"
            );
            // Noise must not hide a fault: a mean is known to a tenth.
            assert!(
                got.standard_error < 0.1 * expected.value,
                "{name:?}, {what}: {got:?}"
            );
        };
        for mis in [Mis::Light, Mis::Bsdf, Mis::Resampled] {
            // Directions drawn from the hair rarely find the sun.
            if name != Name::Env || mis != Mis::Bsdf {
                check(&one, &format!("{mis:?}"), Settings { mis, ..base });
            }
        }
        for sequence in [
            Sequence::Independent,
            Sequence::Halton,
            Sequence::Stratified,
        ] {
            check(
                &one,
                &format!("{sequence:?}"),
                Settings { sequence, ..base },
            );
        }
        if !one.rectangles.is_empty() {
            one.rectangle_sampling = RectangleSampling::Area;
            for mis in [Mis::Both, Mis::Light, Mis::Resampled] {
                check(&one, &format!("by area, {mis:?}"), Settings { mis, ..base });
            }
            one.rectangle_sampling = RectangleSampling::SolidAngle;
        }
        for sampler in samplers("gaussian") {
            one.hair = hair("gaussian", sampler, preset);
            check(&one, sampler, base);
        }
    }
}

#[test]
fn every_model_renders() {
    for id in ModelId::ALL {
        let word = id.choice().map_or("published", |(_, word)| word);
        let one = scene(Name::Head, hair(id.name(), word, "brown"), 500, 12);
        let mean = film(&one, &Settings::default(), 4).picture().mean();
        assert!(
            mean.iter()
                .all(|channel| channel.is_finite() && *channel > 1e-3),
            "{id:?}: {mean:?}"
        );
    }
}

#[test]
fn samplers_agree() {
    let means = ["published", "matched"].map(|word| {
        let one = scene(Name::AreaHead, hair("cauchy", word, "brown"), 800, 12);
        let settings = Settings {
            integrator: Integrator::Direct,
            seed: word.len() as u64,
            ..Settings::default()
        };
        mean(&one, &settings, 16, RUNS, 1)
    });
    assert!(distance(&means[0], &means[1]) < 4.0, "{means:?}");
}

/// Returns the scene mirrored in x, by rebuilding its strands; `swap` turns every strand around.
fn rebuilt(scene: &Scene, mirror: bool, swap: bool) -> Scene {
    let turned = |v: Vec3| if mirror { Vec3::new(-v.x, v.y, v.z) } else { v };
    let mut builder = Strands::builder();
    for strand in 0..u32::try_from(scene.strands.strands()).expect("few") {
        let nodes = scene.strands.nodes_of(strand);
        let segments = nodes.start..nodes.end - 1;
        let mut polyline: Vec<(Vec3, f32)> = segments
            .clone()
            .map(|segment| {
                (
                    turned(scene.strands.position(segment, 0.0)),
                    scene.strands.radius(segment, 0.0),
                )
            })
            .collect();
        let last = segments.end - 1;
        polyline.push((
            turned(scene.strands.position(last, 1.0)),
            scene.strands.radius(last, 1.0),
        ));
        if swap {
            polyline.reverse();
        }
        builder.push(polyline).expect("as before");
    }
    let strands = builder.finish();
    let tree = Tree::build(&strands).expect("as before");
    let mut other = Scene {
        strands,
        tree,
        ..scene.clone()
    };
    if mirror {
        other.camera = scene.camera.mirrored();
        other.rectangles = scene.rectangles.iter().map(Rectangle::mirrored).collect();
    }
    other
}

/// Returns the means of the left and of the right half of a picture, over seeds.
fn halves(scene: &Scene, seed: u64) -> [hairis_instruments::stats::Estimate; 2] {
    let settings = Settings {
        integrator: Integrator::Direct,
        ..Settings::default()
    };
    let mut sums = [hairis_instruments::stats::Moments::new(); 2];
    for run in 0..RUNS {
        let picture = film(
            scene,
            &Settings {
                seed: seed + run,
                ..settings
            },
            16,
        )
        .picture();
        let [width, height] = picture.size;
        for (half, sum) in sums.iter_mut().enumerate() {
            let columns = (0..width).filter(|x| usize::from(*x >= width / 2) == half);
            let total: f64 = columns
                .flat_map(|x| (0..height).map(move |y| [x, y]))
                .map(|[x, y]| picture.at(x, y)[1])
                .sum();
            sum.push(total / f64::from(width * height));
        }
    }
    sums.map(|sum| sum.mean_estimate())
}

/// Returns a head lit from the side, so that its halves differ.
fn lopsided(hair: Hair) -> Scene {
    let mut one = scene(Name::AreaHead, hair, 1200, 16);
    one.rectangles = vec![Rectangle::light(
        Vec3::new(20.0, 5.0, 10.0),
        Vec3::new(0.0, 20.0, 0.0),
        20.0 * Vec3::Z,
        Vec3::splat(6.0),
    )];
    one
}

#[test]
fn a_mirrored_scene_gives_the_mirror_image() {
    let one = lopsided(hair("gaussian", "matched", "brown"));
    let [left, right] = halves(&one, 1);
    let [other_left, other_right] = halves(&rebuilt(&one, true, false), 101);
    assert!(
        distance(&left, &other_right) < 4.0 && distance(&right, &other_left) < 4.0,
        "{left:?} {other_right:?}"
    );
    assert!(
        distance(&left, &right) > 8.0,
        "the halves differ: {left:?} {right:?}"
    );
}

/// Returns parallel strands seen across, with a small light at an inclination of -0.2 rad: half the sum of the inclinations is -0.1,
/// and all lobes are shifted by `alpha`.
fn at_the_highlight(alpha: f32) -> Scene {
    let id = ModelId::find("gaussian", Some("matched")).expect("listed");
    let values = id
        .presets()
        .find(|(name, _)| *name == "brown")
        .expect("listed")
        .1
        .with("alpha", &[alpha; 3]);
    let hair = Hair::Model(id.material(&values).expect("in range"), Sampling::Own, 1.0);
    let mut one = scene(Name::AreaSoft, hair, 400, 16);
    one.camera = Camera::new(Vec3::new(0.0, 60.0, 80.0), Vec3::NEG_Y, 3.0, [16, 16]);
    let (sin, cos) = 0.2_f32.sin_cos();
    let corner = 60.0 * Vec3::new(-sin, 0.8 * cos, 0.6 * cos) - Vec3::new(2.0, 0.0, 2.0);
    one.rectangles = vec![Rectangle::light(
        corner,
        4.0 * Vec3::X,
        4.0 * Vec3::Z,
        Vec3::splat(100.0),
    )];
    one
}

#[test]
fn the_direction_of_strands_shows_where_lobes_are_shifted_alone() {
    let one = at_the_highlight(-0.1);
    let [a, b] = [halves(&one, 1), halves(&rebuilt(&one, false, true), 201)];
    for half in 0..2 {
        let darker = a[half].value > 1.1 * b[half].value && distance(&a[half], &b[half]) > 6.0;
        assert!(darker, "root and tip swapped: {a:?} {b:?}");
    }
    let one = at_the_highlight(0.0);
    let [a, b] = [halves(&one, 301), halves(&rebuilt(&one, false, true), 401)];
    assert!(
        distance(&a[1], &b[1]) < 4.0 && distance(&a[0], &b[0]) < 4.0,
        "no shifts: {a:?} {b:?}"
    );
}
