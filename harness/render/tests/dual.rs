//! Dual scattering against paths of any length.

use crate::support::{film, hair_of, scene};
use hairis_render::hair::Energy;
use hairis_render::scene::{Met, Scene};
use hairis_render::scenes::Name;
use hairis_render::transport::{Integrator, Mis, Settings};
use std::process::Command;

/// Scene, model and sampler, and colour.
type Case<'a> = (Name, [&'a str; 2], &'a str);

/// Comparison of two pictures of one scene on the pixels whose centre shows hair.
struct Compared {
    /// Mean of dual scattering over that of paths: red, green and blue.
    means: [f64; 3],
    /// Share of the mean of paths that is light scattered once: red, green and blue.
    single: [f64; 3],
    /// Root of the mean squared difference of luminances over the mean luminance of paths, by blocks of four pixels square.
    by_pixel: f64,
    /// Processor time of a sample of each pixel: dual scattering and paths, ms.
    times: [f64; 2],
}

fn shows_hair(scene: &Scene) -> Vec<bool> {
    let [width, height] = scene.camera.size();
    let at = |x: u32, y: u32| scene.camera.ray(x as f32 + 0.5, y as f32 + 0.5);
    (0..width * height)
        .map(|k| matches!(scene.closest(&at(k % width, k / width)), Met::Hair(_)))
        .collect()
}

/// Renders a case by the three integrators.
fn compare(
    (name, [model, sampler], preset): Case<'_>,
    strands: usize,
    side: u32,
    samples: [u32; 2],
) -> Compared {
    let scene = scene(
        name,
        hair_of([model, sampler, preset], Energy::PerWo),
        strands,
        side,
    );
    let shows = shows_hair(&scene);
    let render = |integrator, mis, samples| {
        let settings = Settings {
            integrator,
            mis,
            ..Settings::default()
        };
        let film = film(&scene, &settings, samples);
        (film.picture(), film.seconds() / f64::from(samples))
    };
    let [few, many] = samples;
    let (dual, dual_time) = render(Integrator::Dual, Mis::Light, few);
    let (paths, path_time) = render(Integrator::Path, Mis::Resampled, many);
    let (direct, _) = render(Integrator::Direct, Mis::Resampled, few);
    let shown = |pixels: &[[f64; 3]], c: usize| -> f64 {
        pixels
            .iter()
            .zip(&shows)
            .filter(|(_, shows)| **shows)
            .map(|(pixel, _)| pixel[c])
            .sum()
    };
    let over = |part: &[[f64; 3]]| [0, 1, 2].map(|c| shown(part, c) / shown(&paths.pixels, c));
    let blocks = |luminances: Vec<f64>| {
        let mut sums = std::collections::BTreeMap::new();
        for (k, (luminance, shows)) in (0..).zip(luminances.iter().zip(&shows)) {
            if !shows {
                continue;
            }
            let (x, y): (u32, u32) = (k % side / 4, k / side / 4);
            *sums.entry((x, y)).or_insert(0.0) += luminance;
        }
        sums
    };
    let (ours, truth) = (blocks(dual.luminances()), blocks(paths.luminances()));
    let squares: f64 = ours
        .iter()
        .map(|(block, sum)| (sum - truth[block]).powi(2))
        .sum();
    let count = truth.len() as f64;
    Compared {
        means: over(&dual.pixels),
        single: over(&direct.pixels),
        by_pixel: (squares / count).sqrt() / (truth.values().sum::<f64>() / count),
        times: [dual_time, path_time].map(|seconds| 1e3 * seconds),
    }
}

/// Blond and brown hair under the area light: means within 5%.
#[test]
fn means_are_near_those_of_paths() {
    for preset in ["blond", "brown"] {
        let case = (Name::AreaHead, ["gaussian", "matched"], preset);
        let Compared { means, single, .. } = compare(case, 20_000, 40, [32, 96]);
        println!("{preset}: {means:.3?}, of it scattered once {single:.3?}");
        for mean in means {
            assert!((mean - 1.0).abs() < 0.05, "{preset}: {means:?}");
        }
        // Without light that was scattered more than once the means are off.
        assert!(single[0] < 0.75, "{preset}: {single:?}");
    }
}

/// Writes the record of all scenes, models and colours with `HAIRIS_RECORD=write`.
#[test]
#[ignore = "slow: five minutes on two cores"]
fn record_of_dual_scattering() {
    let mut rows = Vec::new();
    for name in [Name::AreaHead, Name::Env, Name::Head] {
        for model in [["gaussian", "matched"], ["chiang", "published"]] {
            for preset in ["blond", "brown", "black", "white"] {
                let strands = name.defaults().strands;
                let Compared {
                    means: [r, g, b],
                    single,
                    by_pixel,
                    times: [dual, paths],
                } = compare((name, model, preset), strands, 96, [64, 256]);
                let row = format!(
                    "{},{},{preset},{r:.4},{g:.4},{b:.4},{:.4},{by_pixel:.4},{dual:.2},{paths:.2}",
                    name.word(),
                    model[0],
                    single[0]
                );
                println!("{row}");
                rows.push(row);
            }
        }
    }
    if std::env::var("HAIRIS_RECORD").is_ok_and(|word| word == "write") {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../benches/records/dual.csv"
        );
        let machine = hairis_instruments::machine!();
        let date = Command::new("date")
            .arg("-I")
            .output()
            .expect("there is a clock");
        let text = format!(
            "# CPU: {}\n# commit: {}\n# date: {}# dual scattering of 64 samples over paths of 256, on pixels of 96 x 96 that show hair\n\
             scene,model,colour,red,green,blue,once,by pixel,dual ms,paths ms\n{}\n",
            machine.cpu,
            &machine.commit[..8],
            String::from_utf8_lossy(&date.stdout),
            rows.join("\n")
        );
        std::fs::write(path, text).expect("the record can be written");
    }
}
