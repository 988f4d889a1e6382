//! Scenes and means of pictures for the tests of transport.

use glam::Vec3;
use hairis_instruments::stats::{Estimate, Moments};
use hairis_render::film::{Crop, Film};
use hairis_render::hair::{Choice, Energy};
use hairis_render::material::Hair;
use hairis_render::scene::Scene;
use hairis_render::scenes::{self, Name, Parts};
use hairis_render::transport::{self, Settings};

/// Hair by name.
pub(crate) fn hair(model: &str, sampler: &str, preset: &str) -> Hair {
    Choice::find(model, sampler, preset)
        .expect("listed")
        .hair(Energy::Raw)
        .expect("in range")
}

/// A scene with little hair in a small picture.
pub(crate) fn scene(name: Name, hair: Hair, strands: usize, side: u32) -> Scene {
    let strands = scenes::grow(name, strands).expect("a few strands");
    let parts = Parts {
        strands,
        imported: false,
        head: None,
        hair,
        env: None,
        size: [side, side],
        turn: 0.0,
    };
    scenes::build(name, parts).expect("a scene")
}

/// A film of the whole picture.
pub(crate) fn film(scene: &Scene, settings: &Settings, samples: u32) -> Film {
    transport::film(scene, settings, Crop::whole(scene.camera.size()), samples)
}

/// Mean of a channel over the picture, from renders with `runs` seeds, with its standard error.
pub(crate) fn mean(
    scene: &Scene,
    settings: &Settings,
    samples: u32,
    runs: u64,
    channel: usize,
) -> Estimate {
    let one = |run| {
        film(
            scene,
            &Settings {
                seed: 100 * settings.seed + run,
                ..*settings
            },
            samples,
        )
    };
    (0..runs)
        .map(|run| one(run).picture().mean()[channel])
        .collect::<Moments>()
        .mean_estimate()
}

/// Distance of two independent estimates in standard errors.
pub(crate) fn distance(a: &Estimate, b: &Estimate) -> f64 {
    (a.value - b.value).abs() / a.standard_error.hypot(b.standard_error)
}

/// The direction from the hair of a pixel's centre to the camera, in the frame of fibres along x.
pub(crate) fn inclination(scene: &Scene, x: u32, y: u32) -> f32 {
    let ray = scene.camera.ray(x as f32 + 0.5, y as f32 + 0.5);
    (-ray.direction).dot(Vec3::X).asin()
}
