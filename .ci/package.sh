#!/bin/bash
# Promise: the packages can be published. Each archive has both licences, a README and no source outside it; the libraries and
# the programs compile from the archives alone.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
packages=(hairis hairis-variants hairis-capi hairis-reference hairis-conformance hairis-shaders hairis-gradients hairis-benches hairis-instruments hairis-materials hairis-harness)

rm -rf "$target/package"
cargo package -q --no-verify --allow-dirty --target-dir "$target" "${packages[@]/#/-p}" 2> "$dir/log" || { cat "$dir/log"; exit 1; }
patches=()
for package in "${packages[@]}"; do
  tar xzf "$target/package/$package"-[0-9]*.crate -C "$dir"
  mv "$dir/$package"-[0-9]* "$dir/$package"
  for file in LICENSE-MIT LICENSE-APACHE README.md; do
    [ -s "$dir/$package/$file" ] || { echo "FAIL $package: its archive has no $file"; exit 1; }
  done
  patches+=(--config "patch.crates-io.$package.path='$dir/$package'")
done
check() { # check PACKAGE ARGUMENT...: compiles it from its archive, with the others from theirs
  echo "$1 from its archive: cargo check ${*:2}"
  (cd "$dir/$1" && cargo check -q "${patches[@]}" --target-dir "$target" "${@:2}" 2>&1 | { grep -v 'Patch.*was not used' || true; })
}
# The first three depend on the package of their tests by path alone: their archives have no tests to compile.
check hairis --lib --all-features
check hairis-variants --lib --all-features
check hairis-capi --lib --all-features
check hairis-reference --lib
check hairis-conformance --lib
check hairis-shaders --lib --all-features
check hairis-gradients --lib --all-features
check hairis-instruments --lib --all-features
check hairis-harness --lib --bins --all-features
echo "${#packages[@]} packages can be published"
