//! Work on a picture in slices of time, with saves between the slices, so that a run that is killed
//! loses only a few seconds.

use crate::film::Film;
use crate::part::{Log, Part};
use crate::scene::Scene;
use crate::transport::{Settings, Stop, render_until};
use core::time::Duration;
use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use std::path::Path;
use std::time::Instant;

/// Time after which no further tile of a slice is begun.
const SLICE: Duration = Duration::from_millis(1500);
/// Shortest and longest time between two saves, which otherwise is half of the time since the start.
const SAVE: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(4)];

/// Saver of a picture that grows, which ends the run if a signal asks for it.
#[derive(Debug)]
pub(crate) struct Saver<'a> {
    log: Log,
    interrupt: &'a Interrupt,
    slice: Duration,
    start: Instant,
    saved: Instant,
}

impl<'a> Saver<'a> {
    pub(crate) fn new(log: Log, interrupt: &'a Interrupt) -> Self {
        let start = Instant::now();
        Self {
            log,
            interrupt,
            slice: SLICE,
            start,
            saved: start,
        }
    }

    /// Returns the path of the part's file.
    pub(crate) fn path(&self) -> &Path {
        self.log.path()
    }

    /// Returns the log of a part to which nothing more will be added.
    pub(crate) fn end(self) -> Log {
        self.log
    }

    /// Saves the current state of the part.
    pub(crate) fn save(&mut self, part: &Part) -> Result<(), Error> {
        self.log.save(part)?;
        self.saved = Instant::now();
        Ok(())
    }

    /// Works on a film slice by slice, until `slice` returns true. `slice` must stop when its second argument returns true.
    ///
    /// # Errors
    ///
    /// Returns an error if the part cannot be saved, and [`Error::Interrupted`], with everything saved, after a signal.
    pub(crate) fn work(
        &mut self,
        part: &mut Part,
        mut slice: impl FnMut(&mut Film, &Stop<'_>) -> bool,
    ) -> Result<(), Error> {
        loop {
            let begin = Instant::now();
            let interrupt = self.interrupt;
            let stop = || begin.elapsed() >= self.slice || interrupt.signal().is_some();
            let is_done = slice(&mut part.film, &stop);
            if interrupt.signal().is_some() {
                self.save(part)?;
                let (samples, path) = (part.film.mean_samples(), self.path().display());
                return interrupt.check(|| {
                    format!("{samples:.1} samples of each pixel are in {path}; the same command goes on from there")
                });
            }
            let [least, most] = SAVE;
            if self.saved.elapsed() >= (self.start.elapsed() / 2).clamp(least, most) {
                self.save(part)?;
            }
            if is_done {
                return Ok(());
            }
        }
    }

    /// Adds samples until every pixel has `samples`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`work`](Self::work).
    pub(crate) fn render(
        &mut self,
        part: &mut Part,
        scene: &Scene,
        settings: &Settings,
        samples: u32,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<(), Error> {
        self.work(part, |film, stop| {
            render_until(scene, settings, film, samples, progress, stop);
            film.samples() >= samples || film.tiles.is_empty()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Crop, Tile};
    use crate::hair::{Choice, Energy};
    use crate::scenes::{self, Name, Parts};
    use crate::transport::{Integrator, Mis, film};
    use core::sync::atomic::{AtomicUsize, Ordering};
    use hairis_instruments::interrupt::Signal;

    fn scene() -> Scene {
        let hair =
            Choice::find("gaussian", "matched", "blond").and_then(|hair| hair.hair(Energy::Raw));
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
                let mut saver = Saver {
                    slice: Duration::ZERO,
                    ..Saver::new(log, &interrupt)
                };
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
}
