#!/bin/bash
# Promise: the command hairis runs on real input as a user runs it, and refuses bad input in one line.
set -euo pipefail
cd "$(dirname "$0")/.."
hairis=$(.ci/release.sh)/hairis
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

# Promise: compare writes its page, its JSON and its tables.
"$hairis" compare --quick --out "$dir/out" > "$dir/tables.txt"
for file in "$dir/out/compare.json" "$dir/out/report.html" "$dir/tables.txt"; do
  [ -s "$file" ] || { echo "FAIL $file is missing or empty"; exit 1; }
done
python3 -m json.tool "$dir/out/compare.json" > /dev/null

# Promise: a study in two parts has the same bytes as one run.
"$hairis" study --quick --out "$dir/study" > "$dir/tables.txt" 2> /dev/null
for shard in 1/2 2/2; do "$hairis" study --quick --shard "$shard" --out "$dir/parts" 2> /dev/null; done
"$hairis" merge "$dir/joined" "$dir/parts" > /dev/null 2>&1
for file in study.csv study.parquet; do
  [ -s "$dir/study/$file" ] && cmp "$dir/study/$file" "$dir/joined/$file" || { echo "FAIL $file"; exit 1; }
done

# Promise: each claim has a verdict.
"$hairis" claims --quick --out "$dir/claims" > "$dir/tables.txt" 2> /dev/null
python3 - "$dir/claims/claims.json" <<'END'
import json, sys
claims = json.load(open(sys.argv[1]))["claims"]
assert claims and all(c["verdict"] in ("holds", "holds within limits", "false") for c in claims), claims
END

# Promise: bad input gets exit code 2 and one line that names the problem.
refused() { # refused WORDS ARGUMENT...: exit code 2 and one line that says WORDS
  local words=$1 code=0; shift
  "$hairis" "$@" > /dev/null 2> "$dir/error" < /dev/null || code=$?
  [ "$code" = 2 ] || { echo "FAIL exit code $code of: $*"; exit 1; }
  [ "$(wc -l < "$dir/error")" = 1 ] && grep -q "$words" "$dir/error" || { echo "FAIL $*:"; cat "$dir/error"; exit 1; }
}
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n\x02\x02' > "$dir/cut.hdr"
refused 'missing.hdr' compare --quick --out "$dir/out" --env "$dir/missing.hdr"
refused 'cut.hdr' compare --quick --out "$dir/out" --env "$dir/cut.hdr"
refused 'tables.txt' compare --quick --out "$dir/tables.txt/out"
refused 'seed' compare --seed many
refused 'quik' compare --quik
refused 'seed' claims --seed many
refused 'shard' study --shard 5/4
refused 'seed 1' study --quick --seed 2 --out "$dir/study"
refused 'no part' merge "$dir/joined" "$dir/joined"

# Promise: shader prints a model that a C compiler accepts, and refuses a name that is none.
"$hairis" shader --model chiang --target c --gradient > "$dir/hairis.h"
echo '#include "hairis.h"
int main(void) {
  HairisVec3 wo = {0, 1, 0}, wi = {0.28f, 0.96f, 0};
  return !(hairis_chiang_eval_hit(hairis_chiang_material_brown(), wo, 0.5f, wi).pdf > 0);
}' > "$dir/main.c"
cc -std=c99 -Wall -Wextra -Werror "$dir/main.c" -o "$dir/main" -lm && "$dir/main" || { echo "FAIL the header of chiang"; exit 1; }
refused 'must be one of' shader --model fur --target c
# Promise: a C compiler and the folder of all models are enough to shade a hair, and the example prints the lines of the README.
"$hairis" shader --out "$dir/source" > /dev/null
shaded=$(cd "$dir/source" && cc -std=c99 -O2 -Wall -Wextra -pedantic -Werror example.c -o example -lm && ./example)
[ "$shaded" = "$(sed -n '/^```text$/,/^```$/p' "$dir/source/README.md" | grep -v '^```')" ] || { echo "FAIL the folder's example: $shaded"; exit 1; }
refused 'must be a new folder' shader --out "$dir"

# Promise: a fitted material is a request of eval, and nearer than its start.
"$hairis" fit --from gaussian --to cauchy --starts 1 --out "$dir/fit" > "$dir/fitted.json" 2> /dev/null
python3 - "$dir" <<'END' | "$hairis" eval | grep -q '"pdf_lobe"' || { echo "FAIL fit"; exit 1; }
import json, sys
fit = json.load(open(sys.argv[1] + "/fit/fit.json"))
assert fit["distance"] < fit["distance_of_start"], fit
print(json.dumps(json.load(open(sys.argv[1] + "/fitted.json")) | {"wo": [0, 1, 0], "wi": [0.6, 0.8, 0]}))
END
refused 'must be one of' fit --from fur --to cauchy --out "$dir/fit"
refused 'must be one of' fit --from gaussian --to cauchy --fix fur --out "$dir/fit"

# Promise: eval answers a request.
answer=$(echo '{"model":"cauchy","params":{"alpha":[-0.13,0.065,0.2],"beta":[0.13,0.065,0.26],"gamma_tt":0.17,"gamma_g":0.17,
"phi_g":0.6,"i_r":[0.3,0.3,0.3],"i_tt":[0.8,0.6,0.4],"i_trt":[0.7,0.5,0.3],"i_g":0.5},"wo":[0,1,0],"wi":[0.6,0.8,0]}' |
  tr -d '\n' | "$hairis" eval)
grep -q '"pdf_lobe"' <<<"$answer" || { echo "FAIL eval: $answer"; exit 1; }
echo "the main job runs, and bad input is refused in one line"
