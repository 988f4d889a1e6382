#!/bin/bash
# Promise: hosts without an operating system run through Rust and through C, with the same bits. Prints their flash and stack on a
# Cortex-M4F. Debian's rustc-web with its library source, gcc-arm-none-eabi and QEMU are unpacked under $TOOLS (1.5 GB), not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
tools=${TOOLS:-$target/tools}
mkdir -p "$tools"
. .ci/unpack
unpack rust rustc-web rust-web-src
wrapped rust usr/bin/rustc
unpack qemu-system qemu-system-arm
wrapped qemu-system usr/bin/qemu-system-arm -L "$tools/qemu-system/usr/share/qemu"
unpack gcc-arm gcc-arm-none-eabi
for program in gcc size; do wrapped gcc-arm usr/bin/arm-none-eabi-$program; done
lld=$(rustc --print sysroot)/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld
PATH=$tools:$PATH RUSTC=$tools/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER=$lld \
  variants/capi/examples/cortex_m/run.sh "$target/cortex-m" -Zbuild-std=core -Zbuild-std-features=compiler-builtins-mem
