#!/bin/bash
# Promise: results depend on whether a level fuses, and on nothing else of the machine or the build. `.ci/nostd` with feature
# `bits` prints a hash per entry point, model and level over fixed inputs; hashes of one name and one rounding must be equal
# on every target, and calls that take no level must have the same hash everywhere.
#
#   .ci/bits.sh              x86-64 and x86-64-v3, at every level of this CPU
#   .ci/bits.sh TARGET...    these as well: aarch64 (fuses), armv7, riscv64, i686, s390x, thumb (Cortex-M4), wasm, wasm-simd
#   .ci/bits.sh all          all of them: 20 minutes
#
# Other targets need Debian's rustc-web with its library source, and QEMU: they are unpacked under $TOOLS (600 MB), not
# installed. wasm needs node. Hashes are left in target/bits.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
tools=${TOOLS:-$target/tools}
out=$target/bits
mkdir -p "$out" "$tools"
. .ci/unpack
rm -f "$out"/*.txt
cd .ci/nostd
# Bits do not depend on the optimisation level, either; this one compiles fastest.
build=(cargo build -q --release --locked --features bits --config 'profile.release.opt-level=0')

cross() { # cross NAME TARGET RUSTFLAGS: builds core and the program; prints the program's path
  unpack rust rustc-web rust-web-src
  wrapped rust usr/bin/rustc
  local lld; lld=$(rustc --print sysroot)/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld
  RUSTC=$tools/rustc RUSTC_BOOTSTRAP=1 RUSTFLAGS="$3 -Clinker=$lld -Crelocation-model=static" "${build[@]}" \
    --target "$2" -Zbuild-std=core -Zbuild-std-features=compiler-builtins-mem --target-dir "$target/bits-$1"
  echo "$target/bits-$1/$2/release/hairis-nostd"
}
linux() { # linux NAME TARGET EMULATOR
  unpack qemu-user qemu-user-static
  local program; program=$(cross "$1" "$2" -Clinker-flavor=ld.lld)
  "$tools/qemu-user/usr/bin/qemu-$3-static" "$program" > "$out/$1.txt"
}
run() {
  case $1 in
    x86-64) "${build[@]}" --target-dir "$target/bits-x86-64"
      "$target/bits-x86-64/release/hairis-nostd" > "$out/x86-64.txt" ;;
    x86-64-v3)
      if ! grep -qw avx2 /proc/cpuinfo || ! grep -qw fma /proc/cpuinfo; then echo "x86-64-v3: this CPU has no AVX2"; return; fi
      RUSTFLAGS="$RUSTFLAGS -Ctarget-cpu=x86-64-v3" "${build[@]}" --target-dir "$target/bits-x86-64-v3"
      "$target/bits-x86-64-v3/release/hairis-nostd" > "$out/x86-64-v3.txt" ;;
    aarch64) linux aarch64 aarch64-unknown-linux-gnu aarch64 ;;
    armv7) linux armv7 armv7-unknown-linux-gnueabihf arm ;;
    riscv64) linux riscv64 riscv64gc-unknown-linux-gnu riscv64 ;;
    i686) linux i686 i686-unknown-linux-gnu i386 ;;
    s390x)
      local code=0; linux s390x s390x-unknown-linux-gnu s390x || code=$?
      if [ $code = 77 ]; then echo "s390x: skipped, this QEMU multiplies doubles wrongly"; rm "$out/s390x.txt"; return; fi
      return $code ;;
    thumb)
      unpack qemu-system qemu-system-arm
      wrapped qemu-system usr/bin/qemu-system-arm -L "$tools/qemu-system/usr/share/qemu"
      local program; program=$(cross thumb thumbv7em-none-eabihf '')
      timeout 600 "$tools/qemu-system-arm" -M mps2-an386 -cpu cortex-m4 -nographic -monitor none -serial none \
        -semihosting-config enable=on,target=native -kernel "$program" 2> "$out/thumb.txt" ;;
    wasm|wasm-simd)
      local features=-simd128 program; [ "$1" = wasm ] || features=+simd128
      program=$(cross "$1" wasm32-unknown-unknown "-Ctarget-feature=$features")
      node wasm.mjs "$program.wasm" > "$out/$1.txt" ;;
    *) echo "no such target: $1"; return 1 ;;
  esac
}

names=(x86-64 x86-64-v3)
[ "${1:-}" != all ] || set -- aarch64 armv7 riscv64 i686 s390x thumb wasm wasm-simd
for name in "${names[@]}" "$@"; do
  run "$name" || { echo "FAIL $name: exit code $?"; exit 1; }
done

cd "$out"
awk '
  { key = $1 " " $2; lines[FILENAME]++ }
  !(key in hash) { hash[key] = $3; place[key] = FILENAME " " $4; next }
  hash[key] != $3 { print "FAIL " FILENAME " " $4 ": " key " is not that of " place[key]; bad++ }
  END {
    for (key in hash) {
      names++
      twin = key; sub(/^fused/, "plain", twin)
      # The hashes must see the rounding of a product, or they prove nothing.
      if (twin != key) { pairs++; if (hash[twin] != hash[key]) differ++ }
    }
    for (file in lines) { files++; if (lines[file] < 140) { print "FAIL " file ": " lines[file] " hashes"; bad++ } }
    printf "%d hashes on %d targets, %d differ from their own; %d of %d pairs tell the roundings apart\n", names, files, bad, differ, pairs
    exit bad > 0 || (pairs && differ < pairs / 2)
  }' *.txt
