//! Records the build for reports: compiler, commit and optimisation level. Without git or without a repository the commit is
//! "unknown". Also the build script of hairis-study and of the renderer; `hairis_instruments::machine!` reads what it records.

use std::path::Path;
use std::process::Command;

fn main() {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    set(
        "RUSTC",
        &run(&rustc, &["--version"]).unwrap_or_else(unknown),
    );
    set(
        "OPT_LEVEL",
        &std::env::var("OPT_LEVEL").unwrap_or_else(|_| unknown()),
    );
    set(
        "TARGET_FEATURES",
        &std::env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default(),
    );

    // Only a repository that tracks the package counts: an unpacked copy may lie inside another one.
    let ours = run("git", &["ls-files", "--error-unmatch", "Cargo.toml"]).is_some();
    let commit = ours.then(|| run("git", &["rev-parse", "HEAD"])).flatten();
    // No optional locks: a build must not refresh the user's index.
    let status = ours
        .then(|| {
            run(
                "git",
                &[
                    "--no-optional-locks",
                    "status",
                    "--porcelain",
                    "--untracked-files=no",
                ],
            )
        })
        .flatten();
    set("COMMIT", &commit.unwrap_or_else(unknown));
    set(
        "DIRTY",
        status.map_or("unknown", |s| if s.is_empty() { "no" } else { "yes" }),
    );

    // Commits, checkouts and edits of these sources run this again; they rebuild the package anyway, save a commit.
    watch("Cargo.toml");
    watch("src");
    if let Some(root) = ["..", "../.."]
        .into_iter()
        .find(|root| Path::new(root).join("Cargo.lock").exists())
    {
        for path in [
            "Cargo.toml",
            "Cargo.lock",
            "kernels/src",
            "variants/src",
            "harness/instruments/src",
            "harness/program/src",
            "benches/src",
        ] {
            watch(&format!("{root}/{path}"));
        }
        if std::env::var("CARGO_PKG_NAME").is_ok_and(|name| name == "hairis-study") {
            watch(&format!("{root}/harness/src"));
        }
    }
    if ours {
        for name in ["HEAD", "logs/HEAD"] {
            if let Some(path) = run("git", &["rev-parse", "--git-path", name]) {
                watch(&path);
            }
        }
    }
}

/// Watches a path that exists; cargo takes a missing one for changed, each time.
fn watch(path: &str) {
    if Path::new(path).exists() {
        println!("cargo::rerun-if-changed={path}");
    }
}

fn set(name: &str, value: &str) {
    println!(
        "cargo::rustc-env=HAIRIS_BUILD_{name}={}",
        value.lines().next().unwrap_or_default()
    );
}

fn unknown() -> String {
    "unknown".into()
}

/// Output of a command, trimmed; `None` when it is missing or fails.
fn run(program: &str, args: &[&str]) -> Option<String> {
    let output = Command::new(program).args(args).output().ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
