#!/bin/bash
# Builds the C library, and installs it with its headers, pkg-config file and CMake package: install.sh PREFIX [FEATURES]. FEATURES
# are those of Cargo.toml, separated by commas: "raw-hits", which is the default, for raw hits in less time; "every-sampler" for samplers
# that few programs need, for two thirds more size; "std" for a message where a panic ends the program. DESTDIR is put before PREFIX, as
# packagers expect. PREFIX may have spaces and quotes. Needs cargo and a C compiler.
set -euo pipefail
[ $# -ge 1 ] && [ $# -le 2 ] || { echo "usage: install.sh PREFIX [FEATURES]" >&2; exit 2; }
prefix=$(realpath -m -- "$1") features=${2-raw-hits}
case $1$prefix in
  *[[:cntrl:]'$()']* | *' ')
    printf 'PREFIX must have no control character, $, ( or ) and no space at its end, which pkg-config cannot quote, got %q\n' "$1" >&2
    exit 2 ;;
esac
cd "$(dirname "$0")"
target=$(realpath -m "${CARGO_TARGET_DIR:-../../target}")/capi-install
# Both libraries at once, and not the Rust library, with which cargo would not optimise at link time.
cargo rustc --locked --profile capi --target-dir "$target" --no-default-features --features "$features" --crate-type cdylib,staticlib

to=${DESTDIR:-}$prefix
install -d "$to/include" "$to/lib/pkgconfig" "$to/lib/cmake/hairis"
install -m 644 include/hairis.h include/hairis.hpp "$to/include"
install -m 755 "$target/capi/libhairis_capi.so" "$to/lib/libhairis.so.1.0.0"
ln -sf libhairis.so.1.0.0 "$to/lib/libhairis.so.1"
ln -sf libhairis.so.1 "$to/lib/libhairis.so"
install -m 644 "$target/capi/libhairis_capi.a" "$to/lib/libhairis.a"
install -m 644 cmake/*.cmake "$to/lib/cmake/hairis"
# pkg-config fills in the prefix, and then splits the fields into words.
word=$(sed 's/[ "\x27\\#]/\\&/g' <<< "$prefix")
cat > "$to/lib/pkgconfig/hairis.pc" <<PC
prefix=$word
Name: hairis
Description: Hair scattering for renderers
Version: 1.0.0
Libs: -L\${prefix}/lib -lhairis
Cflags: -I\${prefix}/include
PC
echo "installed in $to"
