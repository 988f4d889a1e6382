//! Runtime of a library without std.

unsafe extern "C" {
    fn abort() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: C's `abort` takes nothing and does not return.
    unsafe { abort() }
}

/// Personality routine, which the compiled `core` names even where `panic` is `abort`. Nothing calls it.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}
