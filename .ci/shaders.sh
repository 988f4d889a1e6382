#!/bin/bash
# Promise: generated source is what it says, for models with the code of all. C and C++ (gcc, clang), SPIR-V and GLSL on a Vulkan driver
# have the bits of one lane, and so have Slang by way of GLSL and Python with NumPy; plain WGSL and Slang have its accuracy there, WGSL also
# on WebGPU of headless Chromium, and NaN is black; GLSL, HLSL, SPIR-V, OpenCL C and PTX compile, and Slang as SPIR-V, WGSL, HLSL, Metal
# and CUDA; gradients in C have the bits of the graph, and the compiler of Slang finds them; the examples fit widths by Slang, and draw
# the same picture on wgpu and on the CPU.
# Where nvcc and a GPU are, CUDA has the bits of one lane as well.
# Debian's packages: gcc, g++, clang, glslang-tools, spirv-tools, libvulkan-dev, mesa-vulkan-drivers; node, npm, and Chromium as in
# .ci/page.sh.
# A tool that is missing is installed where apt can, and named where it cannot: its tests are skipped.
#
#   .ci/shaders.sh         4096 cases per model and function
#   .ci/shaders.sh 32      32 times as many, for every model, with every arithmetic, and C at level 3 as well
set -euo pipefail
cd "$(dirname "$0")/.."
for tool in clang glslangValidator spirv-val; do command -v "$tool" > /dev/null || missing=yes; done
[ -e /usr/include/vulkan/vulkan.h ] || missing=yes
compgen -G '/usr/share/vulkan/icd.d/lvp_icd*.json' > /dev/null || missing=yes
if [ -n "${missing:-}" ]; then
  { .ci/apt update -qq && .ci/apt install -qqy --no-install-recommends clang glslang-tools spirv-tools libvulkan-dev \
      mesa-vulkan-drivers; } > /dev/null 2>&1 || echo "some tools are missing: their tests are skipped"
fi
export HAIRIS_CASES=${1:-1}
# Drivers in software alone: results are those of the driver that the bounds were measured on.
for driver in /usr/share/vulkan/icd.d/lvp_icd*.json; do
  [ -e "$driver" ] && export VK_ICD_FILENAMES=$driver VK_DRIVER_FILES=$driver
done
# Chromium brings its own Tint and SwiftShader.
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
export tools=${TOOLS:-$target/tools} HAIRIS_CHROMIUM HAIRIS_PLAYWRIGHT
HAIRIS_PLAYWRIGHT=$tools/page
mkdir -p "$tools"
HAIRIS_CHROMIUM=$(bash -ec '. .ci/unpack; browser; node --version; "$chromium" --version; echo "$chromium"' | tail -n 1) ||
  { unset HAIRIS_CHROMIUM; echo "node, npm or Chromium is missing: tests on WebGPU are skipped"; }
export HAIRIS_PYTHON=$tools/numpy/bin/python
[ -x "$HAIRIS_PYTHON" ] || python3 -m venv "$tools/numpy"
"$HAIRIS_PYTHON" -m pip install -q numpy
# The compiler of Slang; its device for CPUs compiles by g++.
export HAIRIS_SLANG=$tools/slang/bin/python
[ -x "$HAIRIS_SLANG" ] || python3 -m venv "$tools/slang"
"$HAIRIS_SLANG" -m pip install -q numpy slangpy==0.43.1
# The programs of the test command, which has compiled them.
messages=$(cargo test -q --locked --workspace --no-run --message-format=json)
program() {
  python3 -c '
import json, sys
for built in map(json.loads, sys.stdin):
    if built.get("executable") and built["target"]["src_path"].endswith(sys.argv[1]):
        print(built["executable"])' "/$1/tests/main.rs" <<<"$messages"
}
for package in variants/shaders harness/shader; do
  tests=$(program $package)
  (cd $package && "$tests" --ignored --nocapture && "$tests" python)
done
fit=$(mktemp -d)
cargo run -q --locked -p hairis-shader -- --model gaussian --target slang > "$fit/hairis_gaussian.slang"
(cd "$fit" && "$HAIRIS_SLANG" "$OLDPWD/variants/shaders/examples/slang_fit.py" cpu | tee fit.log && grep -q 'widths \[0.131  *0.0654 *0.262 *\]' fit.log)
rm -r "$fit"
# The bounds of the example are those of the driver in software. Mesa asks for XDG_RUNTIME_DIR.
if [ -n "${VK_DRIVER_FILES:-}" ]; then
  picture=$(mktemp --suffix .png)
  XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-/tmp} cargo run -q --locked --manifest-path variants/shaders/examples/tuft/Cargo.toml \
    --target-dir "$target/tuft" -- "$picture"
  rm "$picture"
fi
