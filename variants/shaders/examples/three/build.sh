#!/bin/bash
# Puts the example together in target/page/three, beside the page whose shaders it uses: build.sh [ARGUMENT OF CARGO BUILD...].
# Needs what harness/page/build.sh needs, and npm. $RENDER is the hairis-render that grows the hair.
set -euo pipefail
cd "$(dirname "$0")"
root=$(cd ../../../.. && pwd)
target=$(realpath -m "${CARGO_TARGET_DIR:-$root/target}")
out=$target/page/three work=$target/three-build
# The page's script ends with this one.
[ -e "$target/page-build/dual.wasm" ] && compgen -G "$target/page/*.wgsl" > /dev/null || exec "$root/harness/page/build.sh" "$@"
mkdir -p "$out" "$work"
cp package.json "$work"
cp package.json "$out"
cp "$target/page-build/dual.wasm" "$out/hairis.wasm"
npm install --silent --no-audit --no-fund --no-package-lock --prefix "$work"
web=$root/harness/page/web
cat "$web"/{kernel,light,inputs,fields}.js src/panel.js > "$work/page.js"
export NODE_PATH=$work/node_modules
bundle() { # bundle FILE OUTPUT [ARGUMENT...]
  "$work/node_modules/.bin/esbuild" "src/$1" --bundle --minify --format=esm --charset=utf8 --log-level=warning "--alias:#page=$work/page.js" "--outfile=$out/$2" "${@:3}"
}
bundle library.js hairis-three.js --external:three
bundle example.js example.js
bundle paths.js paths.js --loader:.wgsl=text
node types.mjs "$out/hairis.wasm" > "$out/hairis-three.d.ts"
for name in index paths; do
  # One style for all pages.
  sed -e "/<!-- style -->/{r /dev/stdin" -e 'd}' "web/$name.html" < <(sed -n '/<style>/,/<\/style>/p' "$web/index.html") | sed 's/^ *//' > "$out/$name.html"
done
program() { (cd "$root" && cargo run -q --release --locked -p "$1" -- "${@:2}"); } # program PACKAGE [ARGUMENT...]
shader() { if [ -n "${HAIRIS:-}" ]; then "$HAIRIS" shader "$@"; else program hairis-shader "$@"; fi; }
shader --target wgsl --model dual-scattering | sed '/^ *\/\//d' > "$out/dual-scattering.wgsl"
for file in "$target"/page/*.wgsl; do
  cp "$file" "$out"
  name=$(basename "$file" .wgsl)
  shader --target wgsl --model "$name" --call eval_sample_hit | sed '/^ *\/\//d' > "$out/$name.paths.wgsl"
done
render() { if [ -n "${RENDER:-}" ]; then "$RENDER" render "$@"; else program hairis-render render "$@"; fi; }
render straight --strands 5000 --size 8x8 --spp 1 --out "$work/groom.exr" --export "$out/groom.hair" > /dev/null
for file in hairis-three.js example.js paths.js; do echo "$file has $(wc -c < "$out/$file") bytes, $(gzip -c "$out/$file" | wc -c) compressed"; done
