//! WebAssembly: the host has the output, and the program a function to start it.

#[link(wasm_import_module = "host")]
unsafe extern "C" {
    fn host_write(text: *const u8, len: usize);
}

#[unsafe(no_mangle)]
extern "C" fn run() -> i32 {
    crate::start()
}

pub fn exit(_code: i32) -> ! {
    core::arch::wasm32::unreachable()
}

pub fn write(text: &[u8]) {
    // SAFETY: the host reads `text.len()` bytes at `text`.
    unsafe { host_write(text.as_ptr(), text.len()) }
}
