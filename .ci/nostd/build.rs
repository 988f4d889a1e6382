//! No start files, no default libraries: the program contains all that it needs.

fn main() {
    for arg in ["-nostartfiles", "-nodefaultlibs", "-nostdlib", "-static", "-no-pie"] {
        println!("cargo::rustc-link-arg-bins={arg}");
    }
}
