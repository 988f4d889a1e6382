#!/bin/bash
# Builds the programs that other checks look at, once for all of them, and prints their folder: release.sh [LEVEL [FEATURES]].
# At opt-level 3, the default, `hairis` with the programs that it starts, `entry` and `hairis-exhaustive`; at "s" and "z" `entry`
# alone, with these features of hairis-benches. The same packages each time: features that differ would compile the kernels again.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
level=${1:-3}
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")/opt-$level
case $level in
  3) what='-p hairis-harness -p hairis-study -p hairis-shader -p hairis-referee -p hairis-benches -p hairis-exhaustive --bin hairis --bin hairis-study
    --bin hairis-shader --bin hairis-referee --bin entry --bin hairis-exhaustive
    --features hairis-study/parquet,hairis-study/png' value=3 ;;
  *) what="-p hairis-benches --bin entry ${2:+--features $2}" value="\"$level\"" ;;
esac
cargo build -q --release --locked $what \
  --config "profile.release.opt-level=$value" --target-dir "$target" >&2
echo "$target/release"
