#!/bin/bash
# Promise: every feature compiles without the others (other checks have all of them), and dependencies have known licences, one
# source and no second version but those listed in .ci/deny.toml. The minimum Rust version is clippy's: incompatible_msrv.
#
# Not here are sets that other steps compile. The test command has hairis-harness, hairis-study and hairis-instruments with no feature,
# hairis-gradients with `any` and hairis-shaders with `spirv`; .ci/release.sh has hairis-gradients and hairis-shaders with no
# feature. The wheel has hairis-materials with no feature.
#
# Licences, bans and sources need cargo-deny, which takes minutes to build: where it is not installed the script says so.
# Advisories are not checked: their database is a git repository.
set -euo pipefail
cd "$(dirname "$0")/.."
check() { # check PACKAGE FEATURES...: without the default features, with each of these sets
  local package=$1; shift
  for features in "$@"; do
    cargo check -q --locked -p "$package" --no-default-features --features "$features" || { echo "FAIL $package with '$features'"; exit 1; }
    echo "$package with '$features'"
  done
}
check hairis '' serde trace
check hairis-reference ''
check hairis-variants '' any serde any,serde any,every-sampler
# In a profile that aborts: without std nothing can unwind.
for features in '' std every-sampler raw-hits; do
  cargo check -q --locked --profile capi -p hairis-capi --no-default-features --features "$features" || { echo "FAIL hairis-capi with '$features'"; exit 1; }
  echo "hairis-capi with '$features'"
done
check hairis-instruments parquet png
# Without the models for the kernels, which other packages turn on.
check hairis-shader '' spirv
check hairis-referee ''

if command -v cargo-deny > /dev/null; then cargo deny check --config .ci/deny.toml licenses bans sources
else echo "licences, bans and sources were not checked: cargo install --locked cargo-deny"; fi
