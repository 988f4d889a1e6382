//! Where the time of rendering goes.

use core::cell::Cell;
use core::fmt;
use std::time::Instant;

/// A kind of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Finding what rays meet, and whether anything is in their way.
    Rays,
    /// Drawing directions towards lights, and looking lights up.
    Light,
    /// The scattering model: prepared hits, values and samples.
    Kernels,
    /// Frames of fibres, places on them, and directions into and out of the frames.
    Frames,
    /// Uniform numbers.
    Numbers,
    /// Weights, queues and sums.
    Rest,
}

/// Seconds of each phase, over all threads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile([f64; Self::PHASES.len()]);

impl Profile {
    const PHASES: [(Phase, &'static str); 6] = [
        (Phase::Rays, "rays"),
        (Phase::Light, "light"),
        (Phase::Kernels, "kernels"),
        (Phase::Frames, "frames"),
        (Phase::Numbers, "numbers"),
        (Phase::Rest, "rest"),
    ];

    /// Adds those of another.
    pub fn add(&mut self, other: Self) {
        self.0.iter_mut().zip(other.0).for_each(|(sum, seconds)| *sum += seconds);
    }

    /// Share of a phase, from 0 to 1.
    #[must_use]
    pub fn share(&self, phase: Phase) -> f64 {
        self.0[phase as usize] / self.0.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |(phase, name): (Phase, &str)| format!("{name} {:.1} %", 100.0 * self.share(phase));
        f.write_str(&Self::PHASES.map(share).join(", "))
    }
}

thread_local! {
    /// When this thread's last lap ended; `None` while nothing is measured.
    static LAST: Cell<Option<Instant>> = const { Cell::new(None) };
    static SECONDS: Cell<Profile> = const { Cell::new(Profile([0.0; Profile::PHASES.len()])) };
}

/// Starts to measure this thread.
pub(super) fn start() {
    SECONDS.set(Profile::default());
    LAST.set(Some(Instant::now()));
}

/// Ends it.
pub(super) fn stop() -> Profile {
    LAST.set(None);
    SECONDS.get()
}

/// Counts the time since the last lap as `phase`. Costs next to nothing where nothing is measured, and 30 ns where it is.
#[inline]
pub(super) fn lap(phase: Phase) {
    if let Some(last) = LAST.get() {
        count(phase, last);
    }
}

#[cold]
fn count(phase: Phase, last: Instant) {
    let now = Instant::now();
    let mut profile = SECONDS.get();
    profile.0[phase as usize] += (now - last).as_secs_f64();
    SECONDS.set(profile);
    LAST.set(Some(now));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laps_add_up_to_the_whole() {
        lap(Phase::Rays);
        assert_eq!(stop(), Profile::default(), "nothing is measured before the start");
        let begin = Instant::now();
        start();
        std::thread::sleep(core::time::Duration::from_millis(3));
        lap(Phase::Light);
        lap(Phase::Rest);
        let profile = stop();
        let (whole, sum) = (begin.elapsed().as_secs_f64(), profile.0.iter().sum::<f64>());
        assert!(sum >= 3e-3 && sum <= whole, "{sum} of {whole}");
        assert!(profile.share(Phase::Light) > 0.5 && profile.share(Phase::Rays) == 0.0, "{profile}");
        let mut twice = profile;
        twice.add(profile);
        assert!((twice.share(Phase::Light) - profile.share(Phase::Light)).abs() < 1e-12);
    }
}
