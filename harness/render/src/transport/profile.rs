//! Time of rendering by part of the work, and the share of rays that reach a light.

use core::cell::Cell;
use core::fmt;
use std::time::Instant;

/// Kind of work whose time a profile measures.
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

/// Seconds of each phase, and rays towards lights, over all threads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile {
    seconds: [f64; Self::PHASES.len()],
    /// Number of rays towards a light.
    towards: u64,
    /// Number of rays that reach it.
    reached: u64,
}

impl Profile {
    const PHASES: [(Phase, &'static str); 6] = [
        (Phase::Rays, "rays"),
        (Phase::Light, "light"),
        (Phase::Kernels, "kernels"),
        (Phase::Frames, "frames"),
        (Phase::Numbers, "numbers"),
        (Phase::Rest, "rest"),
    ];

    /// Adds the times and the counts of rays of another profile.
    pub fn add(&mut self, other: Self) {
        self.seconds
            .iter_mut()
            .zip(other.seconds)
            .for_each(|(sum, seconds)| *sum += seconds);
        self.towards += other.towards;
        self.reached += other.reached;
    }

    /// Returns the seconds of all phases.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.seconds.iter().sum()
    }

    /// Returns the share of the time that a phase took, from 0 to 1.
    #[must_use]
    pub fn share(&self, phase: Phase) -> f64 {
        self.seconds[phase as usize] / self.seconds().max(f64::MIN_POSITIVE)
    }

    /// Returns the share of the rays towards lights that reach them, from 0 to 1, which is 0 without any.
    #[must_use]
    pub fn visible(&self) -> f64 {
        self.reached as f64 / self.towards.max(1) as f64
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share =
            |(phase, name): (Phase, &str)| format!("{name} {:.1} %", 100.0 * self.share(phase));
        write!(f, "{}; ", Self::PHASES.map(share).join(", "))?;
        write!(
            f,
            "{:.1} % of {} rays towards lights reach them",
            100.0 * self.visible(),
            self.towards
        )
    }
}

thread_local! {
    /// End of this thread's last lap; `None` while nothing is measured.
    static LAST: Cell<Option<Instant>> = const { Cell::new(None) };
    static SUMS: Cell<Profile> =
        const { Cell::new(Profile { seconds: [0.0; Profile::PHASES.len()], towards: 0, reached: 0 }) };
}

/// Starts to measure this thread.
pub fn start() {
    SUMS.set(Profile::default());
    LAST.set(Some(Instant::now()));
}

/// Ends the measurement of this thread, and returns its profile.
#[must_use]
pub fn stop() -> Profile {
    LAST.set(None);
    SUMS.get()
}

/// Counts the time since the last lap as `phase`, which costs next to nothing if nothing is measured, and otherwise 30 ns.
#[inline]
pub fn lap(phase: Phase) {
    if let Some(last) = LAST.get() {
        count(phase, last);
    }
}

#[cold]
fn count(phase: Phase, last: Instant) {
    let now = Instant::now();
    let mut profile = SUMS.get();
    profile.seconds[phase as usize] += (now - last).as_secs_f64();
    SUMS.set(profile);
    LAST.set(Some(now));
}

/// Counts a ray towards a light, if this thread is measured.
#[inline]
pub fn count_ray(reached: bool) {
    if LAST.get().is_some() {
        let mut profile = SUMS.get();
        profile.towards += 1;
        profile.reached += u64::from(reached);
        SUMS.set(profile);
    }
}
