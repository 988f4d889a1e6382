#!/bin/bash
# Both hosts on an emulated Cortex-M4F, with their flash and stack: run.sh TO [CARGO ARGUMENT...]. Needs arm-none-eabi-gcc, qemu-system-arm
# and Rust's target thumbv7em-none-eabihf.
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: run.sh TO [CARGO ARGUMENT...]" >&2; exit 2; }
to=$(realpath -m "$1"); shift
cd "$(dirname "$0")"
target=thumbv7em-none-eabihf
cargo build -q --locked --release --target $target --target-dir "$to/rust" "$@"
# Without std, and optimised for size as the host in Rust is.
cargo rustc -q --locked --manifest-path ../../Cargo.toml --profile capi --config 'profile.capi.opt-level="s"' --no-default-features \
  --crate-type staticlib --target $target --target-dir "$to/c" "$@"
arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -std=c11 -Os -ffreestanding -nostdlib -Wall -Wextra \
  -pedantic -Werror -I../../include start.s host.c "$to/c/$target/capi/libhairis_capi.a" -Wl,--gc-sections -T memory.ld -o "$to/host-c"
cp "$to/rust/$target/release/host" "$to/host-rust"
for language in rust c; do
  arm-none-eabi-size "$to/host-$language" | awk -v language=$language 'NR == 2 { print language ": " $1 + $2 " bytes of flash, " $3 " of static memory" }'
  timeout 60 qemu-system-arm -M mps2-an386 -cpu cortex-m4 -nographic -monitor none -serial none -semihosting-config enable=on,target=native \
    -kernel "$to/host-$language" 2> "$to/$language.txt" || { cat "$to/$language.txt"; echo "FAIL $language: exit code $?"; exit 1; }
  # Sizes are printed in digits of 16, as numbers are.
  while read -r words; do
    case $words in *bytes*) echo "  ${words% *} $((16#${words##* }))" ;; *) echo "  $words" ;; esac
  done < "$to/$language.txt"
done
cmp <(grep -v bytes "$to/rust.txt") <(grep -v bytes "$to/c.txt") && echo "the same bits through Rust and through C"
