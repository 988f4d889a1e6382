//! Another Rust library, which uses std: it allocates, and a panic in it unwinds.

/// Returns the length of a text, after allocating it on the heap and catching a panic.
///
/// # Safety
///
/// The text must end in 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn other_length(text: *const core::ffi::c_char) -> i32 {
    // SAFETY: the caller's promise.
    let text = unsafe { std::ffi::CStr::from_ptr(text) }
        .to_string_lossy()
        .into_owned();
    std::panic::set_hook(Box::new(|_| ()));
    let caught = std::panic::catch_unwind(|| panic!("on purpose"));
    if caught.is_err() {
        text.len() as i32
    } else {
        -1
    }
}
