//! Clock of the time that a thread has worked.

/// Returns the time that this thread has worked, in seconds from any start. Time that other programs take of the machine does not count.
///
/// If the system has no such clock, the result is wall time.
#[must_use]
pub fn seconds_of_thread() -> f64 {
    #[cfg(unix)]
    {
        let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
    }
    #[cfg(not(unix))]
    {
        static START: std::sync::LazyLock<std::time::Instant> =
            std::sync::LazyLock::new(std::time::Instant::now);
        START.elapsed().as_secs_f64()
    }
}
