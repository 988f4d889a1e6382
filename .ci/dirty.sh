#!/bin/bash
# Promise: entry points called with the upper halves of the vector registers dirty take no longer than otherwise.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")/dirty
cd .ci/dirty
cargo build -q --release --locked --target-dir "$target"
[ "${1:-}" != --build ] || exit 0
"$target/release/hairis-dirty" "$@"
