//! Runtime of a library without std: a panic handler that aborts, and a personality routine.

unsafe extern "C" {
    fn abort() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: C's `abort` takes nothing and does not return.
    unsafe { abort() }
}

// Personality routine, which the compiled `core` names even where `panic` is `abort`, although nothing calls it. It is weak, so that
// the routine of another Rust library in the program takes precedence in any link order, and hidden, so that it is not exported.
#[cfg(not(any(windows, target_vendor = "apple")))]
core::arch::global_asm!(
    ".weak rust_eh_personality",
    ".hidden rust_eh_personality",
    "rust_eh_personality:",
);

#[cfg(any(windows, target_vendor = "apple"))]
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}
