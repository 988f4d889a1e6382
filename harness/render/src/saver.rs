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
pub struct Saver<'a> {
    log: Log,
    interrupt: &'a Interrupt,
    slice: Duration,
    start: Instant,
    saved: Instant,
}

impl<'a> Saver<'a> {
    /// Makes a saver of a part with this log, for a run that `interrupt` may end.
    #[must_use]
    pub fn new(log: Log, interrupt: &'a Interrupt) -> Self {
        let start = Instant::now();
        Self {
            log,
            interrupt,
            slice: SLICE,
            start,
            saved: start,
        }
    }

    /// Sets the time after which no further tile of a slice is begun, which is 1.5 s otherwise.
    #[must_use]
    pub fn with_slice(self, slice: Duration) -> Self {
        Self { slice, ..self }
    }

    /// Returns the path of the part's file.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.log.path()
    }

    /// Returns the log of a part to which nothing more will be added.
    #[must_use]
    pub fn end(self) -> Log {
        self.log
    }

    /// Saves the current state of the part.
    ///
    /// # Errors
    ///
    /// Returns an error if the part cannot be saved.
    pub fn save(&mut self, part: &Part) -> Result<(), Error> {
        self.log.save(part)?;
        self.saved = Instant::now();
        Ok(())
    }

    /// Works on a film slice by slice, until `slice` returns true. `slice` must stop when its second argument returns true.
    ///
    /// # Errors
    ///
    /// Returns an error if the part cannot be saved, and [`Error::Interrupted`], with everything saved, after a signal.
    pub fn work(
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
    pub fn render(
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
