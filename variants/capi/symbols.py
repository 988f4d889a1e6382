#!/usr/bin/env python3
"""What the library is made of: bytes of text by call and by model, from a library that is not stripped.

symbols.py LIBRARY, built by: cargo build --profile capi --config 'profile.capi.strip=false' -p hairis-capi"""
import collections
import re
import subprocess
import sys

CALLS = (
    ("hits that integrate", r"in_packets|Integrate<|kernels::Prepare<|kernels::EvalPdf<|kernels::SampleWi<|Bsdf8"),
    ("hits, evaluate", r"HitEvals"),
    ("hits, sample", r"HitSamples"),
    ("columns, weigh", r"Weighs|weigh_columns"),
    ("columns, evaluate", r"columns::Eval|hairis_eval_columns"),
    ("columns, sample", r"columns::Sample|hairis_sample_columns"),
    ("hits, dispatch and portable", r"hits::run"),
    ("one direction", r"points::"),
    ("set-up", r"setup::|models::|text::|from_values|registry|parameters|params::"),
)
MODELS = (
    ("matched, 25 bands", r"Matched<[^>]*, 25>"),
    ("matched, 5 bands", r"Matched<[^>]*, 5>"),
    ("matched", r"Matched<"),
    ("published", r"Published<"),
    ("Chiang, by channel", r"Chiang<true>"),
    ("Chiang", r"Chiang"),
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
        if match and match[1] not in seen:
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
