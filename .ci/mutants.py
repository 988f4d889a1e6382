#!/usr/bin/env python3
"""Share of small faults in the kernels and the variants that their tests find. By hand, for hours; needs cargo-mutants.

    .ci/mutants.py run [GROUP...]   tests 300 mutants, of every group
    .ci/mutants.py missed SUITE...  tests those that were missed again, by these: hairis, levels, variants, listed, printed, all;
                                    with MUTANTS=REGEX those whose name it matches
    .ci/mutants.py write            writes benches/records/mutants.csv

cargo-mutants lists every mutant, and a seed draws 300 of them. A group has the mutants of one model, which are compiled for the portable
lanes and this model alone, and tested by the tests of its package in their small size. The suites take longer: a package with all models
for the portable lanes, `listed` with every sampler, and the test command of README.md. Answers are appended to
target/mutants/record.csv as they come, so that a run that was stopped goes on. Groups and suites have clones of their own of the commit, so that two may run side by side.
"""
import collections
import csv
import json
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import time

COUNT, SEED = 300, "hairis"
VARIANTS = ["--features", "hairis-variants/any,hairis-variants/serde"]
PACKAGES = ["-p", "hairis", "-p", "hairis-variants", *VARIANTS]
ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "target" / "mutants"
RECORD = WORK / "record.csv"
COMMITTED = ROOT / "benches/records/mutants.csv"
FLAGS = re.search(r"RUSTFLAGS='(.*)'", (ROOT / ".ci/flags").read_text())[1]
# Tests that count what they have seen on all levels, and find the portable one too few.
SKIPPED = ["--", "--skip", "a_lobe_off_the_sphere_has_the_density_it_is_drawn_with", "--skip", "weights_are_below_their_bound"]
# Package with the tests of each group, the model that is compiled, and the tests' names.
GROUPS = {
    "kernels": ("hairis", "gaussian", ""),
    "levels": ("hairis", "gaussian", ""),
    "dual": ("hairis-variants", None, "dual_scattering"),
    "variants": ("hairis-variants", None, ""),
    "cauchy": ("hairis-variants", "cauchy", ""),
    "chiang": ("hairis-variants", "chiang", ""),
    "d_eon": ("hairis-variants", "d-eon", ""),
    "kajiya_kay": ("hairis-variants", "kajiya-kay", ""),
}
PORTABLE = FLAGS + " --cfg=hairis_portable_alone"
# Packages and features of each suite, what it skips, and its compiler flags.
SUITES = {
    "hairis": (["-p", "hairis", "--all-features", "--lib", "--test", "main"], SKIPPED, PORTABLE),
    "variants": (["-p", "hairis-variants", *VARIANTS, "--test", "main", "--test", "samplers"], SKIPPED, PORTABLE),
    "listed": (["-p", "hairis-variants", "--all-features", "--test", "main"], SKIPPED, PORTABLE),
    "levels": (["-p", "hairis", "--all-features", "--test", "main"], [], FLAGS),
    "printed": (["-p", "hairis-gradients", "-p", "hairis-shaders", "--features", "hairis-shaders/spirv", "--test", "main"], [], PORTABLE),
    "all": (re.search(r"^cargo test(.*)$", (ROOT / "README.md").read_text(), re.M)[1].split(), [], FLAGS),
}


def group_of(file):
    if re.match(r"kernels/src/simd/(avx|dispatch)", file):
        return "levels"
    if file.startswith("kernels/src/dual_scattering"):
        return "dual"
    if file.startswith("kernels/"):
        return "kernels"
    stem = pathlib.Path(file).parts[2].removesuffix(".rs")
    return {"hair": "cauchy"}.get(stem, stem if stem in GROUPS else "variants")


def drawn():
    listed = subprocess.run(["cargo", "mutants", "--list", "--json", *PACKAGES], cwd=ROOT, check=True, capture_output=True, text=True)
    mutants = {mutant["name"]: mutant for mutant in json.loads(listed.stdout)}
    return [mutants[name] for name in random.Random(SEED).sample(sorted(mutants), COUNT)], len(mutants)


def record():
    """The last row of each mutant, and the suites that missed it: of the committed record, and of this run."""
    rows, tried = {}, collections.defaultdict(set)
    for path in (COMMITTED, RECORD):
        if path.exists():
            lines = path.read_text().splitlines()
            for name, outcome, suite, *_ in csv.reader(line for line in lines if not line.startswith(("#", "mutant,"))):
                if outcome != "untested":
                    rows[name] = [outcome, suite]
                    tried[name].add(suite)
    return rows, tried


def mutated(text, mutant):
    """The text of a file with the mutant's span replaced."""
    lines = text.splitlines(keepends=True)
    start, end = mutant["span"]["start"], mutant["span"]["end"]
    at = lambda place: sum(map(len, lines[: place["line"] - 1])) + place["column"] - 1
    return text[: at(start)] + mutant["replacement"] + text[at(end) :]


def runs(command, tree, env, limit):
    """None beyond the limit of seconds, otherwise whether the command succeeds."""
    limits = lambda: resource.setrlimit(resource.RLIMIT_AS, (16 << 30, 16 << 30))
    with (tree.parent / "log").open("a") as log:
        process = subprocess.Popen(
            command, cwd=tree, env=env, stdout=log, stderr=log, start_new_session=True, preexec_fn=limits)
        try:
            return process.wait(limit) == 0
        except subprocess.TimeoutExpired:
            return None
        finally:
            # What is left where a test hangs, or where this program is stopped.
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def clone(name):
    tree = WORK / name / "tree"
    if not tree.exists():
        subprocess.run(["git", "clone", "-q", "--shared", ROOT, tree], check=True)
    subprocess.run(["git", "checkout", "-q", "--force", "--detach", commit()], cwd=tree, check=True)
    return tree


def commit():
    return subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def answer(mutant, tree, build, test, env, limit):
    """Outcome of a mutant: unviable, caught, timeout or missed."""
    path = tree / mutant["file"]
    text = path.read_text()
    path.write_text(mutated(text, mutant))
    try:
        if not runs(build, tree, env, 900):
            return "unviable"
        return {True: "missed", False: "caught", None: "timeout"}[runs(test, tree, env, limit)]
    finally:
        path.write_text(text)


def test(mutants, name, build, test, env, limit):
    tree = clone(name)
    env = os.environ | {"CARGO_TARGET_DIR": str(WORK / name / "target"), "CARGO_TERM_COLOR": "never", "CARGO_INCREMENTAL": "1"} | env
    if not (runs(build, tree, env, 1800) and runs(test, tree, env, limit)):
        sys.exit(f"{name}: the tests do not pass without mutants, see {WORK / name / 'log'}")
    for mutant in mutants:
        start = time.monotonic()
        outcome = answer(mutant, tree, build, test, env, limit)
        row = [mutant["name"], outcome, name, f"{time.monotonic() - start:.0f}"]
        with RECORD.open("a") as file:
            csv.writer(file, lineterminator="\n").writerow(row)
        print(*row, flush=True)


def run(names):
    mutants, (known, _) = drawn()[0], record()
    for name in names or GROUPS:
        package, model, filter = GROUPS[name]
        left = [m for m in mutants if group_of(m["file"]) == name and m["name"] not in known]
        print(name, len(left), flush=True)
        if not left:
            continue
        flags = FLAGS if name == "levels" else PORTABLE
        flags += f' --cfg=hairis_one --cfg=hairis_one="{model}"' if model else ""
        features = VARIANTS if package == "hairis-variants" else ["--all-features"]
        command = ["cargo", "test", "-q", "--locked", "-p", package, *features, "--test", "main"]
        arguments = [*(["--"] if name == "levels" else SKIPPED), "-Zunstable-options", "--fail-fast", *([filter] if filter else [])]
        test(left, name, [*command, "--no-run"], command + arguments, {"RUSTFLAGS": flags, "RUSTC_BOOTSTRAP": "1"}, 400)


def missed(suites):
    for suite in suites:
        known, tried = record()
        names = {name for name, row in known.items() if row[0] == "missed" and suite not in tried[name]}
        pattern = os.environ.get("MUTANTS", "^kernels" if suite == "hairis" else "")
        left = [m for m in drawn()[0] if m["name"] in names and re.search(pattern, m["name"])]
        print(suite, len(left), flush=True)
        arguments, skipped, flags = SUITES[suite]
        command = ["cargo", "test", "-q", "--locked", *arguments]
        if left:
            test(left, suite, [*command, "--no-run"], command + skipped, {"RUSTFLAGS": flags}, 1800)


def write():
    """Writes the record; why a mutant that was missed is equivalent stays as it stands there."""
    mutants, total = drawn()
    known, _ = record()
    lines = COMMITTED.read_text().splitlines() if COMMITTED.exists() else []
    why = {row["mutant"]: row["why"] for row in csv.DictReader(line for line in lines if not line.startswith("#"))}
    with COMMITTED.open("w") as file:
        file.write(f"# {COUNT} of {total} mutants of cargo-mutants, by .ci/mutants.py\n")
        file.write(f"# CPU: any CPU\n# commit: {commit()}\n# date: {time.strftime('%Y-%m-%d')}\n")
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["mutant", "outcome", "suite", "why"])
        for name in sorted(mutant["name"] for mutant in mutants):
            outcome, suite = known.get(name, ["untested", ""])[:2]
            rows.writerow([name, outcome, suite, why.get(name, "") if outcome == "missed" else ""])


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))
    match sys.argv[1:]:
        case ["run", *names] if set(names) <= set(GROUPS):
            run(names)
        case ["missed", *suites] if suites and set(suites) <= set(SUITES):
            missed(suites)
        case ["write"]:
            write()
        case _:
            sys.exit(__doc__)
