#!/bin/bash
# Writes a record of the benches to benches/records/<cpu>/<date>.csv, in 20 minutes on an otherwise idle machine.
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
