//! Tests of `saver`.

use core::sync::atomic::{AtomicUsize, Ordering};
use core::time::Duration;
use hairis_instruments::interrupt::{Interrupt, Signal};
use hairis_render::film::{Crop, Film, Tile};
use hairis_render::hair::{Choice, Energy};
use hairis_render::part::Part;
use hairis_render::saver::Saver;
use hairis_render::scene::Scene;
use hairis_render::scenes::{self, Name, Parts};
use hairis_render::transport::{Integrator, Mis, Settings, film};

fn scene() -> Scene {
    let hair = Choice::find("gaussian", "matched", "blond").and_then(|hair| hair.hair(Energy::Raw));
    let parts = Parts {
        strands: scenes::grow(Name::Env, 300).expect("a few"),
        imported: false,
        head: None,
        hair: hair.expect("listed"),
        env: None,
        size: [70; 2],
        turn: 0.0,
    };
    scenes::build(Name::Env, parts).expect("a scene")
}

/// Returns tiles without their times.
fn sums(film: &Film) -> Vec<Tile> {
    let timeless = |tile: &Tile| Tile {
        seconds: 0.0,
        ..tile.clone()
    };
    film.tiles.iter().map(timeless).collect()
}

/// Checks that runs that a signal ends within each pass come to the bits of one run.
#[test]
fn signals_within_passes_do_not_show() {
    let scene = scene();
    let folder = tempfile::TempDir::new().expect("a folder");
    for (integrator, mis) in [
        (Integrator::Path, Mis::Both),
        (Integrator::Gather, Mis::Resampled),
    ] {
        let settings = Settings {
            integrator,
            mis,
            ..Settings::default()
        };
        let path = folder.path().join(format!("{integrator:?}.part"));
        let fresh = || Part {
            run: "a run".to_owned(),
            film: Film::new(Crop::whole([70; 2])),
            finished: false,
        };
        let mut stops = Vec::new();
        let part = loop {
            let (mut part, log) = Part::resume(&path, fresh(), Some(6)).expect("its own");
            let interrupt = Interrupt::default();
            let mut saver = Saver::new(log, &interrupt).with_slice(Duration::ZERO);
            let tiles = AtomicUsize::new(0);
            let progress = |_: f64| {
                if tiles.fetch_add(1, Ordering::Relaxed) == 3 {
                    interrupt.raise(Signal::Terminate);
                }
            };
            let mut passes = [4, 6].into_iter();
            let ended = passes.try_for_each(|samples| {
                saver.render(&mut part, &scene, &settings, samples, &progress)
            });
            let Err(error) = ended else {
                break part;
            };
            let message = error.to_string();
            assert!(
                message.contains("SIGTERM") && message.contains(".part"),
                "{message}"
            );
            stops.push((part.film.samples(), part.film.most_samples()));
        };
        assert!(
            stops.contains(&(0, 4)) && stops.contains(&(4, 6)),
            "within both passes: {stops:?}"
        );
        let at_once = film(&scene, &settings, Crop::whole([70; 2]), 6);
        assert!(sums(&part.film) == sums(&at_once), "{integrator:?}");
    }
}
