//! Replacements for std and libc: an entry point, output and exit, and where the target's core has none the memory functions.

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod cortex_m;
#[cfg(target_os = "linux")]
mod linux;
#[cfg(target_arch = "x86_64")]
mod memory;
#[cfg(target_arch = "wasm32")]
mod wasm;

#[cfg(all(target_os = "none", target_arch = "arm"))]
pub use cortex_m::{exit, write};
#[cfg(target_os = "linux")]
pub use linux::{exit, write};
#[cfg(target_arch = "wasm32")]
pub use wasm::{exit, write};
