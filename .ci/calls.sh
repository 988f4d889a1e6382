#!/bin/bash
# Promise: the dispatched entry points contain no call; every model is inlined into them whole. One call to a function
# that was not inlined costs more than twice the kernel's time.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v objdump >/dev/null || { apt-get update -qq && apt-get install -qqy binutils; }
program=$(.ci/release.sh)/hairis
# Not counted: integrating the lobes of eight hits, which copies whole BSDFs; beside the integrals a copy is nothing.
objdump -d --no-show-raw-insn -C "$program" | awk '
  /^[0-9a-f]+ <.*>:$/ { name = $0; entry = name ~ /hairis::simd::dispatch::(run|rows|pairs|eight)_avx/ && name !~ /conserving::Integrate/; entries += entry }
  entry && /\tcall/ { print name; print; calls++ }
  END { printf "%d dispatched entry points, %d calls\n", entries, calls; exit calls > 0 || entries < 8 }'
