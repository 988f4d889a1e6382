#!/bin/bash
# Promise: the kernels need neither std nor alloc. A program with a panic handler and no allocator links, runs and
# contains neither; a program that uses one of them does not link. Not optimised, so that nothing that is called is left out; these
# are the builds of .ci/bits.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
cd .ci/nostd
build=(cargo build -q --release --locked --config 'profile.release.opt-level=0')

prove() { # prove NAME RUSTFLAGS
  RUSTFLAGS="$RUSTFLAGS $2" "${build[@]}" --features bits --target-dir "$target/bits-$1"
  local program=$target/bits-$1/release/hairis-nostd
  local undefined
  undefined=$(nm -u "$program")
  [ -z "$undefined" ] || { echo "FAIL $1: undefined symbols: $undefined"; exit 1; }
  if nm -C "$program" | grep -E '(^|[ <(&])(std|alloc)::|__rust_(alloc|dealloc|realloc)'; then
    echo "FAIL $1: std or alloc in the program"; exit 1
  fi
  "$program" > /dev/null || { echo "FAIL $1: check $? failed"; exit 1; }
  echo "$1: links and runs without std"
}
refused() { # refused FEATURE WORDS
  local out
  out=$("${build[@]}" --target-dir "$target/bits-x86-64" --features "$1" 2>&1) && { echo "FAIL $1 was accepted"; exit 1; }
  grep -q "$2" <<<"$out" || { echo "FAIL $1 was refused for another reason: $out"; exit 1; }
  echo "refused, as it must be: $1"
}

prove x86-64 ''
if grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo; then prove x86-64-v3 -Ctarget-cpu=x86-64-v3; fi
refused neg-std 'panic_impl'
refused neg-alloc 'no global memory allocator'
