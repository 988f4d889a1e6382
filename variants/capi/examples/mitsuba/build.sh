#!/bin/bash
# The plugin, against the wheels of Mitsuba, Dr.Jit and nanobind of a Python and an installed hairis: build.sh PYTHON PREFIX TO. Mitsuba's
# wheel is compiled for x86-64-v3: a plugin for another instruction set loads, and its vectors have another layout.
set -euo pipefail
[ $# = 3 ] || { echo "usage: build.sh PYTHON PREFIX TO" >&2; exit 2; }
python=$1 prefix=$(realpath "$2") to=$3
cd "$(dirname "$0")"
site=$("$python" -c 'import mitsuba, os; print(os.path.dirname(os.path.dirname(mitsuba.__file__)))')
mkdir -p "$to"
g++ -std=c++17 -O2 -march=x86-64-v3 -fPIC -shared -fvisibility=hidden -Wno-attributes -DMI_BUILD_MODULE=0 \
  -I"$site/mitsuba/include" -I"$site/drjit/include" -I"$site/nanobind/include" -I"$site/nanobind/ext/robin_map/include" \
  -I"$prefix/include" hairis_plugin.cpp -o "$to/hairis.so" -L"$site/mitsuba" -L"$site/drjit" \
  -l:libmitsuba.so -l:libdrjit-core.so -l:libdrjit-extra.so -L"$prefix/lib" -lhairis \
  -Wl,-rpath,"$site/mitsuba:$site/drjit:$prefix/lib"
