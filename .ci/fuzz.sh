#!/bin/bash
# Promise: no input makes an entry point of the kernels or a reader of files panic, overflow, hang or give a result that is not
# finite. libFuzzer runs over the corpus in .ci/fuzz/corpus and on inputs made from it.
#
#   .ci/fuzz.sh                    the kernels, 60 seconds
#   .ci/fuzz.sh all SECONDS        the kernels and every reader of files; by hand: it takes minutes to compile
#   .ci/fuzz.sh all SECONDS keep   adds the inputs that reach new branches to the corpus
#
# The first byte of an input names its target: k the kernels, e JSON lines, p part files, m maps, h hair files, r parts of
# pictures. An input that fails is left in target/fuzz/failed; the program takes its name and runs it again.
set -euo pipefail
cd "$(dirname "$0")/fuzz"
. ../flags
command -v g++ > /dev/null || { ../apt update -qq && ../apt install -qqy g++; }
target=$(realpath -m "${CARGO_TARGET_DIR:-../../target}")/fuzz
host=$(rustc -vV | sed -n 's/^host: //p')
features=''
[ "${1:-}" != all ] || features=readers

# Counters of branches and comparisons, as cargo-fuzz has them; --target keeps build scripts out of it. Memory is
# .ci/memory.sh's: AddressSanitizer would double the build.
flags='-Cpasses=sancov-module -Ccodegen-units=16'
for option in level=4 inline-8bit-counters pc-table trace-compares; do flags+=" -Cllvm-args=-sanitizer-coverage-$option"; done
RUSTFLAGS="$RUSTFLAGS $flags" cargo build -q --release --locked --features "$features" --target "$host" --target-dir "$target"
fuzzer=$target/$host/release/hairis-fuzz

mkdir -p "$target/failed" "$target/found"
# A file of 500 bytes may describe the largest map that is read, 2^25 pixels: 7 seconds in this build on an idle core.
"$fuzzer" -max_total_time="${2:-60}" -timeout=60 -rss_limit_mb=2048 -max_len=4096 -artifact_prefix="$target/failed/" \
  -print_final_stats=1 "$target/found" corpus > "$target/log" 2>&1 ||
  { tail -40 "$target/log"; echo "FAIL: the input is in $target/failed"; exit 1; }
grep -E 'stat::number_of_executed_units|stat::peak_rss_mb|^#.*DONE' "$target/log"
# Merged: an input stays if it reaches what no other does.
[ "${3:-}" != keep ] || "$fuzzer" -merge=1 -rss_limit_mb=2048 -max_len=4096 corpus "$target/found" 2>&1 | tail -1
