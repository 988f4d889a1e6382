//! Identity of the CPU on which benches are measured.

use std::{env, fs};

/// Returns the name of the CPU with its family, model and stepping, because names alone are often meaningless on rented machines.
#[must_use]
pub fn name() -> String {
    let Ok(info) = fs::read_to_string("/proc/cpuinfo") else {
        return env::consts::ARCH.to_owned();
    };
    let field = |name: &str| {
        let line = info
            .lines()
            .find(|line| line.split(':').next().is_some_and(|key| key.trim() == name));
        line.and_then(|line| line.split(':').nth(1))
            .map_or("", str::trim)
    };
    format!(
        "{} family {} model {} stepping {}",
        field("model name"),
        field("cpu family"),
        field("model"),
        field("stepping")
    )
}
