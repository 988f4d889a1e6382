#!/bin/bash
# Promise: opt-levels "s" and "z" add no calls to AVX2 and AVX-512 code, but those that .ci/sizes.py names, and "s" takes at most
# 1.5 times the time of 3.
# Reports bytes of code, calls and instructions per call of the entry points. The check has three models at "s" and "z", in which is
# the code of the others; tables and times have all of them.
#
#   .ci/sizes.sh           checks; fails above 1.55 times the instructions at "s", which stays below 1.5 times the time
#                          (reservoirs: 1.65, Kajiya-Kay and Chiang: 1.95, one lane of the set-up of Chiang: 2.1)
#   .ci/sizes.sh --build   compiles only
#   .ci/sizes.sh --write   writes the table to benches/records/sizes.csv as well
#   .ci/sizes.sh --time    time of every entry point at "s" and "z" against 3, programs interleaved
set -euo pipefail
cd "$(dirname "$0")/.."
command -v objdump > /dev/null || { .ci/apt update -qq && .ci/apt install -qqy binutils; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

case ${1:-} in
  --write | --time) features= ;;
  *) features=three-models ;;
esac
# Level 3 comes last: .ci/calls.sh builds it meanwhile, and `built` is its folder below.
for level in "s $features" "z $features" 3; do
  built=$(.ci/release.sh $level)
  cp "$built/entry" "$dir/entry-${level%% *}"
done
[ "${1:-}" != --build ] || exit 0

if [ "${1:-}" = --time ]; then
  # ROUNDS rounds; the median over them of the time, and of the ratios within a round.
  for round in $(seq "${ROUNDS:-5}"); do
    for start in prepare/ eval/ sample/ resample/; do
      for level in 3 s z; do "$dir/entry-$level" time "$start*" 0.02 | sed "s/^/$round $level /"; done
    done
  done | grep -v reference | python3 -c '
import statistics, sys
ns = {}
for line in sys.stdin:
    round, level, name, time = line.split()
    ns.setdefault(name, {}).setdefault(round, {})[level] = float(time)
print("entry,ns_3,ns_s,ns_z,s_over_3,z_over_3")
for name, rounds in ns.items():
    median = lambda f: statistics.median(f(r) for r in rounds.values())
    times = ",".join(f"{median(lambda r: r[level]):.3f}" for level in "3sz")
    ratios = ",".join(f"{median(lambda r: r[level] / r[chr(51)]):.2f}" for level in "sz")
    print(f"{name},{times},{ratios}")'
  exit
fi

failed=0
python3 .ci/sizes.py 3="$dir/entry-3" s="$dir/entry-s" z="$dir/entry-z" > "$dir/sizes.csv" || failed=1
# Of level 3, .ci/instructions.sh has counted this very program if it ran before.
counted=$built/entry.counts
if [ "$counted" -nt "$built/entry" ]; then cp "$counted" "$dir/3.csv"
else .ci/instructions.sh --count "$dir/entry-3" > "$dir/3.csv"; fi
.ci/instructions.sh --count "$dir/entry-s" > "$dir/s.csv"
join -t, <(sort "$dir/3.csv") <(sort "$dir/s.csv") | awk -F, '
  { ratio = $6 / $3; compared++ }
  ratio > most { most = ratio; name = $1 }
  # Kajiya-Kay and Chiang, written by lobes, are not tuned for "s": measured 1.90 at most. Reservoirs: measured 1.61. One lane of the set-up of
  # Chiang: 2.05, 1811 over 882, as level 3 makes vectors of four lobes and channels, and "s" none.
  function bound(name) { return name == "prepare/prepare/chiang/scalar" ? 2.1 : name ~ /kajiya-kay|chiang|d-eon/ ? 1.95 : name ~ /reservoir/ ? 1.65 : 1.55 }
  ratio > bound($1) { printf "FAIL %s: %.2f times the instructions at s\n", $1, ratio; bad++ }
  END { printf "%d entry points, at most %.2f times the instructions at s (%s)\n", compared, most, name; exit bad > 0 || compared < 120 }' || failed=1

if [ "${1:-}" = --write ]; then
  { echo "# Bytes of code and calls by opt-level, by .ci/sizes.sh --write with $(rustc -V)."; cat "$dir/sizes.csv"; } > benches/records/sizes.csv
else
  cat "$dir/sizes.csv"
fi
exit $failed
