//! Scenes and means of pictures for the tests of transport.

use glam::Vec3;
use hairis_instruments::stats::{Estimate, Moments};
use hairis_render::film::{Crop, Film};
use hairis_render::hair::{Choice, Energy};
use hairis_render::material::Hair;
use hairis_render::scene::Scene;
use hairis_render::scenes::{self, Name, Parts};
use hairis_render::transport::{self, Settings};

/// Returns hair by the names of its model, sampler and preset.
pub(crate) fn hair(model: &str, sampler: &str, preset: &str) -> Hair {
    hair_of([model, sampler, preset], Energy::Raw)
}

/// Returns hair like [`hair`], with an energy.
pub(crate) fn hair_of([model, sampler, preset]: [&str; 3], energy: Energy) -> Hair {
    let choice = Choice::find(model, sampler, preset).expect("listed");
    choice.hair(energy).expect("in range")
}

/// Returns a scene with little hair in a small picture.
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

/// Renders the whole picture of a scene, and returns its film.
pub(crate) fn film(scene: &Scene, settings: &Settings, samples: u32) -> Film {
    transport::film(scene, settings, Crop::whole(scene.camera.size()), samples)
}

/// Returns the mean of a channel over the picture, from renders with `runs` seeds, with its standard error.
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

/// Returns the distance of two independent estimates in standard errors.
pub(crate) fn distance(a: &Estimate, b: &Estimate) -> f64 {
    (a.value - b.value).abs() / a.standard_error.hypot(b.standard_error)
}

/// Returns the inclination, in rad, of the direction from a pixel's centre to the camera, for fibres along x.
pub(crate) fn inclination(scene: &Scene, x: u32, y: u32) -> f32 {
    let ray = scene.camera.ray(x as f32 + 0.5, y as f32 + 0.5);
    (-ray.direction).dot(Vec3::X).asin()
}
