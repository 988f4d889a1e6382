#!/bin/bash
# Promise: the properties hold for other numbers than those of CI, and the slow tests pass. By hand: every round draws a seed,
# prints it, and runs the tests of kernels and variants with it; then those of the kernels compiled for x86-64-v3, the energy of
# 40,000 materials, and the tests that are ignored for their time, run once.
#
#   .ci/long.sh          one round
#   .ci/long.sh ROUNDS   so many
#
# HAIRIS_SEED=N cargo test ... repeats a round. Each chi-square test fails once in a hundred rounds by chance; no other may.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
failed=0
for round in $(seq "${1:-1}"); do
  seed=$(od -An -N8 -tu8 /dev/urandom | tr -d ' ')
  echo "round $round: HAIRIS_SEED=$seed"
  HAIRIS_SEED=$seed cargo test -q --locked -p hairis -p hairis-variants --all-features --test main --no-fail-fast || { echo "FAIL seed $seed"; failed=1; }
done
if grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo; then
  # A target folder of its own, so that neither build discards the other's work.
  CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-target}/v3 RUSTFLAGS="$RUSTFLAGS -Ctarget-cpu=x86-64-v3" cargo test -q -p hairis --all-features || failed=1
fi
# Energy of 10,000 materials of each kind and bell: figures are printed.
HAIRIS_MATERIALS=10000 cargo test -q --locked --release -p hairis --all-features --test main conserves_energy -- --nocapture || failed=1
cargo test -q --locked -p hairis-harness --lib -- --ignored || failed=1
cargo test -q --locked --release -p hairis-render --test main -- --ignored || failed=1
exit $failed
