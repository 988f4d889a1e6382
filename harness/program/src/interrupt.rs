//! Signals that ask a run to end, which first saves its finished work.

use crate::error::Error;
use crate::program::say;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Arc;

pub use crate::signal::Signal;

/// Flag that records whether a signal has asked this process to end. Clones share the flag.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicUsize>);

impl Interrupt {
    /// Watches for SIGINT and SIGTERM, which from then on no longer end the process by themselves. A further signal ends the process at
    /// once, unless it comes within a second of the first, because `timeout` and launchers send the same signal twice in a row.
    ///
    /// On systems other than Unix nothing is watched.
    #[must_use]
    pub fn watch() -> Self {
        let watched = Self::default();
        #[cfg(unix)]
        if let Err(error) = watched.watch_signals() {
            say(&format!(
                "cannot watch for signals: {error}; SIGINT and SIGTERM end the run at once"
            ));
        }
        watched
    }

    #[cfg(unix)]
    fn watch_signals(&self) -> std::io::Result<()> {
        use core::time::Duration;
        use std::time::Instant;

        let numbers = Signal::ALL.map(|signal| i32::from(signal.number()));
        let mut signals = signal_hook::iterator::Signals::new(numbers)?;
        let watched = self.clone();
        let watch = move || {
            let mut first: Option<Instant> = None;
            for number in signals.forever() {
                if first.is_some_and(|first| first.elapsed() > Duration::from_secs(1)) {
                    std::process::exit(128 + number);
                }
                first.get_or_insert_with(Instant::now);
                if let Some(signal) = usize::try_from(number).ok().and_then(Signal::from_number) {
                    watched.raise(signal);
                }
            }
        };
        std::thread::Builder::new()
            .name("signals".to_owned())
            .spawn(watch)
            .map(|_| ())
    }

    /// Records a signal as if the process had received it. Only the first signal counts.
    pub fn raise(&self, signal: Signal) {
        // The first signal determines the exit code.
        let _ = self.0.compare_exchange(
            0,
            usize::from(signal.number()),
            Ordering::Relaxed,
            Ordering::Relaxed,
        );
    }

    /// Returns the first signal that was received or [raised](Self::raise), if any.
    #[must_use]
    pub fn signal(&self) -> Option<Signal> {
        Signal::from_number(self.0.load(Ordering::Relaxed))
    }

    /// Returns an error that ends the run if a signal has asked for it. `saved` describes where the finished work is, and how to
    /// continue.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Interrupted`] if there was a signal.
    pub fn check(&self, saved: impl FnOnce() -> String) -> Result<(), Error> {
        self.signal().map_or(Ok(()), |signal| {
            Err(Error::Interrupted {
                signal,
                saved: saved(),
            })
        })
    }
}
