//! Bits of pictures, which depend on the seed and not on the threads.

use crate::support::{film, hair, scene};
use glam::Vec3;
use hairis_render::film::{Crop, Film};
use hairis_render::scene::Scene;
use hairis_render::scenes::Name;
use hairis_render::transport::{self, Integrator, Mis, Settings};

/// Returns the sums of a film as bits, which must not depend on the machine's load.
fn sums(film: &Film) -> Vec<(Crop, u32, Vec<[u64; 4]>)> {
    let bits = |sums: &hairis_render::film::Sums| {
        let [r, g, b] = sums.radiance.map(f64::to_bits);
        [r, g, b, sums.luminance_sq.to_bits()]
    };
    film.tiles
        .iter()
        .map(|tile| {
            (
                tile.place,
                tile.samples,
                tile.sums.iter().map(bits).collect(),
            )
        })
        .collect()
}

#[test]
fn threads_passes_and_crops_do_not_show() {
    let cases = [
        (Name::Head, Integrator::Path, Mis::Both),
        (Name::Head, Integrator::Gather, Mis::Both),
        (Name::Head, Integrator::Gather, Mis::Resampled),
        (Name::Env, Integrator::Gather, Mis::Resampled),
        (Name::Env, Integrator::Path, Mis::Resampled),
    ];
    for (name, integrator, mis) in cases {
        let one = scene(name, hair("gaussian", "matched", "blond"), 800, 70);
        let settings = Settings {
            integrator,
            mis,
            ..Settings::default()
        };
        let whole = Crop::whole([70, 70]);
        let all: Vec<_> = [1, 2, 7]
            .map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new()
                    .num_threads(threads)
                    .build()
                    .expect("threads");
                sums(&pool.install(|| film(&one, &settings, 6)))
            })
            .into();
        assert!(
            all[0] == all[1] && all[0] == all[2],
            "{integrator:?}, {mis:?}: threads show"
        );
        let mut bit_by_bit = Film::new(whole);
        for samples in [1, 3, 6] {
            transport::render(&one, &settings, &mut bit_by_bit, samples, &|_| ());
        }
        assert_eq!(
            sums(&bit_by_bit),
            all[0],
            "{integrator:?}, {mis:?}: passes show"
        );
        let crop = Crop {
            x: 21,
            y: 30,
            width: 13,
            height: 11,
        };
        let part = transport::film(&one, &settings, crop, 6).picture();
        let picture = film(&one, &settings, 6).picture();
        for [x, y] in crop.pixels() {
            assert_eq!(
                part.at(x - crop.x, y - crop.y),
                picture.at(x, y),
                "{integrator:?}, {mis:?}: the crop shows at {x} {y}"
            );
        }
        assert!(picture.mean()[0] > 1e-3);
    }
}

#[test]
fn many_samples_are_those_of_passes() {
    for (mis, rays) in [
        (Mis::Both, 1),
        (Mis::Both, 3),
        (Mis::Resampled, 1),
        (Mis::Resampled, 3),
    ] {
        let one = scene(Name::Env, hair("gaussian", "matched", "blond"), 800, 12);
        let settings = Settings {
            integrator: Integrator::Gather,
            mis,
            rays,
            ..Settings::default()
        };
        // Whole pools of resampled rays and others, and a second table of the sky.
        let mut film = Film::new(Crop::whole([12, 12]));
        for samples in [32, 45, 64, 550] {
            transport::render(&one, &settings, &mut film, samples, &|_| ());
        }
        let at_once = transport::film(&one, &settings, Crop::whole([12, 12]), 550);
        assert!(
            sums(&film) == sums(&at_once),
            "{mis:?}, {rays} rays: passes show"
        );
        assert_eq!(film.samples(), 550);
    }
}

#[test]
fn the_variance_of_a_shading_point_is_that_of_its_samples() {
    // With one camera ray, too. Over seeds of independent numbers, as a sum over pixels.
    let one = scene(
        Name::AreaHead,
        hair("gaussian", "uniform", "blond"),
        800,
        12,
    );
    let (mut expected, mut pictures) = (0.0, Vec::new());
    for seed in 0..64 {
        let sequence = hairis_render::numbers::Sequence::Independent;
        let settings = Settings {
            integrator: Integrator::Gather,
            sequence,
            seed,
            ..Settings::default()
        };
        let film = film(&one, &settings, 8);
        let beside = hairis_render::layers::Beside::film(&film, "");
        let variance = beside
            .channels
            .iter()
            .find(|channel| channel.name == "variance")
            .expect("a layer");
        // Bessel's correction, which the layer goes without.
        expected += variance.pixels.iter().map(|x| f64::from(*x)).sum::<f64>() * 8.0 / 7.0 / 64.0;
        pictures.push(film.picture().luminances());
    }
    let of_pixel = |k: usize| {
        let mean = pictures.iter().map(|picture| picture[k]).sum::<f64>() / 64.0;
        pictures
            .iter()
            .map(|picture| (picture[k] - mean).powi(2))
            .sum::<f64>()
            / 63.0
    };
    let got: f64 = (0..144).map(of_pixel).sum();
    assert!(
        got > 0.0 && (expected / got - 1.0).abs() < 0.2,
        "{expected} for {got}"
    );
}

#[test]
fn a_backdrop_is_seen_beside_the_hair_and_lights_nothing() {
    for integrator in [Integrator::Gather, Integrator::Path] {
        let one = scene(Name::Env, hair("gaussian", "matched", "blond"), 800, 24);
        let other = Scene {
            backdrop: Some(Vec3::splat(0.25)),
            ..one.clone()
        };
        let settings = Settings {
            integrator,
            ..Settings::default()
        };
        let [under_sky, before] = [&one, &other].map(|scene| film(scene, &settings, 4).picture());
        assert_eq!(before.at(0, 0), [0.25; 3], "{integrator:?}: a corner");
        assert_eq!(
            before.at(12, 12),
            under_sky.at(12, 12),
            "{integrator:?}: the head"
        );
    }
}
