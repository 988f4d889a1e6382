#!/usr/bin/env python3
"""What the library is made of, by call and model, in kB of code: symbols.py PREFIX/lib/libhairis.a, after install.sh PREFIX. The static
library keeps the names of its functions."""
import collections
import re
import subprocess
import sys

CALLS = (
    ("hits, evaluate", r"HitEvals"),
    ("hits, sample", r"HitSamples"),
    ("hits, one lane and groups", r"hits::run"),
    ("columns, evaluate", r"columns::Eval|hairis_eval_columns"),
    ("columns, sample", r"columns::Sample|hairis_sample_columns"),
    ("columns, weigh", r"Weighs|weigh_columns"),
    ("one direction", r"points::"),
    ("set-up, fit of the albedo", r"prepare8|prepare_integrated|albedo|Integrate<|kernels::Prepare<|conserving"),
    ("set-up, parameters", r"setup::|color::|models::|text::|artist::|from_values|registry|parameters|params::"),
)
MODELS = (
    ("matched, 25 bands", r"Matched<[^>]*, 25>"),
    ("matched, 5 bands", r"Matched<[^>]*, 5>"),
    ("matched", r"Matched<"),
    ("published", r"Published<"),
    ("Chiang, by channel", r"Chiang<true>"),
    ("Chiang", r"Chiang"),
    ("d'Eon", r"DEon"),
    ("Kajiya-Kay", r"KajiyaKay"),
)


def first(name: str, groups: tuple, rest: str) -> str:
    return next((label for label, pattern in groups if re.search(pattern, name)), rest)


def main() -> None:
    lines = subprocess.run(["nm", "-SC", "-t", "d", sys.argv[1]], capture_output=True, text=True, check=True).stdout.splitlines()
    table: dict = collections.defaultdict(collections.Counter)
    seen = set()
    for line in lines:
        match = re.match(r"(\d+) (\d+) [tTwW] (.*)", line)
        if match and (int(match[1]) == 0 or match[1] not in seen):
            seen.add(match[1])
            call = first(match[3], CALLS, "std, core and the rest")
            table[call][first(match[3], MODELS, "any model")] += int(match[2])
    models = [label for label, _ in MODELS] + ["any model"]
    print("| kB of text | all | " + " | ".join(models) + " |")
    print("|---|" + "--:|" * (len(models) + 1))
    total: collections.Counter = collections.Counter()
    for call in [label for label, _ in CALLS] + ["std, core and the rest"]:
        print(f"| {call} | {sum(table[call].values()) / 1e3:.0f} | " + " | ".join(f"{table[call][m] / 1e3:.0f}" for m in models) + " |")
        total += table[call]
    print(f"| all | {sum(total.values()) / 1e3:.0f} | " + " | ".join(f"{total[m] / 1e3:.0f}" for m in models) + " |")


main()
