//! No start files, no default libraries: what the program needs, it brings.

fn main() {
    for arg in ["-nostartfiles", "-nodefaultlibs", "-nostdlib", "-static", "-no-pie"] {
        println!("cargo::rustc-link-arg-bins={arg}");
    }
}
