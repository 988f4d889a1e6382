#!/bin/bash
# Promise: the dispatched entry points contain no call; every model is inlined into them whole. One call to a function
# that was not inlined costs more than twice the kernel's time. Those of slices save their registers in aligned memory: across two cache
# lines they would take up to 15% longer.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v objdump >/dev/null || { .ci/apt update -qq && .ci/apt install -qqy binutils; }
program=$(.ci/release.sh)/hairis
# Not counted: integrating the lobes of eight hits, which copies whole BSDFs; beside the integrals a copy is nothing.
objdump -d --no-show-raw-insn -C "$program" | awk '
  /^[0-9a-f]+ <.*>:$/ { name = $0; entry = name ~ /hairis::simd::dispatch::(run|rows|pairs|eight)_avx/ && name !~ /conserving::Integrate/; entries += entry }
  entry && /\tcall/ { print name; print; calls++ }
  entry && name !~ /run_avx/ && /vmovup[sd].*%rsp.*%[yz]mm|vmovup[sd].*%[yz]mm.*%rsp/ { print name; print; across++ }
  entry && /vmovap[sd].*%[yz]mm.*%rsp/ { saved++ }
  END {
    printf "%d dispatched entry points, %d calls; %d registers saved, %d moves of slices to or from memory that is not aligned\n", entries, calls, saved, across
    exit calls > 0 || across > 0 || entries < 8 || saved == 0
  }'
