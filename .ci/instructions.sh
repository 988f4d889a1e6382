#!/bin/bash
# Promise: no entry point takes over 3% more instructions per call than the committed table. Counts both models on every
# level that valgrind emulates (AVX2, not AVX-512).
#
#   .ci/instructions.sh                  compare with the table
#   .ci/instructions.sh --write          rewrite the table, after a change that is worth its instructions
#   .ci/instructions.sh --count PROGRAM  count for another build of the program `entry`; compares with nothing
#
# The program runs under callgrind, which counts within `entry::pass` alone. Only the program's own instructions count: those
# of the system's libraries depend on their version and on the CPU. Of calls into them (memcpy and the like) the table records
# only whether there are any. The counts depend on the compiler alone.
set -euo pipefail
cd "$(dirname "$0")/.."
table=benches/records/instructions.csv
passes=4

command -v valgrind > /dev/null || { .ci/apt update -qq && .ci/apt install -qqy valgrind; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
if [ "${1:-}" = --count ]; then
  source=$2
else
  # .ci/sizes.sh finds the counts in `counts` and does not count again.
  source=$(.ci/release.sh)/entry
fi
counts=$source.counts
# Without its debug information, which valgrind would read.
program=$dir/entry
strip -g -o "$program" "$source"

# sums OUTPUT: instructions of the program itself, and of everything else.
sums() {
  awk -v program="/$(basename "$program")" '
    /^c?ob=/ {
      match($0, /\([0-9]+\)/)
      id = substr($0, RSTART, RLENGTH)
      if (length($0) >= RSTART + RLENGTH) name[id] = substr($0, RSTART + RLENGTH + 1)
      if (/^ob/) now = id
      next
    }
    /^calls=/ { callee = 1; next }
    /^[-+*0-9]/ { if (!callee) sum[now] += $2; callee = 0 }
    END {
      for (id in sum)
        if (substr(name[id], length(name[id]) - length(program) + 1) == program) own += sum[id]
        else others += sum[id]
      printf "%d %d\n", own, others
    }' "$1"
}

# count OPERATION: rows of its entry points. One process makes all passes, as it takes longer to start than for most of them, and writes
# the counts of each. The two patterns differ, as valgrind keeps one option of a pattern.
count() {
  local out=$dir/$1 number=0 line
  valgrind -q --tool=callgrind --toggle-collect='entry::pass*' --dump-after='*entry::pass*' --callgrind-out-file="$out" \
    "$program" run "$1/*" $passes > "$out.calls"
  # Calls in a pass and directions in a call; then own and other instructions of the passes.
  while read -r line; do
    number=$((number + 1))
    [[ $line == */reference/* ]] || echo "$line $(sums "$out.$number")"
  done < "$out.calls" | awk -v passes=$passes '{
    calls = passes * $2
    if ($4 < calls) { print "FAIL " $1 ": nothing was counted" > "/dev/stderr"; exit 1 }
    libraries = ($5 < 0.5 * calls) ? "no" : "yes"
    printf "%s,%d,%.1f,%s\n", $1, $3, $4 / calls, libraries
  }' > "$out.rows"
}
export -f count sums
export program dir passes

operations=(resample sample eval hits prepare)
printf '%s\n' "${operations[@]}" | xargs -P "$(nproc)" -I OPERATION bash -euo pipefail -c 'count OPERATION'
rows=$(for operation in "${operations[@]}"; do cat "$dir/$operation.rows"; done)
echo "$rows" > "$counts"
[ "$(wc -l <<< "$rows")" -ge 42 ] || echo "this CPU has no AVX2: its level was not counted" >&2

case ${1:-} in
  --count) echo "$rows" ;;
  --write)
    {
      echo "# Instructions per call, by .ci/instructions.sh --write with $(rustc -V); libraries: whether a call leaves the program."
      echo "entry,directions,instructions,libraries"
      echo "$rows"
    } > "$table"
    echo "wrote $table"
    ;;
  *)
    grep -qF "with $(rustc -V);" "$table" ||
      echo "note: $(rustc -V) is not the compiler of the table: $(sed -n 1p "$table")"
    awk -F, '
      /^#/ || /^entry,/ { next }
      FNR == NR { was[$1] = $3; left[$1] = $4; next }
      !($1 in was) { print "FAIL " $1 " is not in the table"; bad++; next }
      {
        compared++
        grown = 100 * ($3 / was[$1] - 1)
        if (grown > 3) { printf "FAIL %s: %.1f instructions, %.1f%% more than the %.1f of the table\n", $1, $3, grown, was[$1]; bad++ }
        else if (grown < -3) printf "%s: %.1f instructions, %.1f%% fewer than the %.1f of the table\n", $1, $3, -grown, was[$1]
        if ($4 == "yes" && left[$1] == "no") { print "FAIL " $1 " now calls a library"; bad++ }
      }
      END {
        printf "%d entry points counted, %d grew or are new\n", compared, bad
        if (bad) print "if that is intended, .ci/instructions.sh --write makes the table anew: commit it, and say why"
        exit bad > 0 || compared == 0
      }' "$table" - <<< "$rows"
    ;;
esac
