#!/bin/bash
# Makes a record of the benches: benches/records/<cpu>/<date>.csv, a quarter of an hour. Nothing else should run meanwhile.
# Arguments go to `cargo bench`: benches/record.sh --bench eval
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build -q --release --locked -p hairis-benches --bin record
record=${CARGO_TARGET_DIR:-target}/release/record
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
CRITERION_HOME=$dir cargo bench --locked -p hairis-benches "$@"
folder=benches/records/$("$record" cpu)
mkdir -p "$folder"
"$record" "$dir" > "$dir/record.csv"
mv "$dir/record.csv" "$folder/$(date +%F).csv"
echo "wrote $folder/$(date +%F).csv"
