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

/// Rejects a scene that does not fit in `available` bytes.
///
/// # Errors
///
/// Returns [`Error::Usage`] with the memory that the scene needs and the memory that is left.
pub fn check_within(segments: u64, pixels: u64, available: u64) -> Result<(), Error> {
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

/// Parses the bytes that are left from the text of `/proc/meminfo`, whose line is `MemAvailable: N kB`.
#[must_use]
pub fn of_machine(meminfo: &str) -> Option<u64> {
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
