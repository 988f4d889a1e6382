#!/bin/bash
# Promise: the properties hold for other numbers than those of CI, and for four times as many, and the slow tests pass. By hand: every
# round draws a seed, prints it, and runs the tests of kernels and variants with it, those included that CI leaves out for the samplers
# that differ by constants, but no records, and a search uphill of a second per stated bound; then, in CI's size, the tests of the kernels
# compiled for x86-64-v3, the energy of 40,000 materials, and the tests that are ignored for their time, run once; then size and answers
# of the C library with the feature `every-sampler`, the tests of models, derivatives, harness and renderer with it, those of the wheel and
# Mitsuba's chi-square with it, models printed for Python in every framework, generated source of every model, and the hosts without an
# operating system. The wheel needs the virtual environment that .ci/hosts.sh makes.
#
#   .ci/long.sh          one round, and the rest
#   .ci/long.sh ROUNDS   so many
#   .ci/long.sh 0 PART.. these parts alone: v3 energy ignored listed library wheel frameworks shaders cortex_m
#
# What has passed is a line of target/long/COMMIT.csv, with its seconds on the clock and of processor time, and is left out when this
# runs again: a run that was stopped goes on.
#
# HAIRIS_SEED=N HAIRIS_CASES=4 cargo test ... repeats a round. A round fails by chance less than once in 10,000 times (see False alarms in the
# documentation of hairis-conformance): one that fails has found a bug.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
work=$(realpath -m "${CARGO_TARGET_DIR:-target}")/long
log=$work/$(git rev-parse --short=8 HEAD).csv
mkdir -p "$work"
touch "$log"
failed=0
# Processor time of what has ended, in hundredths of a second.
ended() { awk '{ print $16 + $17 }' "/proc/$$/stat"; }
# A part: its name, a word that is written beside it, and its command.
part() { # part NAME WORD COMMAND...
  local clock=$SECONDS processor result=passed
  processor=$(ended)
  grep -q "^$1,.*,passed," "$log" && return
  "${@:3}" || { result=FAILED; failed=1; }
  echo "$1,$2,$result,$((SECONDS - clock)),$((($(ended) - processor) / 100))" | tee -a "$log"
}
round() { # round SEED
  HAIRIS_SEED=$1 HAIRIS_CASES=4 cargo test -q --locked -p hairis -p hairis-variants --all-features --test main --test samplers --test uphill \
    --no-fail-fast -- --include-ignored --skip record_of
}
rounds=${1:-1}
for round in $(seq "$rounds"); do
  seed=$(od -An -N8 -tu8 /dev/urandom | tr -d ' ')
  part "round $round" "$seed" round "$seed"
done
export HAIRIS_CASES=1
v3() {
  grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo || return 0
  # A target folder of its own, so that neither build discards the other's work.
  CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-target}/v3 RUSTFLAGS="$RUSTFLAGS -Ctarget-cpu=x86-64-v3" cargo test -q -p hairis --all-features --lib --test main --test samplers
}
# Energy of 10,000 materials of each kind and bell: figures are printed.
energy() {
  HAIRIS_MATERIALS=10000 cargo test -q --locked --release -p hairis --all-features --test main conserves_energy -- --nocapture
}
ignored() {
  cargo test -q --locked -p hairis-variants --all-features --test main record_of -- --ignored &&
    cargo test -q --locked -p hairis-harness -p hairis-study -- --ignored && cargo test -q --locked --release -p hairis-render --test main -- --ignored
}
listed() {
  cargo test -q --locked -p hairis-harness -p hairis-study -p hairis-render -p hairis-variants -p hairis-gradients --features hairis-variants/every-sampler
}
# The C library with every sampler: at most 5.75 MB, and the answers of Rust.
library() {
  local work
  work=$(realpath -m "${CARGO_TARGET_DIR:-target}")/library
  mkdir -p "$work"
  variants/capi/install.sh "$work/prefix" every-sampler > "$work/install.log" 2>&1 || { cat "$work/install.log"; return 1; }
  cargo build -q --release --locked --manifest-path .ci/hosts/Cargo.toml --target-dir "$work/answers" &&
    "$work/answers/release/hairis-hosts" "$work" || return 1
  local name size
  for name in bits refusals; do
    gcc -std=c11 -O2 -I"$work/prefix/include" "variants/capi/tests/$name.c" "$work/prefix/lib/libhairis.a" -lm -o "$work/$name" || return 1
  done
  "$work/bits" "$work/answers.bin" && "$work/refusals" || return 1
  size=$(stat -c %s "$work/prefix/lib/libhairis.so.1.0.0")
  echo "libhairis.so: $size bytes"
  [ "$size" -le 5750000 ]
}
# The wheel with every sampler: its tests, and Mitsuba's chi-square test of all seventeen entries of the list.
wheel() {
  local work python llvm
  work=$(realpath -m "${CARGO_TARGET_DIR:-target}")/hosts
  python=$work/venv/bin/python
  [ -x "$python" ] || { echo "the wheel needs $python: run .ci/hosts.sh"; return 1; }
  rm -rf "$work/every"
  (cd variants/python && "$work/venv/bin/maturin" build -q --locked --features every-sampler --target-dir "$work/wheel" --out "$work/every") &&
    "$python" -m pip install -q --force-reinstall --no-deps "$work"/every/*.whl || return 1
  llvm=$(ls /usr/lib/*/libLLVM.so.[0-9]* 2> /dev/null | sort -V | tail -1)
  DRJIT_LIBLLVM_PATH=$llvm "$python" -m pytest -q -p no:cacheprovider variants/python/tests &&
    (cd variants/capi/examples/mitsuba && DRJIT_LIBLLVM_PATH=$llvm "$python" chi2.py | tee "$work/chi2.log") &&
    grep -q '136 of 136 pass' "$work/chi2.log"
}
# Models printed for Python in every framework, on 10,000 hits of 20 materials, for the wheel of .ci/hosts.sh, and the wheel's module for PyTorch.
# PyTorch of PyPI brings CUDA, and takes 5 GB.
frameworks() {
  local work python llvm program
  work=$(realpath -m "${CARGO_TARGET_DIR:-target}")/hosts
  python=$work/venv/bin/python
  llvm=$(ls /usr/lib/*/libLLVM.so.[0-9]* 2> /dev/null | sort -V | tail -1)
  program=$(.ci/release.sh) && "$python" -m pip install -q torch && "$python" -m pip install -q --force-reinstall --no-deps "$work"/wheels/*.whl &&
    "$python" -m pytest -q -p no:cacheprovider variants/python/tests/test_frameworks.py -k torch &&
    DRJIT_LIBLLVM_PATH=$llvm "$python" .ci/frameworks.py "$program/hairis" numpy drjit torch jax
}
# Generated source of every model.
shaders() { .ci/shaders.sh 4; }
cortex_m() { .ci/cortex_m.sh; }
all=(v3 energy ignored listed library wheel frameworks shaders cortex_m)
for name in "${@:2}"; do
  [[ " ${all[*]} " == *" $name "* ]] || { echo "PART must be one of ${all[*]}, got $name"; exit 2; }
done
parts=("${@:2}")
for name in "${parts[@]:-${all[@]}}"; do part "$name" - "$name"; done
exit $failed
