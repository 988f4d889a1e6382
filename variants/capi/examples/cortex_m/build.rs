//! Passes the linker script that places code and data where the board has memory.

fn main() {
    println!("cargo::rerun-if-changed=memory.ld");
    let folder = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    println!("cargo::rustc-link-arg-bins=-T{folder}/memory.ld");
}
