//! Memory that a picture needs, compared with the memory that is left.

use hairis_instruments::error::Error;
use std::fs;

/// Largest number of bytes that a segment takes while the tree is built, of any kind of hair: strands,
/// boxes and blocks. Triangles take less.
const PER_SEGMENT: u64 = 256;
/// Largest number of bytes that a pixel takes while its picture is written: sums, layers and the file.
const PER_PIXEL: u64 = 176;

/// Rejects a scene that does not fit in the memory that is left, if the system states how much that is.
///
/// # Errors
///
/// Returns [`Error::Usage`] with the memory that the scene needs and the memory that is left.
pub fn check(segments: u64, pixels: u64) -> Result<(), Error> {
    available().map_or(Ok(()), |available| {
        check_within(segments, pixels, available)
    })
}

fn check_within(segments: u64, pixels: u64, available: u64) -> Result<(), Error> {
    let need = segments
        .saturating_mul(PER_SEGMENT)
        .saturating_add(pixels.saturating_mul(PER_PIXEL));
    if need <= available {
        return Ok(());
    }
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    Err(Error::Usage(format!(
        "{segments} segments and {pixels} pixels take up to {:.1} GB of memory, and {:.1} GB are left: render fewer strands or a smaller --size",
        gigabytes(need),
        gigabytes(available)
    )))
}

/// Returns the bytes that are left to the machine, or to the control group of the process if that is less.
fn available() -> Option<u64> {
    let number = |path: &str| fs::read_to_string(path).ok()?.trim().parse::<u64>().ok();
    let left = |most: &str, used: &str| Some(number(most)?.saturating_sub(number(used)?));
    [
        fs::read_to_string("/proc/meminfo")
            .ok()
            .and_then(|text| of_machine(&text)),
        left("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
        left(
            "/sys/fs/cgroup/memory/memory.limit_in_bytes",
            "/sys/fs/cgroup/memory/memory.usage_in_bytes",
        ),
    ]
    .into_iter()
    .flatten()
    .min()
}

/// Parses the line `MemAvailable: N kB`.
fn of_machine(meminfo: &str) -> Option<u64> {
    let line = meminfo
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim()
        .strip_suffix("kB")?
        .trim()
        .parse::<u64>()
        .ok()?
        .checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_refused_with_both_sizes() {
        assert!(
            check_within(1_000_000, 1_000_000, 500_000_000).is_ok(),
            "half a gigabyte holds it"
        );
        let problem = check_within(1_000_000, 1_000_000, 400_000_000)
            .expect_err("more than there is")
            .to_string();
        assert!(
            problem.contains("0.4 GB") && problem.contains("1000000 segments"),
            "{problem}"
        );
        assert!(
            check_within(u64::MAX, u64::MAX, u64::MAX - 1).is_err(),
            "the sum saturates"
        );
    }

    #[test]
    fn the_memory_of_the_machine_is_read() {
        assert_eq!(
            of_machine("MemTotal: 9 kB\nMemAvailable:       2 kB\n"),
            Some(2048)
        );
        assert_eq!(of_machine("MemAvailable: many\n"), None);
        assert_eq!(of_machine(""), None);
    }
}
