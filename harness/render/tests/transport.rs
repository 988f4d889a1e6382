//! Comparison of light drawn from tables with light drawn at each point.

mod profile;
mod resampled;

use glam::Vec3;
use hairis::simd::f32x8;
use hairis_conformance::cases;
use hairis_instruments::light::{Environment, rounded};
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_instruments::stats::{Estimate, Moments};
use hairis_render::film::{Crop, Film};
use hairis_render::hair::{Choice, Energy};
use hairis_render::lights::{LightSample8, Rectangle, Table};
use hairis_render::scene::Scene;
use hairis_render::scenes::{self, Name, Parts};
use hairis_render::transport::{Integrator, Mis, Settings, render_by_tables, tables};
use rayon::prelude::*;

/// Returns a few strands on a head under a map with bright texels, with or without two lamps.
fn under_map(lamps: bool) -> Scene {
    let mut xi = Independent::new(21, 0);
    let bright = |k: usize| {
        if matches!(k, 70 | 137 | 300) {
            60.0
        } else {
            1.0
        }
    };
    let pixels = (0..512)
        .map(|k| xi.next_xi_f32::<3>().map(|x| bright(k) * x))
        .collect();
    let env = Environment::from_pixels("small", 32, 16, pixels).expect("valid");
    let hair = Choice::find("gaussian", "matched", "blond")
        .and_then(|hair| hair.hair(Energy::Raw))
        .expect("listed");
    let strands = scenes::grow(Name::Env, 1500).expect("a few");
    let parts = Parts {
        strands,
        imported: false,
        head: None,
        hair,
        env: Some(env),
        size: [32; 2],
        turn: 0.0,
    };
    let mut scene = scenes::build(Name::Env, parts).expect("a scene");
    if lamps {
        for x in [-30.0, 20.0] {
            let corner = Vec3::new(x, 20.0, 10.0);
            let lamp = Rectangle::light(
                corner,
                10.0 * Vec3::X,
                Vec3::new(0.0, 6.0, 8.0),
                Vec3::splat(20.0),
            );
            scene.rectangles.push(lamp.facing(Vec3::ZERO));
        }
    }
    scene
}

/// Number of pictures of a mean, of which there are 200 in CI.
fn seeds() -> usize {
    cases(200)
}

/// Returns the error of a mean that has `error` with 200 pictures.
fn scaled(error: f64) -> f64 {
    error * (200.0 / seeds() as f64).sqrt()
}

/// Returns the mean luminance of pictures of many seeds, whose first tables have densities that are wrong by a factor.
fn mean(scene: &Scene, integrator: Integrator, mis: Mis, samples: u32, factor: f64) -> Estimate {
    let luminance = |seed: u64| -> f64 {
        let settings = Settings {
            integrator,
            mis,
            seed,
            ..Settings::default()
        };
        let mut tables = tables(scene, &settings);
        if factor != 1.0 {
            let table = Table::draw(&scene.sky, seed, tables.length()).expect("a sky");
            let scaled = |block: &LightSample8| LightSample8 {
                pdf: block.pdf * f32x8::splat(rounded(factor)),
                ..*block
            };
            let scaled: Vec<_> = table.blocks().iter().map(scaled).collect();
            tables = tables.with_first(Some(scaled.into()));
        }
        let mut film = Film::new(Crop::whole(scene.camera.size()));
        render_by_tables(
            scene,
            &tables,
            &settings,
            &mut film,
            samples,
            &|_| (),
            &|| false,
        );
        film.picture().luminances().iter().sum()
    };
    let all: Vec<f64> = (0..seeds() as u64).into_par_iter().map(luminance).collect();
    all.into_iter().collect::<Moments>().mean_estimate()
}

/// Returns the distance of two estimates in standard errors.
fn apart(a: &Estimate, b: &Estimate) -> f64 {
    (a.value - b.value) / a.standard_error.hypot(b.standard_error)
}

#[test]
fn candidates_from_a_table_are_unbiased() {
    let gather =
        |scene: &Scene, mis, samples, factor| mean(scene, Integrator::Gather, mis, samples, factor);
    for lamps in [false, true] {
        let scene = under_map(lamps);
        let expected = gather(&scene, Mis::Both, 32, 1.0);
        // Whole blocks of candidates, incomplete ones, a pool of 32 rays and one of 11.
        for samples in [16, 5, 43] {
            let got = gather(&scene, Mis::Resampled, samples, 1.0);
            assert!(got.standard_error < scaled(3e-3) * got.value, "{got:?}");
            assert!(
                apart(&got, &expected).abs() < 4.0,
                "{samples} rays, lamps {lamps}: {got:?} for {expected:?}"
            );
        }
        let fault = scaled(0.02);
        let wrong = gather(&scene, Mis::Resampled, 32, 1.0 + fault);
        assert!(
            lamps || apart(&wrong, &expected) < -4.0,
            "a density that is wrong by {fault} shows: {wrong:?} for {expected:?}"
        );
    }
}

#[test]
fn paths_have_the_same_light_from_a_table() {
    for lamps in [false, true] {
        let scene = under_map(lamps);
        // Samples of two passes, the second incomplete.
        let [got, expected] =
            [Mis::Resampled, Mis::Both].map(|mis| mean(&scene, Integrator::Path, mis, 6, 1.0));
        assert!(got.standard_error < scaled(1e-2) * got.value, "{got:?}");
        assert!(
            apart(&got, &expected).abs() < 4.0,
            "lamps {lamps}: {got:?} for {expected:?}"
        );
    }
}
