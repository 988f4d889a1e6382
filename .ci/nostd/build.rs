//! No start files, no default libraries: the program contains all that it needs.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=cortex-m.ld");
    let [os, arch] =
        ["OS", "ARCH"].map(|name| var(format!("CARGO_CFG_TARGET_{name}")).unwrap_or_default());
    let own_script = format!(
        "-T{}/cortex-m.ld",
        var("CARGO_MANIFEST_DIR").unwrap_or_default()
    );
    let args: &[&str] = match (&*os, &*arch) {
        // Linked by the compiler driver of the host.
        ("linux", "x86_64") => &[
            "-nostartfiles",
            "-nodefaultlibs",
            "-nostdlib",
            "-static",
            "-no-pie",
        ],
        // Linked by LLD itself.
        ("linux", _) => &["-static", "--no-dynamic-linker"],
        ("none", _) => &[&own_script],
        (_, "wasm32") => &["--no-entry", "--export=run"],
        _ => &[],
    };
    for arg in args {
        println!("cargo::rustc-link-arg-bins={arg}");
    }
}
