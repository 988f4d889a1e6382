#!/bin/bash
# Promise: the page works. In headless Chromium: no error on the console; every slider moves a picture; values, V and L1 are those of
# `hairis`; links, undo and JSON restore; WebGPU and the module shade alike, and the page does without WebGPU; at most 280,000 bytes
# without the shaders, a map within 16 ms, the first paint within 300 ms. The example of `hairis shader --out` shades a hair. The
# example for three.js shades pixels as `hairis eval` does, and its path tracer has the means of `hairis-render`.
# Needs node, and npm's playwright-core and esbuild.
#
# Where the toolchain has no wasm32 (`rustup target add wasm32-unknown-unknown`), Debian's rustc-web builds it, and where there is no
# Chromium, Debian's chromium-headless-shell runs it: they are unpacked under $TOOLS (900 MB), not installed.
#
#   .ci/page.sh              everything
#   .ci/page.sh times,tuft   these tests alone; $HAIRIS is the program that they ask, built by .ci/release.sh otherwise, and
#                            $RENDER is hairis-render, by default the one that `cargo test` has compiled
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
tools=${TOOLS:-$target/tools}
mkdir -p "$tools"
. .ci/unpack

arguments=(-q) bootstrap=()
if [ ! -d "$(rustc --print sysroot)/lib/rustlib/wasm32-unknown-unknown" ]; then
  unpack rust rustc-web rust-web-src
  wrapped rust usr/bin/rustc
  CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(rustc --print sysroot)/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld
  export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER
  arguments+=(-Zbuild-std=core -Zbuild-std-features=compiler-builtins-mem)
  # RUSTC_BOOTSTRAP makes the compiler look like a nightly: for this build alone.
  bootstrap=(env RUSTC="$tools/rustc" RUSTC_BOOTSTRAP=1)
fi
browser

# The warnings of the module as a library of this machine; the build for wasm32 takes those of its dependencies as they are.
cargo clippy -q --locked --manifest-path harness/page/Cargo.toml --target-dir "$target/page-build" -- -D warnings
hairis=${HAIRIS:-$(.ci/release.sh)/hairis}
render=${RENDER:-$target/debug/hairis-render}
if [ ! -x "$render" ]; then
  cargo build -q --release --locked -p hairis-render
  render=$target/release/hairis-render
fi
HAIRIS=$hairis RENDER=$render "${bootstrap[@]}" harness/page/build.sh "${arguments[@]}"
cp harness/page/tests/*.mjs variants/shaders/examples/three/tests/*.mjs "$tools/page"
cp variants/shaders/examples/three/README.md "$tools/page/three.md"
node "$tools/page/page.mjs" "$target/page" "$hairis" "$chromium" "$render" "$@"
