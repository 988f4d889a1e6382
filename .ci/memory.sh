#!/bin/bash
# Promise: the unsafe code reads and writes nothing beyond its slices, at any length from 0 to 69 and any alignment, on every
# level. AddressSanitizer watches every level of this CPU, valgrind those that it emulates (not AVX-512).
set -euo pipefail
cd "$(dirname "$0")/memory"
. ../flags
command -v valgrind > /dev/null || { ../apt update -qq && ../apt install -qqy valgrind; }
target=$(realpath -m "${CARGO_TARGET_DIR:-../../target}")/memory
host=$(rustc -vV | sed -n 's/^host: //p')
log=$(mktemp)
trap 'rm -f "$log"' EXIT

watched() { # watched NAME COMMAND...: passes, and fails on the access that it must report
  local name=$1; shift
  "$@" > "$log" 2>&1 || { cat "$log"; echo "FAIL $name"; exit 1; }
  echo "$name: $(cat "$log")"
  if "$@" bad > "$log" 2>&1; then cat "$log"; echo "FAIL $name does not see a read behind a slice"; exit 1; fi
}

# RUSTC_BOOTSTRAP for this command alone: the sanitizer is no stable option. --target keeps build scripts out of it.
RUSTC_BOOTSTRAP=1 RUSTFLAGS="$RUSTFLAGS -Zsanitizer=address" cargo build -q --release --locked --target "$host" --target-dir "$target/asan"
watched AddressSanitizer "$target/asan/$host/release/hairis-memory"
cargo build -q --release --locked --target-dir "$target/plain"
watched valgrind valgrind -q --error-exitcode=9 "$target/plain/release/hairis-memory"
