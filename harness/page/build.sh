#!/bin/bash
# Puts the page together in target/page: build.sh [ARGUMENT OF CARGO BUILD...]. Needs the target of WebAssembly
# (`rustup target add wasm32-unknown-unknown`), and node for a script without comments. $HAIRIS is the program that prints the shaders.
set -euo pipefail
cd "$(dirname "$0")"
root=$(cd ../.. && pwd)
target=$(realpath -m "${CARGO_TARGET_DIR:-$root/target}")
out=$target/page
# The flags of .cargo/config.toml, and no others.
unset RUSTFLAGS
if command -v npm > /dev/null; then # the module of the example for three.js
  cargo build --release --locked --features dual --target-dir "$target/page-build" "$@"
  cp "$target/page-build/wasm32-unknown-unknown/release/hairis_page.wasm" "$target/page-build/dual.wasm"
fi
cargo build --release --locked --target-dir "$target/page-build" "$@"
rm -rf "$out"
mkdir -p "$out"
cp "$target/page-build/wasm32-unknown-unknown/release/hairis_page.wasm" "$out/hairis.wasm"
# Indentation is a twentieth of the page.
sed 's/^ *//' web/index.html > "$out/index.html"
cat web/{kernel,state,figures,plots,inputs,fields,controls,light,gpu,tuft,words,main}.js > "$target/page-build/page.js"
if command -v npx > /dev/null; then npx --yes esbuild@0.28.2 --log-level=warning --minify --charset=utf8 --format=iife "$target/page-build/page.js" --outfile="$out/page.js"
else cp "$target/page-build/page.js" "$out"; fi
# From the root, because cargo's settings of this folder are those of WebAssembly.
shader() { if [ -n "${HAIRIS:-}" ]; then "$HAIRIS" shader "$@"; else (cd "$root" && cargo run -q --release --locked -p hairis-shader -- "$@"); fi; }
# The names of the models, as the refusal of a name that is none lists them.
names=$(shader --target wgsl --model '' 2>&1 | sed -n 's/.*must be one of \(.*\), got.*/\1/p' | tr -d ,) || true
[ -n "$names" ] || { echo "hairis shader must list its models, got nothing"; exit 1; }
for name in $names; do
  shader --target wgsl --model "$name" --call eval_hit --only value | sed '/^ *\/\//d' > "$out/$name.wgsl"
done
echo "$out has $(cat "$out"/* | wc -c) bytes: python3 -m http.server --directory $out"
# The example for three.js lies beside the page, which has its links where npm provides three.js.
if command -v npm > /dev/null; then "$root/variants/shaders/examples/three/build.sh"
else sed -i '/href="three/d' "$out/index.html"; fi
