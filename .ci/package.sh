#!/bin/bash
# Promise: the packages can be published. Each archive has both licences, a README and no source outside it; the libraries and
# the programs compile from the archives alone.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
packages=(hairis hairis-variants hairis-capi hairis-reference hairis-conformance hairis-shaders hairis-gradients hairis-benches hairis-program hairis-instruments hairis-materials hairis-harness hairis-study hairis-shader hairis-referee)

rm -rf "$target/package"
cargo package -q --no-verify --allow-dirty --target-dir "$target" "${packages[@]/#/-p}" 2> "$dir/log" || { cat "$dir/log"; exit 1; }
# A workspace of the archives, with the profiles and the versions of this one.
sed -e "s/^members = .*/members = [$(printf '"%s",' "${packages[@]}")]/" -e '/^default-members = /d' Cargo.toml > "$dir/Cargo.toml"
cp Cargo.lock "$dir"
echo '[patch.crates-io]' >> "$dir/Cargo.toml"
for package in "${packages[@]}"; do
  tar xzf "$target/package/$package"-[0-9]*.crate -C "$dir"
  mv "$dir/$package"-[0-9]* "$dir/$package"
  for file in LICENSE-MIT LICENSE-APACHE README.md; do
    [ -s "$dir/$package/$file" ] || { echo "FAIL $package: its archive has no $file"; exit 1; }
  done
  echo "$package = { path = '$package' }" >> "$dir/Cargo.toml"
done
# The flags of this workspace, which are looked for from the folder on.
. .ci/flags
(cd "$dir" && cargo check -q --workspace --lib --bins --all-features --target-dir "$target")
echo "${#packages[@]} packages can be published"
