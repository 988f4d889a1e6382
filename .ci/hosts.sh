#!/bin/bash
# Promise: C, C++, Python and Mitsuba are hosts of the kernels. The C library answers as Rust does, to the bit, for every model and entry
# point; refuses without writing; reads and writes nothing beyond its columns, under AddressSanitizer and valgrind; exports its header's
# names alone; links by CMake, by pkg-config and beside another Rust library. The wheel passes its tests, those of its modules for Dr.Jit
# and JAX included. Models printed for Python have the accuracy of one lane in NumPy and Dr.Jit, and derivatives there, and the wheel has
# the same source. Mitsuba's own chi-square test accepts every sampler.
#
# Needs cargo, gcc, and Debian's packages and PyPI for the rest. Prints the time of each part, and the sizes.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
root=$PWD
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
work=$target/hosts
mkdir -p "$work"
# With a space, which every host has to quote.
prefix=$work/the\ prefix
capi=$root/variants/capi
part() { printf -- '--- %s (%ss)\n' "$*" "$SECONDS"; }

part tools
packages=()
command -v cmake > /dev/null || packages+=(cmake)
command -v pkg-config > /dev/null || packages+=(pkg-config)
command -v valgrind > /dev/null || packages+=(valgrind)
ls /usr/lib/*/libLLVM.so.[0-9]* > /dev/null 2>&1 || packages+=(libllvm19)
[ ${#packages[@]} = 0 ] || { .ci/apt update -qq && .ci/apt install -qqy "${packages[@]}" > /dev/null; }
python=$work/venv/bin/python
[ -x "$python" ] || python3 -m venv "$work/venv"
"$python" -m pip install -q 'maturin>=1.9,<2' numpy mypy pytest matplotlib jax 'mitsuba==3.9.1' 'nanobind>=2'

part builds
# On one core the library as it is by default, and the wheel; meanwhile what Rust answers, and the library that is watched. .ci/long.sh
# builds the library with the feature `every-sampler`.
libraries() {
  "$capi/install.sh" "$prefix"
  cd variants/python
  rm -rf "$work/wheels"
  "$work/venv/bin/maturin" build -q --locked --target-dir "$work/wheel" --out "$work/wheels"
}
CARGO_BUILD_JOBS=1 libraries > "$work/libraries.log" 2>&1 &
libraries=$!
cargo build -q --release --locked --manifest-path .ci/hosts/Cargo.toml --target-dir "$work/answers"
"$work/answers/release/hairis-hosts" "$work"
# Every model, and every access of the library is checked. Not optimised, which does not change a bit and takes two minutes to compile.
# RUSTC_BOOTSTRAP for this command alone: the sanitizer is no stable option.
host=$(rustc -vV | sed -n 's/^host: //p')
RUSTC_BOOTSTRAP=1 RUSTFLAGS="$RUSTFLAGS -Zsanitizer=address" cargo rustc -q --locked -p hairis-capi --profile capi \
  --config 'profile.capi.lto=false' --config 'profile.capi.opt-level=0' --no-default-features --features every-sampler \
  --crate-type staticlib --target "$host" --target-dir "$work/asan"
wait $libraries || { cat "$work/libraries.log"; echo "FAIL the library or the wheel"; exit 1; }

part header
strict=(-Wall -Wextra -pedantic -Werror -I"$prefix/include")
for standard in c11 c17; do gcc -std=$standard "${strict[@]}" -fsyntax-only "$work/layout.c"; done
for standard in c++17 c++20; do g++ -std=$standard "${strict[@]}" -x c++ -fsyntax-only "$prefix/include/hairis.hpp"; done
names() { sort -u | sed 's/ *$//'; }
declared=$(grep -oE '\bhairis_[a-z_]+\(' "$prefix/include/hairis.h" | tr -d '(' | names)
exported=$(nm -D --defined-only "$prefix/lib/libhairis.so" | awk '{print $3}' | names)
[ "$declared" = "$exported" ] || { diff <(echo "$declared") <(echo "$exported"); echo "FAIL the library exports other names than the header declares"; exit 1; }
echo "$(grep -c _Static_assert "$work/layout.c") assertions on the layout; $(wc -l <<<"$exported") names exported, those of the header"
readelf -d "$prefix/lib/libhairis.so" | grep -q 'SONAME.*\[libhairis.so.1\]' || { echo "FAIL SONAME"; exit 1; }

part C
dynamic=(-L"$prefix/lib" -Wl,-rpath,"$prefix/lib" -lhairis -lm)
build_c() { gcc -std=c11 -O2 -g "${strict[@]}" "$1" -o "$2" "${@:3}"; }
build_c "$capi/tests/bits.c" "$work/bits" "${dynamic[@]}"
build_c "$capi/tests/refusals.c" "$work/refusals" "${dynamic[@]}"
# The library must refuse the ten models of `every-sampler` by name: with two presets and three energies each.
HAIRIS_MAY_LACK=1 "$work/bits" "$work/answers.bin" | tee "$work/bits.log"
grep -q '; 60 are not in the library' "$work/bits.log" || { echo "FAIL the library has other models"; exit 1; }
"$work/refusals"

part 'floating-point exceptions'
build_c "$capi/tests/exceptions.c" "$work/exceptions" "${dynamic[@]}"
build_c "$capi/tests/exceptions.c" "$work/exceptions-static" "$prefix/lib/libhairis.a" -lpthread -ldl -lm
for library in '' -static; do
  printf 'libhairis%s: ' "${library:-.so}"
  "$work/exceptions$library"
  "$work/exceptions$library" trap
done
# Programs that trap: a furnace by columns, and a loop of samples and evaluations as renderers have it.
for example in furnace.c pbrt_hair.cpp; do
  case $example in *.c) compiler='gcc -std=c11' ;; *) compiler='g++ -std=c++17' ;; esac
  $compiler -O2 -D_GNU_SOURCE "${strict[@]}" -include "$capi/tests/traps.h" "$capi/examples/$example" -o "$work/trapping" "${dynamic[@]}"
  "$work/trapping" > "$work/trapping.log" || { cat "$work/trapping.log"; echo "FAIL $example with traps"; exit 1; }
done
echo 'furnace.c and pbrt_hair.cpp end well with traps'

# What watches memory must report a column that is one number short, in the call that fills it.
reported() { # reported COMMAND...
  "$@" > "$work/short.log" 2>&1 && { echo "FAIL a column that is too short is not reported"; exit 1; }
  grep -q 'AddressSanitizer: heap-buffer-overflow\|Invalid write of size' "$work/short.log" &&
    grep -q 'hairis_eval_columns' "$work/short.log" || { cat "$work/short.log"; echo "FAIL a short column is reported otherwise"; exit 1; }
}

part AddressSanitizer
# Of every model: the library lacks none.
watched=(-fsanitize=address "$work/asan/$host/capi/libhairis_capi.a" -lm)
build_c "$capi/tests/bits.c" "$work/bits-asan" "${watched[@]}"
build_c "$capi/tests/refusals.c" "$work/refusals-asan" "${watched[@]}"
"$work/bits-asan" "$work/answers.bin"
# A wrong answer is found: the last but one number of the file is changed.
cp "$work/answers.bin" "$work/wrong.bin"
printf '\x01' | dd of="$work/wrong.bin" bs=1 seek=$(($(stat -c %s "$work/wrong.bin") - 7)) conv=notrunc status=none
if "$work/bits-asan" "$work/wrong.bin" > /dev/null 2>&1; then echo "FAIL bits accepts a wrong answer"; exit 1; fi
"$work/refusals-asan"
reported "$work/bits-asan" "$work/answers.bin" short

part valgrind
HAIRIS_MAY_LACK=1 valgrind -q --error-exitcode=9 "$work/bits" "$work/answers.bin"
valgrind -q --error-exitcode=9 "$work/refusals"
reported valgrind -q --error-exitcode=9 --exit-on-first-error=yes "$work/bits" "$work/answers.bin" short

part 'C++, CMake, pkg-config'
cmake -S "$capi/tests" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release > /dev/null
cmake --build "$work/consumer" > /dev/null
"$work/consumer/shared"
"$work/consumer/static" > /dev/null
# The folders of cargo-c and of distributions.
moved=$work/moved
libraries=$moved/lib/$(gcc -print-multiarch)
rm -rf "$moved"
mkdir -p "$libraries" "$moved/share"
cp -r "$prefix/include" "$moved"
cp -a "$prefix"/lib/libhairis.* "$libraries"
cp -r "$prefix/lib/cmake" "$moved/share"
cmake -S "$capi/tests" -B "$work/consumer-moved" -DCMAKE_PREFIX_PATH="$moved" -DCMAKE_BUILD_TYPE=Release > /dev/null
cmake --build "$work/consumer-moved" --target shared > /dev/null
"$work/consumer-moved/shared"
# A prefix is one word of the flags, whatever its letters are, and refused where pkg-config cannot quote it.
for name in 'a  b' "it's" 'a"b' 'a#b' 'a\b' 'a;b&c|d' 'a*?[x]' 'a`b`' ' a' $'\303\251'; do
  odd=$work/odd/$name
  "$capi/install.sh" "$odd" > "$work/odd.log" 2>&1 || { cat "$work/odd.log"; echo "FAIL a prefix: $odd"; exit 1; }
  eval "flags=($(PKG_CONFIG_PATH=$odd/lib/pkgconfig pkg-config --cflags --libs hairis))"
  [ "${flags[*]}" = "-I$odd/include -L$odd/lib -lhairis" ] || { echo "FAIL the flags of pkg-config: ${flags[*]}"; exit 1; }
done
for name in 'a$b' 'a(b' 'a)' $'a\nb' $'a\n' $'a\t' 'a '; do
  if "$capi/install.sh" "$work/odd/$name" 2> "$work/odd.log" || [ "$(grep -c '^PREFIX must' "$work/odd.log")/$(wc -l < "$work/odd.log")" != 1/1 ]; then
    echo "FAIL the prefix '$name' is not refused in one line"; exit 1
  fi
done
rm -r "$work/odd"
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
eval "flags=($(pkg-config --cflags --libs hairis))"
for example in furnace.c furnace.cpp pbrt_hair.cpp resample.cpp; do
  case $example in *.c) compiler='gcc -std=c11' ;; *) compiler='g++ -std=c++17' ;; esac
  $compiler -O2 -Wall -Wextra -pedantic -Werror "$capi/examples/$example" -o "$work/example" "${flags[@]}" -lm
  (cd "$work" && LD_LIBRARY_PATH=$prefix/lib ./example > example.log) || { cat "$work/example.log"; echo "FAIL $example"; exit 1; }
  tail -2 "$work/example.log"
done

for exceptions in -fexceptions '-fno-exceptions -fno-rtti'; do
  g++ -std=c++17 $exceptions -O2 -Wall -Wextra -pedantic -Werror "$capi/tests/reporting.cpp" -o "$work/reporting" "${flags[@]}"
  LD_LIBRARY_PATH=$prefix/lib "$work/reporting"
done

part 'two Rust libraries'
rustc --edition 2024 --crate-type staticlib -O "$capi/tests/other.rs" -o "$work/libother.a"
other=$work/libother.a hairis=$prefix/lib/libhairis.a
gcc -std=c11 "${strict[@]}" "$capi/tests/two.c" -o "$work/two" "$other" "$hairis" -lpthread -ldl -lm
"$work/two"
gcc -std=c11 "${strict[@]}" "$capi/tests/two.c" -o "$work/two" "$hairis" "$other" -lpthread -ldl -lm
"$work/two"

# The newest LLVM: version 15 does not compile Dr.Jit's code for AVX-512.
DRJIT_LIBLLVM_PATH=$(ls /usr/lib/*/libLLVM.so.[0-9]* 2> /dev/null | sort -V | tail -1)
export DRJIT_LIBLLVM_PATH
part wheel
"$python" -m pip install -q --force-reinstall --no-deps "$work"/wheels/*.whl
"$python" -m pytest -q -p no:cacheprovider variants/python/tests
(cd variants/python && MYPYPATH=tests "$work/venv/bin/mypy" --strict --cache-dir "$work/mypy" hairis tests examples)
"$python" variants/python/tests/same_as_c.py "$prefix/lib/libhairis.so"

part 'NumPy and Dr.Jit'
programs=$(.ci/release.sh)
HAIRIS_HITS=100 "$python" .ci/frameworks.py "$programs/hairis" numpy drjit > "$work/frameworks.log" ||
  { grep FAIL "$work/frameworks.log"; exit 1; }

part Mitsuba
(cd "$capi/examples/mitsuba" && "$python" chi2.py 1000000)
# The referee judges the hair of Mitsuba itself: its values have a cosine, and are right, and so are its samples.
"$programs/hairis-referee" vectors --model chiang | "$python" harness/referee/examples/mitsuba_hair.py > "$work/mitsuba.json"
{ "$programs/hairis-referee" check --tolerance 0.01 "$work/mitsuba.json" || true; } | tee "$work/verdict"
grep -q '^value .* factor cos theta_i, else right' "$work/verdict"
grep -q '^samples .* right' "$work/verdict"
"$capi/examples/mitsuba/build.sh" "$python" "$prefix" "$work/plugins"
(cd "$work" && "$python" "$capi/examples/mitsuba/pixels.py" "$work/plugins")

part figures
printf 'libhairis.so %s bytes, libhairis.a %s, wheel %s\n' "$(stat -c %s "$prefix/lib/libhairis.so.1.0.0")" \
  "$(stat -c %s "$prefix/lib/libhairis.a")" "$(stat -c %s "$work"/wheels/*.whl)"
[ "$(stat -c %s "$prefix/lib/libhairis.so.1.0.0")" -le 2750000 ] || { echo "FAIL the library has more than 2.75 MB"; exit 1; }
[ "$(stat -c %s "$work"/wheels/*.whl)" -le 1990000 ] || { echo "FAIL the wheel has more than 1.99 MB"; exit 1; }
echo "hosts passed in ${SECONDS}s"
